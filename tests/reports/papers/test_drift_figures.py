"""Bars and regressions, as the paper's reproduction draws them, show what the results say."""

import re
import xml.etree.ElementTree as ET
from dataclasses import dataclass, replace

import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.textpath import TextPath
from report_results import ANGLES, area_results, with_rows
from scipy import stats

from posstats.reports.block import error_sources
from posstats.reports.block.line_figures import Panel, generalised, ordinary
from posstats.reports.block.words import words_in
from posstats.reports.document.format import MICRORADIAN
from posstats.reports.papers.drift import figures, words

N_STRIPS, PER_STRIP = 3, 10
GREY, ABOVE = "#d5dae0", "#d55e00"
HELD = ("angles", "omega", "phi", "kappa", "none")


def drawings_of(area, results, language="en"):
    return figures.draw_area(words.words_in(language), area, results)


@pytest.fixture(scope="module")
def results():
    def correlated(row):
        covariance = 0.4 * row.intercept_se_rad * row.slope_se
        return replace(row, cov_intercept_slope=covariance) if row.scope == "block" else row

    made = area_results(n_strips=N_STRIPS, per_strip=PER_STRIP)
    return with_rows(made, "regression", correlated)


@pytest.fixture(scope="module")
def drawn(results):
    return drawings_of(1, results)


@dataclass(frozen=True)
class Picture:
    """Texts and paths of an SVG figure, with the scale of its y-axes read off their gridlines."""

    root: ET.Element

    @property
    def texts(self):
        return [node.text for node in self.root.findall(".//{*}text")]

    def paths(self, *looks):
        return [
            np.array(re.findall(r"(-?[\d.]+) (-?[\d.]+)", node.get("d")), dtype=float)
            for node in self.root.findall(".//{*}path")
            if all(look in node.get("style", "") for look in looks) and not node.get("id")
        ]

    def y_labels(self):
        """Numbers left of the axes, top of the picture last, and the gridlines they belong to."""
        labels = [
            (float(node.get("y")), float(node.text.replace("−", "-")))
            for node in self.root.findall(".//{*}text")
            if "text-anchor: end" in node.get("style")
        ]
        lines = [path[0, 1] for path in self.paths(f"stroke: {GREY}")]
        return [value for _, value in labels], lines


def picture(drawing) -> Picture:
    return Picture(ET.fromstring(drawing.svg))  # noqa: S314 - made here


def bars(drawing):
    """Top of every bar, group by group, and of its grey part, in the unit of the axis."""
    seen = picture(drawing)
    values, lines = seen.y_labels()
    slope, constant = np.polyfit(lines, np.log10(values), 1)
    tops = {
        colour: [10.0 ** (slope * path[:, 1].min() + constant) for path in
                 sorted(seen.paths(f"fill: {colour}"), key=lambda path: path[:, 0].min())]
        for colour in (GREY, ABOVE)
    }  # fmt: skip
    return np.array(tops[ABOVE]), np.array(tops[GREY])


def means(results, key, **which):
    return [
        row.mean_mm
        for row in getattr(results, key)
        if all(getattr(row, name) == value for name, value in which.items())
    ]


def test_bars_show_the_parallax_with_angles_held_strip_by_strip(results, drawn):
    told = [value for held in HELD for value in means(results, "error_sources", fixed=held)]
    none = means(results, "error_sources", fixed="none") * len(HELD)
    tops, grey = bars(drawn[0])
    assert tops == pytest.approx(told, rel=2e-3)
    assert grey == pytest.approx(np.minimum(told, none), rel=2e-3)


def test_bars_show_the_parallax_with_one_angle_corrected_and_no_selection(results, drawn):
    relative = means(results, "parallax", method="independent")
    told = means(results, "parallax", method="pos")
    for angle in ANGLES:
        told += means(results, "corrected_parallax", corrected=angle)
    tops, grey = bars(drawn[2])
    assert tops == pytest.approx([*told, *relative], rel=2e-3)
    assert grey == pytest.approx(np.minimum([*told, *relative], relative * 5), rel=2e-3)
    assert "selected" not in " ".join(picture(drawn[2]).texts)


def test_a_strip_without_a_value_has_no_bar(results):
    def without(row):
        lacks = row.strip == "2" and row.fixed == "omega"
        return replace(row, mean_mm=None) if lacks else row

    lacking = with_rows(results, "error_sources", without)
    tops, grey = bars(drawings_of(1, lacking)[0])
    assert np.isfinite(tops).sum() == np.isfinite(grey).sum() == 5 * N_STRIPS - 1


def test_every_group_of_bars_is_named_and_carries_the_mean_over_its_models(results, drawn):
    texts = picture(drawn[0]).texts
    for name in ("omega held", "phi held", "kappa held", "none held"):
        assert name in texts
    every = np.mean(means(results, "error_sources", fixed="angles"))
    assert f"{every:.3f}\u00a0mm" in texts
    assert texts.count("1") == texts.count("3") == len(HELD)


