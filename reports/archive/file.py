"""The bytes of a document for the archive: read with care, parted into its revisions.

An incremental update appends a revision to a PDF and leaves the bytes before it alone; that is how
a signature gets into a document.
"""

import re
import stat
from dataclasses import dataclass
from pathlib import Path

from posstats.errors import PosstatsError

LARGEST_BYTES = 200_000_000

_END = re.compile(rb"startxref\s{1,2}(\d{1,10})\s{1,2}%%EOF(?:\r\n|\r|\n)?")
_PREVIOUS = re.compile(rb"/Prev\s+(\d{1,10})")


class UnreadableArchiveError(PosstatsError):
    """A file that is no document of `posstats accept`, or no longer."""


@dataclass(frozen=True)
class ArchiveFile:
    """A PDF as bytes.

    Attributes
    ----------
    ends
        Where each revision ends; the last is the size of the file.
    """

    data: bytes
    ends: tuple[int, ...]

    @property
    def first(self) -> bytes:
        """The document as it was first written."""
        return self.data[: self.ends[0]]


def read_file(path: Path) -> bytes:
    """The bytes of a regular file of an acceptable size; nothing else is opened.

    Raises
    ------
    UnreadableArchiveError
        For a folder or device, a file too large, an empty one.
    OSError
        If there is no such file, or it cannot be read.
    """
    state = path.stat()
    if not stat.S_ISREG(state.st_mode):
        raise UnreadableArchiveError(f"{path} is no file")
    if state.st_size > LARGEST_BYTES:
        raise UnreadableArchiveError(
            f"{path} has {state.st_size / 1e6:.0f} MB: more than {LARGEST_BYTES / 1e6:.0f} MB are"
            " not read"
        )
    with path.open("rb") as stream:
        return stream.read(LARGEST_BYTES)


def part(data: bytes) -> ArchiveFile:
    """Find the revisions of a PDF.

    Raises
    ------
    UnreadableArchiveError
        If it does not begin or end as a PDF, or its cross-reference tables are not those that
        posstats and signatures write.
    """
    if not data.startswith(b"%PDF-"):
        raise UnreadableArchiveError("it is no PDF: it does not begin with %PDF-")
    *_, last = (None, *_END.finditer(data, max(0, len(data) - 64)))
    if last is None or last.end() != len(data):
        raise UnreadableArchiveError(
            "it does not end as a PDF ends: it was cut off, or bytes were put behind its end"
        )
    return ArchiveFile(data, tuple(_revision_end(data, at) for at in _tables(data, int(last[1]))))


def _tables(data: bytes, last: int) -> list[int]:
    """Offsets of the cross-reference tables, oldest first; each names the one before it."""
    offsets = [last]
    while True:
        offset = offsets[-1]
        if data[offset : offset + 4] != b"xref":
            raise UnreadableArchiveError(
                f"its cross-reference table is not at byte {offset}, where it says: it is damaged,"
                " or another program wrote it"
            )
        trailer = data.find(b"trailer", offset)
        previous = _PREVIOUS.search(data, trailer, data.find(b"startxref", trailer))
        if previous is None:
            return offsets[::-1]
        if int(previous[1]) >= offset:
            raise UnreadableArchiveError("its cross-reference tables lead in a circle")
        offsets.append(int(previous[1]))


def _revision_end(data: bytes, offset: int) -> int:
    end = _END.search(data, offset)
    if end is None or int(end[1]) != offset:
        raise UnreadableArchiveError(f"the cross-reference table at byte {offset} has no end")
    return end.end()
