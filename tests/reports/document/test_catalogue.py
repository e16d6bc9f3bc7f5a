"""The message catalogues: complete, alike in both languages, and all of it used."""

import ast
import re
import string
from itertools import chain

import pytest
from helpers import ROOT

from posstats.acceptance.evidence import ORIENTATIONS
from posstats.acceptance.quantity_names import QUANTITIES
from posstats.errors import PosstatsError
from posstats.reports.acceptance import words as acceptance_words
from posstats.reports.document.catalogue import MissingMessageError, catalogue
from posstats.statistics import samples

DOMAINS = ("document", "acceptance")
ENGLISH, CHINESE = catalogue("en", *DOMAINS), catalogue("zh", *DOMAINS)
MAY_BE_EMPTY = {"page.after", "sentence.between"}
ACCEPTANCE = "".join(
    path.read_text(encoding="utf-8") for path in (ROOT / "posstats" / "acceptance").glob("*.py")
)
CODES = {"within", "exceeds", "investigate", *re.findall(r'Reason\("([^"]+)"', ACCEPTANCE)}
UNTESTABLE = {samples.NO_POINTS, samples.TOO_FEW_POINTS, samples.TOO_MANY_POINTS,
              samples.NO_SCATTER, samples.COLLINEAR}  # fmt: skip


def places(forms: tuple[str, ...]) -> set[str]:
    return {name for form in forms for _, name, _, _ in string.Formatter().parse(form) if name}


def used() -> tuple[set[str], set[str]]:
    """Ids named in modules and templates, and beginnings of ids that are put together."""
    ids, beginnings = set(), set()
    sources = [
        path
        for room in ("acceptance", "document", "pages")
        for path in (ROOT / "reports" / room).glob("*.py")
    ]
    for path in sources:
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.JoinedStr):
                head = node.values[0]
                if isinstance(head, ast.Constant) and str(head.value).endswith("."):
                    beginnings.add(head.value)
            elif isinstance(node, ast.Constant) and isinstance(node.value, str):
                ids.add(node.value)
            if isinstance(node, ast.Call) and getattr(node.func, "attr", "") in {
                "of",
                "known",
                "marked",
            }:
                family = node.args[0]
                if isinstance(family, ast.Constant):
                    beginnings.add(f"{family.value}.")
                elif isinstance(family, ast.JoinedStr):
                    beginnings |= {"method_lead.", "verify_lead.", "method.", "verify."}
    for path in ROOT.glob("templates/**/*.j2"):
        text = path.read_text(encoding="utf-8")
        ids |= set(re.findall(r"say\([\"']([\w.]+)[\"']\)", text))
        beginnings |= set(re.findall(r'say\("([\w.]+\.)" ~', text))
    return ids, beginnings


def test_both_languages_have_the_same_ids_with_the_same_places():
    assert set(ENGLISH.messages) == set(CHINESE.messages)
    for name, forms in ENGLISH.messages.items():
        assert places(forms) == places(CHINESE.messages[name]), name


def test_no_message_is_empty_but_those_that_are_meant_so():
    for words in (ENGLISH, CHINESE):
        empty = {name for name, forms in words.messages.items() if not all(forms)}
        assert empty <= MAY_BE_EMPTY


def test_every_message_is_used_and_every_message_used_is_there():
    ids, beginnings = used()
    defined = set(ENGLISH.messages)
    families = {name.split(".")[0] + "." for name in defined}
    unused = {n for n in defined - ids if not n.startswith(tuple(beginnings))}
    assert not unused
    named = {n for n in ids if re.fullmatch(r"[a-z_]+\.\w+", n)
             and n.startswith(tuple(families))}  # fmt: skip
    files = {n for n in named if n.split(".")[-1] in {"py", "po", "css", "json", "svg", "png"}}
    assert named - files <= defined


def test_every_reason_quantity_and_orientation_has_words():
    for words in (ENGLISH, CHINESE):
        for code in CODES:
            assert words.holds("reason", code)
        for code in UNTESTABLE:
            assert words.holds("untestable", code)
        for quantity in QUANTITIES:
            assert words.holds("quantity", quantity)
        for name in ORIENTATIONS:
            assert words.holds("orientation", name)
            assert words.holds("orientation_reason", name)
        assert words.holds("orientation_reason", "asked")
        for key in acceptance_words.PRODUCT:
            assert words.holds("product", key)


def test_chinese_has_no_english_punctuation_between_chinese():
    for name, forms in CHINESE.messages.items():
        for form in forms:
            assert not re.search(r"[一-鿿][,;:?!()]|[,;:?!()][一-鿿]", form), name
            assert not re.search(r"[一-鿿]\.(?!\w)", form), name


def test_a_missing_message_is_an_error_and_never_its_id():
    with pytest.raises(MissingMessageError):
        ENGLISH.text("verdict.perhaps")
    with pytest.raises(KeyError):
        ENGLISH.text("key.limit")
    with pytest.raises(PosstatsError, match="no language"):
        catalogue("fr", *DOMAINS)


def test_plurals_follow_the_language():
    assert ENGLISH.plural("delivered.n_images", 1, n="1") == "1 image"
    assert ENGLISH.plural("delivered.n_images", 2, n="2") == "2 images"
    assert CHINESE.plural("delivered.n_images", 1, n="1") == "影像 1 张"


def test_enumerations_follow_the_language():
    assert ENGLISH.joined(["a", "b", "c"]) == "a, b and c"
    assert CHINESE.joined(["甲", "乙", "丙"]) == "甲、乙和丙"
    assert ENGLISH.joined([]) == ""


def test_values_with_braces_stay_as_they_are():
    assert ENGLISH.text("key.limit", limit="{x} {{7*7}} %s") == "limit {x} {{7*7}} %s"


def test_no_wording_stands_in_the_code():
    """Texts of several words in the modules of the document are docstrings or errors."""
    allowed = re.compile(r"error|Error|not |no |the |these |posstats|svg|script|<", re.IGNORECASE)
    for path in chain(ROOT.glob("reports/acceptance_*.py")):
        if path.stem.removeprefix("acceptance_") in {"templates", "report", "writing", "cli"}:
            continue  # their sentences are errors, and help on a terminal
        tree = ast.parse(path.read_text(encoding="utf-8"))
        docs = {ast.get_docstring(n, clean=False) for n in ast.walk(tree)
                if isinstance(n, ast.Module | ast.ClassDef | ast.FunctionDef)}  # fmt: skip
        for node in ast.walk(tree):
            if isinstance(node, ast.Constant) and isinstance(node.value, str):
                several = len(re.findall(r"[A-Za-z]{3,} [A-Za-z]{2,}", node.value)) > 0
                keys = node.value in {"not assessed", "not assessable"}
                assert not several or node.value in docs or keys or allowed.match(node.value)
