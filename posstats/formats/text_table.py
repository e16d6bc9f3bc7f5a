"""Tables of a block folder: CSV or Parquet, read as text first and checked in one sweep.

Numbers are parsed by Arrow's compiled reader; line numbers are looked for only when something is
wrong.
"""

import csv
import hashlib
import io
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, SupportsIndex

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.csv
import pyarrow.parquet

from posstats.arrays import Floats, Ints

_NUMBER = re.compile(r"[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?")
_CONTROL_CHARACTERS = r"[\x00-\x08\x0B\x0C\x0E-\x1F\x7F]"  # no XML or HTML can hold them
_SHOWN_TEXT = 60
_HEADER_CHARACTERS = 1_000_000
_OTHER_SEPARATORS = {";": "semicolons", "\t": "tabs", "|": "bars", " ": "spaces"}


@dataclass(frozen=True, eq=False)
class FileTable:
    """One table as it was read.

    Attributes
    ----------
    file
        Name of the file.
    sha256
        Of the file's bytes.
    columns
        Arrow arrays; text for CSV, whatever was stored for Parquet.
    content
        The text of a CSV file, to find lines in; None for Parquet.
    """

    file: str
    sha256: str
    columns: Mapping[str, Any]
    content: str | None

    def __len__(self) -> int:
        return len(next(iter(self.columns.values())))

    def place(self, row: SupportsIndex, column: str) -> str:
        """Where a value stands, for a finding: file, line (row of Parquet) and column."""
        if self.content is None:
            return f"{self.file}, row {int(row) + 1}, {column}"
        return f"{self.file}:{self._lines[row]}, {column}"

    def require(self, names: Sequence[str], findings: list[str]) -> bool:
        """Whether all columns `names` are there; a finding for each that is not."""
        missing = [name for name in names if name not in self.columns]
        if not missing:
            return True
        head = self.file if self.content is None else f"{self.file}:{self._header_line}"
        there = ", ".join(self.columns)
        findings += [
            f"{head}, {name}: found no such column in {there}, expected it" for name in missing
        ]
        return False

    def ids(self, column: str, findings: list[str]) -> Any:
        """Arrow text array of a column of ids; integers of Parquet are taken as their digits."""
        values = _text(self.columns[column])
        if values is None:
            found = self.columns[column].type
            findings.append(f"{self.file}, {column}: found values of type {found}, expected text")
            return pa.array([""] * len(self), pa.string())
        values = pc.fill_null(values, "")
        empty = np.flatnonzero(_as_numpy(pc.or_(pc.equal(values, ""), pc.utf8_is_space(values))))
        findings += [f"{self.place(row, column)}: found nothing, expected an id" for row in empty]
        unprintable = _as_numpy(pc.match_substring_regex(values, _CONTROL_CHARACTERS))
        findings += [
            f"{self.place(row, column)}: found {values[row].as_py()!r}, expected an id without "
            "control characters"
            for row in np.flatnonzero(unprintable)
        ]
        return values

    def text(self, column: str) -> list[str]:
        """Values of a column as Python text, nothing as "" (for small tables)."""
        values = _text(self.columns[column], numbers=True)
        return ["" if value is None else str(value) for value in values.to_pylist()]

    def numbers(
        self,
        column: str,
        findings: list[str],
        optional: bool = False,
        largest: float = np.inf,
        hint: str = "",
    ) -> Floats:
        """(n,) finite numbers of a column; NaN, with a finding, where there is none.

        `optional` lets empty cells and NaN pass without a finding; numbers beyond `largest` in
        size are refused, with a `hint` at what they may be.
        """
        values = _parsed(self.columns[column])
        bad = ~np.isfinite(values)
        for row in np.flatnonzero(bad):
            found = self.columns[column][int(row)].as_py()
            if optional and _is_blank(found):
                values[row] = np.nan
                continue
            shown = "nothing" if found in (None, "") else repr(found)[:_SHOWN_TEXT]
            point = " with a decimal point" if isinstance(found, str) and "," in found else ""
            findings.append(
                f"{self.place(row, column)}: found {shown}, expected a finite number{point}"
            )
            values[row] = np.nan
        for row in np.flatnonzero(np.abs(values) > largest):
            findings.append(
                f"{self.place(row, column)}: found {values[row]:g}, expected a number of at most"
                f" {largest:g} in size{hint}"
            )
            values[row] = np.nan
        return values

    @cached_property
    def _lines(self) -> Ints:
        """(n,) line of the file at which each row starts."""
        starts = [line for line, _ in _records(self.content or "")]
        return np.array(starts[1:], dtype=np.intp)

    @property
    def _header_line(self) -> int:
        return next(_records(self.content or ""))[0]


def read_table(folder: Path, stem: str, findings: list[str]) -> FileTable | None:
    """Read `stem`.csv or `stem`.parquet of a folder.

    Returns None if there is neither, or if the file cannot be read as a table; the second with a
    finding.
    """
    present = [
        path for ending in ("csv", "parquet") if (path := folder / f"{stem}.{ending}").exists()
    ]
    if len(present) == 2:
        findings.append(f"{stem}: found both {stem}.csv and {stem}.parquet, expected one of them")
    if len(present) != 1:
        return None
    path = present[0]
    content = read_bytes(path, findings)
    if content is None:
        return None
    read = _read_csv if path.suffix == ".csv" else _read_parquet
    if not content.strip():
        findings.append(f"{path.name}: found an empty file, expected a table")
        return None
    table = read(path.name, content, findings)
    if table is not None and len(table) == 0:
        findings.append(f"{path.name}: found no rows, expected at least one")
        return None
    return table


