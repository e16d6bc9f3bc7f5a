"""`posstats sign`: from an acceptance document to a signed copy of it."""

import datetime as dt
import os
import tempfile
from collections.abc import Callable
from pathlib import Path

from posstats.errors import PosstatsError

from ..archive.file import UnreadableArchiveError, part, read_file
from ..archive.reading import open_archive
from ..archive.signing import require_pyhanko, sign

LARGEST_KEY_BYTES = 1_000_000


def sign_file(
    path: Path,
    key: Path,
    out: Path,
    passphrase_file: Path | None,
    ask: Callable[[], str],
    *,
    now: dt.datetime,
) -> str:
    """Sign `path` into `out`.

    Parameters
    ----------
    ask
        Asks for the passphrase; called last, when all else is in order.
    now
        The time that the signature states.

    Returns
    -------
    str
        The id of the document.

    Raises
    ------
    PosstatsError
        If there is nothing to sign, no key to sign with, or `out` is not free to be written.
    """
    require_pyhanko()
    _require_other_file(path, out)
    data = read_file(path)
    document_id = _document_id(path, data)
    key_file = _small_file(key)
    passphrase = ask() if passphrase_file is None else _first_line(passphrase_file)
    signed = sign(data, key_file, passphrase.encode(), now=now)
    _write(out, signed)
    return document_id


def _document_id(path: Path, data: bytes) -> str:
    try:
        return open_archive(part(data)).acceptance.document_id
    except UnreadableArchiveError as error:
        raise UnreadableArchiveError(f"{path} is not signed: {error}") from error


def _require_other_file(path: Path, out: Path) -> None:
    if out.is_dir():
        raise PosstatsError(f"{out} is a folder, not a file to write")
    if out.exists() and path.exists() and os.path.samefile(path, out):
        raise PosstatsError(f"{out} is the document itself, which is left alone: give another name")


def _small_file(path: Path) -> bytes:
    if not path.is_file():
        raise PosstatsError(f"{path} is no file")
    if path.stat().st_size > LARGEST_KEY_BYTES:
        raise PosstatsError(f"{path} is no key file: it is too large")
    return path.read_bytes()


def _first_line(path: Path) -> str:
    try:
        text = _small_file(path).decode()
    except UnicodeDecodeError as error:
        raise PosstatsError(f"{path} is no text") from error
    return text.partition("\n")[0].rstrip("\r")


def _write(out: Path, data: bytes) -> None:
    """All of it or nothing; a link is replaced, never followed."""
    handle, name = tempfile.mkstemp(prefix=".posstats-", dir=out.absolute().parent)
    stage = Path(name)
    try:
        with os.fdopen(handle, "wb") as stream:
            stream.write(data)
        umask = os.umask(0)
        os.umask(umask)
        stage.chmod(0o666 & ~umask)
        stage.replace(out)
    finally:
        stage.unlink(missing_ok=True)
