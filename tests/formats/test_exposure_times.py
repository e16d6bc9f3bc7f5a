"""Times of exposure: seconds, GPS seconds of the week, UTC."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from block_folders import findings, refused
from perfect_block import edit

from posstats.formats.block_folder import read_block


def with_times(folder: Path, column: str, values: list[str]) -> Path:
    table = pd.read_csv(folder / "orientations.csv", dtype=str)
    table = table.rename(columns={"time_s": column})
    table[column] = values
    table.to_csv(folder / "orientations.csv", index=False)
    return folder


GPS_TIMES = ["604770", "604780", "604790", "0", "500", "510.5", "520", "530"]


def test_gps_seconds_count_on_over_the_end_of_the_week(folder) -> None:
    times = read_block(with_times(folder, "time_gps_s", GPS_TIMES)).orientations.time_s
    assert np.array_equal(times, [604770, 604780, 604790, 604800, 605300, 605310.5, 605320, 605330])


def test_gps_seconds_of_mixed_rows_count_on_too(folder) -> None:
    with_times(folder, "time_gps_s", GPS_TIMES)
    expected = read_block(folder).orientations
    table = pd.read_csv(folder / "orientations.csv", dtype=str)
    for seed in range(5):
        table.sample(frac=1.0, random_state=seed).to_csv(folder / "orientations.csv", index=False)
        mixed = read_block(folder).orientations
        assert np.array_equal(mixed.time_s, expected.time_s)
        assert np.array_equal(mixed.image, expected.image)


def test_a_pause_of_days_in_rows_of_flight_order_is_no_new_week(folder) -> None:
    times = [str(t) for t in (100, 110, 120, 130, 500000, 500010, 500020, 500030)]
    block = read_block(with_times(folder, "time_gps_s", times))
    assert np.array_equal(block.orientations.time_s, np.array(times, dtype=float))


def test_gps_seconds_lie_within_a_week(folder) -> None:
    with_times(folder, "time_gps_s", ["604800", "-1", *GPS_TIMES[2:]])
    found = findings(folder)
    assert len(found) == 2
    assert "orientations.csv:2, time_gps_s: found 604800" in found[0]
    assert "orientations.csv:3, time_gps_s: found -1" in found[1]


def test_utc_is_counted_from_midnight_before_the_first_exposure(folder) -> None:
    moments = [
        "2024-05-17T23:59:50Z",
        "2024-05-17T23:59:59.125",
        "2024-05-18T02:00:05.250+02:00",
        "2024-05-18 00:00:10",
        *(f"2024-05-18T00:10:{k}0.000001Z" for k in range(4)),
    ]
    times = read_block(with_times(folder, "time_utc", moments)).orientations.time_s
    expected = [86390, 86399.125, 86405.25, 86410, *(87000.000001 + 10 * np.arange(4))]
    assert np.allclose(times, expected, rtol=0, atol=1e-9)


@pytest.mark.parametrize("moment", ["2024-05-17", "yesterday", "", "2024-13-01T00:00:00", "12345"])
def test_what_is_no_moment_is_refused(folder, moment) -> None:
    good = [f"2024-05-17T00:00:{k}0Z" for k in range(6)]
    with_times(folder, "time_utc", [good[0], moment, *good])
    refused(folder, "orientations.csv:3, time_utc", repr(moment), "ISO 8601")


def test_one_kind_of_time_is_expected(folder) -> None:
    with_times(folder, "when", ["1"] * 8)
    refused(folder, "no time column", "time_s, time_gps_s, time_utc")
    edit(folder, "orientations.csv", (",when,", ",time_s,"))
    table = pd.read_csv(folder / "orientations.csv", dtype=str)
    table.assign(time_gps_s="1").to_csv(folder / "orientations.csv", index=False)
    refused(folder, "found time_s and time_gps_s")
