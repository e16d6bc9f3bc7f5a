"""Reports on the two papers' experiments."""
