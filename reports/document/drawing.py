"""A finished figure."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Drawing:
    """A finished figure: `name` is its identifier, `title` its alternative text."""

    name: str
    title: str
    caption: str
    svg: str
