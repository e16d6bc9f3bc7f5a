"""What the verdict does not say."""

from collections.abc import Iterator

from posstats.contract.acceptance import Acceptance, Accuracy
from posstats.contract.results import Results

from ..document import format as fmt
from ..document.content import Bullets, Content, Paragraph, Part, filled
from ..document.table import Table, count_column, prose_column
from .material import Material, scope_name, section
from .words import Words, is_borderline

FEW_POINTS = 30
SIGNIFICANT = 0.05
NAMED_CHARACTERS = 12


def limits(material: Material) -> Part:
    """Limits of the method and of these data, notes of the profile, warnings of the analysis."""
    words, acceptance = material.words, material.acceptance
    content: list[Content] = [
        Paragraph(words.text("limits.intro")),
        Bullets(tuple(_limits(material))),
        *filled([observability_table(words, material.results)]),
    ]
    told = {"notes": acceptance.profile.notes, "warnings": _warnings(words, material.results)}
    for name, texts in told.items():
        if texts:
            listed = Bullets(tuple(dict.fromkeys(texts)))
            content += [Paragraph(words.text(f"limits.{name}")), listed]
    return section(words, "limits", content)


def _warnings(words: Words, results: Results) -> tuple[str, ...]:
    """The notices of the analysis; of an earlier version's file, its sentences."""
    return tuple(map(words.notice, results.notices)) or results.warnings


def observability_table(words: Words, results: Results) -> Table:
    """What the tie points leave open; scopes of which the same is to be said share a row."""
    scopes: dict[tuple[str, int], list[str]] = {}
    for row in results.observability:
        open_rotations = row.rotations or row.unobservable  # an earlier file has words only
        if open_rotations:
            motions = words.joined(words.known("rotation", each) for each in open_rotations)
            named = scopes.setdefault((motions, len(row.images)), [])
            named.append(scope_name(words, row.scope))
    columns = (
        prose_column(words.text("column.scope"), map(words.joined, scopes.values())),
        prose_column(words.text("column.unobservable"), [motions for motions, _ in scopes]),
        count_column(words.text("column.images_open"), [n for _, n in scopes]),
    )
    return Table("observability", words.text("table.observability"), columns)


def _limits(material: Material) -> Iterator[str]:
    words, acceptance = material.words, material.acceptance
    if acceptance.block.simulated:
        yield words.text("limits.simulated")
    yield words.text("limits.scope")
    yield words.text("limits.shift")
    yield words.text("limits.roll")
    yield from _of_points(words, acceptance.accuracy)
    yield from _of_requirements(words, acceptance)
    yield from _of_tests(words, acceptance.accuracy)
    if material.unshown:
        yield words.text("limits.characters", characters=_code_points(words, material.unshown))


def _of_points(words: Words, accuracy: Accuracy) -> Iterator[str]:
    if 0 < accuracy.n < FEW_POINTS:
        yield words.counted("limits.few", accuracy.n, enough=fmt.count(FEW_POINTS))
    if accuracy.n and not accuracy.survey_known:
        yield words.text("limits.survey")


def _of_requirements(words: Words, acceptance: Acceptance) -> Iterator[str]:
    rows = acceptance.requirements
    named = zip(words.requirements(rows), rows, strict=True)
    near = [name for name, row in named if is_borderline(row)]
    if near:
        yield words.counted("limits.borderline", len(near), names=words.listed(near))


def _of_tests(words: Words, accuracy: Accuracy) -> Iterator[str]:
    p = accuracy.mean_shift.p
    if p is not None and p < SIGNIFICANT:
        yield words.text("limits.mean_shift", p=fmt.p_phrase(p))
    if any(row.p is not None and row.p < SIGNIFICANT for row in accuracy.normality):
        yield words.text("limits.normality")


def _code_points(words: Words, letters: str) -> str:
    named = [f"U+{ord(letter):04X}" for letter in letters]
    more = " …" if len(named) > NAMED_CHARACTERS else ""
    return words.text("list.between").join(named[:NAMED_CHARACTERS]) + more
