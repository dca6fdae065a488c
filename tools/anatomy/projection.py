"""Plain texture projections for parts that need no unfolding."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

__all__ = ["with_arch_uvs", "with_top_uvs"]

# the middle of the dental arches, which the projection goes around: z [mm]
_ARCH_MIDDLE = 40.0


def _with_uvs(part, plane):
    """Return `part` with texture coordinates from plane places (n, 2), fitted to the square."""
    low, size = plane.min(axis=0), np.ptp(plane, axis=0)
    return replace(part, uvs=(plane - low) / size, uv_polygons=list(part.polygons))


def with_top_uvs(part):
    """Return `part` with the texture laid on from above: u from right to left, v to the front."""
    return _with_uvs(part, part.positions[:, [0, 2]])


def with_arch_uvs(part):
    """Return `part` with the texture wrapped around the dental arch, seen from the front."""
    x, y, z = part.positions.T
    # past the middle the arch goes straight back, and so does the texture
    around = np.where(z > _ARCH_MIDDLE, np.arctan2(x, z - _ARCH_MIDDLE), np.sign(x) * np.pi / 2)
    back = np.maximum(_ARCH_MIDDLE - z, 0.0) / 30.0
    return _with_uvs(part, np.column_stack([around + np.sign(x) * back, y]))
