"""The contract's JSON: written and read back, and what is said of one that is not right.

Oracle: a document made by hand, and the faults put into it on purpose.
"""

import json
import math
from copy import deepcopy
from dataclasses import dataclass, replace

import pytest
from finding_parts import assert_finding

from posstats.contract.files import as_values, from_json, read_json, to_json
from posstats.contract.notice import Notice
from posstats.contract.results import (
    AnalysedBlock,
    AnalysisSettings,
    Observability,
    Results,
    StripParallax,
    Units,
    Verdict,
)
from posstats.errors import PosstatsError

VERDICT = Verdict(
    raw_px=2.5, raw_mm=None, raw_median_px=math.nan, relative_px=0.25, relative_mm=None,
    relative_median_px=math.inf, corrected_px=1.0, corrected_mm=None, corrected_median_px=1.0,
    cause="phi", cause_share=0.75, corrected_angles=("phi",),
)  # fmt: skip
STRIP = StripParallax(
    strip="1", method="pos", n_models=2, max_mm=None, min_mm=None, mean_mm=None, max_px=3.0,
    min_px=2.0, mean_px=2.5,
)  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class Numbers:
    """The smallest document."""

    schema: str = "numbers/1"
    pair: tuple[float, float] | None
    counts: dict[str, int]


BLOCK = AnalysedBlock(
    name="small", n_images=2, n_strips=1, n_tie_points=9, n_check_points=0, simulated=True,
    crs=None, angles="omega-phi-kappa", inputs=(), n_models=1,
)  # fmt: skip


@pytest.fixture
def results() -> Results:
    return Results(
        posstats_version="0.1.0", created=None, versions={"python": "3.11"}, block=BLOCK,
        settings=AnalysisSettings(
            rules="paper", scope="block", errors="coplanarity", frame="ground",
            frame_setting="ground", robust=True, position_m=0.05, angle_rad=1e-4, image_px=0.2,
        ),
        units=Units(mm=False), verdict=VERDICT, expected_noise_px=0.2, images=(),
        parallax=(STRIP, replace(STRIP, method="independent", mean_px=-math.inf)), models=(),
        error_sources=(), angle_errors=(), angle_error_summary=(), bundle=None, regression=(),
        frames=(), selection=(), corrected_parallax=(), check_points=(),
        check_point_residuals=(), observability=(Observability(scope="block", images=("a", "b")),),
        notices=(Notice(code="some", values={"n": 3, "images": ("a", "b")}),),
    )  # fmt: skip


@pytest.fixture
def values(results):
    return deepcopy(as_values(results))


def refusal(content) -> str:
    text = content if isinstance(content, bytes) else json.dumps(content)
    with pytest.raises(PosstatsError) as caught:
        from_json(text, Results, "r.json")
    return str(caught.value)


def test_what_is_written_is_read_back(results, tmp_path):
    path = tmp_path / "results.json"
    path.write_text(to_json(results), encoding="utf-8")
    read = read_json(path, Results)
    verdict = replace(VERDICT, raw_median_px=None, relative_median_px=None)
    strips = (STRIP, replace(results.parallax[1], mean_px=None))
    assert read == replace(results, verdict=verdict, parallax=strips)
    assert to_json(read) == path.read_text(encoding="utf-8")


def test_what_is_not_finite_is_written_as_null(values):
    assert values["verdict"]["raw_median_px"] is None
    assert values["verdict"]["relative_median_px"] is None
    assert values["parallax"][1]["mean_px"] is None
    assert values["verdict"]["raw_px"] == 2.5


def test_keys_that_are_not_known_are_allowed(results, values):
    values["added"] = 1
    values["parallax"][0]["added"] = [1]
    assert as_values(from_json(json.dumps(values), Results, "r.json")) == as_values(results)


def test_a_whole_number_is_a_number_and_keys_with_a_default_may_lack(values):
    values["verdict"]["raw_px"] = 3
    del values["warnings"]
    read = from_json(json.dumps(values), Results, "r.json")
    assert (read.verdict.raw_px, read.warnings) == (3.0, ())


def test_a_byte_order_mark_is_no_fault(results):
    content = b"\xef\xbb\xbf" + to_json(results).encode()
    assert from_json(content, Results, "r.json").block == BLOCK


@pytest.mark.parametrize("schema", ["posstats-results/2", "posstats-adjustment/1", None, {}, 7])
def test_another_schema_is_refused_in_one_sentence(values, schema):
    values = {"schema": schema, "images": "not even looked at"}
    said = refusal(values)
    assert said.startswith(f"r.json has schema {json.dumps(schema)}; ")
    assert said.endswith(" posstats-results/1")
    assert "\n" not in said


@pytest.mark.parametrize(
    ("place", "value", "where", "found", "expected"),
    [
        (("units", "mm"), "yes", "r.json, units.mm", '"yes"', "true or false"),
        (("verdict", "raw_px"), [1], "r.json, verdict.raw_px", "[1]", "a number or"),
        (("verdict", "cause"), "psi", "r.json, verdict.cause", '"psi"', "a known word"),
        (("block", "n_images"), 2.5, "r.json, block.n_images", "2.5", "a whole number"),
        (("block", "name"), None, "r.json, block.name", "null", "text"),
        (("block",), [], "r.json, block", "[]", "an object"),
        (("images",), None, "r.json, images", "null", "a list"),
        (("parallax", 1), 5, "r.json, parallax[1]", "5", "an object"),
        (("parallax", 1, "max_px"), True, "r.json, parallax[1].max_px", "true", "a number or"),
        (("observability", 0, "images", 1), 7, "r.json, observability[0].images[1]", "7", "text"),
    ],
)
def test_a_wrong_value_is_named_with_its_place(values, place, value, where, found, expected):
    *before, last = place
    table = values
    for key in before:
        table = table[key]
    table[last] = value
    assert_finding(refusal(values), where, found, expected)


@pytest.mark.parametrize(
    ("place", "where"),
    [
        (("images",), "r.json, images"),
        (("parallax", 1, "strip"), "r.json, parallax[1].strip"),
    ],
)
def test_a_missing_key_is_named_with_its_place(values, place, where):
    *before, last = place
    table = values
    for key in before:
        table = table[key]
    del table[last]
    assert_finding(refusal(values), where, "nothing")


@pytest.mark.parametrize(
    ("values", "where", "found", "expected"),
    [
        ({"pair": [1], "counts": {}}, "n.json, pair", "[1]", "a list of"),
        ({"pair": None, "counts": {"a": "x"}}, "n.json, counts[...]", '{"a": "x', "a whole number"),
        (
            {"pair": None, "counts": {"a": "x" * 999}},
            "n.json, counts[...]",
            '{"a": "xxx',
            "a whole number",
        ),
    ],
)
def test_a_list_of_another_length_and_a_value_of_a_mapping_are_named(
    values, where, found, expected
):
    with pytest.raises(PosstatsError) as caught:
        from_json(json.dumps({"schema": "numbers/1"} | values), Numbers, "n.json")
    assert_finding(str(caught.value), where, found, expected)
    assert len(str(caught.value)) < 200


@pytest.mark.parametrize(
    "content",
    [b"", b"{", b"\x00\xff", b'"\xff"', b"[NaN]", b"[" * 100_000],
    ids=lambda c: repr(c[:5]),
)
def test_what_is_no_json_is_named(content):
    assert "is no JSON" in refusal(content)
