"""Coarse versions of a head, for levels of detail."""

from __future__ import annotations

from functools import cache

import igl
import numpy as np

from risorius.anatomy.mechanics import Mechanics
from risorius.head import Head, HeadOptions
from risorius.head.mouth import find_head_lips
from risorius.landmarks.landmark_set import LandmarkSpec
from tests.synthetic import assemble

_LIPS = {"2.2": 1, "8.1": 1, "2.3": -1, "8.2": -1}


def decimated(head: Head, share: float) -> Head:
    """Return `head` with `share` of its skin's triangles and all other parts as they are."""
    skin = head.skin.mesh
    count = int(share * skin.face_count)
    points, faces, _, birth = igl.decimate(skin.positions, skin.faces.astype(np.int64), count)
    pieces = {
        kind: (part.mesh.positions, part.mesh.faces.tolist())
        for kind, part in head.parts.items()
        if kind != "skin"
    }
    pieces = {"skin": (np.asarray(points), np.asarray(faces).tolist()), **pieces}
    lips = find_head_lips(head)
    sides = (lips.upper.astype(int) - lips.lower.astype(int))[np.asarray(birth)]
    marks: dict[str, LandmarkSpec] = {}
    for name in head.landmarks:
        distance = np.linalg.norm(points - head.landmarks.position(name), axis=1)
        if name in _LIPS:
            distance[sides != _LIPS[name]] = np.inf
        marks[name] = LandmarkSpec(vertex=int(np.argmin(distance)))
    mesh = assemble(pieces, names={kind: kind for kind in pieces})
    options = HeadOptions(unit="mm", axes="+Y+Z", parts={kind: kind for kind in pieces})
    return Head.from_mesh(mesh, marks, options=options)


@cache
def coarse_mechanics(share: float) -> Mechanics:
    """Return the moving parts of the built-in head at `share` of its triangles."""
    from risorius.anatomy.template import builtin_head

    return Mechanics.build(decimated(builtin_head(), share))