def test_dots_and_lines_are_those_of_the_results(results, drawn):
    solid, dashed = _lines(picture(drawn[1]))
    for angle, ols, gls in zip(ANGLES, solid, dashed, strict=True):
        to_time, to_error, dots = _scales(results, drawn[1], angle)
        rows = results.angle_errors
        time, error = (
            np.array([getattr(row, key) for row in rows]) for key in ("time_s", f"{angle}_rad")
        )
        step = abs(to_error[0]) * 0.02  # coordinates are rounded to a hundredth of a point
        assert np.polyval(to_time, dots[:, 0]) == pytest.approx(time, abs=0.5)
        assert np.polyval(to_error, dots[:, 1]) == pytest.approx(error, abs=step)
        for line, prefix in ((ols, ""), (gls, "gls_")):
            drawn_at = np.polyval(to_time, line[:, 0])
            expected = _line(results, angle, prefix)(drawn_at)
            assert np.polyval(to_error, line[:, 1]) == pytest.approx(expected, abs=step)


def _scales(results, drawing, angle):
    """Straight lines from paper to time and to error that fit the dots best, and the dots."""
    rows = results.angle_errors
    strokes = _thirds(picture(drawing).paths("stroke-linecap: round"))[ANGLES.index(angle)]
    dots = np.vstack(strokes)[::2]  # each is a stroke of no length
    to_time = np.polyfit(dots[:, 0], [row.time_s for row in rows], 1)
    return to_time, np.polyfit(dots[:, 1], [getattr(row, f"{angle}_rad") for row in rows], 1), dots


def _thirds(paths):
    assert len(paths) == 3 * N_STRIPS
    return [paths[k * N_STRIPS : (k + 1) * N_STRIPS] for k in range(3)]


def _lines(seen):
    black = [path for path in seen.paths("stroke: #1c2430") if len(path) == 40]
    return black[::2], black[1::2]


def _block_row(results, angle):
    rows = [r for r in results.regression if r.angle == angle and r.scope == "block"]
    return rows[0]


def _line(results, angle, prefix):
    row = _block_row(results, angle)
    slope, constant = (
        getattr(row, f"{prefix}{name}") for name in ("slope_rad_per_s", "intercept_rad")
    )
    return lambda time: constant + slope * (time - row.time_origin_s)


@pytest.mark.parametrize("angle", ANGLES)
def test_the_band_is_the_confidence_interval_of_the_line(results, drawn, angle):
    """Width of the OLS band at its ends against the t-quantile of scipy."""
    row = _block_row(results, angle)
    band = _bands(drawn[1])[ANGLES.index(angle)]
    times = np.array([r.time_s for r in results.angle_errors])
    ends = np.array([times.min(), times.max()]) - row.time_origin_s
    variance = (
        row.intercept_se_rad**2 + 2.0 * ends * row.cov_intercept_slope + (ends * row.slope_se) ** 2
    )
    widths = 2.0 * stats.t.ppf(0.975, row.df_resid) * np.sqrt(variance)
    _, to_error, _ = _scales(results, drawn[1], angle)
    at_ends = [
        band[np.isclose(band[:, 0], x, atol=0.011), 1] for x in (band[:, 0].min(), band[:, 0].max())
    ]
    shown = np.array([np.ptp(y) for y in at_ends]) * abs(to_error[0])
    assert shown == pytest.approx(widths, abs=abs(to_error[0]) * 0.03)


def test_among_residuals_the_ols_line_is_zero_and_the_gls_line_their_difference(results):
    row = _block_row(results, "omega")
    axis = Figure().add_subplot()
    panel = Panel(axis, MICRORADIAN, 57000.0, ("ordinary", "generalised"))
    panel.fit([57000.0, 58000.0], ordinary(row), generalised(row), zero=ordinary(row))
    ols, gls = axis.lines
    drawn_at = np.asarray(gls.get_xdata()) + 57000.0
    expected = _line(results, "omega", "gls_")(drawn_at) - _line(results, "omega", "")(drawn_at)
    assert np.asarray(ols.get_ydata()) == pytest.approx(np.zeros(40), abs=1e-9)
    assert np.asarray(gls.get_ydata()) == pytest.approx(1e6 * expected, abs=1e-6)


def _bands(drawing):
    """The OLS bands; matplotlib writes them as shapes that are used once."""
    root = ET.fromstring(drawing.svg)  # noqa: S314 - made here
    shapes = [
        np.array(re.findall(r"(-?[\d.]+) (-?[\d.]+)", node.get("d")), dtype=float)
        for node in root.findall(".//{*}path")
        if node.get("id") and node.get("d").count("L") > 40
    ]
    assert len(shapes) == 6
    return shapes[::2]


