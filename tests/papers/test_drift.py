"""The paper's experiment: its printed numbers, the criteria of its findings, the stored seeds."""

import csv
import itertools
from dataclasses import replace

import numpy as np
import pytest
from helpers import shared_path
from scipy import optimize, stats

from posstats.block.image_pairs import stereo_models
from posstats.papers.drift.areas import AREAS, area_scenario, area_seed, true_causes
from posstats.papers.drift.findings import CRITERIA
from posstats.papers.drift.published import (
    consistent_residual_df,
    implied_scatter,
    impossible_vertical_rmse,
    least_zero_mean_rmse,
    published,
    recomputed,
)
from posstats.papers.drift.seeds import repeated, share, share_interval
from posstats.papers.seeds import write
from posstats.synthetic import simulate
from posstats.synthetic.scenario import AngleError


def typed_elsewhere(table: int) -> list[dict[str, str]]:
    with shared_path("paper", f"table{table}.csv").open(encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


@pytest.mark.parametrize("table", [1, 2, 3, 4])
def test_the_published_numbers_are_those_typed_by_others(table):
    ours, theirs = published(table), typed_elsewhere(table)
    assert len(ours) == len(theirs)
    for mine, other in zip(ours, theirs, strict=True):
        named = {key.removesuffix("_mm") if table == 2 else key: v for key, v in vars(mine).items()}
        assert named.keys() == other.keys()
        for key, text in other.items():
            value = named[key]
            assert value == text if isinstance(value, str) else value == float(text)


def test_rows_are_chosen_by_their_values():
    (row,) = published(4, area=2, orientation="pos")
    assert row.rmse_vertical_m == 3.010
    assert [row.strip for row in published(2, area=3)] == ["1", "2", "3", "4"]


def test_table_3_can_only_be_one_strip_of_sixty_images():
    assert consistent_residual_df() == (58,)


def test_table_3_recomputed_agrees_with_another_librarys_f_distribution():
    for row, printed in zip(recomputed(58), published(3), strict=True):
        assert row.p_value == pytest.approx(stats.f.sf(printed.f_statistic, 1, 58), rel=1e-10)
    assert [round(row.zero_crossing_t) for row in recomputed(58)] == [57020, 58761, 58419]


def test_area_3_of_table_4_cannot_have_had_its_mean_removed_from_the_heights():
    found = [(row.area, row.orientation) for row, _ in impossible_vertical_rmse()]
    assert found == [(3, "pos"), (3, "omega_corrected")]


@pytest.mark.parametrize(
    ("n", "smallest", "largest"), [(5, 0.5, 1.0), (6, 0.2, 1.0), (4, 0.9, 1.0)]
)
def test_no_numbers_of_mean_zero_have_a_smaller_rms_than_the_least(n, smallest, largest):
    """Against a search over all signs by another library's quadratic programme."""
    best = np.inf
    for signs in itertools.product((-1.0, 1.0), repeat=n - 1):
        bounds = [(largest, largest)] + [
            (smallest, largest) if sign > 0 else (-largest, -smallest) for sign in signs
        ]
        start = [np.mean(pair) for pair in bounds]
        found = optimize.minimize(
            lambda x: x @ x, start, jac=lambda x: 2 * x, bounds=bounds, method="SLSQP",
            constraints={"type": "eq", "fun": np.sum},
        )  # fmt: skip
        if found.success and abs(np.sum(found.x)) < 1e-8:
            best = min(best, np.sqrt(found.fun / n))
    assert least_zero_mean_rmse(n, smallest, largest) == pytest.approx(best, rel=1e-6)


@pytest.mark.parametrize("angle", ["phi", "omega", "kappa"])
def test_data_with_the_implied_scatter_regress_to_the_printed_f(angle):
    time = np.linspace(0.0, 848.0, 60)
    (row,) = published(3, angle=angle)
    design = np.column_stack([np.ones(60), time])
    noise = np.random.default_rng(5).normal(size=60)
    noise -= design @ np.linalg.lstsq(design, noise)[0]
    scatter = implied_scatter(angle, float(time.std()))
    line = stats.linregress(time, row.slope_per_t * time + scatter * noise / noise.std())
    f_statistic = 58.0 * line.rvalue**2 / (1.0 - line.rvalue**2)
    assert f_statistic == pytest.approx(row.f_statistic, rel=1e-9)


def test_position_errors_alone_are_not_taken_for_angle_errors():
    """3 m of position noise and no angle error: independent and dependent still agree."""
    scenario = area_scenario(3)
    errors = replace(
        scenario.errors,
        position=replace(scenario.errors.position, noise_m=3.0),
        omega=AngleError(), phi=AngleError(), kappa=AngleError(),
    )  # fmt: skip
    flight = replace(scenario.flight, images_per_strip=(6,) * 4)
    block = simulate(replace(scenario, errors=errors, flight=flight))
    causes = true_causes(block, stereo_models(block))
    assert causes.positions_mm > 10.0 * causes.angles_mm
    found = replace(
        repeated()[3][0],
        pos_mm=causes.positions_mm,
        angles_mm=causes.angles_mm,
        positions_mm=causes.positions_mm,
        independent_mm=causes.angles_mm,
    )
    assert not found.angles_dominate


def test_another_seed_simulates_another_area_and_is_the_stored_one():
    block = simulate(area_scenario(3), area_seed(2, 3))
    causes = true_causes(block, stereo_models(block))
    first, second = repeated()[3][:2]
    assert causes.angles_mm == pytest.approx(second.angles_mm, rel=1e-6)
    assert causes.angles_mm != pytest.approx(first.angles_mm, rel=1e-6)


def test_the_interval_of_a_share_is_wilsons():
    for criterion in ("only_omega_is_linear", "angles_dominate"):
        held = sum(getattr(each, criterion) for each in repeated()[1])
        expected = stats.binomtest(held, 100).proportion_ci(method="wilson")
        assert share_interval(criterion, 1) == pytest.approx(expected, abs=1e-7)


def test_no_two_areas_of_a_run_share_random_numbers_and_the_default_is_the_scenarios():
    for seed in (1, 7):
        assert len({area_seed(seed, area) for area in AREAS}) == 3
    assert [area_seed(1, area) for area in AREAS] == [area_scenario(a).block.seed for a in AREAS]


def test_a_folder_named_like_an_area_does_not_hide_its_scenario(tmp_path, monkeypatch):
    (tmp_path / "area1").mkdir()
    monkeypatch.chdir(tmp_path)
    assert area_scenario(1).block.name == "area1"


# Each criterion: values that break it, one at a time, in findings for which it held.
BREAKING = {
    "angles_dominate": [{"angles_mm": 0.2}, {"positions_mm": 0.2}],
    "omega_is_the_source": [
        {"held_omega_mm": 0.05},
        {"held_phi_mm": 0.1},
        {"held_kappa_mm": 0.1},
        {"held_angles_mm": 0.0035},
    ],
    "only_omega_is_linear": [
        {"strip_omega_r_squared": 0.94},
        {"strip_phi_p": 0.04},
        {"strip_kappa_p": 0.04},
    ],
    "omega_alone_is_chosen": [{"corrected_angles": "omega+phi"}, {"corrected_angles": ""}],
    "only_omega_helps": [
        {"corrected_omega_mm": 0.01},
        {"corrected_phi_mm": 0.1},
        {"corrected_kappa_mm": 0.1},
    ],
    "check_points_improve": [{"corrected_horizontal_m": 50.0}, {"corrected_vertical_m": 50.0}],
    "gains_as_published": [
        {"corrected_horizontal_m": 1.0, "pos_horizontal_m": 2.1},
        {"corrected_vertical_m": 1.0, "pos_vertical_m": 1.9},
    ],
}


@pytest.mark.parametrize("criterion", CRITERIA)
def test_each_criterion_can_hold_and_every_part_of_it_can_fail(criterion):
    found = next(each for area in (1, 3) for each in repeated()[area] if getattr(each, criterion))
    for change in BREAKING[criterion]:
        assert not getattr(replace(found, **change), criterion), change


def test_the_stored_seeds_are_a_hundred_for_every_area():
    assert {area: len(found) for area, found in repeated().items()} == dict.fromkeys(AREAS, 100)


def test_the_findings_come_out_as_often_as_promised():
    assert share("only_omega_is_linear", 1) >= 0.75
    for area in AREAS:
        assert share("check_points_improve", area) >= 0.95
        assert share("omega_alone_is_chosen", area) >= 0.75
        assert share("only_omega_helps", area) >= 0.95


def test_findings_survive_being_stored(tmp_path):
    found = repeated()[2][:3]
    write(enumerate(found, start=1), tmp_path / "seeds.csv")
    stored = (tmp_path / "seeds.csv").read_text(encoding="utf-8").splitlines()
    assert stored[0].startswith("seed,area,pos_mm")
    rows = list(csv.DictReader(stored))
    assert [float(row["pos_mm"]) for row in rows] == [each.pos_mm for each in found]
