"""The report of a block, a file a topic."""
