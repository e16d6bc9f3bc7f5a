"""`posstats profiles`: the profiles that come with posstats, or one of them with its sources."""

from collections.abc import Iterator
from textwrap import wrap

from posstats.acceptance.profile import Profile, Requirement
from posstats.acceptance.profile_files import load_profile, profile_names

_WIDTH = 100
_UNITS = {"m": " (m)", "px": " (px)", "1": ""}


def list_profiles() -> Iterator[str]:
    """Yield a line for every profile: name, edition, title."""
    profiles = [load_profile(name) for name in profile_names()]
    name_width = max(len(each.name) for each in profiles)
    edition_width = max(len(each.edition) for each in profiles)
    for each in profiles:
        yield f"{each.name:{name_width}}  {each.edition:{edition_width}}  {each.title}"


def describe_profile(name: str) -> Iterator[str]:
    """Yield what a profile, or a contract file, demands: limits, sources, notes, statements.

    Raises
    ------
    PosstatsError
        If there is no such profile or file, or it cannot be accepted.
    """
    profile = load_profile(name)
    yield from _heading(profile)
    yield ""
    yield "requirements"
    for requirement in profile.requirements:
        yield from _requirement(requirement)
    yield from _titled("notes", profile.notes)
    for statement in profile.statements:
        title = f"statement, {statement.component} ({statement.language})"
        if statement.withheld_by:
            title += f", withheld: the contract changes {', '.join(statement.withheld_by)}"
        texts = (statement.tested, statement.tested_with_fewer, statement.produced)
        yield from _titled(title, [text for text in texts if text])


def _heading(profile: Profile) -> Iterator[str]:
    rows = {
        "title": profile.title,
        "edition": profile.edition,
        "source": profile.source,
        "files": ", ".join(file.name for file in profile.files),
        "needs of the product": "; ".join(" or ".join(names) for names in profile.needs),
        "map scales": ", ".join(f"1:{scale}" for scale in profile.scales),
        "changed": ", ".join(profile.changed),
        "added": ", ".join(profile.added),
        "omitted": ", ".join(profile.omitted),
    }
    yield profile.name
    for label, text in rows.items():
        if text:
            yield from _wrapped(f"{label}: {text}", "  ")


def _requirement(requirement: Requirement) -> Iterator[str]:
    clause = f" [{requirement.clause}]" if requirement.clause else ""
    demand = "; ".join([_limit(requirement), *_conditions(requirement)])
    yield from _wrapped(f"{requirement.id}{clause}: {demand}", "  ")
    yield from _wrapped(f"source: {requirement.source}", "      ")


def _limit(requirement: Requirement) -> str:
    """``n_blunders_h beyond 3 * class_h (m) at most 0``."""
    measured = requirement.measured
    beyond = "" if requirement.threshold is None else f" beyond {requirement.threshold.text} (m)"
    limit = f"{requirement.limit.text}{_UNITS[measured.unit]}"
    return f"{requirement.quantity}{beyond} {measured.sense} {limit}"


def _conditions(requirement: Requirement) -> Iterator[str]:
    if requirement.when_given is not None:
        yield f"if the product states {requirement.when_given}"
    if requirement.terrain is not None:
        yield f"{requirement.terrain} terrain only"
    if requirement.exceeding == "investigate":
        yield "otherwise to be investigated"
    if not requirement.mandatory:
        yield "not mandatory"
    if requirement.basis_of_score:
        yield "enters the score"


def _titled(title: str, texts: tuple[str, ...] | list[str]) -> Iterator[str]:
    if texts:
        yield ""
        yield title
    for text in texts:
        yield from _wrapped(f"- {text}", "  ")


def _wrapped(text: str, indent: str) -> list[str]:
    return wrap(
        text,
        _WIDTH,
        initial_indent=indent,
        subsequent_indent=f"{indent}    ",
        break_long_words=False,
        break_on_hyphens=False,
    )
