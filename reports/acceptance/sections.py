"""Sections of the acceptance document: what it says around its tables and figures."""

from collections.abc import Iterable, Mapping
from typing import Any

from posstats.contract.notice import Notice

from ..block.view import Results, rows
from ..document import format as fmt
from ..document.content import Bullets, Content, Paragraph, Part, filled, known
from ..document.drawing import Drawing
from . import evidence, tables
from .words import Words, is_borderline

FEW_POINTS = 30
SIGNIFICANT = 0.05
METHOD = ("intersection", "rmse", "product", "intervals", "percentiles", "tests", "parallax",
          "regression", "verdict", "orientation")  # fmt: skip
VERIFY = ("signature", "command", "attachments", "inputs", "recompute")

Drawings = Mapping[str, Drawing]


def parts(
    words: Words, acceptance: Mapping[str, Any], results: Results, drawings: Drawings, unshown: str
) -> tuple[Part, ...]:
    """All sections in the order of reading.

    Parameters
    ----------
    words
        Of the document.
    acceptance, results
        The dictionaries of ``acceptance.json`` and ``results.json``.
    drawings
        The figures by name.
    unshown
        Characters that no typeface at hand can show.
    """
    return (
        _requirements(words, acceptance, drawings),
        _accuracy(words, acceptance, drawings),
        _check_points(words, acceptance, drawings),
        _parallax(words, acceptance, results, drawings),
        _regression(words, results, drawings),
        _method(words),
        _limits(words, acceptance, results, unshown),
        _inputs(words, acceptance, results),
        _verify(words, acceptance),
    )


def _requirements(words: Words, acceptance: Mapping[str, Any], drawings: Drawings) -> Part:
    content: list[Content] = [Paragraph(words.text("requirements.intro"))]
    content += filled([tables.requirements(words, acceptance)])
    content += filled([tables.evidence_and_sources(words, acceptance)])
    content += known(drawings.get("shares"))
    if acceptance.get("quality_grade"):
        grade = acceptance["quality_grade"]
        named = words.of("grade", grade["grade"])
        content.append(Paragraph(words.text("requirements.grade", grade=named,
                                            score=fmt.fixed(grade["score"], 1))))  # fmt: skip
    if acceptance["profile"]["omitted"]:
        omitted = words.catalogue.joined(acceptance["profile"]["omitted"])
        content.append(Paragraph(words.text("requirements.omitted", ids=omitted)))
    content += filled([tables.product_and_contract(words, acceptance)])
    return _part(words, "requirements", content)


def _accuracy(words: Words, acceptance: Mapping[str, Any], drawings: Drawings) -> Part:
    accuracy = acceptance["accuracy"]
    if not accuracy["n"]:
        return _part(words, "accuracy", [Paragraph(words.text("accuracy.none"))])
    content: list[Content] = [Paragraph(_accuracy_intro(words, accuracy))]
    content += filled([tables.rmse(words, acceptance), tables.mean_errors(words, acceptance)])
    content += filled([tables.percentiles(words, acceptance)])
    content += known(drawings.get("histograms"))
    content += filled([tables.significance(words, acceptance)])
    return _part(words, "accuracy", content)


def _accuracy_intro(words: Words, accuracy: Mapping[str, Any]) -> str:
    n, given = accuracy["n"], accuracy["n_given"]
    said = [words.counted("accuracy.intro", n, given=fmt.count(given))]
    if n < given:
        said.append(words.counted("accuracy.missing", given - n))
    if accuracy["survey_known"]:
        said.append(words.text("accuracy.survey", h=words.unit.text(accuracy["survey_h_m"]),
                               v=words.unit.text(accuracy["survey_v_m"])))  # fmt: skip
    else:
        said.append(words.text("accuracy.survey_unknown"))
    return words.text("sentence.between").join(said)


def _check_points(words: Words, acceptance: Mapping[str, Any], drawings: Drawings) -> Part:
    points = acceptance["check_points"]
    if not points:
        return _part(words, "check_points", [Paragraph(words.text("check_points.none"))])
    said = [words.text("check_points.intro", orientation=words.orientation(
        acceptance["orientation"]))]  # fmt: skip
    blunders = [point["point"] for point in points if point["blunder"]]
    if blunders:
        said.append(words.counted("check_points.blunders", len(blunders),
                                  names=words.catalogue.joined(blunders)))  # fmt: skip
    text = Paragraph(words.text("sentence.between").join(said))
    content: list[Content] = [text, evidence.check_points(words, acceptance)]
    content += known(drawings.get("point_plan"))
    return _part(words, "check_points", content)


