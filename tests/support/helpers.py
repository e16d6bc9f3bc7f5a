"""Shared by the tests: where the real data is."""

from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
"""The repository."""

SHARED = ROOT.parent / "shared"


def shared_path(*parts: str) -> Path:
    """A path below ``../shared``, the folder of real data beside the repository; skips without."""
    path = SHARED.joinpath(*parts)
    if not path.exists():
        pytest.skip(f"real data not available: {'/'.join(('shared', *parts))}")
    return path
