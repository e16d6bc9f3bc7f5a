"""`posstats simulate` and `posstats check`: write and validate block folders."""

from collections.abc import Iterator
from pathlib import Path

from posstats.block.image_pairs import stereo_models
from posstats.block.model import Block
from posstats.formats.block_folder import read_block, write_block
from posstats.synthetic import Scenario, simulate

from ..block.wording import warnings
from ..output.staged_folder import staged_folder


def simulate_block(scenario: Scenario, out: Path, seed: int | None) -> Iterator[str]:
    """Simulate a scenario into a block folder; yields what was written."""
    block = simulate(scenario, seed)
    with staged_folder(out) as stage:
        write_block(block, stage)
    yield from _described(block)
    yield f"simulated block: {out}"


def check_block(folder: Path) -> Iterator[str]:
    """Validate a block folder; yields a summary."""
    block = read_block(folder)
    yield from _described(block)
    for warning in warnings(block.notices):
        yield f"warning: {warning}"
    yield "accepted"


def _described(block: Block) -> Iterator[str]:
    checks = int(block.check_points.sum())
    pos = block.orientations
    yield (
        f"{block.name}: {len(pos)} images in {len(pos.strips)} strips, "
        f"{len(stereo_models(block))} stereo models"
    )
    yield (
        f"{len(block.tie_points)} measurements of {len(block.tie_points.point_id)} points,"
        f" {checks} check points"
    )
