"""Typefaces: subsets, Chinese, bold."""
