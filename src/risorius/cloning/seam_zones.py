"""Where several sheets of skin lie on one another: the corners of the mouth, the lids."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from risorius._check import BoolArray, FloatArray
from risorius.cloning.subject import Subject
from risorius.mesh.connectivity import edges
from risorius.mesh.core import TriMesh

__all__ = ["SeamZone", "edge_length", "seam_zones"]

# Reach of the zones on the target and on the source: of the corners as shares of the mouth's
# width, of the lids as shares of the eye's opening. A zone is never smaller than an edge of the
# source there.
_CORNER, _SOURCE_CORNER = 0.16, 0.3
_LID, _SOURCE_LID = 0.6, 1.5
# Stretch of places that is nothing unusual between two faces.
_CORNER_STRETCH, _LID_STRETCH = 1.1, 1.4
# Distance over which doubtful places are evened out [mm].
_BEND = 1.2


@dataclass(frozen=True, eq=False)
class SeamZone:
    """One place where closest points may land on the wrong sheet.

    Parameters
    ----------
    target : (n,) bool
        Vertices of the target's skin.
    source : (v,) bool
        Vertices of the source's skin, of a larger zone.
    ordinary : float
        Stretch of places that two faces may have [1].
    bend : float
        Distance over which doubtful places are evened out [mm].
    """

    target: BoolArray
    source: BoolArray
    ordinary: float
    bend: float


def seam_zones(source: Subject, target: Subject, rest: TriMesh) -> list[SeamZone]:
    """Return the zones that both heads have.

    Parameters
    ----------
    source, target : Subject
    rest : TriMesh
        The source's skin, moved by the similarity [mm].
    """
    result: list[SeamZone] = []
    if source.lips is not None and target.lips is not None:
        width = target.lips.width
        near = np.asarray(source.lips.to_corner < _SOURCE_CORNER * source.lips.width)
        reach = max(_CORNER * width, edge_length(rest, near))
        for corner in target.lips.slit.corners:
            away = _distance(target.mesh.positions, corner)
            result.append(SeamZone(away < reach, near, _CORNER_STRETCH, _BEND))
    for side, margins in target.lids.items():
        own = source.lids.get(side)
        if own is None:
            continue
        near = np.asarray(own.distance < _SOURCE_LID * own.height)
        reach = max(_LID * margins.height, edge_length(rest, near))
        lid = (margins.distance < reach) & ~target.inside
        result.append(SeamZone(lid, near, _LID_STRETCH, _BEND))
    return result


def edge_length(mesh: TriMesh, chosen: BoolArray) -> float:
    """Return the median length of the edges at `chosen` (n,) vertices, 0 without any [mm]."""
    pairs = edges(mesh.faces)
    pairs = pairs[chosen[pairs].any(axis=1)]
    if not len(pairs):
        return 0.0
    ends = mesh.positions[pairs]
    return float(np.median(np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1)))


def _distance(positions: FloatArray, vertex: int) -> FloatArray:
    return np.linalg.norm(positions - positions[vertex], axis=1)
