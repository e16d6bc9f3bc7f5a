"""The normal equations of a bundle problem at a state of its unknowns, and steps between states."""

from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np

from posstats.arrays import Bools, Floats, Ints
from posstats.numerics.bundle.ground_points import intersect_points, move_points, ray_residuals
from posstats.numerics.bundle.normals import Reduced, accumulate
from posstats.numerics.bundle.parameters import ParameterEffects, parameter_effects
from posstats.numerics.bundle.point_groups import GroupedRays, grouped
from posstats.numerics.bundle.point_normals import Ground, Measured, Network
from posstats.numerics.bundle.pos_observations import LinearisedPos, linearised_pos
from posstats.numerics.bundle.precision import Cofactors, PointPrecision, point_precision
from posstats.numerics.bundle.problem import BundleProblem
from posstats.numerics.bundle.rays import CAMERA_PARAMETERS, Cameras, Images
from posstats.numerics.kernels.rotation import rotation_from_vector
from posstats.numerics.solvers.arrow import ArrowMatrix, SelectedInverse, factorised
from posstats.numerics.solvers.levels import Levels, breadth_first_levels

_T = TypeVar("_T")


@dataclass(frozen=True, eq=False)
class State:
    """Values of all unknowns: rotations, projection centres, points by group, parameters."""

    ground_from_image: Floats
    position_m: Floats
    ground_m: Floats
    common: Floats


@dataclass(frozen=True, eq=False)
class Equations:
    """Normal equations of images and additional parameters at a state.

    Attributes
    ----------
    state
        Where they are linearised.
    matrix
        Reduced by the points.
    images, common
        (n, 6), (k,) gradient.
    square_sums
        v'Pv of image, gnss, imu, control and parameters.
    gain
        What the steps of the points alone would take from their sum.
    damping
        Of the points' elements.
    determined
        (p,) points, in the order of the groups.
    pos
        The linearised POS observations.
    """

    state: State
    matrix: ArrowMatrix
    images: Floats
    common: Floats
    square_sums: tuple[float, float, float, float, float]
    gain: float
    damping: float
    determined: Bools
    pos: LinearisedPos

    @property
    def cost(self) -> float:
        """V'Pv of all observations."""
        return sum(self.square_sums)


