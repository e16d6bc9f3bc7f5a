"""Figures 1 to 3 of the first source paper, redrawn for a simulated test area."""

from posstats.contract.results import Results

from ...document.drawing import Drawing
from ...figures import style
from . import corrected, regression, sources
from .words import Words


def draw_area(words: Words, area: int, results: Results) -> tuple[Drawing, Drawing, Drawing]:
    """The paper's three figures for one area, in millimetres at image scale and over time.

    Parameters
    ----------
    words
        Of the report.
    area
        Number of the area; part of the figures' names.
    results
        Of the simulated area, in the ground frame with a block-wide line.

    Returns
    -------
    tuple
        ``area<n>_error_sources``, ``area<n>_regression``, ``area<n>_corrected`` (Figures 1 to 3).
    """
    with style.style(words.families()):
        return (
            sources.figure(words, area, results),
            regression.figure(words, area, results),
            corrected.figure(words, area, results),
        )
