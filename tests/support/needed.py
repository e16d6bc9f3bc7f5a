"""Programs and typefaces that tests need: what is missing is named with what to install."""

import shutil

import pytest

from posstats.errors import PosstatsError
from posstats.reports.typefaces import cjk

INSTALL = "install it (.ci/debian-packages --browser, which make test calls, does on Debian)"


def program(*names: str, package: str) -> str:
    """The path of the first program that is there; the test fails without any."""
    for name in names:
        path = shutil.which(name)
        if path is not None:
            return path
    return pytest.fail(f"{names[0]} is missing, from {package}: {INSTALL}", pytrace=False)


def chinese_typeface() -> None:
    """The test fails without a typeface for Chinese."""
    cjk.font_file.cache_clear()
    try:
        cjk.font_file()
    except PosstatsError as error:
        pytest.fail(f"{error}: {INSTALL}", pytrace=False)