@dataclass(frozen=True, eq=False)
class BundleSystem:
    """A problem with its rays in groups.

    Image coordinates `xy_px` (m, 2), their weights (m,), 1/px2, and the indices `control` (p,)
    of surveyed points are in that order.
    """

    problem: BundleProblem
    rays: GroupedRays
    levels: Levels
    effects: ParameterEffects
    xy_px: Floats
    weight: Floats
    control: Ints
    control_weight: Floats

    @classmethod
    def of(cls, problem: BundleProblem) -> "BundleSystem":
        """Sort a problem for adjustment."""
        n_images = len(problem.position_m)
        rays = grouped(problem.point, problem.image, n_images)
        control = np.full(len(problem.ground_m), -1)
        control[problem.control.point] = np.arange(len(problem.control.point))
        return cls(
            problem,
            rays,
            breadth_first_levels(rays.first, rays.second, n_images),
            parameter_effects(problem.parameters, problem.exposures),
            problem.xy_px[rays.ray],
            problem.sigma_px[rays.ray] ** -2.0,
            control[rays.point],
            np.asarray(np.linalg.inv(problem.control.covariance_m2), dtype=float),
        )

    @property
    def start(self) -> State:
        """The start values."""
        problem = self.problem
        values = np.array([parameter.value for parameter in problem.parameters])
        return State(
            problem.ground_from_image,
            problem.position_m,
            problem.ground_m[self.rays.point],
            values,
        )

    @property
    def n_unknowns(self) -> int:
        """Number of all unknowns."""
        problem = self.problem
        n_points = len(self.rays.point)
        return 6 * len(problem.position_m) + 3 * n_points + len(problem.parameters)

    def with_weight(self, weight: Floats) -> "BundleSystem":
        """The same with other weights (m,) of the rays, in the order of the groups."""
        return replace(self, weight=weight)

    def equations(self, state: State, damping: float = 0.0) -> Equations:
        """Linearise at a state; one pass over the rays."""
        kept, network = np.ones(len(state.ground_m), dtype=bool), self._network(state)

        def accumulated(part: tuple[int, int]) -> tuple[Reduced, tuple[float, float, float]]:
            reduced = self._empty()
            return reduced, accumulate(*part, network, damping, kept, reduced)

        reduced, sums = _added(_in_threads(accumulated, self.rays.parts))
        return self._with_pos(state, reduced, sums, damping, kept)

    def _with_pos(
        self,
        state: State,
        reduced: Reduced,
        sums: tuple[float, float, float],
        damping: float,
        kept: Bools,
    ) -> Equations:
        """Add what POS and the parameters' priors say to the sums of the kernel."""
        pos = linearised_pos(
            self.problem.pos, state.ground_from_image, state.position_m, self.effects, state.common
        )
        weighted = self.problem.pos.weight * pos.residual
        pos_sums = (weighted * pos.residual).sum(axis=0)
        prior = np.array([parameter.weight for parameter in self.problem.parameters])
        start = np.array([parameter.value for parameter in self.problem.parameters])
        camera = self.effects.camera
        images = reduced.images + np.einsum("nra,nr->na", pos.by_pose, weighted)
        common = np.einsum("nrk,nr->k", pos.by_common, weighted) + prior * (state.common - start)
        common[camera] += reduced.common
        return Equations(
            state,
            self._matrix(reduced, pos, prior),
            images,
            common,
            (
                sums[0],
                float(pos_sums[:3].sum()),
                float(pos_sums[3:].sum()),
                sums[1],
                float(prior @ (state.common - start) ** 2),
            ),
            sums[2],
            damping,
            kept,
            pos,
        )

    def step(self, equations: Equations, fraction: float = 1.0) -> tuple[State, float]:
        """The state after (part of) a step, and g'N^-1 g: the square of all of it in sigma.

        Raises
        ------
        UndeterminedError
            If the normal equations are singular.
        """
        state, damping = equations.state, equations.damping
        matrix = equations.matrix
        if damping > 0.0:
            images, common = matrix.diagonal()
            matrix = matrix.plus_diagonal(damping * images, damping * common)
        factor = factorised(matrix, self.levels)
        solved = factor.solve(-equations.images[:, :, None], -equations.common[:, None])
        image_step, common_step = solved[0][:, :, 0], solved[1][:, 0]
        square = equations.gain - float(
            (image_step * equations.images).sum() + common_step @ equations.common
        )
        image_step, common_step = fraction * image_step, fraction * common_step
        moved, network = np.empty_like(state.ground_m), self._network(state)
        camera_step = common_step[self.effects.camera]

        def move(part: tuple[int, int]) -> None:
            move_points(*part, network, image_step, camera_step, damping, moved)

        _in_threads(move, self.rays.parts)
        turn = rotation_from_vector(image_step[:, :3])
        return State(
            turn @ state.ground_from_image,
            state.position_m + image_step[:, 3:],
            moved,
            state.common + common_step,
        ), square

    def intersected(self, state: State) -> State:
        """The state with its points intersected anew."""
        state = replace(state, ground_m=state.ground_m.copy())
        network = self._network(state)

        def intersect(part: tuple[int, int]) -> None:
            intersect_points(*part, network)

        _in_threads(intersect, self.rays.parts)
        return state

    def precision(self, equations: Equations) -> tuple[SelectedInverse, PointPrecision]:
        """Covariances of all unknowns, and the redundancy numbers of the rays, by group.

        Raises
        ------
        UndeterminedError
            If the normal equations are singular.
        """
        inverse = factorised(equations.matrix, self.levels).selected_inverse()
        camera = self.effects.camera
        cofactors = Cofactors(
            inverse.blocks(self.rays.first, self.rays.second),
            np.ascontiguousarray(inverse.border[:, :, camera]),
            np.ascontiguousarray(inverse.corner[np.ix_(camera, camera)]),
        )
        n_points, n_rays = len(self.rays.point), len(self.rays.ray)
        out = PointPrecision(np.empty((n_points, 3, 3)), np.empty((n_rays, 2)))
        network = self._network(equations.state)

        def propagate(part: tuple[int, int]) -> None:
            point_precision(*part, network, cofactors, out)

        _in_threads(propagate, self.rays.parts)
        return inverse, out

    def residuals(self, state: State) -> Floats:
        """(m, 2) computed minus measured, px, of the rays by group; NaN behind a camera."""
        residual, network = np.empty((len(self.rays.ray), 2)), self._network(state)

        def write(part: tuple[int, int]) -> None:
            ray_residuals(*part, network, residual)

        _in_threads(write, self.rays.parts)
        return residual

    def _network(self, state: State) -> Network:
        problem, column = self.problem, self.effects.camera_column
        camera_values = np.append(state.common[self.effects.camera], 0.0)
        return Network(
            self.rays.groups,
            Measured(self.xy_px, self.weight),
            Ground(state.ground_m, self.control, problem.control.position_m, self.control_weight),
            Images(state.ground_from_image, state.position_m, problem.exposures.camera),
            Cameras(
                problem.distance_px,
                problem.mm_per_px,
                problem.bauer_radius_mm,
                camera_values[column].reshape(-1, len(CAMERA_PARAMETERS)),
                column,
            ),
        )

    def _empty(self) -> Reduced:
        n, k = len(self.problem.position_m), len(self.effects.camera)
        return Reduced(
            np.zeros((len(self.rays.first), 6, 6)),
            np.zeros((n, 6, k)),
            np.zeros((k, k)),
            np.zeros((n, 6)),
            np.zeros(k),
        )

    def _matrix(self, reduced: Reduced, pos: LinearisedPos, prior: Floats) -> ArrowMatrix:
        """All observations' normal equations; the kernel gives upper triangles."""
        n, _, k = pos.by_common.shape
        own = self.rays.first == self.rays.second
        weighted_pose = pos.by_pose * self.problem.pos.weight[:, :, None]
        blocks = reduced.blocks
        blocks[own] = _symmetric(blocks[own]) + np.swapaxes(weighted_pose, 1, 2) @ pos.by_pose
        border = np.swapaxes(weighted_pose, 1, 2) @ pos.by_common
        border[:, :, self.effects.camera] += reduced.border
        rows = (pos.by_common * np.sqrt(self.problem.pos.weight)[:, :, None]).reshape(6 * n, k)
        corner = rows.T @ rows + np.diag(prior)
        corner[np.ix_(self.effects.camera, self.effects.camera)] += _symmetric(reduced.corner)
        return ArrowMatrix(self.rays.first, self.rays.second, blocks, border, corner)


def _symmetric(upper: Floats) -> Floats:
    """(..., b, b) with both triangles, of upper ones."""
    upper = np.triu(upper)
    return upper + np.swapaxes(np.triu(upper, 1), -1, -2)


def _in_threads(
    function: Callable[[tuple[int, int]], _T], parts: Iterable[tuple[int, int]]
) -> list[_T]:
    with ThreadPoolExecutor() as threads:
        return list(threads.map(function, parts))


def _added(
    parts: list[tuple[Reduced, tuple[float, float, float]]],
) -> tuple[Reduced, tuple[float, float, float]]:
    """The sums of all parts."""
    reduced = Reduced(
        *(sum(arrays[1:], arrays[0]) for arrays in zip(*(p[0] for p in parts), strict=True))
    )
    image, control, gain = (sum(values) for values in zip(*(p[1] for p in parts), strict=True))
    return reduced, (image, control, gain)
