"""`posstats verify`: a line a question, and whether all that was asked holds."""

import datetime as dt
from collections.abc import Sequence
from importlib.metadata import version
from pathlib import Path

from posstats.contract.versions import versions
from posstats.errors import PosstatsError
from posstats.version import __version__

from ..acceptance.data import reassess
from ..acceptance.page import render_document
from ..acceptance.writing import read_templates
from ..archive.file import read_file
from ..verification.answers import Answer
from ..verification.questions import verify
from ..verification.recomputation import recompute
from ..verification.signature import read_trust
from ..verification.steps import Steps


def verify_file(
    path: Path,
    inputs: Path | None,
    trust_file: Path | None,
    templates: Path | None = None,
    *,
    now: dt.datetime,
) -> Sequence[Answer]:
    """Answer every question on the document `path`, as of `now`.

    Raises
    ------
    PosstatsError
        If the trusted certificate or the templates cannot be read, or the inputs are no folder.
    OSError
        If a file cannot be read.
    """
    if inputs is not None and not inputs.is_dir():
        raise PosstatsError(f"{inputs} is no block folder")
    trust = None if trust_file is None else _trust(trust_file)
    known = None if templates is None else read_templates(templates)
    return list(verify(path, steps(), inputs=inputs, trust=trust, templates=known, now=now))


def steps() -> Steps:
    """The steps of the installed version."""
    return Steps(
        recompute=recompute,
        reassess=reassess,
        render_document=render_document,
        numbers={"posstats": __version__, **versions()},
        layout=f"posstats {__version__}, WeasyPrint {version('weasyprint')}",
    )


def _trust(path: Path) -> list[bytes]:
    try:
        return read_trust(read_file(path))
    except PosstatsError as error:
        raise PosstatsError(f"{path}: {error}") from error
