"""Profiles and contracts on disk: found, read with all that they extend, checked as a whole."""

from collections.abc import Sequence
from functools import lru_cache
from importlib.resources import files
from importlib.resources.abc import Traversable
from pathlib import Path

from posstats.acceptance.profile import Contract, Profile, ProfileFile
from posstats.acceptance.profile_merging import merged
from posstats.acceptance.profile_reading import open_profile, read_content
from posstats.errors import BlockFormatError, PosstatsError
from posstats.formats.hints import nearest, shown

_MAX_BYTES = 100_000
_MAX_FILES = 10


class ProfileFormatError(BlockFormatError):
    """Profile or contract files that cannot be accepted; `findings` has a sentence per fault."""


def profile_names() -> tuple[str, ...]:
    """Names of the profiles that come with posstats, sorted."""
    names = (Path(entry.name) for entry in _folder().iterdir())
    return tuple(sorted(name.stem for name in names if name.suffix == ".toml"))


def load_profile(name_or_path: str | Path) -> Profile:
    """A profile that comes with posstats (``asprs-2024``), or of a TOML file.

    What the file says of contract and product is read by `load_contract`.

    Raises
    ------
    ProfileFormatError
        As for `load_contract`, and if the files have no requirement.
    PosstatsError
        If there is no such profile or file.
    """
    profile, _ = load_contract(name_or_path)
    if profile is None:
        name = Path(name_or_path).name
        raise ProfileFormatError([f"{name}: found no requirement, expected [[requirement]]"])
    return profile


def load_contract(
    name_or_path: str | Path, base: str | Path | None = None
) -> tuple[Profile | None, Contract]:
    """Requirements, parties and product of a contract file, with all that it extends.

    Parameters
    ----------
    base
        Profile that the file extends if it does not say so itself (the user's ``--profile``).

    Returns
    -------
    Profile, or None if neither the file nor what it extends has a requirement; and contract.

    Raises
    ------
    ProfileFormatError
        With every finding, each with file and line where known: unknown keys (with the nearest
        known one), values of the wrong type or size, formulas that are none, repeated and
        missing ids, files that extend each other or are not there, a `base` other than what the
        file extends.
    PosstatsError
        If there is no such profile or file.
    """
    return profile_of_files(_chain(name_or_path, base))


def profile_of_files(read: Sequence[ProfileFile]) -> tuple[Profile | None, Contract]:
    """Profile and contract of files that were read before: the contract first.

    Each file extends the next one, whatever its `extends` says: so that a document can be judged
    again from what is embedded in it.

    Raises
    ------
    ProfileFormatError
        As for `load_contract`.
    """
    contents = [read_content(file) for file in read]
    profile, contract = merged(contents)
    findings = [finding for content in contents for finding in content.findings]
    if findings:
        raise ProfileFormatError(findings)
    return profile, contract


def _chain(name_or_path: str | Path, base: str | Path | None) -> tuple[ProfileFile, ...]:
    """The named file and all that it extends, from contract to standard."""
    place: Traversable | None = _asked_for(name_or_path)
    chain: list[ProfileFile] = []
    places: list[str] = []
    while place is not None:
        places.append(_identity(place))
        chain.append(_read(place, chain))
        place = _extended(chain[-1], place, places)
        if place is None and base is not None:
            place, base = _base(base, places), None
        if len(chain) > _MAX_FILES:
            raise ProfileFormatError([f"{chain[0].name}: extends more than {_MAX_FILES} files"])
    return tuple(chain)


def _asked_for(name_or_path: str | Path) -> Traversable:
    """The profile or file that the caller named."""
    name = str(name_or_path)
    place = _located(name, Path())
    if place is None:
        known = nearest(name, profile_names())
        raise PosstatsError(f"no profile file {shown(name)}, and no profile of that name{known}")
    return place


def _base(base: str | Path, places: Sequence[str]) -> Traversable | None:
    """The profile to extend; None if the files extend it already."""
    place = _asked_for(base)
    if _identity(place) in places:
        return None
    if len(places) > 1:
        names = " -> ".join(Path(each).name for each in places)
        raise ProfileFormatError(
            [f"{names}: extends another profile than {base}, which was asked for"]
        )
    return place


def _extended(file: ProfileFile, place: Traversable, places: Sequence[str]) -> Traversable | None:
    """The file that a file extends."""
    document = open_profile(file)
    if document.findings:
        raise ProfileFormatError(document.findings)
    name = document.values.get("extends")
    if not isinstance(name, str) or not name.strip():
        return None  # of another type: refused when the file is read
    folder = place.parent if isinstance(place, Path) else Path()
    extended = _located(name, folder)
    if extended is None:
        known = nearest(name, profile_names())
        document.refuse(("extends",), f"found no file {shown(name)} and no profile{known}")
    elif _identity(extended) in places:
        names = " -> ".join(Path(each).name for each in [*places, _identity(extended)])
        document.refuse(("extends",), f"found a circle: {names}")
    if document.findings:
        raise ProfileFormatError(document.findings)
    return extended


def _folder() -> Traversable:
    return files("posstats") / "acceptance" / "profiles"


@lru_cache(maxsize=1)
def _shipped() -> dict[str, Traversable]:
    return {name: _folder() / f"{name}.toml" for name in profile_names()}


def _located(name: str, folder: Path) -> Traversable | None:
    """A profile of ours by its name, or a file or folder; None if there is neither."""
    if name in _shipped():
        return _shipped()[name]
    path = folder / name
    try:
        return path if name.strip() and path.exists() else None
    except (OSError, ValueError):  # a name that is too long, or holds a null character
        return None


def _identity(place: Traversable) -> str:
    return str(place.resolve()) if isinstance(place, Path) else str(place)


def _read(place: Traversable, chain: Sequence[ProfileFile]) -> ProfileFile:
    """Content of a regular file of modest size; its name made unique in the chain."""
    name = _unique(place.name, [file.name for file in chain])
    if place.is_dir():
        raise ProfileFormatError([f"{name}: found a folder, expected a TOML file"])
    if not place.is_file():
        raise ProfileFormatError([f"{name}: found a device or pipe, expected a TOML file"])
    try:
        with place.open("rb") as file:
            content = file.read(_MAX_BYTES + 1)
    except OSError as error:
        raise ProfileFormatError([f"{name}: cannot be read ({error.strerror})"]) from error
    if len(content) > _MAX_BYTES:
        raise ProfileFormatError([f"{name}: found more than {_MAX_BYTES} bytes, expected fewer"])
    return ProfileFile(name, content)


def _unique(name: str, taken: Sequence[str]) -> str:
    """A file name that is not taken: ``base-2.toml`` beside ``base.toml``."""
    path, number, candidate = Path(name), 2, name
    while candidate in taken:
        candidate, number = f"{path.stem}-{number}{path.suffix}", number + 1
    return candidate
