"""From a block to its results: angle errors, regression, rules, correction."""
