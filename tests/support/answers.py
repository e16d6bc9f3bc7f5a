"""Questions and failing answers of a verification, and documents that were changed."""

import io
from dataclasses import replace

import pikepdf
from archive_documents import (
    STEPS,
)

from posstats.reports.verification import words
from posstats.reports.verification.words import Answer, Standing

INTACT = words.intact_question("the signature")


IN_FORCE = words.certificate_question("the signature")


TRUSTED = words.trust_question("the signature")


OTHER = replace(STEPS, layout="posstats 9, WeasyPrint 99", numbers={"posstats": "9"})


def failures(answers: dict[str, Answer]) -> dict[str, str]:
    return {q: each.text for q, each in answers.items() if each.standing is Standing.FAIL}


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
