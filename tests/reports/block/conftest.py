"""The made-up blocks of these tests, and their pages, rendered once."""

import pytest
from report_results import area_results, coarse_results

from posstats.reports.block.document import build
from posstats.reports.pages import html


@pytest.fixture(scope="session")
def area():
    return area_results(per_strip=12)


@pytest.fixture(scope="session")
def coarse():
    return coarse_results()


@pytest.fixture(scope="session")
def area_document(area):
    return build(area)


@pytest.fixture(scope="session")
def chinese_document(area):
    return build(area, "zh")


@pytest.fixture(scope="session")
def page(area_document) -> str:
    return html.render(area_document)


@pytest.fixture(scope="session")
def coarse_page(coarse) -> str:
    return html.render(build(coarse))
