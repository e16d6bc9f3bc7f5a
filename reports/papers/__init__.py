"""Reports on the reproduction of two papers, and what they share."""