def test_each_panel_states_r_squared_and_p_and_its_unit(results, drawn):
    texts = picture(drawn[1]).texts
    for angle in ANGLES:
        row = _block_row(results, angle)
        head = next(text for text in texts if text.startswith(f"{angle}: R²"))
        share = float(re.search(r"R² [=<] ([\d.]+)", head)[1])
        assert share == pytest.approx(row.r_squared, abs=1e-4)
        p = row.p_value
        assert ("p < 0.001 (OLS)" if p < 0.001 else f"p = {p:.3f} (OLS)") in head
    assert sorted(text for text in texts if text.startswith("error, ")) == [
        "error, mrad",
        "error, µrad",
        "error, µrad",
    ]


def test_r_squared_is_never_rounded_to_nothing_or_to_certainty(results):
    share = {"omega": 0.99996, "phi": 2.5e-5, "kappa": 0.5}
    extreme = with_rows(results, "regression", lambda row: replace(row, r_squared=share[row.angle]))
    heads = " ".join(picture(drawings_of(1, extreme)[1]).texts)
    assert "omega: R² > 0.9999" in heads
    assert "phi: R² < 0.0001" in heads


def test_captions_say_simulated_name_the_area_and_give_the_shares(results, drawn):
    for drawing in drawn:
        assert drawing.caption.startswith("Simulated area 1, predicted: ")
        assert drawing.caption.endswith(".")
        assert drawing.title.startswith("Simulated area 1: ")
    held = [np.mean(means(results, "error_sources", fixed=name)) for name in HELD]
    assert f"{100.0 * held[1] / held[0]:.3g}\u00a0%" in drawn[0].caption
    assert f"{100.0 * held[3] / held[4]:.3g}\u00a0%" in drawn[0].caption


def test_pictures_of_two_areas_can_stand_on_one_page(results, drawn):
    ids = []
    for drawing in (*drawn, *drawings_of(2, results)):
        root = ET.fromstring(drawing.svg)  # noqa: S314 - made here
        ids += [node.get("id") for node in root.iter() if node.get("id")]
    assert len(ids) == len(set(ids))
    assert [drawing.name for drawing in drawn] == [
        "area1_error_sources", "area1_regression", "area1_corrected"
    ]  # fmt: skip


@pytest.mark.parametrize("n_strips", [1, 3, 9])
def test_no_text_leaves_its_picture_or_touches_another(n_strips):
    for drawing in drawings_of(3, area_results(n_strips=n_strips, per_strip=8)):
        root = ET.fromstring(drawing.svg)  # noqa: S314 - made here
        _, _, width, height = (float(number) for number in root.get("viewBox").split())
        boxes = [_box(node) for node in root.findall(".//{*}text")]
        assert len(boxes) > 10
        for x0, y0, x1, y1 in boxes:
            assert 0.0 <= x0 < x1 <= width
            assert 0.0 <= y0 < y1 <= height
        for k, one in enumerate(boxes):
            assert not any(_overlap(one, other) for other in boxes[:k])


def _box(node):
    """Place of a text as it will be set in DejaVu Sans, with its turn."""
    style, transform = node.get("style"), node.get("transform", "")
    size = float(re.search(r"font-size: ([\d.]+)", style)[1])
    extent = TextPath((0.0, 0.0), node.text, size=size).get_extents()
    share = {"middle": 0.5, "end": 1.0}.get(re.sub(r".*anchor: (\w+).*", r"\1", style), 0.0)
    left, right = (x - share * extent.x1 for x in (extent.x0, extent.x1))
    moved = re.match(r"translate\(([\d.]+) ([\d.]+)\)", transform)
    x, y = (float(v) for v in (moved.groups() if moved else (node.get("x"), node.get("y"))))
    if transform.startswith("rotate(-90"):
        return x - extent.y1, y - right, x - extent.y0, y - left
    return x + left, y - extent.y1, x + right, y - extent.y0


def _overlap(one, other):
    return one[0] < other[2] and other[0] < one[2] and one[1] < other[3] and other[1] < one[3]


def test_ids_too_many_for_the_room_are_written_under_some_bars():
    many = area_results(n_strips=40, per_strip=4)
    texts = picture(drawings_of(1, many)[0]).texts
    written = [text for text in texts if re.fullmatch(r"\d+", text)]
    assert written[0] == "1"
    assert len(HELD) <= len(written) < 40 * len(HELD)


def test_zero_parallax_has_no_place_on_a_logarithmic_scale(results):
    exact = with_rows(results, "error_sources", lambda row: replace(row, mean_px=0.0))
    assert error_sources.figure(words_in("en"), exact) is None


def test_pictures_of_a_large_area_are_small():
    large = area_results(n_strips=9, per_strip=36)
    assert max(len(drawing.svg.encode()) for drawing in drawings_of(2, large)) < 150_000
