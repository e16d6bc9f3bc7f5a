"""How the numbers of the document are computed."""

from ..document.content import Part
from .material import Material, led, section

METHOD = ("intersection", "rmse", "product", "intervals", "percentiles", "tests", "parallax",
          "regression", "verdict", "orientation")  # fmt: skip


def method(material: Material) -> Part:
    """A paragraph a method."""
    return section(material.words, "method", led(material.words, "method", METHOD))
