"""Output folders that are never half-written."""

import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from posstats.errors import PosstatsError


@contextmanager
def staged_folder(target: Path) -> Iterator[Path]:
    """A temporary folder beside or in `target`, whose files are moved there on success.

    Files of the same names are replaced, others are left alone. When the body fails or is
    interrupted nothing of it remains, and `target` is as it was.

    Raises
    ------
    PosstatsError
        If the target is a file, or cannot be written.
    """
    if target.exists() and not target.is_dir():
        raise PosstatsError(f"{target} is a file, not a folder to write into")
    existing = _nearest_existing(target)
    try:
        stage = Path(tempfile.mkdtemp(prefix=".posstats-", dir=existing))
    except OSError as error:
        raise PosstatsError(f"cannot write into {existing}: {error.strerror}") from error
    try:
        yield stage
        _move_files(stage, target)
    finally:
        shutil.rmtree(stage, ignore_errors=True)


def _nearest_existing(folder: Path) -> Path:
    """The folder itself or its first existing ancestor: the same file system as the target."""
    folder = folder.absolute()
    while not folder.is_dir():
        folder = folder.parent
    return folder


def _move_files(stage: Path, target: Path) -> None:
    for source in sorted(path for path in stage.rglob("*") if path.is_file()):
        destination = target / source.relative_to(stage)
        destination.parent.mkdir(parents=True, exist_ok=True)
        source.replace(destination)
