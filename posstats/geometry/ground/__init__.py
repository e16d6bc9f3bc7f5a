"""Points on the ground: intersection, footprints, check points."""
