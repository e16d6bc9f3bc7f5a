"""The reader of TOML files: every fault of every table is found, with its line.

Oracle: a file whose lines are counted by eye, and the wrong values put into it on purpose.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Annotated, Literal

import numpy as np
import pytest
from finding_parts import assert_finding
from msgspec import Meta

from posstats.errors import BlockFormatError
from posstats.formats.toml_document import Conflict, TomlDocument, open_toml
from posstats.formats.toml_types import NEEDED, ONE_OR_MORE, Before, Check, repeated


@dataclass(frozen=True)
class Lens:
    focus: Annotated[float, Meta(gt=0, description="a number above 0")]
    unit: Literal["mm", "px"] = "mm"
    counts: Annotated[tuple[int, ...], Meta(description="numbers"), ONE_OR_MORE] = ()
    marks: Annotated[tuple[str, ...], Meta(description="texts"), Check(repeated)] = ()
    title: Annotated[str, Before(lambda value: value.strip())] | None = None
    anything: object = None


@dataclass(frozen=True)
class Tag:
    id: Annotated[str, NEEDED] | None = None
    least: int = 0
    most: int = 9

    def conflicts(self) -> Iterable[Conflict]:
        if self.least > self.most:
            yield ("least",), f"found {self.least}, expected less"


@dataclass(frozen=True)
class File:
    lens: Lens
    tag: Annotated[tuple[Tag, ...], Meta(max_length=3)] = ()
    spare: Annotated[tuple[Lens, ...], Meta(min_length=1), ONE_OR_MORE] = ()
    flag: bool = False


GOOD = """\
flag = true
[lens]
focus = 3
counts = 4
title = " x "

