"""Additional parameters that a block does not need, or cannot determine, are dropped in order."""

from dataclasses import dataclass, replace

from posstats.adjustment.significance import ParameterTest, parameter_tests
from posstats.contract.adjustment import DropReason
from posstats.errors import UndeterminedError
from posstats.numerics.bundle import adjust
from posstats.numerics.bundle.parameters import (
    GNSS_DRIFTS,
    GNSS_SHIFTS,
    IMU_DRIFTS,
    IMU_SHIFTS,
    CommonParameter,
)
from posstats.numerics.bundle.problem import AdjustedBundle, BundleProblem

_SHIFTS = (*GNSS_SHIFTS, *IMU_SHIFTS)
_DRIFTS = (*GNSS_DRIFTS, *IMU_DRIFTS)


@dataclass(frozen=True)
class Dropped:
    """A parameter that was dropped.

    Attributes
    ----------
    parameter
        As it was.
    reason
        ``singular``: without it the normal equations may be regular; ``not determined``: not
        significant, and see `ParameterTest`; ``not significant``.
    test
        Its test at that time; None where the equations were singular.
    """

    parameter: CommonParameter
    reason: DropReason
    test: ParameterTest | None


@dataclass(frozen=True, eq=False)
class Selection:
    """The parameters that are left.

    Attributes
    ----------
    dropped
        In order.
    problem, result
        Without them, and its adjustment.
    """

    dropped: tuple[Dropped, ...]
    problem: BundleProblem
    result: AdjustedBundle


def select_parameters(problem: BundleProblem) -> Selection:
    """Drop parameters one at a time, the least significant first, and adjust again.

    While the normal equations are singular, the last of the parameters of their null space goes.
    Never dropped are weighted observations: shifts and drifts with a prior, and whatever is
    known beforehand to be other than 0; and a shift while its drift is in, as it depends on the
    origin of time whether that is significant.

    Raises
    ------
    UndeterminedError
        If the equations are singular for other reasons.
    ConvergenceError, GeometryError
        As `adjust`.
    """
    dropped: list[Dropped] = []
    while True:
        try:
            result = adjust(problem)
        except UndeterminedError as error:
            at = _last_open(problem, error)
            dropped.append(Dropped(problem.parameters[at], "singular", None))
            problem = _without(problem, at)
            continue
        tests = parameter_tests(problem, result)
        useless = [at for at in _droppable(problem) if not tests[at].significant]
        if not useless or result.dof <= 0:
            return Selection(tuple(dropped), problem, result)
        at = max(useless, key=lambda each: tests[each].p)
        reason: DropReason = "not significant" if tests[at].determined else "not determined"
        dropped.append(Dropped(problem.parameters[at], reason, tests[at]))
        problem = _without(problem, at)


def _last_open(problem: BundleProblem, error: UndeterminedError) -> int:
    """The last parameter of the null space that may be dropped; the error, if there is none."""
    candidates = sorted(set(error.common) & set(_droppable(problem)))
    if not candidates:
        raise error
    return candidates[-1]


def _droppable(problem: BundleProblem) -> list[int]:
    names = {(parameter.name, parameter.scope) for parameter in problem.parameters}
    return [
        at
        for at, parameter in enumerate(problem.parameters)
        if not _weighted(parameter)
        and not (
            parameter.name in _SHIFTS
            and (_DRIFTS[_SHIFTS.index(parameter.name)], parameter.scope) in names
        )
    ]


def _weighted(parameter: CommonParameter) -> bool:
    """Whether a parameter is an observation that the adjustment must not lose."""
    trend = parameter.name in (*_SHIFTS, *_DRIFTS)
    return parameter.sigma is not None and (trend or parameter.value != 0.0)


def _without(problem: BundleProblem, at: int) -> BundleProblem:
    return replace(problem, parameters=problem.parameters[:at] + problem.parameters[at + 1 :])
