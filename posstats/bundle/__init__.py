"""The POS-supported self-calibrating bundle block adjustment: arrays in, arrays out."""

from posstats.bundle.gauss_newton import adjust
from posstats.bundle.problem import AdjustedBundle, BundleProblem

__all__ = ["AdjustedBundle", "BundleProblem", "adjust"]
