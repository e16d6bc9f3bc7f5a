"""Output folders that are never half-written."""

import shutil
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from posstats.errors import PosstatsError


@contextmanager
def staged_folder(target: Path, replaced: Sequence[str] = ()) -> Iterator[Path]:
    """A temporary folder beside or in `target`, whose files are moved there on success.

    Files of the same names are replaced, those named in `replaced` (of an earlier run) are removed
    if they are not written again, others are left alone. When the body fails or is
    interrupted nothing of it remains, and `target` is as it was.

    Raises
    ------
    PosstatsError
        If the target is a file, or cannot be written.
    """
    existing = _nearest_existing(target)
    try:
        stage = Path(tempfile.mkdtemp(prefix=".posstats-", dir=existing))
    except OSError as error:
        raise PosstatsError(f"cannot write into {existing}: {error.strerror}") from error
    try:
        yield stage
        written = {path.name for path in stage.iterdir()}
        _move_files(stage, target)
        for name in set(replaced) - written:
            (target / name).unlink(missing_ok=True)
    finally:
        shutil.rmtree(stage, ignore_errors=True)


def _nearest_existing(folder: Path) -> Path:
    """The folder itself or its first existing ancestor: the same file system as the target."""
    for existing in (folder.absolute(), *folder.absolute().parents):
        if existing.is_dir():
            return existing
        if existing.exists():
            raise PosstatsError(f"{existing} is a file, not a folder to write into")
    raise PosstatsError(f"{folder} has no folder above it that exists")


def _move_files(stage: Path, target: Path) -> None:
    for source in sorted(path for path in stage.rglob("*") if path.is_file()):
        destination = target / source.relative_to(stage)
        destination.parent.mkdir(parents=True, exist_ok=True)
        source.replace(destination)
