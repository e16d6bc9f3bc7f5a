"""Coverage of the 95 % intervals of `posstats adjust`, over simulated blocks of known truth.

Every block has a flight, terrain and errors of its own. The systematic errors of the POS are drawn
from the priors that the adjustment takes them to have, all other errors from the stated accuracy;
"weights wrong" states other accuracies. Shares are means over the blocks: intervals of one block
err together, so that a share's standard error comes from the scatter between the blocks.
"""

import argparse
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from posstats.adjustment import Adjustment, AdjustmentSettings, adjust_block
from posstats.adjustment.additional_parameters import additional_parameters
from posstats.adjustment.block_problem import bundle_problem
from posstats.block.model import Accuracy, Block, GroundPoints, Orientations
from posstats.contract.choices import DriftScope, SelfCalibration
from posstats.geometry.ground.check_points import surveyed_check_points
from posstats.numerics.kernels.rotation import angles_from_rotation, rotation_from_angles, wrapped
from posstats.synthetic import load_scenario, simulate

_Floats = NDArray[np.float64]

LEVEL = 0.95
IMAGE_PX, GNSS_M, IMU_RAD, SURVEY_M = 0.25, 0.1, float(np.radians(0.006)), 0.03
"""True standard deviations of image coordinates, POS positions and angles, control points."""
BAUER_EDGE_PX = 2.0
"""Standard deviation of the deformation that each of Bauer's parameters makes at `EDGE_MM`."""
EDGE_MM, BAUER_RADIUS_MM = 80.0, 100.0
ELEMENTS = ("omega", "phi", "kappa", "x", "y", "z")

SCENARIO = load_scenario(
    {
        "block": {"name": "coverage"},
        "camera": {
            "width_px": 13824,
            "height_px": 7680,
            "pixel_size_mm": 0.012,
            "principal_distance_mm": 120.0,
        },
        "flight": {
            "scale_denominator": 10000,
            "forward_overlap": 0.60,
            "side_overlap": 0.30,
            "n_strips": 4,
            "images_per_strip": 8,
            "headings_deg": [90, 270],
            "speed_m_per_s": 70.0,
            "turn_s": 200.0,
            "position_jitter_m": 10.0,
        },
        "terrain": {"relief_m": 60.0, "wavelength_m": 2000.0},
        "tie_points": {"per_model": 30},
        "control_points": {"n": 4, "distribution": "corners"},
        "check_points": {"n": 16, "distribution": "grid"},
    }
)
"""Without errors: these are drawn here, so that every one of them is known."""


@dataclass(frozen=True)
class Setting:
    """What is adjusted, and the stated over the true standard deviations of image, GNSS, IMU."""

    name: str
    drift: DriftScope = "block"
    self_calibration: SelfCalibration = "none"
    stated: tuple[float, float, float] = (1.0, 1.0, 1.0)
    estimate_weights: bool = False

    @property
    def adjustment(self) -> AdjustmentSettings:
        """What a user of `posstats adjust` would choose."""
        return AdjustmentSettings(
            drift=self.drift,
            self_calibration=self.self_calibration,
            estimate_weights=self.estimate_weights,
            bauer_radius_mm=BAUER_RADIUS_MM,
        )


WRONG = (0.5, 2.0, 0.5)
SETTINGS = (
    Setting("drift of each strip", "strip"),
    Setting("drift of the block"),
    Setting("self-calibration", self_calibration="bauer"),
    Setting("weights wrong", stated=WRONG),
    Setting("weights wrong, estimated", stated=WRONG, estimate_weights=True),
)


@dataclass(frozen=True, eq=False)
class Observed:
    """A block as observed, and its truth.

    Attributes
    ----------
    block
        Its `adjusted` orientations are the true ones.
    ground_m
        (p, 3) true positions of the tie points, control and check points among them.
    value
        (name, scope) -> true value of an additional parameter, measured minus true.
    """

    block: Block
    ground_m: _Floats
    value: Mapping[tuple[str, str], float]


def observe(setting: Setting, seed: int) -> Observed:
    """Simulate a block and draw all errors of its observations."""
    perfect = simulate(SCENARIO, seed)
    rng = np.random.default_rng([seed, 1])  # other numbers than those of the simulation
    value = {
        (each.name, each.scope): _scale(each.name, each.sigma) * rng.standard_normal()
        for each in additional_parameters(perfect, setting.adjustment)
    }
    ties, noise_px = perfect.tie_points, rng.standard_normal(perfect.tie_points.xy_px.shape)
    deformed_px = _deformed(ties.xy_px, value, perfect.cameras[0].pixel_size_mm)
    block = replace(
        perfect,
        orientations=_pos(perfect, value, setting, rng),
        tie_points=replace(ties, xy_px=deformed_px + IMAGE_PX * noise_px),
        ground_points=_surveyed(perfect.ground_points, rng),
        accuracy=Accuracy(GNSS_M, IMU_RAD, IMAGE_PX * setting.stated[0]),
    )
    # without errors, the rays meet in the points
    return Observed(block, bundle_problem(perfect).ground_m, value)


