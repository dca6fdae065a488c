"""One named object of an asset file."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

__all__ = ["Part", "from_triangles", "mirror_part", "triangles_of"]


@dataclass(frozen=True)
class Part:
    """Polygons of one object.

    Parameters
    ----------
    name : str
    positions : (n, 3) ndarray
        Vertices [mm].
    polygons : list of tuple of int
        Counter-clockwise from outside.
    groups, materials : list of str
        One per polygon.
    uvs : (k, 2) ndarray
        Texture coordinates, may be empty.
    uv_polygons : list of tuple of int
        Texture coordinate of every corner; empty without `uvs`.
    """

    name: str
    positions: np.ndarray
    polygons: list
    groups: list
    materials: list
    uvs: np.ndarray = field(default_factory=lambda: np.zeros((0, 2)))
    uv_polygons: list = field(default_factory=list)


def from_triangles(name, positions, faces, *, material=""):
    """Return a part of one group and material, with one texture coordinate per vertex if given."""
    polygons = [tuple(face) for face in np.asarray(faces).tolist()]
    return Part(name, positions, polygons, [name] * len(polygons), [material] * len(polygons))


def triangles_of(polygons):
    """Return the fan triangulation (t, 3) of `polygons`, in order."""
    fans = [(p[0], p[k], p[k + 1]) for p in polygons for k in range(1, len(p) - 1)]
    return np.array(fans, int).reshape(-1, 3)


def mirror_part(part, name):
    """Return the mirror image of a part of the left side, vertex for vertex."""
    flipped = [(p[0], *p[:0:-1]) for p in part.polygons]
    uv_flipped = [(p[0], *p[:0:-1]) for p in part.uv_polygons]
    return replace(
        part,
        name=name,
        positions=part.positions * [-1, 1, 1],
        polygons=flipped,
        groups=[group.replace("left", "right") for group in part.groups],
        uvs=part.uvs * [-1, 1] + [1, 0] if len(part.uvs) else part.uvs,
        uv_polygons=uv_flipped,
    )
