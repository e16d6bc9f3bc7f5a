"""The chain from a block to its results: the only place that knows the order of the steps."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from posstats.adjustment.imu_free import ImuFreeBundle, adjust_imu_free
from posstats.analysis.angle_errors import (
    AngleErrors,
    adjusted_errors,
    bundle_errors,
    coplanarity_errors,
    in_camera_frame,
)
from posstats.analysis.correction import predicted_errors
from posstats.analysis.out_of_sample import out_of_sample_parallax
from posstats.analysis.regression import BLOCK_SCOPE, AngleRegression, regress
from posstats.analysis.rules import Decision, OutOfSampleParallax, RuleSet, decide, load_rules
from posstats.arrays import Floats
from posstats.block.image_pairs import StereoModels, stereo_models
from posstats.block.model import Block, Orientations
from posstats.block.turned import corrected
from posstats.contract.choices import Scope
from posstats.contract.notice import Notice
from posstats.errors import PosstatsError
from posstats.geometry.ground.check_points import CheckPointResiduals, check_point_residuals
from posstats.geometry.stereo.parallax import model_rms_px
from posstats.geometry.stereo.relative_orientation import Method, RelativeOrientation, orient
from posstats.numerics.kernels.rotation import ANGLE_NAMES
from posstats.settings import Settings

Progress = Callable[[str, float], object]

FIXED: tuple[Method, ...] = ("angles", "omega", "phi", "kappa")
"""Right-image angles that the fixed-element method holds at their POS values (Figure 1)."""


@dataclass(frozen=True, eq=False)
class FrameAnalysis:
    """Angle errors in one frame, their regression, and what is decided of it.

    Attributes
    ----------
    out_of_sample
        Parallax on unseen images with every angle's decided form, or a constant where nothing is
        corrected; None unless frames are compared.
    """

    errors: AngleErrors
    regressions: tuple[AngleRegression, ...]
    decisions: tuple[Decision, ...]
    out_of_sample: OutOfSampleParallax | None = None

    @property
    def frame(self) -> str:
        """``ground`` or ``camera``."""
        return self.errors.frame

    def correct(self, orientations: Orientations, decisions: tuple[Decision, ...]) -> Orientations:
        """The orientations without the errors that the decisions take off."""
        predicted = predicted_errors(
            self.regressions, decisions, orientations.time_s, orientations.strip
        )
        return corrected(orientations, predicted, self.frame)


@dataclass(frozen=True, eq=False)
class Analysis:
    """Everything that was found out about a block.

    Attributes
    ----------
    raw_px
        (p,) RMS y-parallax of the models from POS.
    independent, dependent
        Relative orientation of all models.
    fixed
        Relative orientation with POS angles of the right image held, by `FIXED`.
    frames
        The ground frame, and the camera frame if it was asked for.
    chosen
        The one of `frames` whose corrections were selected.
    frame_notice
        Why that one, when it was chosen automatically.
    corrected_orientations, corrected_px
        By "omega", "phi", "kappa" (the line of each angle alone, ground frame) and "selected":
        orientations, and (p,) RMS y-parallax of the models.
    triangulated_px
        The same from "adjusted" if the block has it, and from "bundle" if it was made.
    check_points
        Residuals of "pos", of every correction, of "adjusted" if the block has it, and of "bundle"
        if it was made.
    bundle
        Where angle errors came from, or None if from elsewhere.
    """

    block: Block
    settings: Settings
    models: StereoModels
    raw_px: Floats
    independent: RelativeOrientation
    dependent: RelativeOrientation
    fixed: dict[str, RelativeOrientation]
    frames: tuple[FrameAnalysis, ...]
    chosen: FrameAnalysis
    frame_notice: Notice | None
    corrected_orientations: dict[str, Orientations]
    corrected_px: dict[str, Floats]
    triangulated_px: dict[str, Floats]
    check_points: tuple[CheckPointResiduals, ...]
    bundle: ImuFreeBundle | None = None


def analyse(
    block: Block, settings: Settings | None = None, *, progress: Progress | None = None
) -> Analysis:
    """Analyse a block: parallax, cause, regression, decision, correction, check points.

    Parameters
    ----------
    block
        From `read_block` or `posstats.synthetic.simulate`.
    settings
        Default: the paper's rules on the block, coplanarity errors, ground frame, robust.
    progress
        Called as progress(step, share done 0..1).

    Raises
    ------
    PosstatsError
        If there is no stereo model, the rules cannot be read, or the adjustment fails.

    Examples
    --------
    >>> import posstats
    >>> analysis = posstats.analyse(posstats.read_block("block"))
    >>> [(each.angle, each.form) for each in analysis.chosen.decisions]
    [('omega', 'linear'), ('phi', 'none'), ('kappa', 'none')]
    """
    settings = settings or Settings()
    report = progress or _no_progress
    rules = load_rules(settings.rules)
    report("forming stereo models", 0.0)
    models = stereo_models(block)
    if len(models) == 0:
        raise PosstatsError(
            "no two consecutive images of a strip have common tie points: there is no stereo model"
        )
    report("relative orientation", 0.05)
    independent = orient(models, "independent", robust=settings.robust)
    dependent = orient(models, "dependent", independent=independent)
    fixed = {str(name): orient(models, name, independent=independent) for name in FIXED}
    errors, bundle = _angle_errors(block, models, settings, report)
    report("regression", 0.8)
    frames = _frames(models, errors, rules, settings)
    chosen, frame_notice = _chosen_frame(frames)
    report("correction", 0.9)
    orientations = _corrected_orientations(block.orientations, frames[0], chosen, settings.scope)
    report("check points", 0.95)
    return Analysis(
        block=block,
        settings=settings,
        models=models,
        raw_px=model_rms_px(models),
        independent=independent,
        dependent=dependent,
        fixed=fixed,
        frames=frames,
        chosen=chosen,
        frame_notice=frame_notice,
        corrected_orientations=orientations,
        corrected_px=_parallax(models, orientations),
        triangulated_px=_parallax(models, _triangulated(block, bundle)),
        check_points=_check_points(block, orientations, bundle),
        bundle=bundle,
    )


def _no_progress(_step: str, _done: float) -> None:
    pass


def _angle_errors(
    block: Block, models: StereoModels, settings: Settings, report: Progress
) -> tuple[AngleErrors, ImuFreeBundle | None]:
    """The errors, and the bundle they come from if it is one."""
    if settings.errors == "adjusted":
        return adjusted_errors(block), None

    def advance(done: int, total: int) -> None:
        report(f"{settings.errors} adjustment", 0.1 + 0.7 * done / total)

    if settings.errors == "bundle":
        bundle = adjust_imu_free(block, robust=settings.robust, progress=advance)
        return bundle_errors(block, bundle), bundle
    return coplanarity_errors(block, models, robust=settings.robust, progress=advance), None


def _frames(
    models: StereoModels, errors: AngleErrors, rules: RuleSet, settings: Settings
) -> tuple[FrameAnalysis, ...]:
    """The ground frame always, the camera frame if the settings ask for it."""
    wanted = [errors]
    if settings.frame != "ground":
        wanted.append(in_camera_frame(errors, models.orientations))
    return tuple(_frame_analysis(models, each, rules, settings) for each in wanted)


def _frame_analysis(
    models: StereoModels, errors: AngleErrors, rules: RuleSet, settings: Settings
) -> FrameAnalysis:
    regressions = regress(errors)

    def out_of_sample(judged: Sequence[Decision]) -> OutOfSampleParallax:
        return out_of_sample_parallax(models, errors, judged)

    decisions = decide(regressions, rules, scope=settings.scope, out_of_sample=out_of_sample)
    compared = None
    if settings.frame == "auto":
        compared = out_of_sample(tuple(_with_some_form(decision) for decision in decisions))
    return FrameAnalysis(errors, regressions, decisions, compared)


def _with_some_form(decision: Decision) -> Decision:
    """The decision, or a constant where nothing is corrected: frames differ in constants too."""
    return decision if decision.correct else replace(decision, correct=True, form="constant")


def _chosen_frame(frames: tuple[FrameAnalysis, ...]) -> tuple[FrameAnalysis, Notice | None]:
    """The camera frame if it was asked for, or leaves less parallax out of sample."""
    ground = frames[0]
    compared = [frame.out_of_sample for frame in frames if frame.out_of_sample is not None]
    if not compared:
        return frames[-1], None
    left_px = [each.corrected_px for each in compared]
    if not np.isfinite(left_px).all():
        return ground, Notice(code="frames_not_compared")
    chosen = frames[int(np.argmin(left_px))]
    values = {"frame": chosen.frame, "out_of_sample": compared[0].method}
    return chosen, Notice(code="frame_of_less_parallax", values=values)


def _corrected_orientations(
    pos: Orientations, ground: FrameAnalysis, chosen: FrameAnalysis, scope: Scope
) -> dict[str, Orientations]:
    """Each ground angle alone by its line, whatever was decided (Figure 3), and the selection."""
    alone = {
        angle: ground.correct(pos, _line_of(angle, ground.regressions, scope))
        for angle in ANGLE_NAMES
    }
    return alone | {"selected": chosen.correct(pos, chosen.decisions)}


def _line_of(
    angle: str, regressions: tuple[AngleRegression, ...], scope: Scope
) -> tuple[Decision, ...]:
    """Take off the paper's line of one angle, wherever there is one."""
    return tuple(
        Decision(angle, each.frame, each.scope, True, "linear", "ols", "alone")
        for each in regressions
        if each.angle == angle
        and (each.scope == BLOCK_SCOPE) == (scope == "block")
        and each.ols is not None
    )


def _triangulated(block: Block, bundle: ImuFreeBundle | None) -> dict[str, Orientations]:
    found = {} if block.adjusted is None else {"adjusted": block.adjusted}
    return found if bundle is None else found | {"bundle": bundle.orientations}


def _parallax(models: StereoModels, orientations: dict[str, Orientations]) -> dict[str, Floats]:
    """(p,) RMS y-parallax of the models, px, from each of some orientations."""
    return {
        name: model_rms_px(models.with_orientations(each)) for name, each in orientations.items()
    }


def _check_points(
    block: Block, orientations: dict[str, Orientations], bundle: ImuFreeBundle | None
) -> tuple[CheckPointResiduals, ...]:
    sources = {"pos": block.orientations} | orientations
    if block.adjusted is not None:
        sources["adjusted"] = block.adjusted
    residuals = (check_point_residuals(block, each, name) for name, each in sources.items())
    return (*residuals, *(() if bundle is None else (bundle.check_points,)))
