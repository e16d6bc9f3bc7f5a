"""`posstats accept`: from a block or its results to the acceptance document."""

import re
from dataclasses import dataclass
from pathlib import Path

from posstats.acceptance.product import Product
from posstats.acceptance.profile import Contract, Profile
from posstats.acceptance.profile_files import load_contract
from posstats.contract.choices import JudgedOrientation, Language
from posstats.contract.files import from_json, to_json
from posstats.contract.results import Results
from posstats.errors import PosstatsError

from ..acceptance.data import Demand, assembled, embedded
from ..acceptance.summary import summary
from ..acceptance.words import words_of
from ..acceptance.writing import read_templates, write_document
from ..block.wording import with_words
from ..output.progress import Advance, progress_bar
from ..output.staged_folder import staged_folder
from ..output.timestamp import now

BLOCK_TOML = "block.toml"
EXIT_CODES = {"accepted": 0, "rejected": 3, "not assessable": 4}
_LENGTH = re.compile(r"\s*([0-9]*\.?[0-9]+)\s*(mm|cm|m)\s*")
_METRES = {"mm": 1e-3, "cm": 1e-2, "m": 1.0}
_LARGEST_RESULTS = 500_000_000


@dataclass(frozen=True)
class Wish:
    """What a user asks for, as on the command line; None: not given."""

    profile: str | None
    contract: Path | None
    product: Product
    orientation: JudgedOrientation | None
    language: Language
    templates: Path | None


def length_m(text: str) -> float:
    """A length with its unit, in metres: ``10cm``.

    Raises
    ------
    ValueError
        If it is none, or zero.
    """
    match = _LENGTH.fullmatch(text)
    if match is None or float(match[1]) == 0.0:
        raise ValueError(f"{text!r} is no length: write 10cm, 100mm or 0.1m")
    return round(float(match[1]) * _METRES[match[2]], 9)


def judge(source: Path, out: Path, wish: Wish, *, pdf: bool = True) -> tuple[str, list[str]]:
    """Judge a block folder or a results.json, and write the document into `out`.

    Returns
    -------
    The verdict (a key of `EXIT_CODES`), and the lines of the terminal summary.

    Raises
    ------
    PosstatsError
        If profile, contract, product, results or templates cannot be used.
    """
    profile, contract = _profile_and_contract(wish)
    product = contract.product.updated(wish.product)
    demand = Demand(profile, contract, product, wish.orientation, wish.language)
    templates = {} if wish.templates is None else read_templates(wish.templates)
    with staged_folder(out, replaced=("acceptance.pdf",)) as stage, progress_bar("reading") as bar:
        found, text, sources = _results(source, wish.orientation, bar)
        bar("assessment", 0.7)
        sources |= {f"templates/{name}": content for name, content in templates.items()}
        files = embedded(found, text, demand, sources)
        acceptance = assembled(found, demand, files, now())
        bar("writing the document", 0.75)
        missing = write_document(acceptance, found, templates, files, stage, pdf=pdf)
    written = ["acceptance.html"] + (["acceptance.pdf"] if pdf and not missing else [])
    lines = [*summary(acceptance), "", *([missing] if missing else [])]
    paths = ", ".join(str(out / name) for name in written)
    lines.append(words_of(acceptance).text("terminal.document", files=paths))
    return acceptance.verdict, lines


def _profile_and_contract(wish: Wish) -> tuple[Profile, Contract]:
    """Of the contract file, which may extend the profile; or of the profile alone."""
    first = wish.contract or wish.profile
    if first is None:
        raise PosstatsError(
            "give a profile (--profile, see posstats profiles) or a contract file (--contract)"
        )
    profile, contract = load_contract(first, base=wish.profile if wish.contract else None)
    if profile is None:
        raise PosstatsError(
            f"{first} has no requirement: let it extend a profile, or name one with --profile"
        )
    return profile, contract


def _results(
    source: Path, orientation: JudgedOrientation | None, bar: Advance
) -> tuple[Results, bytes, dict[str, bytes]]:
    """Results, their text, and the block.toml that they come from where the block is given."""
    if not source.is_dir():
        text = _results_text(source)
        return from_json(text, Results, str(source)), text, {}
    # an analysis takes a second to import, and results.json needs none
    from posstats.analysis.results import results
    from posstats.analysis.steps import analyse
    from posstats.formats.block_folder import read_block
    from posstats.settings import Settings

    block = read_block(source)
    settings = Settings(errors="bundle" if orientation == "bundle" else "coplanarity")
    analysis = analyse(block, settings, progress=lambda step, done: bar(step, 0.7 * done))
    found = with_words(results(analysis, created=now()))
    text = to_json(found).encode("utf-8")
    return found, text, {BLOCK_TOML: (source / BLOCK_TOML).read_bytes()}


def _results_text(path: Path) -> bytes:
    """The bytes of a results.json.

    Raises
    ------
    PosstatsError
        If it is too large.
    """
    if path.stat().st_size > _LARGEST_RESULTS:
        raise PosstatsError(f"{path}: more than {_LARGEST_RESULTS // 1_000_000} MB are not read")
    return path.read_bytes()
