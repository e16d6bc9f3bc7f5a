"""The paper's experiment: its printed numbers, the criteria of its findings, the stored seeds."""

import csv
from dataclasses import replace

import pytest
from helpers import shared_path
from scipy import stats

from posstats.experiment.areas import AREAS, area_scenario, area_seed
from posstats.experiment.findings import CRITERIA
from posstats.experiment.published import consistent_residual_df, published, recomputed
from posstats.experiment.seeds import repeated, share, write


def typed_elsewhere(table: int) -> list[dict[str, str]]:
    with shared_path("paper", f"table{table}.csv").open(encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


@pytest.mark.parametrize("table", [1, 2, 3, 4])
def test_the_published_numbers_are_those_typed_by_others(table):
    ours, theirs = published(table), typed_elsewhere(table)
    assert len(ours) == len(theirs)
    for mine, other in zip(ours, theirs, strict=True):
        named = {key.removesuffix("_mm") if table == 2 else key: v for key, v in mine.items()}
        assert named.keys() == other.keys()
        for key, text in other.items():
            value = named[key]
            assert value == text if isinstance(value, str) else value == float(text)


def test_rows_are_chosen_by_their_values():
    (row,) = published(4, area=2, orientation="pos")
    assert row["rmse_vertical_m"] == 3.010
    assert [row["strip"] for row in published(2, area=3)] == ["1", "2", "3", "4"]


def test_table_3_can_only_be_one_strip_of_sixty_images():
    assert consistent_residual_df() == (58,)


def test_table_3_recomputed_agrees_with_another_librarys_f_distribution():
    for row, printed in zip(recomputed(58), published(3), strict=True):
        assert row.p_value == pytest.approx(stats.f.sf(printed["f_statistic"], 1, 58), rel=1e-10)
    assert [round(row.zero_crossing_t) for row in recomputed(58)] == [57020, 58761, 58419]


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
    "angles_dominate": [{"independent_mm": 0.2}, {"dependent_mm": 0.1}],
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
    "more_than_relative_is_left": [{"corrected_omega_mm": 0.0034}],
}


@pytest.mark.parametrize("criterion", CRITERIA)
def test_each_criterion_holds_in_area_1_and_every_part_of_it_can_fail(criterion):
    found = next(each for each in repeated()[1] if getattr(each, criterion))
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
