"""The documentation is true: its example is a block, its links lead somewhere."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from strip_scene import block, scene

from posstats.accuracy import check_point_residuals
from posstats.analysis import Settings, analyse
from posstats.block_io import read_block
from posstats.results import results
from posstats.stereo import stereo_models

DOCS = Path(__file__).resolve().parents[1] / "docs"


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
    assert read.warnings == ()
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


def _keys(value):
    if isinstance(value, dict):
        return set(value).union(*map(_keys, value.values()))
    return set().union(*map(_keys, value)) if isinstance(value, list) else set()


def test_every_key_of_the_results_is_described():
    oriented, ground = scene(1, n_points=20)
    turned = oriented.with_angles(oriented.angles_rad + 1e-5 * np.arange(5)[:, None])
    made = block(turned, ground, is_check=np.arange(20) < 4)
    analysis = analyse(replace(made, adjusted=oriented), Settings(errors="adjusted", frame="auto"))
    values = results(analysis)
    packages = set(values.pop("versions"))
    page = (DOCS / "results.md").read_text(encoding="utf-8")
    named = set(re.findall(r"`(\w+)`", page)) | set(re.findall(r"^### (\w+)$", page, re.MULTILINE))
    assert _keys(values) - named == set()
    assert "numpy" in packages
