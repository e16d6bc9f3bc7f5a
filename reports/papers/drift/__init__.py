"""The first paper: drift of POS angles."""
