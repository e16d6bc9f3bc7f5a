"""The report of a bundle block adjustment."""
