"""The POS-supported self-calibrating bundle block adjustment (second source paper).

Image coordinates, antenna positions, IMU angles, control points and prior values of additional
parameters are adjusted together by least squares: Gauss-Newton, where a step would raise the
weighted sum of squares shortened, or damped after Levenberg and Marquardt.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from posstats.arrays import Floats
from posstats.errors import ConvergenceError, GeometryError
from posstats.numerics.bundle.problem import AdjustedBundle, BundleProblem, ObservationGroup
from posstats.numerics.bundle.system import BundleSystem, Equations, State
from posstats.numerics.solvers.arrow import SelectedInverse
from posstats.numerics.solvers.robust import huber_weights, kept_weights, median_scale

MAX_ITERATIONS = 100
_SETTLED = 1e-4  # length of the next step, in standard deviations of all unknowns together
_ROUGHLY = 0.1  # mean square step in standard deviations from which on weights are settled
_FIRST_DAMPING = 1e-2
_LEAST_DAMPING = 1e-7
_MOST_DAMPING = 1e8
# Parts of a step, and whether points are intersected anew after it: turns of a weakly held block
# by degrees are no straight lines, and damping would take hundreds of steps.
_TRIALS = ((1.0, False), (1.0, True), (0.25, True))


def adjust(
    problem: BundleProblem,
    *,
    robust: bool = False,
    progress: Callable[[int, int], object] | None = None,
) -> AdjustedBundle:
    """Adjust a block.

    Points that their rays do not determine are left out. The robust solution reweights image
    rays after Huber until it settles, then takes out rays beyond 3.5 standard deviations (median
    absolute deviation), fixes that choice and converges as least squares.

    Raises
    ------
    ConvergenceError
        If it does not settle in `MAX_ITERATIONS` steps, trials that failed counted.
    UndeterminedError
        If observations and priors do not determine every orientation and parameter.
    GeometryError
        If start values put points behind cameras, or a parameter has no scope.
    """
    iteration = _Iteration(progress)
    system = BundleSystem.of(problem)
    system, equations = _linearised(system, system.start)
    if robust:
        stated = system.weight
        for weights in (_huber, _kept):
            length, roughly = np.inf, _ROUGHLY * system.n_unknowns
            while length > roughly:
                weight = stated * weights(
                    system.residuals(equations.state) * np.sqrt(stated)[:, None]
                )
                system, equations = _linearised(system.with_weight(weight), equations.state)
                equations, length = iteration.step(system, equations)
    equations, length = iteration.step(system, equations)
    foretold = np.inf
    while not foretold < _SETTLED**2:
        before = length
        equations, length = iteration.step(system, equations)
        foretold = _next_square(before, length)
    return _result(system, equations, iteration.count)


def _next_square(before: float, last: float) -> float:
    """Square of the next step, if steps shrink on as the last two (squares) did."""
    if np.isinf(before):
        return np.inf
    return last if last >= before else last**2 / before


def _linearised(system: BundleSystem, state: State) -> tuple[BundleSystem, Equations]:
    """The equations at a state, and the system without points that are not determined there."""
    equations = system.equations(state)
    if not np.isfinite(equations.cost):
        raise GeometryError("points lie behind cameras: check the angles, their system and axes")
    if equations.determined.all():
        return system, equations
    kept = np.repeat(equations.determined, np.diff(system.rays.groups.first_ray))
    system = system.with_weight(np.where(kept, system.weight, 0.0))
    return system, system.equations(state)


@dataclass
class _Iteration:
    """Steps to smaller sums of squares, counted over all phases."""

    progress: Callable[[int, int], object] | None
    count: int = 0

    def step(self, system: BundleSystem, equations: Equations) -> tuple[Equations, float]:
        """The next equations, and the square of the step to them in standard deviations.

        A damped step, or part of one, has no such length: it is infinite.
        """
        while True:
            damping = equations.damping
            eased = 0.1 * damping if damping > 10.0 * _LEAST_DAMPING else 0.0
            for fraction, anew in _TRIALS:
                self._counted(equations)
                state, square = system.step(equations, fraction)
                after = system.equations(system.intersected(state) if anew else state, eased)
                # the sums of squares before and after a settled step differ by rounding only
                allowed = np.inf if square < _SETTLED**2 else equations.cost
                if after.determined.all() and after.cost < allowed:
                    whole = damping == 0.0 and fraction == 1.0
                    return after, square if whole else np.inf
                if not np.isfinite(after.cost):
                    break
            damping = 10.0 * damping if damping > 0.0 else _FIRST_DAMPING
            equations = system.equations(equations.state, damping)

    def _counted(self, equations: Equations) -> None:
        if self.count == MAX_ITERATIONS or equations.damping > _MOST_DAMPING:
            raise ConvergenceError(
                f"the bundle adjustment did not settle in {self.count} steps: check the angles,"
                " their system, and the identities of the points"
            )
        self.count += 1
        if self.progress is not None:
            self.progress(self.count, MAX_ITERATIONS)


def _huber(standardised: Floats) -> Floats:
    """(m,) Huber's weights of rays by the larger of their standardised residuals (m, 2)."""
    return huber_weights(_largest(standardised), median_scale(standardised))


