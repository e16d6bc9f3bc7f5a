"""Angle errors of the POS: what the recorded angles differ from the estimated ones.

error = POS angle - estimated angle, per image. The estimate is the coplanarity adjustment of the
block (`coplanarity_errors`), its bundle adjustment (`bundle_errors`), or an adjusted orientation
that came with it (`adjusted_errors`).
Errors live in the ground frame (omega, phi, kappa of the block's system) or in the camera frame
(pitch, roll, yaw about image x, y, z: R_pos = R_estimated exp([e]x)).
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from posstats.adjustment.imu_free import ImuFreeBundle
from posstats.analysis.observability import (
    UNDETERMINED_SHARE,
    EstimatedAngles,
    Observability,
    observability,
)
from posstats.arrays import Bools, Floats, Ids, Ints
from posstats.block.image_pairs import MIN_MODEL_POINTS, StereoModels, cross_strip_pairs
from posstats.block.model import Block, Orientations
from posstats.contract.choices import AngleErrorSource, Frame
from posstats.contract.notice import Notice, listing
from posstats.errors import GeometryError
from posstats.geometry.coplanarity.adjustment import Priors, adjust_coplanarity
from posstats.geometry.coplanarity.point_pairs import SHORTEST_BASE, long_bases, point_pairs
from posstats.numerics.kernels.rotation import (
    rotation_derivatives,
    rotation_from_angles,
    skew,
    vector_from_rotation,
    wrapped,
)
from posstats.numerics.solvers.weak_prior import weak_prior_rad

_SHOWN = 10
_SMALL_ANGLE_RAD = 1e-3


@dataclass(frozen=True, eq=False)
class AngleErrors:
    """Angle errors of n images.

    Attributes
    ----------
    frame
        ``ground``: omega, phi, kappa; ``camera``: pitch, roll, yaw.
    source
        ``coplanarity``, ``bundle`` or ``adjusted``.
    image, strip
        (n,) ids.
    time_s
        (n,).
    error_rad
        (n, 3), NaN where there is no estimate.
    covariance_rad2
        (n, 3, n, 3) of all errors, NaN where there is no estimate; None for ``adjusted``.
    used
        (n,) false where the error is missing or not determined.
    observability
        Of the block, then of every strip; empty for ``adjusted``.
    sigma0
        Standard deviation of an image coordinate from the residuals, px; None for ``adjusted``,
        NaN without redundancy.
    notices
        What a reader has to know of them.
    """

    frame: Frame
    source: AngleErrorSource
    image: Ids
    strip: Ids
    time_s: Floats
    error_rad: Floats
    covariance_rad2: Floats | None
    used: Bools
    observability: tuple[Observability, ...] = ()
    sigma0: float | None = None
    notices: tuple[Notice, ...] = ()

    def __len__(self) -> int:
        return len(self.image)

    @property
    def sigma_rad(self) -> Floats:
        """(n, 3) standard deviations; NaN where unknown."""
        if self.covariance_rad2 is None:
            return np.full(self.error_rad.shape, np.nan)
        n = len(self)
        return np.sqrt(np.diagonal(self.covariance_rad2.reshape(3 * n, 3 * n))).reshape(n, 3)


def adjusted_errors(block: Block) -> AngleErrors:
    """POS angles minus the angles of the block's adjusted orientation.

    Raises
    ------
    GeometryError
        If the block has no adjusted orientation.
    """
    if block.adjusted is None:
        raise GeometryError(
            f"block {block.name!r} has no adjusted orientation (adjusted.csv) to compare with"
        )
    pos = block.orientations
    error = wrapped(pos.angles_rad - block.adjusted.angles_rad)
    used = np.all(np.isfinite(error), axis=1)
    return AngleErrors(
        frame="ground",
        source="adjusted",
        image=pos.image,
        strip=pos.strip,
        time_s=pos.time_s,
        error_rad=error,
        covariance_rad2=None,
        used=used,
        notices=listing("no_adjusted_orientation", pos.image[~used], _SHOWN),
    )


def coplanarity_errors(
    block: Block,
    models: StereoModels,
    *,
    robust: bool = True,
    progress: Callable[[int, int], object] | None = None,
) -> AngleErrors:
    """Angle errors from the coplanarity adjustment of the whole block.

    Parameters
    ----------
    block
        Its check points take no part.
    models
        The stereo models of the block; pairs across strips are added here.
    robust
        Take out blunders; else plain least squares.
    progress
        Called as progress(done, total).

    Raises
    ------
    GeometryError
        If no pair of images has common points, or the block is too large.
    ConvergenceError
        If the adjustment does not settle.
    """
    pos = block.orientations
    image_pairs = models.pairs.joined(cross_strip_pairs(block))
    long = long_bases(pos, image_pairs)
    pairs = point_pairs(block, image_pairs.subset(long))
    if len(pairs.left) == 0:
        raise GeometryError(
            "no pair of images has common tie points and a base longer than "
            f"{SHORTEST_BASE:g} of its standard deviations: angle errors need both"
        )
    priors = Priors(
        angles_rad=pos.angles_rad,
        position_m=pos.position_m,
        sigma_angles_rad=weak_prior_rad(pos.sigma_angles_rad),
        sigma_position_m=pos.sigma_position_m,
        system=pos.system,
        image_px=block.accuracy.image_px,
    )
    adjusted = adjust_coplanarity(pairs, priors, robust=robust, progress=progress)
    estimate = _Estimate(
        adjusted.angles_rad,
        adjusted.covariance_rad2,
        pairs.n_points_of_images(len(pos)),
        adjusted.sigma_px,
    )
    errors = _errors(pos, "coplanarity", estimate)
    return replace(errors, notices=_short_bases(long) + errors.notices)


def bundle_errors(block: Block, bundle: ImuFreeBundle) -> AngleErrors:
    """POS angles minus the angles of the block's bundle adjustment, from `adjust_imu_free`."""
    estimate = _Estimate(
        bundle.adjusted.angles_rad, bundle.angle_covariance_rad2, bundle.n_points, bundle.sigma_px
    )
    errors = _errors(block.orientations, "bundle", estimate)
    wrong = (
        *listing("contradicted_positions", bundle.contradicted_positions, _SHOWN),
        *listing("contradicted_control", bundle.contradicted_control, _SHOWN),
    )
    return replace(errors, notices=errors.notices + wrong)


