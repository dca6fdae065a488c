"""Carry the regions of the face to another head by warp and cylindrical projection."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.spatial import cKDTree

from risorius._check import BoolArray, FloatArray, IntArray, as_points
from risorius.anatomy.regions import REGIONS, Regions
from risorius.mesh.core import TriMesh
from risorius.spatial.raycast import Scene
from risorius.vectormuscle.export import Export

__all__ = ["RegionTransfer", "nearest_corners", "split_lips", "transfer_regions"]

# Vertices closer than this share of the head to a source vertex are that vertex.
_SAME = 1e-7
_LOWER, _MIDDLE = REGIONS.index("lower"), REGIONS.index("middle")


@dataclass(frozen=True, eq=False)
class RegionTransfer:
    """Which vertex of the source each vertex of the target takes its region from.

    Parameters
    ----------
    vertices : (n,) int32
        Of the source's skin, for each vertex of the target's.
    missed : (n,) bool
        Where no ray hit; the nearest vertex stands in.
    """

    vertices: IntArray
    missed: BoolArray

    def carry(self, regions: Regions) -> Regions:
        """Return the target's regions, before the lips are told apart."""
        return Regions(regions.weights[self.vertices], regions.mobility[self.vertices])


def nearest_corners(
    source: TriMesh, points: npt.ArrayLike, *, axis: tuple[float, float]
) -> RegionTransfer:
    """Project points on a mesh along the radii of a vertical cylinder.

    From each point a ray goes outwards and inwards; of the triangle that it meets first, the
    nearest corner counts (spec vector-muscles 2.7).

    Parameters
    ----------
    source : TriMesh
        The source's skin, warped onto the target [mm].
    points : (n, 3) array_like
        The target's skin [mm].
    axis : (float, float)
        x and z of the cylinder's axis [mm].
    """
    queries = as_points("points", points)
    radial = queries - [axis[0], 0.0, axis[1]]
    radial[:, 1] = 0.0
    length = np.linalg.norm(radial, axis=1, keepdims=True)
    radial = np.where(length > 0.0, radial / np.maximum(length, 1e-300), [0.0, 0.0, 1.0])
    hits = Scene([source]).cast(queries, radial, both_directions=True)
    used = np.unique(source.faces)
    distance, row = cKDTree(source.positions[used]).query(queries)
    vertices = used[np.asarray(row)].astype(np.int32)
    size = float(np.ptp(source.positions, axis=0).max())
    cast = hits.hit & (np.asarray(distance) > _SAME * size)
    corners = source.faces[hits.face[cast]]
    apart = np.linalg.norm(source.positions[corners] - hits.positions[cast][:, None], axis=2)
    vertices[cast] = np.take_along_axis(corners, apart.argmin(axis=1)[:, None], axis=1)[:, 0]
    return RegionTransfer(vertices, ~hits.hit & (np.asarray(distance) > _SAME * size))


def transfer_regions(export: Export) -> RegionTransfer:
    """Return where the target's skin takes its regions from, through the warp of an export."""
    skin = export.source.skin.mesh
    warped = TriMesh(export.warp(skin.positions), skin.faces)
    left, right = (export.features[1].points[name] for name in ("head_left", "head_right"))
    middle = 0.5 * (left + right)
    axis = (float(middle[0]), float(middle[2]))
    return nearest_corners(warped, export.target.skin.mesh.positions, axis=axis)


def split_lips(regions: Regions, *, upper: BoolArray, lower: BoolArray) -> Regions:
    """Return the regions with both lips on their own side: nearest corners mix them up (E10).

    Lips are mobile as well: a ray may have met the lining of the mouth, which is not.

    Parameters
    ----------
    regions : Regions
        Of n vertices.
    upper, lower : (n,) bool
        Vertices that belong to the upper lip, and to the lower one.
    """
    weights: FloatArray = regions.weights.copy()
    both = weights[:, _LOWER] + weights[:, _MIDDLE]
    weights[upper, _MIDDLE], weights[upper, _LOWER] = both[upper], 0.0
    weights[lower, _LOWER], weights[lower, _MIDDLE] = both[lower], 0.0
    return Regions(weights, np.where(upper | lower, 1.0, regions.mobility))