def read_bytes(path: Path, findings: list[str]) -> bytes | None:
    """The content of a file, or a finding that says why there is none."""
    if path.is_dir():
        findings.append(f"{path.name}: found a folder, expected a file")
        return None
    try:
        return path.read_bytes()
    except OSError as error:
        findings.append(f"{path.name}: cannot be read ({error.strerror})")
        return None


def sha256(content: bytes) -> str:
    """Hexadecimal SHA-256 of a file's content."""
    return hashlib.sha256(content).hexdigest()


def _read_csv(file: str, content: bytes, findings: list[str]) -> FileTable | None:
    text = _decoded(file, content, findings)
    if text is None:
        return None
    if not text.strip():
        findings.append(f"{file}: found an empty file, expected a table")
        return None
    header = _header(file, text, findings)
    if header is None:
        return None
    try:
        table = pyarrow.csv.read_csv(
            pa.BufferReader(text.lstrip("\r\n").encode()),
            parse_options=pyarrow.csv.ParseOptions(newlines_in_values='"' in text),
            convert_options=pyarrow.csv.ConvertOptions(
                column_types=dict.fromkeys(header, pa.string()), strings_can_be_null=False
            ),
        )
    except pa.ArrowInvalid as error:
        findings += _ragged_rows(file, text, len(header)) or [f"{file}: found no table: {error}"]
        return None
    return FileTable(file, sha256(content), _columns(table), text)


def _decoded(file: str, content: bytes, findings: list[str]) -> str | None:
    """UTF-8 text without byte order mark, or a finding."""
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content[: error.start].count(b"\n") + 1
        findings.append(f"{file}:{line}: found bytes that are not UTF-8, expected text")
        return None
    if "\0" in text:
        line = text[: text.index("\0")].count("\n") + 1
        findings.append(f"{file}:{line}: found binary data, expected text")
        return None
    return text


def _header(file: str, text: str, findings: list[str]) -> list[str] | None:
    """Column names as they stand, or None with a finding if they are no names."""
    try:
        line, header = next(_records(text[:_HEADER_CHARACTERS]))
    except csv.Error as error:
        findings.append(f"{file}:1: found no header row ({error}), expected column names")
        return None
    names = [name.strip() for name in header]
    if len(names) == 1:
        for separator, word in _OTHER_SEPARATORS.items():
            if separator in names[0]:
                findings.append(
                    f"{file}:{line}: found columns separated by {word}, expected commas (and"
                    " decimal points)"
                )
                return None
    twice = sorted({name for name in names if names.count(name) > 1})
    findings += [f"{file}:{line}, {name}: found the column twice, expected once" for name in twice]
    return None if twice else header


def _records(text: str) -> Iterator[tuple[int, list[str]]]:
    """First line (counted from 1) and fields of every record that is not empty."""
    reader = csv.reader(io.StringIO(text, newline=""))
    line = 1
    for fields in reader:
        if fields:
            yield line, fields
        line = reader.line_num + 1


def _ragged_rows(file: str, text: str, n_columns: int) -> list[str]:
    try:
        return [
            f"{file}:{line}: found {len(fields)} values, expected {n_columns}"
            f"{'; decimal commas?' if len(fields) > n_columns else ''}"
            for line, fields in _records(text)
            if len(fields) != n_columns
        ]
    except csv.Error as error:
        return [f"{file}: found no table: {error}"]


def _read_parquet(file: str, content: bytes, findings: list[str]) -> FileTable | None:
    try:
        table = pyarrow.parquet.read_table(pa.BufferReader(content))
    except (pa.ArrowInvalid, OSError) as error:
        findings.append(f"{file}: found no Parquet file ({error}), expected one")
        return None
    twice = sorted({name for name in table.column_names if table.column_names.count(name) > 1})
    findings += [f"{file}, {name}: found the column twice, expected once" for name in twice]
    if not table.column_names:
        findings.append(f"{file}: found no columns, expected a table")
    if twice or not table.column_names:
        return None
    return FileTable(file, sha256(content), _columns(table), None)


def _columns(table: Any) -> dict[str, Any]:
    return {
        name.strip(): column.combine_chunks()
        for name, column in zip(table.column_names, table.columns, strict=True)
    }


def _text(values: Any, numbers: bool = False) -> Any:
    """Arrow text of text, integer or (if asked) any other values, else None."""
    if pa.types.is_dictionary(values.type):
        values = values.dictionary_decode()
    if _is_text(values.type) or pa.types.is_integer(values.type) or numbers:
        return values.cast(pa.string())
    return None


def _parsed(values: Any) -> Floats:
    """Numbers of an Arrow array, NaN where there is none."""
    if pa.types.is_dictionary(values.type):
        values = values.dictionary_decode()
    if pa.types.is_boolean(values.type):
        return np.full(len(values), np.nan)
    if _is_text(values.type):
        text = pc.utf8_trim_whitespace(values.cast(pa.string()))
        try:
            return np.array(_as_numpy(text.cast(pa.float64())), dtype=float)
        except pa.ArrowInvalid:
            return np.array([_number(item) for item in text.to_pylist()])
    try:
        return np.array(_as_numpy(values.cast(pa.float64(), safe=False)), dtype=float)
    except (pa.ArrowInvalid, pa.ArrowNotImplementedError):
        return np.full(len(values), np.nan)


def _is_text(kind: Any) -> bool:
    return bool(
        pa.types.is_string(kind) or pa.types.is_large_string(kind) or pa.types.is_string_view(kind)
    )


def _number(text: str | None) -> float:
    return float(text) if text is not None and _NUMBER.fullmatch(text) else np.nan


def _is_blank(found: object) -> bool:
    return found is None or str(found).strip().lower() in ("", "nan")


def _as_numpy(values: Any) -> Any:
    return values.to_numpy(zero_copy_only=False)
