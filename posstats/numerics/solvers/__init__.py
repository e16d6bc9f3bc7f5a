"""Least-squares solvers: dense, and block-sparse with selected inverse."""
