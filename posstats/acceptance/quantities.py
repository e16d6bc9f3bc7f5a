"""How every quantity of a profile is found from the evidence; or why it cannot be."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from posstats.acceptance.evidence import Evidence
from posstats.acceptance.product import Product
from posstats.acceptance.published import (
    asprs_product_accuracy,
    nssda_accuracy_h,
    nssda_accuracy_v,
)
from posstats.acceptance.reasons import Reason, Unavailable
from posstats.arrays import Floats
from posstats.statistics.rmse import MIN_POINTS, RmseInterval, rmse_interval

COMPONENTS: Mapping[str, tuple[int, ...]] = MappingProxyType(
    {"x": (0,), "y": (1,), "h": (0, 1), "v": (2,), "3d": (0, 1, 2)}
)
"""Columns of the differences that an RMSE joins."""


@dataclass(frozen=True)
class Found:
    """A quantity as it was found, with its 95 % interval where one is known; NaN where not.

    Of an RMSE that holds the accuracy of the survey, `survey_m` is that accuracy: more check
    points make it no better.
    """

    value: float
    low: float = float("nan")
    high: float = float("nan")
    df_per_point: float | None = None
    survey_m: float = 0.0


@dataclass(frozen=True)
class Question:
    """The evidence and what else a quantity may need."""

    evidence: Evidence
    product: Product
    threshold: float | None = None

    def differences(self, component: str) -> Floats:
        """(n, k) of the components that an RMSE joins.

        Raises
        ------
        Unavailable
            Without check points.
        """
        if len(self.evidence) == 0:
            raise Unavailable(Reason(code="no check points"))
        return self.evidence.difference_m[:, COMPONENTS[component]]

    def lengths(self, component: str) -> Floats:
        """(n,) lengths of the differences."""
        lengths: Floats = np.linalg.norm(self.differences(component), axis=1)
        return lengths

    def survey(self, component: str) -> float:
        """Root mean square accuracy of the check points' survey, m.

        Raises
        ------
        Unavailable
            Without check points, or where the accuracy of one is not stated.
        """
        self.differences(component)
        squares = np.zeros(len(self.evidence))
        if component in ("h", "3d"):
            squares += self.evidence.survey_h_m**2
        if component in ("v", "3d"):
            squares += self.evidence.survey_v_m**2
        if np.isnan(squares).any():
            raise Unavailable(Reason(code="survey accuracy not stated"))
        return float(np.sqrt(squares.mean()))


def rmse(question: Question, component: str) -> RmseInterval:
    """Root mean square error of a component, mean shift kept, with its 95 % interval.

    Raises
    ------
    Unavailable
        With fewer check points than an interval takes: such a value says nothing.
    """
    differences = question.differences(component)
    if len(differences) < MIN_POINTS:
        raise Unavailable(
            Reason(code="too few points", values={"n": len(differences), "needed": MIN_POINTS})
        )
    return rmse_interval(differences)


def _rmse(component: str) -> Callable[[Question], Found]:
    def find(question: Question) -> Found:
        return _found(rmse(question, component))

    return find


def _found(interval: RmseInterval, survey_m: float = 0.0) -> Found:
    """An RMSE; with the accuracy of the survey added in quadrature (ASPRS 7.11)."""
    values = (interval.rmse, interval.low, interval.high)
    value, low, high = (
        float("nan") if each is None else asprs_product_accuracy(each, survey_m) for each in values
    )
    return Found(value, low, high, interval.df_per_point, survey_m)


def _product_rmse(component: str) -> Callable[[Question], Found]:
    def find(question: Question) -> Found:
        return _found(rmse(question, component), question.survey(component))

    return find


def _accuracy_h_95(question: Question) -> Found:
    x, y = (rmse(question, component).rmse or 0.0 for component in "xy")
    found = nssda_accuracy_h(x, y)
    if found.value is None:
        raise Unavailable(Reason(code="nssda ratio", values={"ratio": found.ratio}))
    return Found(found.value)


def _accuracy_v_95(question: Question) -> Found:
    found = rmse(question, "v")
    values = (found.rmse, found.low, found.high)
    value, low, high = (float("nan") if each is None else nssda_accuracy_v(each) for each in values)
    return Found(value, low, high, found.df_per_point)


def _mean_error(component: str) -> Callable[[Question], Found]:
    def find(question: Question) -> Found:
        mean = question.differences(component).mean(axis=0)
        return Found(float(np.linalg.norm(mean)))

    return find


def _largest_mean_error(question: Question) -> Found:
    return Found(float(np.abs(question.differences("3d").mean(axis=0)).max()))


def _largest(component: str) -> Callable[[Question], Found]:
    def find(question: Question) -> Found:
        return Found(float(question.lengths(component).max()))

    return find


def _largest_over_rmse(component: str) -> Callable[[Question], Found]:
    def find(question: Question) -> Found:
        lengths = question.lengths(component)
        scale = float(np.sqrt(np.mean(lengths**2)))
        return Found(float(lengths.max()) / scale if scale > 0.0 else 0.0)

    return find


def _n_blunders(component: str) -> Callable[[Question], Found]:
    def find(question: Question) -> Found:
        lengths = question.lengths(component)
        if question.threshold is None:
            return Found(float("nan"))
        return Found(float(np.sum(lengths > question.threshold)))

    return find


def _survey(component: str) -> Callable[[Question], Found]:
    return lambda question: Found(question.survey(component))


def _measured_share(question: Question) -> Found:
    if question.evidence.n_given == 0:
        raise Unavailable(Reason(code="no check points"))
    return Found(len(question.evidence) / question.evidence.n_given)


def _quadrant_share(question: Question) -> Found:
    question.differences("h")
    return Found(question.evidence.quadrant_share)


def _parallax(statistic: Callable[[Floats], float]) -> Callable[[Question], Found]:
    def find(question: Question) -> Found:
        parallax = question.evidence.parallax_px
        return Found(statistic(parallax) if len(parallax) else float("nan"))

    return find


def _root_mean_square(values: Floats) -> float:
    return float(np.sqrt(np.mean(values**2)))


def _largest_value(values: Floats) -> float:
    return float(values.max())


def _sample_size(question: Question) -> Found:
    if question.product.sample_size is None:
        raise Unavailable(Reason(code="product value missing", values={"name": "sample_size"}))
    return Found(float(question.product.sample_size))


FINDERS: Mapping[str, Callable[[Question], Found]] = MappingProxyType(
    {
        **{f"rmse_{component}": _rmse(component) for component in COMPONENTS},
        **{f"product_rmse_{component}": _product_rmse(component) for component in ("h", "v", "3d")},
        "accuracy_h_95": _accuracy_h_95,
        "accuracy_v_95": _accuracy_v_95,
        **{f"mean_error_{component}": _mean_error(component) for component in "hv"},
        "largest_mean_error": _largest_mean_error,
        **{f"largest_residual_{component}": _largest(component) for component in "hv"},
        **{f"largest_residual_{c}_over_rmse": _largest_over_rmse(c) for c in "hv"},
        **{f"n_blunders_{component}": _n_blunders(component) for component in "hv"},
        **{f"survey_{component}": _survey(component) for component in "hv"},
        "n_check_points": lambda question: Found(float(len(question.evidence))),
        "measured_share": _measured_share,
        "quadrant_share": _quadrant_share,
        "parallax_rms_px": _parallax(_root_mean_square),
        "parallax_largest_px": _parallax(_largest_value),
        "image_rms_px": lambda question: Found(question.evidence.image_rms_px),
        "sigma0": lambda question: Found(question.evidence.sigma0),
        "remaining_drift_p": lambda question: Found(question.evidence.drift_p),
        "sample_size": _sample_size,
    }
)
"""By the names of `QUANTITIES`."""


def find(name: str, question: Question) -> Found:
    """The value of a quantity.

    Raises
    ------
    Unavailable
        With the reason, where the evidence does not say.
    """
    found = FINDERS[name](question)
    if np.isnan(found.value):
        values = {"quantity": name, "orientation": question.evidence.orientation}
        raise Unavailable(Reason(code="quantity not available", values=values))
    return found
