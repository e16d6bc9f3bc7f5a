"""One straight line, or one constant, through angle errors.

Ordinary least squares gives the statistics of the source paper (equations 2-4); generalised
least squares, with the propagated covariance of the angle errors, gives honest standard errors.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy import stats

from posstats.arrays import Floats, Ids
from posstats.errors import PosstatsError
from posstats.statistics.linear_model import (
    LinearFit,
    generalised_least_squares,
    ordinary_least_squares,
)

MIN_LINE_POINTS = 3
MIN_CONSTANT_POINTS = 2
ROUNDING = 1e-6
"""Asymmetry and negative eigenvalues of a covariance up to this share of its size are rounding:
adjustments of real blocks leave 1e-9, single precision 1e-7."""
TURN_GAPS = 3.0
"""A gap longer than this many usual (median) intervals starts a new cluster of exposures; two
missing photographs in a row do not."""


class FitError(PosstatsError, ValueError):
    """A regression that cannot be made."""


class ImpossibleFitError(FitError):
    """A regression that these data do not carry, for a reason with a `code` and `values`."""

    def __init__(self, message: str, code: str, **values: int) -> None:
        self.code = code
        self.values = values
        super().__init__(message)


@dataclass(frozen=True, eq=False)
class DriftFit:
    """A straight line error = intercept + slope * t.

    Attributes
    ----------
    slope, slope_se
        rad/s.
    sigma
        Residual standard deviation, rad: sqrt(sum of squares / (n - 2)), unweighted.
    rsquared
        Equation (3); for GLS in the metric of V^-1 (share of the scatter about the GLS mean).
        0 for a constant response.
    f_statistic
        Equation (4) with k = 1: (slope / slope_se)^2. 0 for a constant response; None where the
        points lie on a line to rounding (F has no bound then).
    f_pvalue
        P(F(df_model, df_resid) > f_statistic) of the hypothesis slope = 0.
    df_model, df_resid
        1, and n - 2; for GLS Satterthwaite's degrees of freedom of the slope.
    n, n_time_clusters
        Number of exposures, and of groups of exposures (see `time_clusters`).
    white_noise_sigma, strip_effect_sigma
        Estimated standard deviations, rad; None where the model has none.
    residuals
        (n,) error minus line, rad, in the order given.
    time_reference_s
        The exposure time nearest the mean.
    value_at_reference
        The line there, rad.
    covariance
        (2, 2) of (value_at_reference, slope).
    """

    slope: float
    slope_se: float
    sigma: float
    rsquared: float
    f_statistic: float | None
    f_pvalue: float
    df_model: int
    df_resid: float
    n: int
    n_time_clusters: int
    white_noise_sigma: float | None
    strip_effect_sigma: float | None
    residuals: Floats
    time_reference_s: float
    value_at_reference: float
    covariance: Floats

    def conf_int(self, level: float = 0.95) -> tuple[float, float]:
        """Confidence interval of the slope, rad/s."""
        if not 0.0 < level < 1.0:
            raise FitError(f"a confidence level lies between 0 and 1, not {level!r}")
        reach = float(stats.t.ppf(0.5 + 0.5 * level, self.df_resid)) * self.slope_se
        return self.slope - reach, self.slope + reach

    def predict(self, time_s: ArrayLike) -> tuple[Floats, Floats]:
        """The line and its standard error at times (m,), rad."""
        since = np.asarray(time_s, dtype=float) - self.time_reference_s
        (value, cross), (_, slope) = self.covariance
        variance = value + 2.0 * since * cross + since**2 * slope
        return self.value_at_reference + since * self.slope, np.sqrt(np.maximum(variance, 0.0))

    def intercept_at(self, time_s: float) -> tuple[float, float]:
        """Value of the line at one time and its standard error, rad."""
        value, se = self.predict(time_s)
        return float(value), float(se)

    def coefficient_covariance(self, time_s: float) -> Floats:
        """Covariance (2, 2) of (intercept at `time_s`, slope): rad^2, rad^2/s, rad^2/s^2."""
        move = np.array([[1.0, time_s - self.time_reference_s], [0.0, 1.0]])
        moved: Floats = move @ self.covariance @ move.T
        return moved


@dataclass(frozen=True)
class ConstantFit:
    """A constant error: value and standard error in rad, t test of the hypothesis value = 0."""

    value: float
    se: float
    df_resid: float
    p_value: float
    n: int


def fit_drift(
    time_s: ArrayLike,
    error_rad: ArrayLike,
    covariance: ArrayLike | None = None,
    *,
    strip: Sequence[object] | Ids | None = None,
) -> DriftFit:
    """Fit a straight line to angle errors.

    Parameters
    ----------
    time_s, error_rad
        (n,) exposure times in seconds of any origin, and errors in radians; n >= 3.
    covariance
        (n, n) covariance of the errors, absolute, rad^2. Without it the fit is OLS. With it the
        fit is GLS, and the variance of additional white noise is estimated by REML.
    strip
        (n,) strip of every exposure: GLS gets a random constant per strip, its variance
        estimated too. Needs `covariance` (zeros if nothing is known).

    Raises
    ------
    FitError
        (a PosstatsError and a ValueError) for fewer than three exposures, equal times, values
        that are not finite, arrays that do not fit, a covariance that is not symmetric and
        positive semidefinite.

    Examples
    --------
    >>> import posstats
    >>> fit = posstats.fit_drift([0.0, 10.0, 20.0, 30.0], [1.0e-5, 1.6e-5, 2.3e-5, 2.8e-5])
    >>> print(f"{fit.slope:.2e} +- {fit.slope_se:.2e} rad/s, R2 {fit.rsquared:.4f}")
    6.10e-07 +- 2.65e-08 rad/s, R2 0.9963
    >>> low, high = fit.conf_int()
    >>> print(f"95 % interval {low:.2e} to {high:.2e} rad/s, p {fit.f_pvalue:.4f}")
    95 % interval 4.96e-07 to 7.24e-07 rad/s, p 0.0019
    """
    time, error = _paired(time_s, error_rad, MIN_LINE_POINTS)
    reference = int(np.argmin(np.abs(time - time[0] - np.mean(time - time[0]))))
    # Differences from one exposure are exact where the times are: no origin, however far,
    # costs digits. The powers of two below cost none either.
    since = time - time[reference]
    if not since.any():
        raise ImpossibleFitError(
            "all exposure times are equal: a drift has no meaning", "equal_times"
        )
    span = _power_of_two(float(np.abs(since).max()))
    design = np.column_stack([np.ones(len(time)), since / span])
    units = np.array([1.0, 1.0 / span])
    fit = _fitted(error, error[reference], design, units, covariance, strip)
    return _drift_fit(fit, time, error, reference)


def fit_constant(
    error_rad: ArrayLike,
    covariance: ArrayLike | None = None,
    *,
    strip: Sequence[object] | Ids | None = None,
) -> ConstantFit:
    """Fit a constant to angle errors (n,), n >= 2; arguments and errors as in `fit_drift`."""
    _, error = _paired(error_rad, error_rad, MIN_CONSTANT_POINTS)
    fit = _fitted(error, error[0], np.ones((len(error), 1)), np.ones(1), covariance, strip)
    value = float(fit.coefficients[0] + error[0])
    se, df = float(np.sqrt(fit.covariance[0, 0])), float(fit.df[0])
    ratio = abs(value) / se if se > 0.0 else np.inf if value else 0.0
    p_value = 2.0 * float(stats.t.sf(ratio, df))
    return ConstantFit(value, se, df, p_value, len(error))


def time_clusters(time_s: ArrayLike) -> int:
    """Number of groups of exposures separated by gaps over `TURN_GAPS` median intervals.

    Errors vary together within a group more than between groups, so this number says more
    about what a drift rests on than the number of exposures does.
    """
    intervals = np.diff(np.unique(np.asarray(time_s, dtype=float)))
    if len(intervals) == 0:
        return 1
    return 1 + int(np.count_nonzero(intervals > TURN_GAPS * np.median(intervals)))


def _paired(time_s: ArrayLike, error_rad: ArrayLike, n_min: int) -> tuple[Floats, Floats]:
    try:
        time, error = np.asarray(time_s, dtype=float), np.asarray(error_rad, dtype=float)
    except (TypeError, ValueError) as problem:
        raise FitError(f"times and errors must be numbers: {problem}") from problem
    if time.ndim != 1 or time.shape != error.shape:
        raise FitError(
            f"times {time.shape} and errors {error.shape} must be two lists of equal length"
        )
    if not (np.isfinite(time).all() and np.isfinite(error).all()):
        raise FitError("times and errors must be finite: leave images without a value out")
    if len(time) < n_min:
        images = "1 image is" if len(time) == 1 else f"{len(time)} images are"
        raise ImpossibleFitError(
            f"{images} too few: this fit needs at least {n_min}",
            "too_few_images",
            n=len(time),
            n_needed=n_min,
        )
    return time, error


def _fitted(
    error: Floats,
    offset: float,
    design: Floats,
    coefficient_units: Floats,
    covariance: ArrayLike | None,
    strip: Sequence[object] | Ids | None,
) -> LinearFit:
    """Fit error - offset on `design`, scaled to order 1; coefficients come back in radians."""
    y = error - offset
    if covariance is None:
        if strip is not None:
            raise FitError("a strip effect needs a covariance matrix (zeros if nothing is known)")
        scale = _power_of_two(np.abs(y).max())
        return ordinary_least_squares(y / scale, design).rescaled(scale, coefficient_units)
    known, strips = _checked_covariance(covariance, len(y)), _strip_matrix(strip, len(y))
    scale = _power_of_two(max(np.abs(y).max(), np.sqrt(np.diag(known).max())))
    fit = ordinary_least_squares(y / scale, design)
    if known.any() or not _exact(fit.residuals * scale, error):
        try:
            fit = generalised_least_squares(y / scale, design, known / scale**2, strips)
        except np.linalg.LinAlgError as problem:
            raise ImpossibleFitError(
                "the covariance matrix of the angle errors is singular", "singular_covariance"
            ) from problem
    return fit.rescaled(scale, coefficient_units)


def _drift_fit(fit: LinearFit, time: Floats, error: Floats, reference: int) -> DriftFit:
    slope, slope_se = float(fit.coefficients[1]), float(np.sqrt(fit.covariance[1, 1]))
    df = float(fit.df[1])
    f_statistic: float | None
    if _exact(error - error[reference], error):
        rsquared, f_statistic, p_value = 0.0, 0.0, 1.0
    elif slope_se == 0.0 or (fit.white_noise_variance is None and _exact(fit.residuals, error)):
        rsquared, f_statistic, p_value = 1.0, None, 0.0
    else:
        f_statistic = (slope / slope_se) ** 2
        rsquared = _explained(f_statistic, fit, len(time))
        p_value = float(stats.f.sf(f_statistic, 1, df))
    return DriftFit(
        slope=slope,
        slope_se=slope_se,
        sigma=float(np.sqrt(np.sum(fit.residuals**2) / (len(time) - 2))),
        rsquared=rsquared,
        f_statistic=f_statistic,
        f_pvalue=p_value,
        df_model=1,
        df_resid=df,
        n=len(time),
        n_time_clusters=time_clusters(time),
        white_noise_sigma=_root(fit.white_noise_variance),
        strip_effect_sigma=_root(fit.strip_effect_variance),
        residuals=fit.residuals,
        time_reference_s=float(time[reference]),
        value_at_reference=float(fit.coefficients[0] + error[reference]),
        covariance=fit.covariance,
    )


def _explained(f_statistic: float, fit: LinearFit, n: int) -> float:
    """R2 from F: for OLS F / (F + n - 2); for GLS F is itself the explained sum of squares."""
    unexplained = float(n - 2) if fit.white_noise_variance is None else fit.weighted_ss
    return f_statistic / (f_statistic + unexplained)


def _checked_covariance(covariance: ArrayLike, n: int) -> Floats:
    try:
        known = np.asarray(covariance, dtype=float)
    except (TypeError, ValueError) as problem:
        raise FitError(f"the covariance must be a matrix of numbers: {problem}") from problem
    if known.shape != (n, n):
        raise FitError(f"the covariance of {n} errors must be {n} x {n}, not {known.shape}")
    if not np.isfinite(known).all():
        raise ImpossibleFitError(
            "the covariance must be finite: leave images without a value out", "infinite_covariance"
        )
    size = np.abs(known).max()
    if np.abs(known - known.T).max() > ROUNDING * size:
        raise ImpossibleFitError("the covariance is not symmetric", "asymmetric_covariance")
    symmetric: Floats = 0.5 * (known + known.T)
    if size > 0.0 and np.linalg.eigvalsh(symmetric / size)[0] < -ROUNDING:
        raise ImpossibleFitError(
            "the covariance is not positive semidefinite", "indefinite_covariance"
        )
    return symmetric


def _strip_matrix(strip: Sequence[object] | Ids | None, n: int) -> Floats | None:
    """Z (n, S); None where a strip effect means nothing: one strip, or one image per strip."""
    if strip is None:
        return None
    if len(strip) != n:
        raise FitError(f"{len(strip)} strip ids for {n} errors")
    number = {label: k for k, label in enumerate(dict.fromkeys(strip))}
    if len(number) in (1, n):
        return None
    matrix: Floats = np.eye(len(number))[[number[label] for label in strip]]
    return matrix


def _exact(difference: Floats, error: Floats) -> bool:
    """True where `difference` is nothing but the rounding of the errors."""
    return bool(np.abs(difference).max() <= 4.0 * np.finfo(float).eps * np.abs(error).max())


def _root(variance: float | None) -> float | None:
    return None if variance is None else float(np.sqrt(variance))


def _power_of_two(size: float) -> float:
    """The power of two next above `size`: dividing by it costs no digits."""
    return float(np.ldexp(1.0, int(np.frexp(size)[1])))