def _short_bases(long: Bools) -> tuple[Notice, ...]:
    """One notice that counts the pairs of images left out, or none."""
    n_short = int(np.count_nonzero(~long))
    if n_short == 0:
        return ()
    values = {"n": n_short, "n_pairs": len(long), "n_sigmas": SHORTEST_BASE}
    return (Notice(code="pairs_with_short_base", values=values),)


@dataclass(frozen=True, eq=False)
class _Estimate:
    """Angles (n, 3), their covariance (n, 3, n, 3), tie points (n,) of the images, image noise."""

    angles_rad: Floats
    covariance_rad2: Floats
    n_points: Ints
    sigma_px: float


def _errors(pos: Orientations, source: AngleErrorSource, estimate: _Estimate) -> AngleErrors:
    n = len(pos)
    tied = estimate.n_points > 0
    error = wrapped(pos.angles_rad - estimate.angles_rad)
    covariance = estimate.covariance_rad2.copy()
    variance = np.diagonal(covariance.reshape(3 * n, 3 * n)).reshape(n, 3)
    prior_sigma = weak_prior_rad(pos.sigma_angles_rad)
    limit = UNDETERMINED_SHARE * prior_sigma
    determined = tied & np.all(variance <= limit**2, axis=1)
    found = observability(
        EstimatedAngles(
            image=pos.image,
            strip=pos.strip,
            position_m=pos.position_m,
            rotation_covariance_rad2=_about_ground_axes(covariance, estimate.angles_rad, pos),
            prior_sigma_rad=prior_sigma.min(axis=1),
            determined=determined,
            tied=tied,
        )
    )
    error[~tied] = np.nan
    covariance[~tied] = np.nan
    covariance[:, :, ~tied] = np.nan
    return AngleErrors(
        frame="ground",
        source=source,
        image=pos.image,
        strip=pos.strip,
        time_s=pos.time_s,
        error_rad=error,
        covariance_rad2=covariance,
        used=determined,
        observability=found,
        sigma0=estimate.sigma_px,
        notices=_undetermined(pos.image, estimate.n_points, determined),
    )


