"""The second source paper's experiment: POS errors removed within the adjustment of a block."""
