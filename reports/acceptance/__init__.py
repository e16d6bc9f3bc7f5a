"""The acceptance document."""
