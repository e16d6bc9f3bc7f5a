"""Whether the data inside a document hold together, and follow from the input files."""

import hashlib
from collections.abc import Iterator
from pathlib import Path, PurePath

from posstats.contract.acceptance import Acceptance
from posstats.contract.files import as_values
from posstats.contract.notice import Notice
from posstats.contract.results import Results
from posstats.contract.survey import InputFile
from posstats.errors import PosstatsError

from ..archive.reading import ACCEPTANCE, MALFORMED, Archive
from .answers import (
    ASSESSMENT,
    FILES,
    INPUTS,
    RECOMPUTED,
    Answer,
    answer,
    failed,
    said,
)
from .steps import Steps
from .values import TOLERANCE, differences

_OF_THE_RUN = {"created", "posstats_version", "versions"}


def embedded_files(archive: Archive) -> Answer:
    """Every file that is listed, no other, with its stated hash and relationship."""
    return answer(FILES, _file_problems(archive), said("files_as_listed", n=len(archive.files)))


def _file_problems(archive: Archive) -> Iterator[Notice]:
    rows = {row.file: row for row in archive.acceptance.attachments}
    yield from (
        said("file_missing", file=name) for name in sorted(rows.keys() - archive.files.keys())
    )
    others = archive.files.keys() - rows.keys() - {ACCEPTANCE}
    yield from (said("file_unlisted", file=name) for name in sorted(others))
    for name in sorted(rows.keys() & archive.files.keys()):
        if _sha256(archive.files[name].content) != rows[name].sha256:
            yield said("file_changed", file=name)
        elif archive.files[name].relationship != rows[name].relationship:
            yield said("file_relationship", file=name)
    stated = archive.acceptance.results
    if _sha256(archive.files[stated.file].content) != stated.sha256:
        yield said("file_not_assessed", file=stated.file)


def assessment(archive: Archive, steps: Steps) -> Answer:
    """Assess the embedded results again."""
    stated = archive.acceptance
    try:
        found = as_values(steps.reassess(archive.results, profile_files(archive), stated))
        tolerance = _tolerance(stated, steps)
        problems = list(_compared(archive.stated_acceptance, found, tolerance))
    except (PosstatsError, *MALFORMED) as error:
        return failed(ASSESSMENT, said("unrepeatable", reason=_reason(error)))
    holds = _within("assessed", tolerance, verdict=stated.verdict)
    return answer(ASSESSMENT, problems, holds, hedged=tolerance > 0.0)


def profile_files(archive: Archive) -> dict[str, bytes]:
    """The embedded profile files by the names that the assessment lists; found by their hash.

    Raises
    ------
    PosstatsError
        If one is not embedded.
    """
    by_hash = {_sha256(file.content): file.content for file in archive.files.values()}
    rows = archive.acceptance.profile.files
    missing = [row.file for row in rows if row.sha256 not in by_hash]
    if missing:
        raise PosstatsError(f"{', '.join(missing)} is not embedded as it was used")
    return {row.file: by_hash[row.sha256] for row in rows}


def input_files(archive: Archive, folder: Path) -> Answer:
    """Hash every input file that the results name."""
    rows = archive.results.block.inputs
    try:
        problems = [problem for row in rows for problem in _input_problems(folder, row)]
    except OSError as error:
        return failed(
            INPUTS,
            said("input_unreadable", file=str(error.filename), reason=str(error.strerror)),
        )
    return answer(INPUTS, problems, said("inputs_same", n=len(rows)))


def _input_problems(folder: Path, row: InputFile) -> Iterator[Notice]:
    if PurePath(row.file).name != row.file:
        yield said("no_file_name", file=row.file)
    elif not (folder / row.file).is_file():
        yield said("file_missing", file=row.file)
    else:
        with (folder / row.file).open("rb") as stream:
            if hashlib.file_digest(stream, "sha256").hexdigest() != row.sha256:
                yield said("input_differs", file=row.file)


def recomputed(archive: Archive, folder: Path, steps: Steps) -> Answer:
    """Compute the results from the input files again."""
    stated = archive.stated_results
    try:
        found = as_values(steps.recompute(folder, archive.results))
        tolerance = _tolerance(archive.results, steps)
        problems = list(_compared(stated, {**dict.fromkeys(stated), **found}, tolerance))
    except (PosstatsError, OSError, *MALFORMED) as error:
        return failed(RECOMPUTED, said("unrecomputable", reason=_reason(error)))
    return answer(RECOMPUTED, problems, _within("recomputed", tolerance), hedged=tolerance > 0.0)


def _compared(
    stated: dict[str, object], found: dict[str, object], tolerance: float
) -> Iterator[Notice]:
    """Of everything found again: what is stated, or what is different."""
    keys = [key for key in found if key not in _OF_THE_RUN]
    yield from differences(
        {key: stated.get(key) for key in keys}, {key: found[key] for key in keys}, tolerance
    )


def _tolerance(stated: Acceptance | Results, steps: Steps) -> float:
    """None for the same versions."""
    made = {"posstats": stated.posstats_version, **stated.versions}
    same = all(made.get(name) == version for name, version in steps.numbers.items())
    return 0.0 if same else TOLERANCE


def _within(code: str, tolerance: float, **values: str) -> Notice:
    """What holds; with other versions also how closely."""
    if not tolerance:
        return said(code, **values)
    return said(f"{code}_within", tolerance=f"{tolerance:g}", **values)


def _reason(error: BaseException) -> str:
    first = str(error).partition("\n")[0]
    return first if isinstance(error, PosstatsError) else f"{type(error).__name__}: {first}"


def _sha256(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()
