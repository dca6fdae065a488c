"""Spring muscles as they are computed: ellipsoids along fibres, bulging as they contract."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from risorius._check import FloatArray, IntArray
from risorius.anatomy.jaw import JawPose
from risorius.controls.control import Pose, resolve_pose
from risorius.mesh.core import TriMesh
from risorius.springmuscle.contraction import Contracted, Contraction
from risorius.springmuscle.face import SpringFace

__all__ = ["SpringBodies", "contracted"]


@dataclass(frozen=True, eq=False)
class SpringBodies:
    """Bodies of all muscles of a spring face.

    Parameters
    ----------
    face : SpringFace
    meshes : mapping of str to TriMesh
        At rest, by muscle; canonical frame [mm].
    """

    face: SpringFace
    meshes: Mapping[str, TriMesh]
    _contraction: Contraction
    _local: FloatArray

    @staticmethod
    def of(face: SpringFace) -> SpringBodies:
        """Return the bodies of the muscles of `face`."""
        sphere, faces = _sphere()
        local = face.muscles.half_axes[:, None, :] * sphere
        bare = SpringBodies(face, {}, Contraction(face.muscles), local)
        places = bare.posed({})
        meshes = {
            name: TriMesh(points, _repeated(faces, points)) for name, points in places.items()
        }
        return SpringBodies(face, meshes, bare._contraction, local)

    def posed(self, pose: Pose) -> dict[str, FloatArray]:
        """Return the vertices (k, 3) of every body in a pose, by muscle [mm]."""
        muscles, now = self.face.muscles, contracted(self.face, pose, self._contraction)
        placed = now.centres[:, None] + np.einsum("sij,svj->svi", now.axes, self._local)
        return {
            muscle.name: placed[muscles.segment_muscle == number].reshape(-1, 3)
            for number, muscle in enumerate(muscles.muscles)
        }


def contracted(face: SpringFace, pose: Pose, contraction: Contraction | None = None) -> Contracted:
    """Return the muscles of a face in a pose; `contraction` is theirs, if it is known already."""
    values = resolve_pose(face.controls, pose).values
    jaw = JawPose(*(values.get(f"jaw_{n}", 0.0) for n in ("pitch", "yaw", "protrusion")))
    points, aims = face.muscles.moved_with_jaw(face.mechanics.jaw, jaw)
    way = contraction or Contraction(face.muscles)
    return way(face.muscles.contractions(values), points=points, aims=aims)


def _sphere() -> tuple[FloatArray, IntArray]:
    """Return an icosahedron: vertices (12, 3) and faces (20, 3)."""
    ratio = 0.5 * (1.0 + 5.0**0.5)
    corners = [
        np.roll([0.0, a, b * ratio], turn)
        for turn in range(3)
        for a in (-1.0, 1.0)
        for b in (-1.0, 1.0)
    ]
    points = np.array(corners) / np.hypot(1.0, ratio)
    near = np.linalg.norm(points[:, None] - points, axis=2) < 1.1
    faces: list[list[int]] = []
    for a in range(12):
        for b in range(a + 1, 12):
            for c in range(b + 1, 12):
                if near[a, b] and near[b, c] and near[a, c]:
                    outside = np.dot(
                        np.cross(points[b] - points[a], points[c] - points[a]), points[a]
                    )
                    faces.append([a, b, c] if outside > 0.0 else [a, c, b])
    return points, np.array(faces, np.int32)


def _repeated(faces: IntArray, points: FloatArray) -> IntArray:
    """Return the faces (m, 3) of as many spheres as `points` (k, 3) hold."""
    starts = 12 * np.arange(len(points) // 12)
    return (faces[None] + starts[:, None, None]).reshape(-1, 3).astype(np.int32)
