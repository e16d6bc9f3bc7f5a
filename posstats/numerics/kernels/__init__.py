"""Compiled kernels: rotations, collinearity, coplanarity; arrays in, arrays out."""
