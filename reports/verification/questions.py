"""`posstats verify`: every question on a document of `posstats accept`, answered.

Nothing in the document is believed: its data are hashed, assessed and laid out again. What cannot
be found out without a signature is who wrote it.
"""

import datetime as dt
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from ..archive.file import UnreadableArchiveError, part, read_file
from ..archive.reading import MALFORMED, Archive, open_archive
from .answers import (
    APPENDED,
    INPUTS,
    READABLE,
    RECOMPUTED,
    Answer,
    Standing,
    answer,
    caught,
    failed,
    not_asked,
    said,
)
from .data import assessment, embedded_files, input_files, recomputed
from .pages import pages
from .signature import count_signatures, signatures
from .steps import Steps
from .updates import appended


def verify(
    path: Path,
    steps: Steps,
    *,
    inputs: Path | None = None,
    trust: Sequence[bytes] | None = None,
    templates: Mapping[str, bytes] | None = None,
    now: dt.datetime,
) -> Iterator[Answer]:
    """Answer every question on a document, one after the other.

    Parameters
    ----------
    steps
        What the document was made with.
    inputs
        Block folder with the input files; None: not asked for.
    trust
        Certificates, DER, that a signer's certificate has to lead to; None: not asked for.
    templates
        Those that the user knows, by name; pages of others are not believed.

    Raises
    ------
    OSError
        If the file cannot be read.
    """
    try:
        archive = open_archive(part(read_file(path)))
        n_signatures = count_signatures(archive.pdf)
    except UnreadableArchiveError as error:
        yield failed(READABLE, caught("because", error))
        return
    stated = archive.acceptance
    holds = said("readable", document_id=stated.document_id, verdict=stated.verdict)
    yield answer(READABLE, [], holds)
    yield from signatures(archive.file, n_signatures, trust, now)
    yield _on_updates(archive, n_signatures)
    yield embedded_files(archive)
    yield assessment(archive, steps)
    yield pages(archive, steps, templates)
    yield from _on_inputs(archive, inputs, steps)


def holds(answers: Sequence[Answer]) -> bool:
    """Whether all that was asked holds."""
    return all(each.standing is not Standing.FAIL for each in answers)


def _on_updates(archive: Archive, n_signatures: int) -> Answer:
    try:
        return appended(archive.file, archive.pdf, n_signatures)
    except (UnreadableArchiveError, *MALFORMED) as error:
        return failed(APPENDED, caught("updates_incomparable", error))


def _on_inputs(archive: Archive, inputs: Path | None, steps: Steps) -> Iterator[Answer]:
    if inputs is None:
        yield not_asked(INPUTS, said("no_inputs"))
        yield not_asked(RECOMPUTED, said("no_inputs"))
    else:
        yield input_files(archive, inputs)
        yield recomputed(archive, inputs, steps)
