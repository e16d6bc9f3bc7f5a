"""The time of a report."""

import datetime as dt
import os


def now() -> str:
    """ISO 8601 time, UTC; fixed by SOURCE_DATE_EPOCH for reproducible output."""
    epoch = os.environ.get("SOURCE_DATE_EPOCH")
    moment = (
        dt.datetime.now(dt.UTC) if epoch is None else dt.datetime.fromtimestamp(int(epoch), dt.UTC)
    )
    return moment.isoformat(timespec="seconds")
