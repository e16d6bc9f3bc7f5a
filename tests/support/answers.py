"""Questions and failing answers of a verification, and documents that were changed."""

import io
from dataclasses import replace

import pikepdf
from archive_documents import STEPS

from posstats.contract.notice import Notice
from posstats.reports.verification.answers import Answer, Question, Standing

INTACT = Question("intact")
IN_FORCE = Question("in_force")
TRUSTED = Question("signer_trusted")
OTHER = replace(STEPS, layout="posstats 9, WeasyPrint 99", numbers={"posstats": "9"})


def failures(answers: dict[Question, Answer]) -> dict[Question, tuple[Notice, ...]]:
    return {q: each.said for q, each in answers.items() if each.standing is Standing.FAIL}


def codes(said: tuple[Notice, ...]) -> set[str]:
    return {each.code for each in said}


def reason(said: tuple[Notice, ...]) -> str:
    """What an error says that is the only part of an answer."""
    (only,) = said
    return str(only.values["reason"])


def changed(data: bytes, at: int) -> bytes:
    return data[:at] + bytes([data[at] ^ 1]) + data[at + 1 :]


def rewritten(data: bytes, name: str, edit) -> bytes:
    """A file replaced, the whole PDF written again with a right cross-reference table."""
    pdf = pikepdf.open(io.BytesIO(data))
    for each in pikepdf.NameTree(pdf.Root.Names.EmbeddedFiles).values():
        if str(each.UF) == name:
            each.EF.F.write(edit(each.EF.F.read_bytes()))
    out = io.BytesIO()
    pdf.save(out)
    return out.getvalue()
