"""The documentation is true: its example is a block, its links lead somewhere."""

import pkgutil
import re
import runpy

import numpy as np
import pytest
from helpers import ROOT, shared_path
from small_blocks import Layout, observed_block, true_block

from posstats.analysis.results import results
from posstats.analysis.steps import analyse
from posstats.block.image_pairs import stereo_models
from posstats.contract.files import as_values
from posstats.formats.block_folder import read_block, write_block
from posstats.geometry.ground.check_points import check_point_residuals
from posstats.numerics.kernels.rotation import wrapped
from posstats.reports.block.wording import warnings

DOCS = ROOT / "docs"
KEYS = runpy.run_path(str(DOCS / "keys.py"))


def _example(folder):
    text = (DOCS / "block-format.md").read_text(encoding="utf-8")
    files = dict(re.findall(r"^`(\S+)`\n\n```\w+\n(.*?)```", text, re.MULTILINE | re.DOTALL))
    for name, content in files.items():
        (folder / name).write_text(content, encoding="utf-8")
    return files


def test_the_example_of_the_block_format_is_a_block(tmp_path):
    files = _example(tmp_path)
    assert set(files) == {
        "block.toml",
        "orientations.csv",
        "tie_points.csv",
        "ground_points.csv",
    }
    read = read_block(tmp_path)
    assert read.notices == ()
    models = stereo_models(read)
    assert list(models.pairs.n_points) == [6]
    # made in the grid with 0.2 px of noise: q has 0.2 * sqrt(2) px, the frame adds a little
    assert np.sqrt(np.mean(models.y_parallax_px() ** 2)) < 1.0


def test_the_check_point_of_the_example_is_met(tmp_path):
    _example(tmp_path)
    read = read_block(tmp_path)
    found = check_point_residuals(read, read.orientations, "pos")
    assert list(found.status) == ["ok"]
    assert np.all(np.abs(found.difference_m) < 4.0 * found.sigma_m)


@pytest.mark.parametrize("page", sorted(DOCS.glob("*.md")), ids=lambda page: page.name)
def test_links_lead_to_pages_and_headings_that_exist(page):
    for target in re.findall(r"\]\(([^)\s]+)\)", page.read_text(encoding="utf-8")):
        if target.startswith("https://"):
            continue
        name, _, heading = target.partition("#")
        linked = page.parent / name if name else page
        assert linked.exists(), target
        if heading:
            titles = re.findall(r"^#+ (.*)$", linked.read_text(encoding="utf-8"), re.MULTILINE)
            anchors = [re.sub(r"[^\w\- ]", "", t.lower()).replace(" ", "-") for t in titles]
            assert heading in anchors, target


@pytest.mark.parametrize("page", sorted(DOCS.glob("*.md")), ids=lambda page: page.name)
def test_tables_of_keys_are_made_of_the_contract(page):
    text = page.read_text(encoding="utf-8")
    assert KEYS["written"](text) == text


def test_the_code_that_the_method_names_exists():
    rows = re.findall(
        r"^\| \[\d\]\(.*\| ([^|]+) \|$", (DOCS / "method.md").read_text("utf-8"), re.M
    )
    named = [name for row in rows for name in re.findall(r"`([\w/]+)`", row)]
    assert len(named) > 20
    assert [name for name in named if not (ROOT / "posstats" / f"{name}.py").is_file()] == []


def _exists(name: str) -> bool:
    """Whether a dotted name is a module, or something in one."""
    try:
        return pkgutil.resolve_name(name) is not None
    except (ImportError, AttributeError):
        return False


def test_dotted_names_in_texts_of_the_code_exist():
    folders = (ROOT / name for name in ("posstats", "reports", "benchmarks"))
    paths = [path for folder in folders for path in folder.rglob("*.py")]
    found = {n for p in paths for n in re.findall(r"`(posstats(?:\.\w+)+)`", p.read_text("utf-8"))}
    assert len(found) > 5
    assert sorted(name for name in found if not _exists(name)) == []


