"""Teeth that the skin must stay in front of: convex hulls, the lower one moved by the jaw."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from risorius._check import FloatArray, IntArray
from risorius.anatomy.jaw import JawAxes, JawPose
from risorius.anatomy.mechanics import Mechanics
from risorius.solvers.constraints import Contacts
from risorius.spatial.hull import convex_hull

__all__ = ["Arch", "Teeth", "build_teeth"]

# Skin deeper than this inside a hull at rest does not touch it [built-in mm].
_DEEPEST = 3.0
# How far from the mouth, in its widths, skin may meet teeth.
_NEAR = 1.2
_EPSILON = 1e-9
_PUSHES = 3


@dataclass(frozen=True, eq=False)
class Arch:
    """The convex hull of one row of teeth.

    Parameters
    ----------
    normals : (f, 3) float64
        Unit outward normals of its planes.
    offsets : (f,) float64
        ``normals @ x <= offsets`` inside [mm].
    forward : (3,) float64
        Where skin leaves it.
    vertices : (k,) int32
        Skin that it touches.
    corners : (c, 3) float64
        Vertices of the hull, whose box tells quickly what is outside [mm].
    is_lower : bool
    """

    normals: FloatArray
    offsets: FloatArray
    forward: FloatArray
    vertices: IntArray
    corners: FloatArray
    is_lower: bool

    def moved(self, jaw: JawAxes, pose: JawPose) -> Arch:
        """Return the arch where the jaw takes it."""
        if not self.is_lower or pose.at_rest:
            return self
        feet = self.normals * self.offsets[:, None]
        placed = jaw.move(feet, pose)
        normals = jaw.move(feet + self.normals, pose) - placed
        ends = jaw.move(np.stack([np.zeros(3), self.forward]), pose)
        offsets = np.einsum("fd,fd->f", normals, placed)
        corners = jaw.move(self.corners, pose)
        return Arch(normals, offsets, ends[1] - ends[0], self.vertices, corners, True)

    def exits(self, points: FloatArray) -> tuple[FloatArray, IntArray]:
        """Return how far (q,) points are from leaving forwards, 0 outside, and by which plane."""
        distance, plane = np.zeros(len(points)), np.zeros(len(points), np.int32)
        low, high = self.corners.min(axis=0), self.corners.max(axis=0)
        near = np.flatnonzero(((points > low) & (points < high)).all(axis=1))
        below = self.offsets - points[near] @ self.normals.T
        inside = (below > 0.0).all(axis=1)
        near, below = near[inside], below[inside]
        rate = self.normals @ self.forward
        leaves = rate > _EPSILON
        travel = np.where(leaves, below / np.where(leaves, rate, 1.0), np.inf)
        plane[near] = travel.argmin(axis=1)
        distance[near] = travel.min(axis=1)
        return distance, plane

    def depth(self, positions: FloatArray) -> FloatArray:
        """Return how deep (k,) the skin that it touches lies inside, at most 0 outside [mm]."""
        return (self.offsets - positions[self.vertices] @ self.normals.T).min(axis=1)


@dataclass(frozen=True, eq=False)
class Teeth:
    """The rows of teeth that a head has."""

    arches: tuple[Arch, ...]

    def moved(self, jaw: JawAxes, pose: JawPose) -> Teeth:
        """Return them where the jaw takes them."""
        return Teeth(tuple(arch.moved(jaw, pose) for arch in self.arches))

    def contacts(self, positions: FloatArray) -> Contacts | None:
        """Return contacts for the skin (n, 3) that has got inside, None if none has."""
        rows: list[IntArray] = []
        points: list[FloatArray] = []
        normals: list[FloatArray] = []
        for arch in self.arches:
            places = positions[arch.vertices]
            distance, plane = arch.exits(places)
            inside = np.flatnonzero(distance > 0.0)
            rows.append(arch.vertices[inside])
            points.append(places[inside] + distance[inside, None] * arch.forward)
            normals.append(arch.normals[plane[inside]])
        if not sum(len(row) for row in rows):
            return None
        return Contacts(np.concatenate(rows), np.concatenate(points), np.concatenate(normals))

    def pushed_out(self, positions: FloatArray) -> FloatArray:
        """Return the skin (n, 3) with what is still inside put on the surface [mm]."""
        result = positions.copy()
        # Leaving one row may end in the other.
        for _ in range(_PUSHES):
            is_out = True
            for arch in self.arches:
                distance, _ = arch.exits(result[arch.vertices])
                result[arch.vertices] += distance[:, None] * arch.forward
                is_out &= not distance.any()
            if is_out:
                break
        return result


def build_teeth(mechanics: Mechanics, scale: float) -> Teeth:
    """Return the teeth of a head; hulls shrink until no skin lies inside at rest."""
    head, lips = mechanics.head, mechanics.lips
    positions = head.skin.mesh.positions
    middle = head.landmarks.positions(("2.2", "2.3")).mean(axis=0)
    near = np.linalg.norm(positions - middle, axis=1) < _NEAR * lips.width
    arches: list[Arch] = []
    for kind, forward in (
        ("teeth_upper", np.array([0.0, 0.0, 1.0])),
        ("teeth_lower", mechanics.jaw.forward),
    ):
        part = head.part(kind)
        if part is None:
            continue
        hull = convex_hull(part.mesh.positions)
        below = (hull.plane_offsets - positions @ hull.plane_normals.T).min(axis=1)
        touched = np.flatnonzero(near & (below < _DEEPEST * scale)).astype(np.int32)
        shrink = max(float(below[touched].max(initial=0.0)), 0.0) + 1e-6 * scale
        arches.append(
            Arch(
                hull.plane_normals,
                hull.plane_offsets - shrink,
                forward,
                touched,
                hull.mesh.positions,
                kind == "teeth_lower",
            )
        )
    return Teeth(tuple(arches))