[[tag]]
id = "a"
[[tag]]
id = "b" # [tag]
least = 2
[spare]
focus = 1.5
"""


def document(*changes: tuple[str, str]) -> TomlDocument:
    text = GOOD
    for old, new in changes:
        assert old in text
        text = text.replace(old, new, 1)
    return open_toml(text.encode(), "x.toml")


def findings(*changes: tuple[str, str]) -> list[str]:
    read = document(*changes)
    with pytest.raises(BlockFormatError) as caught:
        read.read_or_raise(File)
    assert list(caught.value.findings) == read.findings
    return read.findings


def test_a_file_becomes_its_dataclass() -> None:
    read = document().read_or_raise(File)
    lens = Lens(focus=3.0, counts=(4,), title="x")
    tags = (Tag(id="a"), Tag(id="b", least=2))
    assert read == File(lens=lens, tag=tags, spare=(Lens(focus=1.5),), flag=True)
    assert isinstance(read.lens.focus, float)


@pytest.mark.parametrize(
    ("old", "new", "where", "found", "expected"),
    [
        ("focus = 3", "focus = true", "x.toml:3, lens.focus", "True", "a number above 0"),
        ("focus = 3", "focus = nan", "x.toml:3, lens.focus", "nan", "a number above 0"),
        ("focus = 3", "focus = inf", "x.toml:3, lens.focus", "inf", "a number above 0"),
        ("focus = 3", "focus = -1", "x.toml:3, lens.focus", "-1", "a number above 0"),
        ("focus = 3", "focus = '3'", "x.toml:3, lens.focus", "'3'", "a number above 0"),
        ("focus = 3", "focus = 2020-01-01", "x.toml:3, lens.focus", "datetime.date", "a number"),
        ("focus = 3", f"focus = 0x{'f' * 5000}", "x.toml:3, lens.focus", "a number of", "a number"),
        ("focus = 3", f"focus = {10**400}", "x.toml:3, lens.focus", "1000", "a number above 0"),
        ("focus = 3", "", "x.toml:2, lens.focus", "nothing", "a number above 0"),
        ("focus = 3", "focus = 3\nunit = 'mmm'", "x.toml:4, lens.unit", "'mmm'", "mm or px;"),
        ("focus = 3", "focus = 3\nunit = [1]", "x.toml:4, lens.unit", "[1]", "mm or px"),
        ("counts = 4", "counts = [4, true]", "x.toml:4, lens.counts", "[4, True]", "numbers"),
        ("counts = 4", "counts = 4.0", "x.toml:4, lens.counts", "4.0", "numbers"),
        ("counts", "cuonts", "x.toml:4, lens.cuonts", "an unknown key", "counts?"),
        ("counts = 4", "marks = ['a', 'a']", "x.toml:4, lens.marks", "'a' twice", "each once"),
        ("flag = true", "flag = 1", "x.toml:1, flag", "1", "true or false"),
        ("id = \"b\"", "id = 7", "x.toml:10, tag.id", "7", "text in quotes"),
        ("id = \"b\" # [tag]\n", "", "x.toml:9, tag.id", "nothing", "text in quotes"),
        ("least = 2", "least = 10", "x.toml:11, tag.least", "10", "less"),
        ("least = 2", "[[tag]]\n[[tag]]", "x.toml:7, tag", "4 tables", "at most 3"),
        ("focus = 1.5", "focus = 0", "x.toml:13, spare.focus", "0", "a number above 0"),
        ("[spare]\nfocus = 1.5", "[tags]", "x.toml:12, tags", "an unknown key", "tag?"),
        ("flag = true", "spare = []", "x.toml", "", ""),
    ],
)  # fmt: skip
def test_a_fault_is_named_with_its_line(old, new, where, found, expected) -> None:
    assert_finding(findings((old, new))[0], where, found, expected)


def test_all_faults_of_all_tables_are_found() -> None:
    found = findings(
        ("flag = true", "flag = 0\nflags = 1"), ("focus = 3", "focus = 0"), ("counts", "count"),
        ('id = "a"', "id = 1"), ("least = 2", "least = 'x'\nmost = 2.5"),
    )  # fmt: skip
    places = sorted(finding.split(": ")[0] for finding in found)
    assert places == [
        *("x.toml:1, flag", "x.toml:12, tag.least", "x.toml:13, tag.most", "x.toml:2, flags"),
        *("x.toml:4, lens.focus", "x.toml:5, lens.count", "x.toml:9, tag.id"),
    ]


def test_keys_of_any_spelling_have_their_line() -> None:
    text = b'lens.focus = 0\n"tag" = [ { id = 1 },\n{ least = "x" } ]\n\'spare\'.focus = 0\n'
    read = open_toml(text, "x.toml")
    read.read(File)
    assert sorted(finding.split(": ")[0] for finding in read.findings) == [
        *("x.toml:1, lens.focus", "x.toml:2, tag.id", "x.toml:2, tag.id", "x.toml:2, tag.least"),
        "x.toml:4, spare.focus",
    ]


def test_what_looks_like_a_heading_inside_a_list_or_text_is_none() -> None:
    text = (
        b'[lens]\ncounts = [\n[1]\n]\nmarks = ["""\n[tag]\nfocus = 1\n"""]\n# [spare]\nfocus = 0\n'
    )
    read = open_toml(text, "x.toml")
    read.read(File)
    assert "x.toml:2, lens.counts: found [[1]], expected numbers" in read.findings
    assert read.findings[0].startswith("x.toml:")


def test_what_is_right_can_be_used_beside_what_is_not() -> None:
    read = document(("least = 2", "least = 'x'"), ("flag = true", "flag = 1"))
    file = read.read(File)
    assert file is not None
    assert read.given() == ("flag", "lens", "tag", "spare")
    assert read.given(("tag", 1)) == ("id", "least")
    assert read.said(file.tag[1], ("tag", 1)) == {"id": "b"}
    assert read.is_right(("lens",))
    assert not read.is_right(("tag",))
    assert (file.flag, file.tag[1].least) == (False, 0)
    read.refuse(("tag", 0, "id"), "found it")
    assert read.findings[-1] == "x.toml:8, tag.id: found it"


def test_a_mapping_has_no_lines_and_may_hold_numpy() -> None:
    read = TomlDocument("x", {"lens": {"focus": np.float64(2.0), "counts": (1, 2)}})
    assert read.read_or_raise(File).lens == Lens(focus=2.0, counts=(1, 2))
    wrong = TomlDocument("x", {"lens": {"focus": 0}, "tag": 3})
    assert wrong.read(File) is None
    number, tables = wrong.findings
    assert_finding(number, "x, lens.focus", "0", "a number above 0")
    assert_finding(tables, "x, tag", "3", "a list of")


@pytest.mark.parametrize(
    ("content", "where", "found", "expected"),
    [
        (b"a = 1\nb = '\xff'\n", "x.toml:2", "a file that", ""),
        (b"a = ", "x.toml", "no valid TOML:", ""),
        (b"a = " + b"[" * 5000, "x.toml", "lists within lists", ""),
        (b"a = " + b"1" * 5000, "x.toml", "a number of", ""),
        (b"a = 1\nb." + b"b." * 5000 + b"b = 1", "x.toml:2", "a line of 10007", "at most 10000"),
        (b"".join(b"k%d = 1\n" % k for k in range(101)), "x.toml", "101 keys", "at most 100"),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_what_cannot_be_read_at_all_is_one_finding(content, where, found, expected) -> None:
    read = open_toml(content, "x.toml", longest_line=10_000)
    assert read.read(File) is None
    (finding,) = read.findings
    assert_finding(finding, where, found, expected)
