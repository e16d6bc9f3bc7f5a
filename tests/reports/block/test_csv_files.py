"""The lists of the results as CSV files."""

import csv

from posstats.reports.block.csv_files import write_tables


def test_csv_tables_keep_every_row_and_every_digit(area, tmp_path):
    write_tables(area, tmp_path)
    with (tmp_path / "models.csv").open(encoding="utf-8", newline="") as stream:
        read_back = list(csv.DictReader(stream))
    assert len(read_back) == len(area.models)
    assert [float(row["pos_px"]) for row in read_back] == [m.pos_px for m in area.models]
    with (tmp_path / "regression.csv").open(encoding="utf-8", newline="") as stream:
        first = next(csv.DictReader(stream))
    assert float(first["slope_ci95_low"]) == area.regression[0].slope_ci95[0]


def test_csv_tables_leave_missing_values_empty(coarse, tmp_path):
    write_tables(coarse, tmp_path)
    with (tmp_path / "parallax.csv").open(encoding="utf-8", newline="") as stream:
        assert all(row["mean_mm"] == "" for row in csv.DictReader(stream))
