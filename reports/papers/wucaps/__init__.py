"""The second paper: the POS calibrates itself in the adjustment."""
