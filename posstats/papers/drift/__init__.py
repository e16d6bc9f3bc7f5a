"""The first source paper's experiment: its printed numbers, and the same chain on known truth."""
