"""The lists of the results as CSV files."""

import csv
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from posstats.contract.files import as_values
from posstats.contract.results import Results
from posstats.numerics.kernels.rotation import CAMERA_ANGLE_NAMES

CSV_TABLES = (
    "images",
    "parallax",
    "models",
    "error_sources",
    "angle_errors",
    "angle_error_summary",
    "regression",
    "selection",
    "corrected_parallax",
    "check_points",
    "check_point_residuals",
    "observability",
    "frames",
)
_CODES = ("notice", "notices", "rotations")  # beside the words that stand for them
_VECTOR_PARTS = {"slope_ci95": ("low", "high"), "gls_slope_ci95": ("low", "high"), "shift_m": "xyz"}


def write_tables(results: Results, folder: Path) -> list[Path]:
    """Write every list of the results as a CSV file, with all digits and the names of the results.

    Parameters
    ----------
    results
        Of a block.
    folder
        Where the files go; made if it does not exist.

    Returns
    -------
    list of Path
        The files written: one per list that has rows.
    """
    folder.mkdir(parents=True, exist_ok=True)
    written = []
    for name in CSV_TABLES:
        records = [dict(_flat(as_values(row))) for row in getattr(results, name)]
        if records:
            written.append(_write_csv(records, folder / f"{name}.csv"))
    return written


def _write_csv(records: Sequence[Mapping[str, object]], path: Path) -> Path:
    names = [name for name in records[0] if _is_known(name, records)]
    with path.open("w", encoding="utf-8", newline="") as stream:
        writer = csv.DictWriter(stream, names, extrasaction="ignore", lineterminator="\n")
        writer.writeheader()
        writer.writerows(records)
    return path


def _is_known(name: str, records: Sequence[Mapping[str, object]]) -> bool:
    """Whether a column is written: angles of a frame that nobody asked for are not."""
    asked_for = not name.removeprefix("sigma_").startswith(CAMERA_ANGLE_NAMES)
    return asked_for or any(record[name] is not None for record in records)


def _flat(row: Mapping[str, object]) -> Iterator[tuple[str, object]]:
    """One value per name: intervals and vectors in several columns, lists of words in one."""
    for name, value in row.items():
        if name in _CODES:
            continue
        if name in _VECTOR_PARTS:
            yield from _parts(name, value)
        elif name == "footprint":
            yield from _corners(value)
        elif isinstance(value, list | tuple):
            yield name, "; ".join(map(str, value))
        else:
            yield name, value


def _parts(name: str, value: object) -> Iterator[tuple[str, object]]:
    parts = value if isinstance(value, list | tuple) else (None,) * len(_VECTOR_PARTS[name])
    for part, number in zip(_VECTOR_PARTS[name], parts, strict=True):
        yield f"{name}_{part}", number


def _corners(value: object) -> Iterator[tuple[str, object]]:
    corners = value if isinstance(value, list | tuple) else ((None, None),) * 4
    for index, (x, y) in enumerate(corners, start=1):
        yield f"corner{index}_x_m", x
        yield f"corner{index}_y_m", y
