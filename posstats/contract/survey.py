"""What every file says of the block that it is about."""

from dataclasses import dataclass
from typing import Annotated

from posstats.contract.about import about

Corner = tuple[float, float]


@dataclass(frozen=True, kw_only=True)
class InputFile:
    """A file that was read."""

    file: Annotated[str, about("name in the block folder")]
    sha256: Annotated[str, about("checksum of its bytes")]


@dataclass(frozen=True, kw_only=True)
class BlockSummary:
    """What a block is, and what it was read from."""

    name: Annotated[str, about("from `block.toml`")]
    n_images: Annotated[int, about("images")]
    n_strips: Annotated[int, about("strips")]
    n_tie_points: Annotated[int, about("tie points")]
    n_check_points: Annotated[int, about("ground points of role `check`")]
    simulated: Annotated[bool, about("from `block.toml`")]
    crs: Annotated[str | None, about("of the coordinates; `null` if Cartesian")]
    angles: Annotated[str, about("angle system of the computation")]
    inputs: Annotated[tuple[InputFile, ...], about("files read")]


@dataclass(frozen=True, kw_only=True)
class ImagePlace:
    """An image in the plan of the block, in its crs."""

    image: Annotated[str, about("id of the image")]
    strip: Annotated[str, about("id of the strip")]
    time_s: Annotated[float, about("time of exposure")]
    x_m: Annotated[float, about("projection centre")]
    y_m: Annotated[float, about("projection centre")]
    z_m: Annotated[float, about("projection centre")]
    footprint: Annotated[
        tuple[Corner, Corner, Corner, Corner] | None, about("four corners `[x, y]`, or `null`")
    ]
