"""Whether the data inside a document hold together, and follow from the input files."""

import hashlib
from collections.abc import Iterator, Mapping
from pathlib import Path, PurePath
from typing import Any

from posstats.errors import PosstatsError

from ..archive.reading import ACCEPTANCE, MALFORMED, Archive
from .steps import Steps
from .values import TOLERANCE, differences
from .words import ASSESSMENT, FILES, INPUTS, NOT_HERE, RECOMPUTED, Answer, answer, failed, listed

_OF_THE_RUN = {"created", "posstats_version", "versions"}


def embedded_files(archive: Archive) -> Answer:
    """Every file that is listed, no other, with its stated hash and relationship."""
    try:
        problems = list(_file_problems(archive))
    except MALFORMED as error:
        return failed(FILES, f"their list is damaged ({error})")
    return answer(FILES, problems, f"yes, {len(archive.files)} files")


def _file_problems(archive: Archive) -> Iterator[str]:
    rows = {row["file"]: row for row in archive.acceptance["attachments"]}
    yield from (f"{name} is missing" for name in sorted(rows.keys() - archive.files.keys()))
    others = archive.files.keys() - rows.keys() - {ACCEPTANCE}
    yield from (f"{name} is not listed" for name in sorted(others))
    for name in sorted(rows.keys() & archive.files.keys()):
        if _sha256(archive.files[name].content) != rows[name]["sha256"]:
            yield f"{name} was changed"
        elif archive.files[name].relationship != rows[name]["relationship"]:
            yield f"{name} has another relationship"
    stated = archive.acceptance["results"]
    if _sha256(archive.files[stated["file"]].content) != stated["sha256"]:
        yield f"{stated['file']} is not what was assessed"


def assessment(archive: Archive, steps: Steps) -> Answer:
    """Assess the embedded results again."""
    stated = archive.acceptance
    try:
        found = steps.reassess(archive.results, profile_files(archive), stated)
        tolerance = _tolerance(stated, steps)
        problems = list(_compared(stated, found, tolerance))
    except (PosstatsError, *MALFORMED) as error:
        return failed(ASSESSMENT, f"it cannot be repeated ({_reason(error)})")
    holds = f"yes, {stated.get('verdict')}{_within(tolerance)}"
    return answer(ASSESSMENT, _hedged(problems, tolerance), holds)


def profile_files(archive: Archive) -> dict[str, bytes]:
    """The embedded profile files by the names that the assessment lists; found by their hash."""
    by_hash = {_sha256(file.content): file.content for file in archive.files.values()}
    return {row["file"]: by_hash[row["sha256"]] for row in archive.acceptance["profile"]["files"]}


def input_files(archive: Archive, folder: Path) -> Answer:
    """Hash every input file that the results name."""
    try:
        rows = archive.results["block"]["inputs"]
        problems = [problem for row in rows for problem in _input_problems(folder, row)]
    except MALFORMED as error:
        return failed(INPUTS, f"their list is damaged ({error})")
    except OSError as error:
        return failed(INPUTS, f"{error.filename}: {error.strerror}")
    return answer(INPUTS, problems, f"yes, {len(rows)} files")


def _input_problems(folder: Path, row: Mapping[str, Any]) -> Iterator[str]:
    name = row["file"]
    if PurePath(name).name != name:
        yield f"{name} is no name of a file in the folder"
    elif not (folder / name).is_file():
        yield f"{name} is missing"
    else:
        with (folder / name).open("rb") as stream:
            if hashlib.file_digest(stream, "sha256").hexdigest() != row["sha256"]:
                yield f"{name} is another file than the one used"


def recomputed(archive: Archive, folder: Path, steps: Steps) -> Answer:
    """Compute the results from the input files again."""
    stated = archive.results
    try:
        found = steps.recompute(folder, stated)
        tolerance = _tolerance(stated, steps)
        problems = list(_compared(stated, {**dict.fromkeys(stated), **found}, tolerance))
    except (PosstatsError, OSError, *MALFORMED) as error:
        return failed(RECOMPUTED, f"they cannot be recomputed ({_reason(error)})")
    return answer(RECOMPUTED, _hedged(problems, tolerance), f"yes{_within(tolerance)}")


def _compared(stated: dict[str, Any], found: dict[str, Any], tolerance: float) -> Iterator[str]:
    """Of everything found again: what is stated, or what is different."""
    keys = [key for key in found if key not in _OF_THE_RUN]
    yield from differences(
        {key: stated.get(key) for key in keys}, {key: found[key] for key in keys}, tolerance
    )


def _tolerance(stated: Mapping[str, Any], steps: Steps) -> float:
    """None for the same versions."""
    made = {"posstats": stated["posstats_version"], **stated["versions"]}
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
