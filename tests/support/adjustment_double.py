"""Results of an adjustment in which no two numbers are alike, built from the contract."""

import itertools
from typing import get_args

from posstats.contract.adjustment import (
    AdditionalParameter,
    AdjustedBlock,
    AdjustedCamera,
    AdjustmentRequest,
    AdjustmentResults,
    ContradictedObservation,
    ControlPoint,
    Correlation,
    DroppedParameter,
    Element,
    FormatCell,
    Group,
    GroupSummary,
    OrientationElement,
    PointSummary,
    Priors,
    Undetermined,
)
from posstats.contract.check_points import CheckPointResidual, CheckPointStatistics
from posstats.contract.notice import Notice
from posstats.contract.survey import ImagePlace, InputFile

UNITS = {"image": "px", "gnss": "m", "imu": "rad", "control": "m",
         "parameters": "standard deviations"}  # fmt: skip


def adjustment_double() -> AdjustmentResults:
    """Every list has rows; positive numbers are multiples of no round step, signs alternate."""
    return _Double().results()


class _Double:
    def __init__(self) -> None:
        self._count = itertools.count(1)

    def some(self) -> float:
        """A positive number that came never before."""
        return 0.0137 * next(self._count) + 0.00021

    def either(self) -> float:
        """The same with alternating sign."""
        n = next(self._count)
        return (-1.0) ** n * (0.0137 * n + 0.00021)

    def results(self) -> AdjustmentResults:
        images = self.images()
        return AdjustmentResults(
            n_iterations=7,
            sigma0=self.some(),
            dof=12345,
            chi2_p=0.0321,
            posstats_version="1.2.3",
            created="2026-01-02T03:04:05+00:00",
            versions={"python": "3.99", "numpy": "9.8"},
            block=AdjustedBlock(
                name="north", n_images=len(images), n_strips=2, n_tie_points=321,
                n_check_points=3, simulated=True, crs=None, angles="omega-phi-kappa",
                inputs=(InputFile(file="block.toml", sha256="ab" * 32),),
                n_control_points=2, n_rays=4567, self_calibrated=True,
            ),
            settings=self.settings(),
            groups=tuple(self.group(name) for name in get_args(Group)),
            parameters=self.parameters(),
            dropped=(DroppedParameter(name="brown_k3", scope="block", reason="not significant"),
                     DroppedParameter(name="brown_k2", scope="block", reason="singular")),
            correlations=self.correlations(),
            observability=self.observability(),
            blunders=self.blunders(),
            n_rejected_rays=1,
            snooping_complete=True,
            check_points=tuple(
                self.statistics(name, removed)
                for name in ("bundle", "pos") for removed in (False, True)
            ),
            check_point_residuals=tuple(
                self.check_point(name, k) for name in ("bundle", "pos") for k in range(3)
            ),
            control_points=tuple(self.control_point(k) for k in range(2)),
            cameras=(self.camera("left"), self.camera("right")),
            orientations=tuple(self.element(name) for name in get_args(Element)),
            points=PointSummary(
                n_tie=319, n_control=2, median_sigma_m=(self.some(), self.some(), self.some())
            ),
            images=images,
            image_residuals=tuple(
                self.cell(x, y)
                for x in (-1000.0, 0.0, 1000.0) for y in (-1000.0, 0.0, 1000.0)
            ),
            notices=(Notice(code="systematic_imu", values={"n": 5, "n_images": 6}),),
        )  # fmt: skip

    def settings(self) -> AdjustmentRequest:
        return AdjustmentRequest(
            control=("A", "B"), drift="strip", self_calibration="brown", camera=True,
            lever_arm=False, estimate_weights=True, drop_insignificant=True, robust=False,
            priors=Priors(
                shift_m=self.some(), drift_m_per_s=self.some(), shift_rad=self.some(),
                drift_rad_per_s=None, boresight_rad=self.some(), lever_arm_m=self.some(),
            ),
            bauer_radius_mm=100.0, position_m=self.some(), angle_rad=self.some(),
            image_px=self.some(), calibration="boresight.toml",
        )  # fmt: skip

    def images(self) -> tuple[ImagePlace, ...]:
        return tuple(
            ImagePlace(
                image=f"{strip}-{k}", strip=strip, time_s=float(k), x_m=1000.0 * k, y_m=y,
                z_m=2000.0,
                footprint=((1000.0 * k, y), (1000.0 * k + 900.0, y),
                           (1000.0 * k + 900.0, y + 900.0), (1000.0 * k, y + 900.0)),
            )
            for strip, y in (("S1", 0.0), ("S2", 1500.0))
            for k in range(3)
        )  # fmt: skip

    def group(self, name: str) -> GroupSummary:
        return GroupSummary(
            group=name, n=next(self._count) + 100, rms=self.some(), redundancy=self.some(),
            variance_factor=self.some(), weight_factor=self.some(), n_unchecked=3,
            median_detectable=self.some(), unit=UNITS[name],
        )  # fmt: skip

    def parameters(self) -> tuple[AdditionalParameter, ...]:
        named = (("gnss_x_shift", "S1", "m"), ("gnss_z_drift", "S2", "m/s"),
                 ("imu_omega_shift", "block", "rad"), ("imu_kappa_drift", "S1", "rad/s"),
                 ("boresight_roll", "block", "rad"), ("lever_arm_w", "block", "m"),
                 ("camera_c", "block", "px"), ("camera_x0", "block", "px"),
                 ("bauer_s1", "block", "1/mm2"), ("brown_p2", "block", ""))  # fmt: skip
        return tuple(
            AdditionalParameter(
                name=name, scope=scope, value=self.either(), sigma=self.some(), t=self.either(),
                p=self.some(), significant=k % 2 == 0, determined=k % 3 != 0,
                prior_sigma=0.3 if k < 5 else None, prior_released=k == 4, unit=unit,
            )
            for k, (name, scope, unit) in enumerate(named)
        )  # fmt: skip

    def correlations(self) -> tuple[Correlation, ...]:
        return (
            Correlation(first="boresight_yaw", first_scope="block", second="imu_kappa_shift",
                        second_scope="S2", value=-0.961),
            Correlation(first="gnss_x_shift", first_scope="S1", second="y", second_scope="S1-0",
                        value=0.987),
        )  # fmt: skip

    def observability(self) -> tuple[Undetermined, ...]:
        def open_(kind: str, names: tuple[str, ...], scope: str, code: str) -> Undetermined:
            return Undetermined(
                kind=kind, names=names, scope=scope, reason_notice=Notice(code=f"open_{code}"),
                remedy_notice=Notice(code=f"helps_{code}"),
            )  # fmt: skip

        return (
            open_("parameter", ("gnss_x_shift",), "S1", "gnss_shifts_by_prior"),
            open_("parameter", ("gnss_x_shift",), "S2", "gnss_shifts_by_prior"),
            open_("image", ("S1-0", "S1-1"), "block", "images_by_imu"),
            open_("connection", ("S2",), "block", "part_of_strips"),
        )

    def blunders(self) -> tuple[ContradictedObservation, ...]:
        def row(kind: str, image: str | None, point: str | None, unit: str, **found: object):
            size = tuple(self.either() for _ in range(2 if unit == "px" else 3))
            return ContradictedObservation(
                kind=kind, image=image, point=point, w=self.either(), size=size, unit=unit, **found
            )

        taken = {"found_by": "snooping", "taken_out": True}
        return (
            row("image", "S1-0", "T1", "px", **taken),
            row("control", None, "C", "m", **taken),
            row("imu", "S2-1", None, "rad", **taken),
            row("gnss", "S2-2", None, "m", found_by="snooping", taken_out=False),
            row("image", "S1-2", "T2", "px", found_by="robust", taken_out=True),
        )

    def statistics(self, orientation: str, removed: bool) -> CheckPointStatistics:
        return CheckPointStatistics(
            orientation=orientation, translation_removed=removed, n=3,
            max_horizontal_m=self.some(), max_vertical_m=self.some(),
            min_horizontal_m=self.some(), min_vertical_m=self.some(),
            rmse_horizontal_m=self.some(), rmse_vertical_m=self.some(),
            shift_m=(self.either(), self.either(), self.either()),
        )  # fmt: skip

    def check_point(self, orientation: str, k: int) -> CheckPointResidual:
        return CheckPointResidual(
            orientation=orientation, point=f"K{k}", n_rays=3 + k, status="ok",
            survey_sigma_xy_m=0.02, survey_sigma_z_m=0.03,
            x_m=500.0 + 900.0 * k, dx_m=self.either(), sigma_x_m=self.some(),
            y_m=300.0 * (k % 2) + 500.0, dy_m=self.either(), sigma_y_m=self.some(),
            z_m=50.0, dz_m=self.either(), sigma_z_m=self.some(),
        )  # fmt: skip

    def control_point(self, k: int) -> ControlPoint:
        return ControlPoint(
            point="AB"[k], x_m=200.0 + 1500.0 * k, y_m=400.0, z_m=60.0, dx_m=self.either(),
            dy_m=self.either(), dz_m=self.either(), largest_w=self.either(),
        )  # fmt: skip

    def camera(self, name: str) -> AdjustedCamera:
        return AdjustedCamera(
            camera=name,
            stated_principal_distance_px=9000.0 + self.some(),
            principal_distance_px=9000.0 + self.some(),
            stated_principal_point_px=(4000.0 + self.some(), 3000.0 + self.some()),
            principal_point_px=(4000.0 + self.some(), 3000.0 + self.some()),
        )

    def element(self, name: Element) -> OrientationElement:
        return OrientationElement(
            element=name, median_sigma=self.some(), max_sigma=self.some(),
            pos_mean=self.either(), pos_rms=self.some(),
            unit="rad" if name in ("omega", "phi", "kappa") else "m",
        )  # fmt: skip

    def cell(self, x_px: float, y_px: float) -> FormatCell:
        return FormatCell(
            camera="left", x_px=x_px, y_px=y_px, n=20, dx_px=self.either(), dy_px=self.either(),
            rms_px=self.some(),
        )  # fmt: skip