def _scale(name: str, prior_sigma: float | None) -> float:
    """Standard deviation of a parameter's true value; Bauer's have no prior, but a size."""
    if prior_sigma is not None:
        return prior_sigma
    pixel_mm = SCENARIO.camera.pixel_size_mm
    ring_mm2 = BAUER_RADIUS_MM**2 - EDGE_MM**2
    return BAUER_EDGE_PX * pixel_mm / EDGE_MM / (ring_mm2 if name == "bauer_s1" else 1.0)


def _deformed(xy_px: _Floats, value: Mapping[tuple[str, str], float], pixel_mm: float) -> _Floats:
    """(m, 2) image coordinates with the deformation of equation 6 of the second source paper."""
    s1, s2, s3 = (value.get((f"bauer_s{k}", "block"), 0.0) for k in (1, 2, 3))
    x, y = pixel_mm * xy_px.T
    ring = s1 * (x**2 + y**2 - BAUER_RADIUS_MM**2)
    deformation_mm = np.column_stack([x * ring - s3 * x, y * ring + s2 * x + s3 * y])
    return xy_px + deformation_mm / pixel_mm


def _pos(
    perfect: Block,
    value: Mapping[tuple[str, str], float],
    setting: Setting,
    rng: np.random.Generator,
) -> Orientations:
    """What the POS measures, equations 3, 5, 7 and 8, and how accurate it is said to be."""
    true = perfect.orientations
    pitch, roll, yaw = (
        value.get((f"boresight_{name}", "block"), 0.0) for name in ("pitch", "roll", "yaw")
    )
    image_from_imu = rotation_from_angles(np.array([pitch, roll, yaw]), "omega-phi-kappa")
    angles = angles_from_rotation(true.ground_from_image @ image_from_imu, true.system)
    angles += _trend(perfect, value, "imu", ELEMENTS[:3])
    position = true.position_m + _trend(perfect, value, "gnss", ELEMENTS[3:])
    shape = position.shape
    return replace(
        true,
        angles_rad=wrapped(angles + IMU_RAD * rng.standard_normal(shape)),
        position_m=position + GNSS_M * rng.standard_normal(shape),
        sigma_position_m=np.full(shape, GNSS_M * setting.stated[1]),
        sigma_angles_rad=np.full(shape, IMU_RAD * setting.stated[2]),
    )


def _trend(
    perfect: Block,
    value: Mapping[tuple[str, str], float],
    sensor: str,
    elements: tuple[str, ...],
) -> _Floats:
    """(n, 3) shift + drift (t - t0), t0 the first exposure of the block or strip."""
    pos = perfect.orientations
    error = np.zeros((len(pos), 3))
    for scope in ("block", *pos.strips):
        inside = (pos.strip == scope) | (scope == "block")
        since_s = pos.time_s[inside] - pos.time_s[inside].min()
        for column, element in enumerate(elements):
            shift = value.get((f"{sensor}_{element}_shift", scope), 0.0)
            drift = value.get((f"{sensor}_{element}_drift", scope), 0.0)
            error[inside, column] += shift + drift * since_s
    return error


def _surveyed(true: GroundPoints, rng: np.random.Generator) -> GroundPoints:
    sigma = np.full(len(true), SURVEY_M)
    noise = SURVEY_M * rng.standard_normal(true.position_m.shape)
    return replace(
        true, position_m=true.position_m + noise, sigma_xy_m=sigma, sigma_z_m=sigma.copy()
    )


@dataclass(frozen=True, eq=False)
class Errors:
    """Estimate minus truth, and its standard deviation as reported; of any one shape."""

    error: _Floats
    sigma: _Floats


def errors_of(observed: Observed, result: Adjustment) -> dict[str, Errors]:
    """Errors of all unknowns of a block by their names: ``omega``, ``tie x``, ``imu drift``..."""
    return {
        **_orientation_errors(observed, result),
        **_parameter_errors(observed, result),
        **_point_errors(observed, result),
    }


def _orientation_errors(observed: Observed, result: Adjustment) -> dict[str, Errors]:
    true, found = observed.block.adjusted, result.orientations
    turned = wrapped(found.angles_rad - true.angles_rad)
    error = np.concatenate([turned, found.position_m - true.position_m], axis=1)
    sigma = np.concatenate([found.sigma_angles_rad, found.sigma_position_m], axis=1)
    return {name: Errors(error[:, k], sigma[:, k]) for k, name in enumerate(ELEMENTS)}


