"""Lines and bands over time as they are drawn, against the fits that results.json states."""

import numpy as np

from posstats.analysis.regression import AngleRegression
from posstats.analysis.rows import regression_row
from posstats.reports.block.line_figures import generalised, ordinary
from posstats.statistics.drift import fit_drift

TIME = np.array([0.0, 12.0, 31.0, 45.0, 90.0, 140.0]) + 57_000.0
ERROR = np.array([1.3, -0.4, 0.9, 2.1, 1.2, 4.2]) * 1e-4
KNOWN = np.diag([1.0, 9.0, 1.0, 4.0, 1.0, 25.0]) * 1e-10


def test_lines_and_bands_are_those_of_the_fits_away_from_their_reference_too():
    fits = fit_drift(TIME, ERROR), fit_drift(TIME, ERROR, KNOWN)
    made = AngleRegression("omega", "ground", "block", 6, 1, *fits, None, None, True)
    row = regression_row(made)
    at = np.array([TIME[0] - 50.0, TIME[2], TIME[5] + 100.0])
    for line, fit in zip((ordinary(row), generalised(row)), fits, strict=True):
        middle, se = fit.predict(at)
        quantile = (fit.conf_int()[1] - fit.slope) / fit.slope_se
        np.testing.assert_allclose(line.at(at), middle, rtol=1e-9)
        np.testing.assert_allclose(line.half_width(at), quantile * se, rtol=1e-6)
