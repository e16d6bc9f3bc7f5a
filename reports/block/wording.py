"""What the results say in words, for people who open ``results.json`` itself."""

from dataclasses import replace
from functools import cache

from posstats.contract.notice import Notice
from posstats.contract.results import Results

from ..document.catalogue import catalogue
from ..document.words import Words


def with_words(results: Results) -> Results:
    """The results with English words beside their codes: reasons, open rotations, warnings."""
    words = _english()
    settings = results.settings
    return replace(
        results,
        settings=replace(settings, frame_reason=_reason(settings.frame_notice)),
        regression=tuple(replace(row, reason=_reason(row.notice)) for row in results.regression),
        selection=tuple(
            replace(row, reason=_reason(*row.notices) or "") for row in results.selection
        ),
        observability=tuple(
            replace(row, unobservable=tuple(words.of("rotation", each) for each in row.rotations))
            for row in results.observability
        ),
        warnings=warnings(results.notices),
    )


def warnings(notices: tuple[Notice, ...]) -> tuple[str, ...]:
    """Notices as English sentences, with numbers as Python prints them."""
    return tuple(_english().notice(each, plain=True) for each in notices)


def _reason(*notices: Notice | None) -> str | None:
    """The notices as clauses of a sentence; None without any."""
    said = _english().reason((each for each in notices if each is not None), plain=True)
    return said.replace("R²", "R2") or None  # spelt so since the first version of the file


@cache
def _english() -> Words:
    return Words(catalogue("en", "document", "notices"))