def _parameter_errors(observed: Observed, result: Adjustment) -> dict[str, Errors]:
    """By kind: a shift or drift of the three axes and all strips is one kind."""
    kinds: dict[str, list[tuple[float, float]]] = {}
    for test in result.parameters:
        words = test.name.split("_")
        kind = " ".join(words if len(words) == 2 else (words[0], words[2]))
        error = test.value - observed.value[test.name, test.scope]
        kinds.setdefault(kind, []).append((error, test.sigma))
    return {kind: Errors(*np.array(pairs).T) for kind, pairs in kinds.items()}


def _point_errors(observed: Observed, result: Adjustment) -> dict[str, Errors]:
    block = observed.block
    tie = np.isfinite(result.adjusted.ground_m[:, 0])
    tie &= ~np.isin(block.tie_points.point_id, block.ground_points.point)
    _, number = surveyed_check_points(block)
    points = {
        "tie": (
            result.adjusted.ground_m[tie] - observed.ground_m[tie],
            result.scale**2 * result.adjusted.ground_covariance_m2[tie],
        ),
        "check": (
            result.check_point_position_m - observed.ground_m[number],
            result.check_point_covariance_m2,
        ),
    }
    return {
        f"{kind} {axis}": Errors(error[:, k], np.sqrt(covariance[:, k, k]))
        for kind, (error, covariance) in points.items()
        for k, axis in enumerate("xyz")
    }


TOTALS = {
    "orientations": ELEMENTS,
    "parameters": ("boresight", "gnss", "imu", "bauer"),
    "tie points": ("tie",),
    "check points": ("check",),
}
"""Name of a group -> how the names of its unknowns begin."""


def with_totals(errors: Mapping[str, Errors]) -> dict[str, Errors]:
    """The errors by name, and before them those of each group together."""
    totals = {}
    for total, starts in TOTALS.items():
        members = [each for name, each in errors.items() if name.split()[0] in starts]
        totals[total] = Errors(
            np.concatenate([each.error for each in members]),
            np.concatenate([each.sigma for each in members]),
        )
    return {**totals, **errors}


Shares = dict[str, tuple[float, float, float]]
"""By name: share of the intervals that hold the truth, as reported (scaled by sigma0, Student's t)
and by the stated weights (not scaled, normal), and the mean square of error over reported sigma."""


def shares(observed: Observed, result: Adjustment) -> Shares:
    """Of one block."""
    tail = 0.5 + 0.5 * LEVEL
    limit = stats.t.ppf(tail, result.adjusted.dof)
    stated_limit = stats.norm.ppf(tail) / result.scale
    found = {}
    for name, each in with_totals(errors_of(observed, result)).items():
        standardised = np.abs(each.error / each.sigma)
        found[name] = (
            float(np.mean(standardised <= limit)),
            float(np.mean(standardised <= stated_limit)),
            float(np.mean(standardised**2)),
        )
    return found


def averaged(blocks: Sequence[Shares]) -> dict[str, _Floats]:
    """By name: (3, 2) means of the shares over the blocks, and their standard errors."""
    table = {}
    for name in blocks[0]:
        each = np.array([block[name] for block in blocks])
        error = each.std(axis=0, ddof=1) / np.sqrt(len(blocks))
        table[name] = np.column_stack([each.mean(axis=0), error])
    return table


def adjusted(setting: Setting, seed: int) -> tuple[Observed, Adjustment]:
    observed = observe(setting, seed)
    return observed, adjust_block(observed.block, setting.adjustment)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--blocks", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1, help="of the first block")
    parser.add_argument("--setting", choices=[setting.name for setting in SETTINGS])
    asked = parser.parse_args()
    seeds = range(asked.seed, asked.seed + asked.blocks)
    for setting in SETTINGS:
        if asked.setting in (None, setting.name):
            table = averaged([shares(*adjusted(setting, seed)) for seed in seeds])
            print(f"{setting.name}, {asked.blocks} blocks: 95 % intervals that hold the truth")
            print("                      as reported       stated weights    mean square")
            for name, values in table.items():
                print(f"  {name:16}  {_written(values)}", flush=True)


def _written(values: _Floats) -> str:
    (share, error), (stated, stated_error), (square, square_error) = values
    return (
        f"{share:7.1%} ± {error:5.1%}   {stated:7.1%} ± {stated_error:5.1%}"
        f"   {square:6.3f} ± {square_error:.3f}"
    )


if __name__ == "__main__":
    main()
