"""Regression on time, and accuracy measures with their intervals and tests."""
