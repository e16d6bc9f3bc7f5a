"""How a reader verifies the document."""

from ..document.content import Paragraph, Part, filled
from ..document.table import text_column
from .material import Material, file_table, led, section

VERIFY = ("signature", "command", "attachments", "inputs", "recompute")


def verify(material: Material) -> Part:
    """What to do, and the files that the document holds."""
    words, listed = material.words, material.acceptance.attachments
    kinds = text_column(
        words.text("column.relationship"),
        [words.of("relationship", each.relationship) for each in listed],
    )
    content = (
        Paragraph(words.text("verify.intro", id=material.acceptance.document_id)),
        *led(words, "verify", VERIFY),
        *filled([file_table(words, "attachments", listed, kinds)]),
    )
    return section(words, "verify", content)
