"""Muscles of the published face: the very meshes that are simulated."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from risorius._check import FloatArray
from risorius.controls.control import Pose
from risorius.layered.faithful import FaithfulFace
from risorius.mesh.core import TriMesh

__all__ = ["FaithfulBodies"]


@dataclass(frozen=True, eq=False)
class FaithfulBodies:
    """Bodies of all muscles of a published layered face.

    Parameters
    ----------
    face : FaithfulFace
    meshes : mapping of str to TriMesh
        At rest, by muscle and side; canonical frame [mm].
    """

    face: FaithfulFace
    meshes: Mapping[str, TriMesh]

    @staticmethod
    def of(face: FaithfulFace) -> FaithfulBodies:
        """Return the bodies of the muscles of `face`."""
        anatomy = face.muscles.anatomy
        meshes: dict[str, TriMesh] = {}
        for laid in anatomy.muscles:
            surface = laid.surface
            points = anatomy.positions[surface.first : surface.last]
            meshes[laid.name] = TriMesh(points, anatomy.faces[surface.rows] - surface.first)
        return FaithfulBodies(face, meshes)

    def posed(self, pose: Pose) -> dict[str, FloatArray]:
        """Return the vertices (k, 3) of every body where it has come to rest, by muscle [mm]."""
        places = self.face.muscle_positions(pose)
        return {
            laid.name: places[laid.surface.first : laid.surface.last]
            for laid in self.face.muscles.anatomy.muscles
        }
