"""Whether an acceptance document is what it says."""