def _undetermined(image: Ids, n_points: Ints, determined: Bools) -> tuple[Notice, ...]:
    """The images without a usable angle, by reason."""
    too_few = ~determined & (n_points > 0) & (n_points < MIN_MODEL_POINTS)
    loose = ~determined & (n_points >= MIN_MODEL_POINTS)
    return (
        *listing("images_untied", image[n_points == 0], _SHOWN),
        *listing("angles_of_few_points", image[too_few], _SHOWN, n_needed=MIN_MODEL_POINTS),
        *listing("angles_loose", image[loose], _SHOWN, prior_fraction=UNDETERMINED_SHARE),
    )


def in_camera_frame(errors: AngleErrors, orientations: Orientations) -> AngleErrors:
    """The same errors as pitch, roll, yaw: e with R_pos = R_estimated exp([e]x).

    Parameters
    ----------
    errors
        In the ground frame.
    orientations
        The POS orientations that the errors belong to.
    """
    pos, system = orientations.angles_rad, orientations.system
    estimated = pos - errors.error_rad
    image_from_ground = np.swapaxes(rotation_from_angles(estimated, system), -1, -2)
    error = vector_from_rotation(image_from_ground @ rotation_from_angles(pos, system))
    covariance = errors.covariance_rad2
    if covariance is not None:
        turn = _inverse_left_jacobian(error) @ _about_image_axes(estimated, orientations)
        covariance = _turned(covariance, turn)
    return replace(errors, frame="camera", error_rad=error, covariance_rad2=covariance)


def _about_image_axes(angles_rad: Floats, orientations: Orientations) -> Floats:
    """(n, 3, 3) A with R(angles + d) = R(angles) exp([A d]x) to first order."""
    system = orientations.system
    image_from_ground = np.swapaxes(rotation_from_angles(angles_rad, system), -1, -2)
    generators = image_from_ground[:, None] @ rotation_derivatives(angles_rad, system)
    columns = [generators[..., 2, 1], generators[..., 0, 2], generators[..., 1, 0]]
    return np.stack(columns, axis=1)


def _about_ground_axes(
    covariance_rad2: Floats, angles_rad: Floats, orientations: Orientations
) -> Floats:
    """Covariance (n, 3, n, 3) of small rotations about the ground axes, from that of angles."""
    rotation = rotation_from_angles(angles_rad, orientations.system)
    turn = rotation @ _about_image_axes(angles_rad, orientations)
    return _turned(covariance_rad2, turn)


def _turned(covariance: Floats, turn: Floats) -> Floats:
    """Covariance (n, 3, n, 3) of turn (n, 3, 3) times the vectors; exactly symmetric."""
    turned: Floats = np.einsum("iab,ibjc,jdc->iajd", turn, covariance, turn, optimize=True)
    return 0.5 * (turned + turned.transpose(2, 3, 0, 1))


def _inverse_left_jacobian(vector_rad: Floats) -> Floats:
    """(n, 3, 3) B with log(exp([d]x) exp([e]x)) = e + B d to first order, e (n, 3).

    B = I - [e]x / 2 + (1 - (t / 2) cot(t / 2)) / t^2 [e]x^2, t = |e|.
    """
    half = 0.5 * np.linalg.norm(vector_rad, axis=-1)[:, None, None]
    safe = np.where(half < _SMALL_ANGLE_RAD, 1.0, half)
    exact = (1.0 - safe / np.tan(safe)) / (4.0 * safe**2)
    factor = np.where(half < _SMALL_ANGLE_RAD, 1.0 / 12.0 + half**2 / 180.0, exact)
    generator = skew(vector_rad)
    jacobian: Floats = np.eye(3) - 0.5 * generator + factor * (generator @ generator)
    return jacobian
