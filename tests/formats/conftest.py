"""Block folders for the tests of reading."""

from pathlib import Path

import pytest
from perfect_block import perfect_block, written


@pytest.fixture
def folder(tmp_path) -> Path:
    """A small Cartesian block of perfect data."""
    return written(perfect_block(None), tmp_path / "block")
