"""How many vertices move, and how far."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from risorius.head.head import Head
from risorius.rig.rig import Rig

__all__ = ["Motion", "cracks", "motions"]

# Motion below this does not count [mm]; without a head, as a share of the mesh's size.
_STILL = 1e-3
_STILL_SHARE = 4e-6
# Copies of one point that part by more than this leave a crack [mm].
_CRACK = 0.01


@dataclass(frozen=True)
class Motion:
    """What moves in one shape.

    Parameters
    ----------
    moved : int
        Vertices of all parts, as the file counts them, that move more than a micrometre (without
        landmarks: more than 4e-6 of the size of the mesh).
    largest, mean : float
        Longest motion, and the mean over the vertices that move [mm, or file unit without
        landmarks].
    vertex : int
        Vertex of the file with the longest motion, -1 if nothing moves.
    part : str
        The part it belongs to, empty where unknown.
    """

    moved: int
    largest: float
    mean: float
    vertex: int
    part: str


def motions(rig: Rig, head: Head | None) -> list[Motion]:
    """Measure the motion in every shape.

    Parameters
    ----------
    rig : Rig
    head : Head or None
        Gives the scale and the parts.
    """
    scale = 1.0 if head is None else head.frame.scale
    still = _STILL if head is not None else _STILL_SHARE * rig.mesh.tri_mesh().size
    names = ["" for _ in range(rig.mesh.vertex_count)]
    if head is not None:
        for kind, part in head.parts.items():
            for vertex in part.source.tolist():
                names[vertex] = kind
    result: list[Motion] = []
    for target in rig.targets:
        length = scale * np.linalg.norm(target.deltas, axis=1)
        moving = length > still
        if not moving.any():
            result.append(Motion(0, 0.0, 0.0, -1, ""))
            continue
        row = int(np.argmax(length))
        vertex = int(target.vertices[row])
        mean = float(length[moving].mean())
        result.append(Motion(int(moving.sum()), float(length[row]), mean, vertex, names[vertex]))
    return result


def cracks(rig: Rig, head: Head) -> list[int]:
    """Count, for every shape, the vertices of the file that leave the others at their place.

    A texture seam stores one point of the surface several times; where the copies move apart by
    more than a hundredth of a millimetre the surface shows a crack. Touching lips are no seam.
    """
    leader = np.arange(rig.mesh.vertex_count)
    for part in head.parts.values():
        leader[part.source] = part.first_source()[part.welded]
    copies = np.flatnonzero(leader != np.arange(len(leader)))
    result: list[int] = []
    for target in rig.targets:
        if not len(copies):
            result.append(0)
            continue
        dense = head.frame.scale * target.dense(rig.mesh.vertex_count)
        apart = np.linalg.norm(dense[copies] - dense[leader[copies]], axis=1)
        result.append(int((apart > _CRACK).sum()))
    return result
