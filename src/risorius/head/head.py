"""The head: what a face is built on."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import numpy as np

from risorius import _formats
from risorius._check import FloatArray
from risorius.errors import MeshError
from risorius.head.find_parts import assign_parts
from risorius.head.frame import Frame, detect_frame
from risorius.head.part import Part
from risorius.head.weld_parts import build_parts
from risorius.landmarks.landmark_set import LandmarkSet, LandmarkSpec, resolve
from risorius.landmarks.sides import require_sides
from risorius.mesh.polygon_mesh import PolygonMesh

__all__ = ["Head", "HeadOptions"]


@dataclass(frozen=True)
class HeadOptions:
    """What a person may say about a head; everything left out is detected.

    Parameters
    ----------
    unit : str, optional
        Unit of the file (see `risorius.head.MILLIMETRES`).
    axes : str, optional
        Up and forward axis of the file, for example ``"+Y+Z"``.
    parts : mapping of str to str
        Part kind -> name of the object, group or material that is this part.
    flip_landmarks : bool
        Exchange left and right in the landmark names.
    """

    unit: str | None = None
    axes: str | None = None
    parts: Mapping[str, str] = field(default_factory=dict[str, str])
    flip_landmarks: bool = False


@dataclass(frozen=True, eq=False)
class Head:
    """A neutral head: parts, landmarks, frame.

    Parameters
    ----------
    source : PolygonMesh
        The input as read [file frame and unit].
    frame : Frame
        Way between the file's frame and the canonical one.
    parts : mapping of str to Part
        By kind; always has ``"skin"``.
    landmarks : LandmarkSet
        Named points; positions in the canonical frame [mm].
    """

    source: PolygonMesh
    frame: Frame
    parts: Mapping[str, Part]
    landmarks: LandmarkSet

    @cached_property
    def positions(self) -> FloatArray:
        """All input vertices (n, 3) in the canonical frame [mm]."""
        return self.frame.to_canonical(self.source.positions)

    @property
    def vertex_count(self) -> int:
        """Number of vertices of the input."""
        return self.source.vertex_count

    @property
    def skin(self) -> Part:
        """The skin."""
        return self.parts["skin"]

    def part(self, kind: str) -> Part | None:
        """Return the part of this kind, or None."""
        return self.parts.get(kind)

    def skin_vertex(self, landmark: str) -> int:
        """Return the vertex of the skin's mesh nearest to `landmark`."""
        wanted = self.landmarks.position(landmark)
        vertex = self.landmarks.vertex(landmark)
        found = self.skin.from_source([vertex], vertex_count=self.vertex_count)[0]
        if found >= 0:
            return int(found)
        distance = np.linalg.norm(self.skin.mesh.positions - wanted, axis=1)
        return int(np.argmin(distance))

    @cached_property
    def height(self) -> float:
        """Height of the face from chin to brow line, times 1.9: about the head's height [mm].

        A bounding box would be spoilt by a bust with shoulders.
        """
        chin = self.landmarks.position("2.1") if "2.1" in self.landmarks else None
        eyes = self.landmarks.positions(("3.7", "3.12")).mean(axis=0)
        if chin is None:
            return 230.0
        return 1.9 * float(np.linalg.norm(eyes - chin))

    @staticmethod
    def from_mesh(
        mesh: PolygonMesh,
        landmarks: Mapping[str, LandmarkSpec],
        *,
        options: HeadOptions | None = None,
    ) -> Head:
        """Build a head from a mesh and landmarks as they stand in their files.

        Raises
        ------
        LandmarkError
            If landmarks are missing, swapped or off the mesh.
        MeshError
            If the mesh has no faces or no part that can be the skin.
        """
        options = options or HeadOptions()
        if not len(mesh.triangles):
            raise MeshError("head: the file has vertices but no faces; export it with polygons")
        marks = resolve(landmarks, mesh)
        if options.flip_landmarks:
            marks = marks.flipped()
        marks = require_sides(marks)
        frame = detect_frame(marks, unit=options.unit, axes=options.axes)
        positions = frame.to_canonical(mesh.positions)
        canonical = marks.at(positions)
        kinds = assign_parts(mesh, positions, canonical, given=options.parts)
        parts = build_parts(mesh, positions, kinds, canonical)
        return Head(mesh, frame, parts, canonical)

    @staticmethod
    def load(
        path: str | Path,
        landmarks: str | Path | None = None,
        *,
        options: HeadOptions | None = None,
    ) -> Head:
        """Read a head and its landmarks.

        Parameters
        ----------
        path : path
            OBJ, PLY, STL, GLB or glTF file.
        landmarks : path, optional
            Landmark file; a GLB written by risorius carries its own.

        Raises
        ------
        FormatError
            If a file is missing or malformed.
        LandmarkError, MeshError
            As `from_mesh`.
        """
        mesh, carried = _formats.read_head(Path(path))
        specs = _formats.read_landmarks(Path(landmarks)) if landmarks is not None else carried
        return Head.from_mesh(mesh, specs, options=options)
