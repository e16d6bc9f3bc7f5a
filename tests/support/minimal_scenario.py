"""The smallest scenario that can be flown, and changes of it."""

from copy import deepcopy

MINIMAL = {
    "block": {"name": "small"},
    "camera": {"width_px": 1000, "height_px": 800, "principal_distance_px": 1500},
    "flight": {
        "forward_overlap": 0.6,
        "side_overlap": 0.3,
        "height_m": 1500,
        "n_strips": 2,
        "images_per_strip": 3,
    },
}


def changed(**tables):
    """MINIMAL with keys of its tables changed; a key set to None is removed."""
    content = deepcopy(MINIMAL)
    for name, values in tables.items():
        table = content.setdefault(name, {})
        table.update(values)
        for key in [key for key, value in table.items() if value is None]:
            del table[key]
    return content
