"""The acceptance document: its front, and its topics in the order of reading."""

from posstats.contract.acceptance import Acceptance
from posstats.contract.results import Results

from ..block.view import strips_with_models
from ..document.numbering import ReportDocument, assembled
from ..figures import style
from ..typefaces import cjk
from . import words as wording
from .accuracy import accuracy
from .check_points import check_points
from .front import front
from .inputs import inputs
from .limits import limits
from .material import Material, Topic
from .method import method
from .parallax import parallax
from .regression import regression
from .requirements import requirements
from .verify import verify

TOPICS: tuple[Topic, ...] = (
    requirements,
    accuracy,
    check_points,
    parallax,
    regression,
    method,
    limits,
    inputs,
    verify,
)


def build(acceptance: Acceptance, results: Results, unshown: str = "") -> ReportDocument:
    """Make the document.

    Parameters
    ----------
    unshown
        Characters that no typeface at hand can show.
    """
    words = wording.words_of(acceptance)
    material = Material(words, acceptance, results, unshown)
    with style.style(_families(acceptance, results)):
        parts = [topic(material) for topic in TOPICS]
    return assembled(front(words, acceptance), (), parts)


def _families(acceptance: Acceptance, results: Results) -> tuple[str, ...]:
    """Typefaces of figures, for the words of the language and the strips' names."""
    named = "".join(strips_with_models(results))
    return cjk.figure_families(named + ("中" if acceptance.language == "zh" else ""))
