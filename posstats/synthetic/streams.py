"""Random streams of a simulation, one per purpose.

Changing one kind of noise leaves the other draws, and the truth, as they were.
"""

from typing import TypeAlias

import numpy as np

Streams: TypeAlias = dict[str, np.random.Generator]

# New purposes go to the end: a stream is known by its place.
_PURPOSES = (
    "flight",
    "terrain",
    "tie points",
    "check points",
    "control points",
    "image",
    "blunders",
    "survey",
    "position",
    "attitude",
    "attitude drift",
)


def random_streams(seed: int) -> Streams:
    """One independent stream per purpose."""
    children = np.random.SeedSequence(seed).spawn(len(_PURPOSES))
    return {
        purpose: np.random.Generator(np.random.PCG64(child))
        for purpose, child in zip(_PURPOSES, children, strict=True)
    }