def test_every_field_of_the_contract_says_what_it_holds():
    page = (DOCS / "results.md").read_text(encoding="utf-8")
    assert re.findall(r"^\| `(\w+)` \|", page, re.MULTILINE)
    assert not re.findall(r"^\| `\w+` \| [^|]* \|\s*\|$", page, re.MULTILINE)


def _code(page, language):
    text = page.read_text(encoding="utf-8")
    return re.findall(rf"^```{language}\n(.*?)^```", text, re.MULTILINE | re.DOTALL)


def _run(code, folder, monkeypatch):
    monkeypatch.chdir(folder)
    (folder / "example.py").write_text(code, encoding="utf-8")
    return runpy.run_path("example.py")


def test_the_python_example_of_the_readme_runs(tmp_path, monkeypatch, capsys):
    folder = tmp_path / "block"
    folder.mkdir()
    write_block(observed_block(true_block(Layout(n_points=300)), np.random.default_rng(4)), folder)
    (code,) = _code(DOCS.parent / "README.md", "python")
    names = _run(code, tmp_path, monkeypatch)
    assert "('omega', 'none', " in capsys.readouterr().out
    assert names["analysis"].settings.frame == "auto"
    assert len(names["models"]) == 8
    line = np.polyfit([0.0, 10.0, 20.0, 30.0], [1.0e-5, 1.6e-5, 2.3e-5, 2.8e-5], 1)
    assert names["fit"].slope == pytest.approx(line[0], rel=1e-12)


def test_the_worked_example_makes_the_block_it_shows(tmp_path, monkeypatch):
    """Oracle: the same POS, converted into omega, phi, kappa beside the data."""
    page = DOCS / "example-seneca.md"
    folder = tmp_path / "seneca"
    folder.mkdir()
    for name in ("raw_pos.csv", "tie_points.csv"):
        (folder / name).symlink_to(shared_path("data", "seneca", name).resolve())
    (code,) = _code(page, "python")
    (settings,) = _code(page, "toml")
    (folder / "block.toml").write_text(settings, encoding="utf-8")
    _run(code, tmp_path, monkeypatch)
    made, given = read_block(folder), read_block(shared_path("data", "seneca"))
    assert list(made.orientations.image) == list(given.orientations.image)
    assert list(made.orientations.strip) == list(given.orientations.strip)
    assert np.allclose(np.diff(made.orientations.time_s), np.diff(given.orientations.time_s))
    # the given block computes in the grid, this one in the tangent frame: they part by the
    # curvature of the earth over the field (300 m / 6370 km = 5e-5 rad), not by a convention
    apart = wrapped(made.orientations.angles_rad - given.orientations.angles_rad)
    assert np.abs(apart).max() < 1e-4
    text = page.read_text(encoding="utf-8")
    assert all(f"warning: {warning}\n" in text for warning in warnings(made.notices))
    assert f"{len(made.tie_points)} measurements of {len(made.tie_points.point_id)}" in text


def test_the_worked_example_quotes_its_verdict():
    """Oracle: the analysis; to 2 %, so that other robust weights leave the text true."""
    block = read_block(shared_path("data", "seneca"))
    values = as_values(results(analyse(block)))
    text = (DOCS / "example-seneca.md").read_text(encoding="utf-8")
    verdict = values["verdict"]
    quoted = re.search(
        r"parallax of (\S+) px \(median (\S+) px\).* the (\S+) px that relative", text
    )
    found = [verdict[name] for name in ("raw_px", "raw_median_px", "relative_px")]
    assert [float(number) for number in quoted.groups()] == pytest.approx(found, rel=0.02)
    assert verdict["corrected_angles"] == []
    for row in values["angle_error_summary"]:
        by = re.search(rf"{row['angle']} by (\S+)°", text)[1]
        assert float(by) == pytest.approx(np.degrees(row["rms_rad"]), rel=0.04)
