"""What an adjustment warns of, as codes and values."""

from collections.abc import Iterator

from posstats.adjustment.steps import Adjustment
from posstats.contract.notice import Notice

_MANY = 0.2  # share of the images from which blunders are none


def adjustment_notices(adjustment: Adjustment) -> tuple[Notice, ...]:
    """Systematic errors, doubtful control, snooping that did not end, weights that stay."""
    return (
        *_systematic(adjustment),
        *_doubtful_control(adjustment),
        *_unfinished(adjustment),
        *_weights(adjustment),
    )


def _systematic(adjustment: Adjustment) -> Iterator[Notice]:
    """POS observations of so many images contradicted that they are no blunders."""
    n_images = len(adjustment.block.orientations)
    for kind in ("gnss", "imu"):
        n = sum(blunder.kind == kind for blunder in adjustment.snooping.blunders)
        if n > _MANY * n_images:
            yield Notice(code=f"systematic_{kind}", values={"n": n, "n_images": n_images})


def _doubtful_control(adjustment: Adjustment) -> Iterator[Notice]:
    """A control point that no other checks, where priors of the GNSS gave way to it."""
    control = adjustment.problem.control
    with_prior = {each.name for each in adjustment.stated.parameters if each.sigma is not None}
    freed = [
        each.name
        for each in adjustment.problem.parameters
        if each.sigma is None and each.name in with_prior and each.name.startswith("gnss")
    ]
    if freed and len(control.point) == 1:
        point = str(adjustment.block.tie_points.point_id[control.point[0]])
        parameters = tuple(dict.fromkeys(freed))
        yield Notice(code="lone_control", values={"point": point, "parameters": parameters})


def _unfinished(adjustment: Adjustment) -> Iterator[Notice]:
    if adjustment.snooping.held is not None:
        yield Notice(code="snooping_held")
    elif not adjustment.snooping.complete:
        yield Notice(code="snooping_stopped")


def _weights(adjustment: Adjustment) -> Iterator[Notice]:
    weights = adjustment.weights
    if weights is not None and weights.kept:
        yield Notice(code="weights_kept", values={"groups": weights.kept})
    if weights is not None and not weights.converged:
        yield Notice(code="weights_not_settled")
