"""Holm's adjustment, beside that of statsmodels."""

import numpy as np
import pytest
from statsmodels.stats.multitest import multipletests

from posstats.statistics.holm import holm


@pytest.mark.parametrize("n", [1, 2, 3, 8])
def test_adjusted_p_values_are_those_of_statsmodels(n):
    p = list(np.random.default_rng(n).uniform(size=n) ** 3)
    assert holm(p) == pytest.approx(multipletests(p, method="holm")[1], rel=1e-15)


def test_what_was_not_tested_does_not_count():
    assert holm([None, 0.01, None, 0.04]) == [None, 0.02, None, 0.04]
    assert holm([None]) == [None]


def test_equal_p_values_stay_equal():
    assert holm([0.02, 0.02, 0.9]) == [0.06, 0.06, 0.9]
