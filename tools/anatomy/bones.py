"""Cranium and mandible as meshes: smoothed, decimated, exactly symmetric."""

from __future__ import annotations

import numpy as np
import pyfqmr

from .cranium_field import cranium_field
from .mandible_field import mandible_field
from .marching import half_surface
from .part import from_triangles
from .remesh import thin_border
from .topology import border_loops, compact, mirrored, vertex_mean

__all__ = ["bone_parts"]


def _smooth(positions, faces, passes=4):
    """Taubin smoothing: shrink and swell by turns."""
    mean = vertex_mean(faces, len(positions))
    for _ in range(passes):
        for share in (0.5, -0.53):
            positions = positions + share * (mean @ positions - positions)
    return positions


def _bone(field, low, high, *, step, triangles):
    """Return positions and faces of the zero surface of `field`, both halves."""
    positions, faces = half_surface(field, low, high, step)
    # smooth both halves together, or the midline is left as a knife edge
    both, both_faces = mirrored(positions, faces)
    positions = _smooth(both, both_faces)[: len(positions)]
    positions[np.concatenate(border_loops(faces)), 0] = 0.0
    simplifier = pyfqmr.Simplify()
    simplifier.setMesh(positions, faces)
    simplifier.simplify_mesh(
        target_count=triangles // 2, aggressiveness=8, preserve_border=True, verbose=0
    )
    positions, faces, _ = (np.array(part) for part in simplifier.getMesh())
    positions = positions.astype(float)
    for _ in range(3):
        faces, count = thin_border(positions, faces, border_loops(faces), 7.0)
        if count == 0:
            break
    positions, faces, _ = compact(positions, faces)
    return mirrored(positions, faces)


def bone_parts():
    """Return cranium and mandible."""
    cranium = _bone(cranium_field, (0, -66, -100), (76, 116, 106), step=1.3, triangles=11000)
    mandible = _bone(mandible_field, (0, -116, -5), (68, -8, 96), step=1.1, triangles=3600)
    return from_triangles("cranium", *cranium, material="bone"), from_triangles(
        "mandible", *mandible, material="bone"
    )
