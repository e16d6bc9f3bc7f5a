"""The terminal that commands print on."""

WIDTH = 88  # letters of a line
