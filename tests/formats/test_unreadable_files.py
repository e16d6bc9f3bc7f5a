"""Files of a block folder that cannot be read, and what is said then."""

import errno
import os
from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet
import pytest
from block_folders import as_parquet, findings, refused, set_cell
from finding_parts import assert_finding, parts


def test_a_missing_folder_or_a_file_is_no_block(folder) -> None:
    refused(folder / "nowhere", "found nothing")
    refused(folder / "block.toml", "found a file")


@pytest.mark.parametrize("name", ["block.toml", "orientations.csv", "tie_points.csv"])
def test_missing_files_are_named(folder, name) -> None:
    (folder / name).unlink()
    refused(folder, name.removesuffix(".csv"), "expected")


@pytest.mark.parametrize(
    "name",
    ["block.toml", "orientations.csv", "tie_points.csv", "ground_points.csv", "adjusted.csv"],
)
@pytest.mark.parametrize(
    ("content", "what"),
    [
        (b"", "empty file"),
        (b"\r\n \n", "empty file"),
        (b"\xff\xfe\x00binary\x80", "not UTF-8"),
        (b"\x89PNG\r\n\x1a\n\0\0", "not UTF-8"),
        (b"point,image\n\0\0,1\n", ""),
        (b'"', ""),
        (b'a,"b\n', ""),
        (b"\xef\xbb\xbf", ""),
        (b"point,image,x,y,z,strip,time_s,omega,phi,kappa,role\n", ""),
    ],
)
def test_files_that_are_no_tables_are_refused(folder, name, content, what) -> None:
    (folder / name).write_bytes(content)
    found = findings(folder)
    assert all(text.startswith(name) for text in found), found
    assert what in found[0]


@pytest.mark.parametrize("content", [b"", b"PAR1", b"no parquet at all", b"PAR1" + b"\0" * 50])
def test_broken_parquet_is_refused(folder, content) -> None:
    (folder / "tie_points.csv").unlink()
    (folder / "tie_points.parquet").write_bytes(content)
    refused(folder, "tie_points.parquet: found")


def test_parquet_with_numbers_for_ids_or_text_for_numbers_is_refused(folder) -> None:
    table = pd.read_csv(folder / "tie_points.csv", dtype={"image": str, "point": str})
    (folder / "tie_points.csv").unlink()
    table["x"] = table["x"].astype(object).where(table.index != 4, None).astype(float)
    table["y"] = table["y"].astype(str).where(table.index != 2, "12,5")
    table.assign(point=np.arange(len(table)) / 2).to_parquet(folder / "tie_points.parquet")
    found = findings(folder)
    types = [text for text in found if text.startswith("tie_points.parquet, point: found")]
    assert "type double" in types[0]
    assert any("tie_points.parquet, row 5, x: found" in text for text in found)
    assert any("tie_points.parquet, row 3, y: found '12,5'" in text for text in found)


def test_a_folder_in_place_of_a_file_is_refused(folder) -> None:
    for name in ("tie_points.csv", "block.toml"):
        (folder / name).unlink()
        (folder / name).mkdir()
    found = findings(folder)
    assert [parts(each)[:2] for each in found] == [
        ("block.toml", "a folder"),
        ("tie_points.csv", "a folder"),
    ]


def test_an_unreadable_file_is_refused(folder, monkeypatch) -> None:
    read_bytes = Path.read_bytes

    def denied(path: Path) -> bytes:
        if path.name == "tie_points.csv":
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))
        return read_bytes(path)

    monkeypatch.setattr(Path, "read_bytes", denied)
    refused(folder, "tie_points.csv: ", "(Permission denied)")


def test_csv_and_parquet_of_one_table_are_refused(folder) -> None:
    pd.read_csv(folder / "adjusted.csv").to_parquet(folder / "adjusted.parquet")
    refused(folder, "found both adjusted.csv and adjusted.parquet")


@pytest.mark.parametrize(
    ("separator", "name"), [(";", "semicolons"), ("\t", "tabs"), ("|", "bars"), (" ", "spaces")]
)
@pytest.mark.parametrize("decimal", [".", ","])
def test_another_separator_is_named_once(folder, separator, name, decimal) -> None:
    path = folder / "tie_points.csv"
    path.write_text(path.read_text().replace(",", separator).replace(".", decimal))
    refused(folder, "tie_points.csv:1: found columns", f"by {name}")


def test_decimal_commas_are_named(folder) -> None:
    set_cell(folder, "orientations.csv", 1, "phi", "0,25")
    refused(folder, "orientations.csv:3, phi: found '0,25'", "a decimal point")
    path = folder / "tie_points.csv"
    head, *rows = path.read_text().splitlines()
    path.write_text("\n".join([head, *(row.replace(".", ",") for row in rows)]))
    assert ("tie_points.csv:2", "6 values", "4; decimal commas?") in map(parts, findings(folder))


@pytest.mark.parametrize("column", ["point", "image"])
def test_ids_of_a_type_that_is_no_text_are_one_finding(folder, column) -> None:
    as_parquet(folder, "tie_points", column, pa.binary())
    refused(folder, f"tie_points.parquet, {column}: found", "type binary")


def test_truth_values_are_no_numbers(folder) -> None:
    as_parquet(folder, "orientations", "omega", pa.bool_())
    found = findings(folder)
    assert_finding(found[0], "orientations.parquet, row 1, omega", "True")


def test_an_empty_block_toml_is_no_table(folder) -> None:
    (folder / "block.toml").write_bytes(b"")
    refused(folder, "block.toml: found an ")