def _parallax(
    words: Words, acceptance: Mapping[str, Any], results: Results, drawings: Drawings
) -> Part:
    if not rows(results, "models"):
        return _part(words, "parallax", [Paragraph(words.text("parallax.none"))])
    table = evidence.parallax_by_strip(words, results, acceptance["orientation"])
    content: list[Content] = [Paragraph(words.text("parallax.intro")), *filled([table])]
    content += known(drawings.get("parallax_by_strip"))
    return _part(words, "parallax", content)


def _regression(words: Words, results: Results, drawings: Drawings) -> Part:
    found = filled([evidence.regression(words, results), evidence.decisions(words, results)])
    text = "regression.intro" if found else "regression.none"
    pictures = known(drawings.get("regression_by_angle"))
    return _part(words, "regression", (Paragraph(words.text(text)), *pictures, *found))


def _method(words: Words) -> Part:
    return _part(words, "method", _led(words, "method", METHOD))


def _led(words: Words, family: str, names: Iterable[str]) -> list[Content]:
    """Paragraphs with a word before each that says what it is about."""
    return [Paragraph(words.of(family, name), words.of(f"{family}_lead", name)) for name in names]


def _limits(words: Words, acceptance: Mapping[str, Any], results: Results, unshown: str) -> Part:
    content: list[Content] = [
        Paragraph(words.text("limits.intro")),
        Bullets(tuple(_limits_list(words, acceptance, unshown))),
        *filled([evidence.observability(words, results)]),
    ]
    told = {
        "notes": acceptance["profile"]["notes"],
        "warnings": _warnings(words, results),
    }
    for name, texts in told.items():
        if texts:
            listed = Bullets(tuple(dict.fromkeys(map(str, texts))))
            content += [Paragraph(words.text(f"limits.{name}")), listed]
    return _part(words, "limits", content)


def _warnings(words: Words, results: Results) -> list[str]:
    """The notices of the analysis; of an earlier version's file, its sentences."""
    said = results.get("notices")
    if said is None:
        return list(results.get("warnings") or ())
    return [words.notice(Notice(code=each["code"], values=each["values"])) for each in said]


def _limits_list(words: Words, acceptance: Mapping[str, Any], unshown: str) -> list[str]:
    accuracy = acceptance["accuracy"]
    said = [words.text("limits.simulated")] if acceptance["block"]["simulated"] else []
    said += [words.text("limits.scope"), words.text("limits.shift"), words.text("limits.roll")]
    if 0 < accuracy["n"] < FEW_POINTS:
        said.append(words.counted("limits.few", accuracy["n"], enough=fmt.count(FEW_POINTS)))
    if accuracy["n"] and not accuracy["survey_known"]:
        said.append(words.text("limits.survey"))
    names = words.requirements(acceptance["requirements"])
    near = [n for n, r in zip(names, acceptance["requirements"], strict=True) if is_borderline(r)]
    if near:
        said.append(words.counted("limits.borderline", len(near), names=words.listed(near)))
    p = accuracy["mean_shift"]["p"]
    if p is not None and p < SIGNIFICANT:
        said.append(words.text("limits.mean_shift", p=fmt.p_phrase(p)))
    if any((row["p"] or 1.0) < SIGNIFICANT for row in accuracy["normality"]):
        said.append(words.text("limits.normality"))
    if unshown:
        said.append(words.text("limits.characters", characters=_code_points(unshown)))
    return said


def _code_points(letters: str, most: int = 12) -> str:
    named = [f"U+{ord(letter):04X}" for letter in letters]
    return ", ".join(named[:most]) + (" …" if len(named) > most else "")


def _inputs(words: Words, acceptance: Mapping[str, Any], results: Results) -> Part:
    block = acceptance["block"]
    listed = [
        tables.files(words, "inputs", [*(block.get("inputs") or ()), acceptance["results"]]),
        tables.files(words, "rules", acceptance["profile"]["files"]),
        tables.settings(words, results),
        tables.software(words, acceptance),
    ]
    return _part(words, "inputs", (Paragraph(words.text("inputs.intro")), *filled(listed)))


def _verify(words: Words, acceptance: Mapping[str, Any]) -> Part:
    content = (
        Paragraph(words.text("verify.intro", id=str(acceptance["document_id"]))),
        *_led(words, "verify", VERIFY),
        *filled([tables.files(words, "attachments", acceptance["attachments"])]),
    )
    return _part(words, "verify", content)


def _part(words: Words, name: str, content: Iterable[Content]) -> Part:
    return Part(name.replace("_", "-"), words.text(f"section.{name}"), tuple(content))
