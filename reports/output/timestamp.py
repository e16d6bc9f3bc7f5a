"""The time: the one place that reads the clock of the computer."""

import datetime as dt
import os


def clock() -> dt.datetime:
    """The moment of a signature and of its verification, UTC."""
    return dt.datetime.now(dt.UTC)


def now() -> str:
    """ISO 8601 time of a report, UTC; fixed by SOURCE_DATE_EPOCH for reproducible output."""
    epoch = os.environ.get("SOURCE_DATE_EPOCH")
    moment = clock() if epoch is None else dt.datetime.fromtimestamp(int(epoch), dt.UTC)
    return moment.isoformat(timespec="seconds")
