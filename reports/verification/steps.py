"""What verification needs of the rest of the package to do the work again."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

from posstats.contract.acceptance import Acceptance
from posstats.contract.results import Results


@dataclass(frozen=True)
class Steps:
    """The steps from a block folder to the page of a document, each a pure function.

    Attributes
    ----------
    recompute
        (block folder, results as a pattern: settings and inputs) -> results.
    reassess
        (results, profile files by name, acceptance as a pattern) -> acceptance.
    render_document
        (acceptance, results, user templates by name) -> HTML.
    numbers
        Versions that numbers depend on: posstats, Python and the main libraries.
    layout
        Versions that the pages depend on, as `made_with` reads them from a document.
    """

    recompute: Callable[[Path, Results], Results]
    reassess: Callable[[Results, Mapping[str, bytes], Acceptance], Acceptance]
    render_document: Callable[[Acceptance, Results, Mapping[str, bytes]], str]
    numbers: Mapping[str, str]
    layout: str