def _kept(standardised: Floats) -> Floats:
    """(m,) 1, or 0 of blunders."""
    return kept_weights(_largest(standardised), median_scale(standardised))


def _largest(standardised: Floats) -> Floats:
    """(m,) the larger of two residuals, infinite behind a camera (rays of points left out)."""
    largest: Floats = np.nan_to_num(np.abs(standardised).max(axis=1), nan=np.inf)
    return largest


def _result(system: BundleSystem, equations: Equations, n_iterations: int) -> AdjustedBundle:
    problem, state = system.problem, equations.state
    inverse, precision = system.precision(equations)
    residual_px = _by_ray(system, system.residuals(state))
    redundancy_px = _by_ray(system, precision.redundancy)
    ground_m = _by_point(system, state.ground_m)
    covariance = _by_point(system, precision.covariance_m2)
    ground_m[np.isnan(covariance[:, 0, 0])] = np.nan
    control = problem.control
    residual_control = ground_m[control.point] - control.position_m
    redundancy_control = 1.0 - np.einsum(
        "gij,gji->gi", system.control_weight, covariance[control.point]
    )
    redundancy_pos = _pos_redundancy(system, equations, inverse)
    prior = np.array([parameter.weight for parameter in problem.parameters])
    redundancy_prior = np.where(prior > 0.0, 1.0 - prior * np.diagonal(inverse.corner), np.nan)
    redundancies = {
        "image": redundancy_px,
        "gnss": redundancy_pos[:, :3],
        "imu": redundancy_pos[:, 3:],
        "control": redundancy_control,
        "parameters": redundancy_prior,
    }
    groups = {
        name: ObservationGroup(int(np.isfinite(r).sum()), square_sum, float(np.nansum(r)))
        for (name, r), square_sum in zip(redundancies.items(), equations.square_sums, strict=True)
    }
    n_points = int(np.isfinite(covariance[:, 0, 0]).sum())
    n_unknowns = 3 * n_points + 6 * len(state.position_m) + len(state.common)
    return AdjustedBundle(
        ground_from_image=state.ground_from_image,
        position_m=state.position_m,
        ground_m=ground_m,
        common=state.common,
        inverse=inverse,
        ground_covariance_m2=covariance,
        residual_px=residual_px,
        redundancy_px=redundancy_px,
        residual_pos=equations.pos.residual,
        redundancy_pos=redundancy_pos,
        residual_control_m=residual_control,
        redundancy_control=redundancy_control,
        rejected=np.isnan(redundancy_px[:, 0]),
        groups=groups,
        dof=sum(group.n for group in groups.values()) - n_unknowns,
        n_iterations=n_iterations,
        system=problem.pos.system,
    )


def _by_ray(system: BundleSystem, values: Floats) -> Floats:
    """(m, ...) in the order of the problem."""
    result = np.empty_like(values)
    result[system.rays.ray] = values
    return result


def _by_point(system: BundleSystem, values: Floats) -> Floats:
    """(p, ...) in the order of the problem, NaN of points without rays."""
    result = np.full((len(system.problem.ground_m), *values.shape[1:]), np.nan)
    result[system.rays.point] = values
    return result


def _pos_redundancy(system: BundleSystem, equations: Equations, inverse: SelectedInverse) -> Floats:
    """(n, 6) redundancy numbers of antenna positions and angles, NaN where not observed."""
    pos, weight = equations.pos, system.problem.pos.weight
    image = np.arange(len(weight))
    own = inverse.blocks(image, image)
    variance = ((pos.by_pose @ own) * pos.by_pose).sum(axis=2)
    crossed = 2.0 * pos.by_pose @ inverse.border + pos.by_common @ inverse.corner
    variance += (crossed * pos.by_common).sum(axis=2)
    return np.where(weight > 0.0, 1.0 - weight * variance, np.nan)
