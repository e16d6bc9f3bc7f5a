"""The short summary that a command prints."""

import textwrap
from collections.abc import Iterator

from . import verdict
from .results_view import Results

WIDTH = 88


def summary(results: Results) -> Iterator[str]:
    """The verdict of the report, its decisions and its warnings, as lines of text."""
    block = results["block"]
    simulated = " (simulated)" if block["simulated"] else ""
    yield f"{block['name']}{simulated}: {block['n_images']} images, {block['n_models']} models"
    yield ""
    yield from textwrap.wrap(verdict.paragraph(results), WIDTH)
    yield ""
    for row in results["selection"]:
        scope = "" if row["scope"] == "block" else f" strip {row['scope']}"
        line = f"{row['angle']}{scope}: {row['form']} ({row['reason']})"
        yield from textwrap.wrap(line, WIDTH, subsequent_indent="  ")
    for warning in results["warnings"]:
        yield from textwrap.wrap(f"warning: {warning}", WIDTH, subsequent_indent="  ")
