"""How deep a posed face's visible skin sinks into its turned left eye."""

from __future__ import annotations

import numpy as np

from risorius.layered import LayeredFace
from risorius.rig.quality.penetration import depths_inside, solid

__all__ = ["depth_added"]


def depth_added(face: LayeredFace, pose: dict[str, float]) -> float:
    """Return the largest growth [mm] of a vertex's depth in the left eye over the neutral's."""
    part, rest = face.head.parts["eye_left"], face.head.skin.mesh.positions
    near = np.linalg.norm(rest - part.mesh.positions.mean(axis=0), axis=1) < 40.0
    chosen = np.flatnonzero(near & ~face.skin.hidden)
    moved = face.displace(pose)
    skin = (rest + moved[face.head.skin.first_source()])[chosen]
    eye = part.mesh.at(part.mesh.positions + moved[part.first_source()])
    before = depths_inside(solid(part.mesh), rest[chosen])
    return float((depths_inside(solid(eye), skin) - before).max())
