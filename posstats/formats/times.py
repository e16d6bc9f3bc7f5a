"""Exposure times of orientations.csv: seconds, GPS seconds of week, or UTC."""

from datetime import UTC, datetime

import numpy as np

from posstats.arrays import Floats
from posstats.formats.text_table import FileTable

TIME_COLUMNS = ("time_s", "time_gps_s", "time_utc")
WEEK_S = 604_800.0
LARGEST_S = 1e11
"""Seconds of no known origin: 3000 years; time stamps in milliseconds since 1970 lie beyond."""


def read_times(table: FileTable, findings: list[str]) -> Floats:
    """Exposure times (n,), seconds, of the one time column; NaN with a finding where there is none.

    UTC is counted in seconds from midnight before the first exposure, which keeps fractions of
    microseconds that seconds since 1970 would lose.
    """
    present = [name for name in TIME_COLUMNS if name in table.columns]
    if len(present) != 1:
        found = " and ".join(present) or "no time column"
        findings.append(
            f"{table.file}: found {found}, expected one column of {', '.join(TIME_COLUMNS)}"
        )
        return np.full(len(table), np.nan)
    if present == ["time_utc"]:
        return _utc_seconds(table, findings)
    hint = "; milliseconds?" if present == ["time_s"] else ""
    seconds = table.numbers(present[0], findings, largest=LARGEST_S, hint=hint)
    if present == ["time_gps_s"]:
        findings += [
            f"{table.place(row, 'time_gps_s')}: found {seconds[row]:.10g},"
            " expected seconds of week in [0, 604800)"
            for row in np.flatnonzero((seconds < 0.0) | (seconds >= WEEK_S))
        ]
        return continuous_gps_seconds(seconds)
    return seconds


def continuous_gps_seconds(seconds_of_week: Floats) -> Floats:
    """GPS seconds of week (n,) counted on over the end of the week.

    In rows of flight order a step back of more than half a week is a new week. In rows of another
    order steps mean nothing: there, a gap of more than half a week in the sorted seconds lies
    between the exposures of the new week and those of the old one.
    """
    steps_back = np.diff(seconds_of_week) < -0.5 * WEEK_S
    weeks = np.concatenate([[0], np.cumsum(steps_back)])
    continuous = seconds_of_week + WEEK_S * weeks
    if np.all(np.diff(continuous) >= 0.0):
        return continuous
    ascending = np.sort(seconds_of_week)
    widest = int(np.argmax(np.diff(ascending)))
    if ascending[widest + 1] - ascending[widest] <= 0.5 * WEEK_S:
        return continuous
    return seconds_of_week + np.where(seconds_of_week <= ascending[widest], WEEK_S, 0.0)


def _utc_seconds(table: FileTable, findings: list[str]) -> Floats:
    moments = []
    for row, text in enumerate(table.text("time_utc")):
        moment = _moment(text)
        if moment is None:
            findings.append(
                f"{table.place(row, 'time_utc')}: found {text!r},"
                " expected ISO 8601 date and time such as 2024-05-17T09:30:00.25Z"
            )
        moments.append(moment)
    known = [moment for moment in moments if moment is not None]
    if not known:
        return np.full(len(table), np.nan)
    origin = min(known).replace(hour=0, minute=0, second=0, microsecond=0)
    return np.array([np.nan if m is None else (m - origin).total_seconds() for m in moments])


def _moment(text: str) -> datetime | None:
    """A UTC moment; without an offset it is taken as UTC, a date alone is none."""
    text = text.strip()
    if len(text) <= len("2024-05-17"):
        return None
    try:
        moment = datetime.fromisoformat(text)
    except ValueError:
        return None
    return moment.replace(tzinfo=UTC) if moment.tzinfo is None else moment.astimezone(UTC)
