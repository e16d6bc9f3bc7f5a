"""The POS-supported self-calibrating bundle block adjustment: arrays in, arrays out."""

from posstats.numerics.bundle.gauss_newton import adjust
from posstats.numerics.bundle.problem import AdjustedBundle, BundleProblem

__all__ = ["AdjustedBundle", "BundleProblem", "adjust"]
