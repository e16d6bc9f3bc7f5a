"""Whether the data inside a document hold together, and follow from the input files."""

import hashlib
from collections.abc import Iterator
from pathlib import Path, PurePath

from posstats.contract.acceptance import Acceptance
from posstats.contract.files import as_values
from posstats.contract.results import Results
from posstats.contract.survey import InputFile
from posstats.errors import PosstatsError

from ..archive.reading import ACCEPTANCE, MALFORMED, Archive
from .steps import Steps
from .values import TOLERANCE, differences
from .words import ASSESSMENT, FILES, INPUTS, NOT_HERE, RECOMPUTED, Answer, answer, failed, listed

_OF_THE_RUN = {"created", "posstats_version", "versions"}


def embedded_files(archive: Archive) -> Answer:
    """Every file that is listed, no other, with its stated hash and relationship."""
    return answer(FILES, _file_problems(archive), f"yes, {len(archive.files)} files")


def _file_problems(archive: Archive) -> Iterator[str]:
    rows = {row.file: row for row in archive.acceptance.attachments}
    yield from (f"{name} is missing" for name in sorted(rows.keys() - archive.files.keys()))
    others = archive.files.keys() - rows.keys() - {ACCEPTANCE}
    yield from (f"{name} is not listed" for name in sorted(others))
    for name in sorted(rows.keys() & archive.files.keys()):
        if _sha256(archive.files[name].content) != rows[name].sha256:
            yield f"{name} was changed"
        elif archive.files[name].relationship != rows[name].relationship:
            yield f"{name} has another relationship"
    stated = archive.acceptance.results
    if _sha256(archive.files[stated.file].content) != stated.sha256:
        yield f"{stated.file} is not what was assessed"


def assessment(archive: Archive, steps: Steps) -> Answer:
    """Assess the embedded results again."""
    stated = archive.acceptance
    try:
        found = as_values(steps.reassess(archive.results, profile_files(archive), stated))
        tolerance = _tolerance(stated, steps)
        problems = list(_compared(archive.stated_acceptance, found, tolerance))
    except (PosstatsError, *MALFORMED) as error:
        return failed(ASSESSMENT, f"it cannot be repeated ({_reason(error)})")
    holds = f"yes, {stated.verdict}{_within(tolerance)}"
    return answer(ASSESSMENT, _hedged(problems, tolerance), holds)


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
        return failed(INPUTS, f"{error.filename}: {error.strerror}")
    return answer(INPUTS, problems, f"yes, {len(rows)} files")


def _input_problems(folder: Path, row: InputFile) -> Iterator[str]:
    if PurePath(row.file).name != row.file:
        yield f"{row.file} is no name of a file in the folder"
    elif not (folder / row.file).is_file():
        yield f"{row.file} is missing"
    else:
        with (folder / row.file).open("rb") as stream:
            if hashlib.file_digest(stream, "sha256").hexdigest() != row.sha256:
                yield f"{row.file} is another file than the one used"


def recomputed(archive: Archive, folder: Path, steps: Steps) -> Answer:
    """Compute the results from the input files again."""
    stated = archive.stated_results
    try:
        found = as_values(steps.recompute(folder, archive.results))
        tolerance = _tolerance(archive.results, steps)
        problems = list(_compared(stated, {**dict.fromkeys(stated), **found}, tolerance))
    except (PosstatsError, OSError, *MALFORMED) as error:
        return failed(RECOMPUTED, f"they cannot be recomputed ({_reason(error)})")
    return answer(RECOMPUTED, _hedged(problems, tolerance), f"yes{_within(tolerance)}")


def _compared(
    stated: dict[str, object], found: dict[str, object], tolerance: float
) -> Iterator[str]:
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


def _within(tolerance: float) -> str:
    return f", within {tolerance:g} of each number: other versions made it" if tolerance else ""


def _hedged(problems: list[str], tolerance: float) -> list[str]:
    return [f"{NOT_HERE}: {listed(problems)}"] if problems and tolerance else problems


def _reason(error: BaseException) -> str:
    first = str(error).partition("\n")[0]
    return first if isinstance(error, PosstatsError) else f"{type(error).__name__}: {first}"


def _sha256(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()
