"""The coplanarity adjustment of a block: angle errors without object points."""
