"""A block and its check points as they stand in the files of the contract."""

from collections.abc import Iterator

from posstats.block.model import Block
from posstats.contract.check_points import CheckPointResidual
from posstats.contract.record import record
from posstats.contract.survey import BlockSummary, ImagePlace, InputFile
from posstats.geometry.ground.check_points import CheckPointResiduals
from posstats.geometry.ground.footprints import footprints


def block_summary(block: Block) -> BlockSummary:
    """What a block is, and what it was read from."""
    n_checks = 0 if block.ground_points is None else int(block.ground_points.is_check.sum())
    return BlockSummary(
        name=block.name,
        n_images=len(block.orientations),
        n_strips=len(block.orientations.strips),
        n_tie_points=int((~block.check_points).sum()),
        n_check_points=n_checks,
        simulated=block.simulated,
        crs=block.frame.crs,
        angles=block.orientations.system,
        inputs=tuple(InputFile(file=name, sha256=digest) for name, digest in block.inputs),
    )


def image_places(block: Block) -> tuple[ImagePlace, ...]:
    """Every image with its place in the plan."""
    pos = block.orientations
    position = block.frame.to_crs(pos.position_m)
    return tuple(
        record(
            ImagePlace,
            {
                "image": pos.image[k],
                "strip": pos.strip[k],
                "time_s": pos.time_s[k],
                "x_m": position[k, 0],
                "y_m": position[k, 1],
                "z_m": position[k, 2],
                "footprint": corners,
            },
        )
        for k, corners in enumerate(footprints(block))
    )


def residual_rows(residuals: CheckPointResiduals) -> Iterator[CheckPointResidual]:
    """Every check point from one set of orientations."""
    for k in range(len(residuals)):
        values = {
            "orientation": residuals.orientation,
            "point": residuals.point[k],
            "n_rays": residuals.n_rays[k],
            "status": residuals.status[k],
            "survey_sigma_xy_m": residuals.survey_sigma_m[k, 0],
            "survey_sigma_z_m": residuals.survey_sigma_m[k, 1],
        }
        for axis, name in enumerate("xyz"):
            values[f"{name}_m"] = residuals.given_m[k, axis]
            values[f"d{name}_m"] = residuals.difference_m[k, axis]
            values[f"sigma_{name}_m"] = residuals.sigma_m[k, axis]
        yield record(CheckPointResidual, values)
