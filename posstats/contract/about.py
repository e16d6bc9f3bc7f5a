"""What a field of the contract holds: the tables of keys in ``docs/`` are made of it."""

from msgspec import Meta


def about(description: str) -> Meta:
    """What a field holds, with its unit, as it stands in ``docs/``."""
    return Meta(description=description)
