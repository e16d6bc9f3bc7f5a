"""What reading a block folder refuses, and changes of its tables."""

from pathlib import Path

import pandas as pd
import pyarrow as pa
import pyarrow.parquet
import pytest

from posstats.errors import BlockFormatError
from posstats.formats.block_folder import read_block


def findings(folder: Path) -> tuple[str, ...]:
    with pytest.raises(BlockFormatError) as refused:
        read_block(folder)
    return refused.value.findings


def refused(folder: Path, *expected: str) -> None:
    """There is one finding, and it holds the expected pieces."""
    found = findings(folder)
    assert len(found) == 1, found
    for piece in expected:
        assert piece in found[0]


def set_cell(folder: Path, name: str, row: int, column: str, value: str) -> None:
    table = pd.read_csv(folder / name, dtype=str, keep_default_na=False)
    table.loc[row, column] = value
    table.to_csv(folder / name, index=False)


def as_parquet(folder: Path, stem: str, column: str, kind: pa.DataType) -> None:
    """The table as Parquet, one column of another type."""
    types = dict.fromkeys(("image", "strip", "point", "role"), str)
    table = pa.Table.from_pandas(pd.read_csv(folder / f"{stem}.csv", dtype=types))
    number = table.column_names.index(column)
    values = table[column].cast(kind) if kind != pa.bool_() else pa.array([True] * len(table))
    pyarrow.parquet.write_table(
        table.set_column(number, column, values), folder / f"{stem}.parquet"
    )
    (folder / f"{stem}.csv").unlink()
