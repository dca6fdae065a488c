"""What cranium and mandible have in common."""

from __future__ import annotations

from .fields import tube

__all__ = ["LEAST_TISSUE", "arch_tube"]

# soft tissue that always covers the bone [mm]
LEAST_TISSUE = 4.6


def arch_tube(points, line, heights, radii, *, stretch):
    """Field of a tube along a dental arch: `line` of x, z, one height and radius each [mm]."""
    knots = [(x, y, z, r) for (x, z), y, r in zip(line, heights, radii)]
    return tube(points, knots, scale=(1.0, stretch, 1.0))
