"""What knows arrays only: compiled kernels, solvers, the bundle's least-squares engine."""
