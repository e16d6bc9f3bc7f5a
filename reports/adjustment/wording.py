"""The English sentences of ``adjustment.json``, and of a block that cannot be adjusted."""

from collections.abc import Iterator
from dataclasses import replace

from posstats.adjustment.defects import Defect
from posstats.adjustment.diagnosis import MistakenDataError
from posstats.adjustment.undetermined import UndeterminedBlockError
from posstats.contract.adjustment import AdjustmentResults
from posstats.contract.choices import DEFAULT_LANGUAGE, Language
from posstats.numerics.bundle.parameters import BLOCK, CommonParameter

from .words import Words, words_in

_SHOWN = 6


def with_words(results: AdjustmentResults) -> AdjustmentResults:
    """The results with their reasons, remedies and warnings in English."""
    words = words_in("en")
    return replace(
        results,
        observability=tuple(
            replace(
                each,
                reason=words.notice(each.reason_notice),
                remedy=words.notice(each.remedy_notice),
            )
            for each in results.observability
        ),
        warnings=tuple(words.notice(each, plain=True) for each in results.notices),
    )


def not_determined(error: UndeterminedBlockError, language: Language = DEFAULT_LANGUAGE) -> str:
    """What is open, why, and what would help."""
    words = words_in(language)
    return words.sentences(_not_determined(words, error))


def mistaken(error: MistakenDataError, language: Language = DEFAULT_LANGUAGE) -> str:
    """The mistake because of which measurements contradict each other."""
    words = words_in(language)
    return words.text("defect.mistaken", mistake=words.notice(error.mistake))


def _not_determined(words: Words, error: UndeterminedBlockError) -> Iterator[str]:
    for defect in error.defects:
        reason, remedy = words.notice(defect.reason), words.notice(defect.remedy)
        subject = _subject(words, defect)
        yield words.text("defect.sentence", subject=subject, reason=reason, remedy=remedy)
    for part in error.parts:
        names = words.text("list.between").join(part.names)
        yield words.text("defect.part", names=names, reason=words.notice(part.reason_notice))


def _subject(words: Words, defect: Defect) -> str:
    if defect.parameters:
        called = [_called(words, each) for each in defect.parameters]
        return words.counted(
            "defect.parameters", len(called), names=words.first(called, _SHOWN, sentence=True)
        )
    if not defect.images:
        return words.text("defect.all_images")
    names = words.first(defect.images, _SHOWN, sentence=True)
    return words.counted("defect.images", len(defect.images), names=names)


def _called(words: Words, parameter: CommonParameter) -> str:
    if parameter.scope == BLOCK:
        return parameter.name
    return words.text("defect.of_scope", name=parameter.name, scope=parameter.scope)
