"""What the viewport shows: meshes in groups, and where their vertices are in a pose."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray
from risorius.anatomy.jaw import JawPose
from risorius.controls.control import Pose, resolve_pose
from risorius.head.head import Head
from risorius.head.part import Part
from risorius.layered.faithful import FaithfulFace
from risorius.layered.muscle_shapes import MuscleShapes
from risorius.mesh.core import TriMesh
from risorius.render.colours import display_rgb
from risorius.render.materials import colour_of_material, eye_paint
from risorius.springmuscle.face import SpringFace
from risorius.studio.drawing.faithful_bodies import FaithfulBodies
from risorius.studio.drawing.spring_bodies import SpringBodies
from risorius.studio.drawing.vector_bodies import vector_bodies
from risorius.studio.subject import Subject

__all__ = ["GROUPS", "SceneMesh", "Stage", "stage_of"]

GROUPS = ("skin", "parts", "skull", "muscles")
"""Groups that a person shows and hides, in the order in which they are drawn."""

# Triangles of single hairs are narrower than this [mm]; cards of many are drawn as a shade.
_HAIR, _CARDS = 0.6, 0.12
_BONE, _BELLY, _TENDON = "#d9cfba", "#a3423c", "#d8b49c"


@dataclass(frozen=True, eq=False)
class SceneMesh:
    """One mesh of the viewport.

    Parameters
    ----------
    name : str
        Part kind, bone, or muscle with side.
    group : str
        One of `GROUPS`.
    mesh : TriMesh
        At rest, canonical frame [mm].
    colour : (n, 3) uint8
        sRGB of every vertex.
    solid : float
        How solid it is beside its group, 0..1.
    """

    name: str
    group: str
    mesh: TriMesh
    colour: npt.NDArray[np.uint8]
    solid: float = 1.0


@dataclass(frozen=True, eq=False)
class Stage:
    """All meshes of a subject and the way to pose them.

    Parameters
    ----------
    subject : Subject
    meshes : tuple of SceneMesh
    """

    subject: Subject
    meshes: tuple[SceneMesh, ...]
    _shapes: MuscleShapes | FaithfulBodies | SpringBodies | None

    def mesh(self, name: str) -> SceneMesh | None:
        """Return the mesh called `name`, or None."""
        return next((each for each in self.meshes if each.name == name), None)

    def rest(self, name: str) -> FloatArray:
        """Return the vertices (k, 3) at rest of the mesh called `name` [mm]."""
        found = self.mesh(name)
        assert found is not None
        return found.mesh.positions

    @property
    def lasting(self) -> tuple[SceneMesh, ...]:
        """All meshes but the muscles, which change as they are drawn."""
        return tuple(each for each in self.meshes if each.group != "muscles")

    def posed(self, pose: Pose, positions: FloatArray, groups: set[str]) -> dict[str, FloatArray]:
        """Return the vertices (k, 3) of the meshes of some groups, by name [mm].

        Parameters
        ----------
        pose : Pose
        positions : (n, 3) float64
            Input vertices of the head in that pose [mm].
        groups : set of str
        """
        subject, result = self.subject, dict[str, FloatArray]()
        for kind, part in subject.head.parts.items():
            if ("skin" if kind == "skin" else "parts") in groups:
                result[kind] = positions[part.first_source()]
        if "skull" in groups:
            values = resolve_pose(subject.face.controls, pose).values
            jaw = JawPose(*(values.get(f"jaw_{n}", 0.0) for n in ("pitch", "yaw", "protrusion")))
            result["mandible"] = subject.mechanics.jaw.move(self.rest("mandible"), jaw)
        if "muscles" in groups:
            if isinstance(self._shapes, MuscleShapes):
                result |= self._shapes.posed(pose, positions)
            elif self._shapes is not None:
                result |= self._shapes.posed(pose)
        return result


def stage_of(subject: Subject, before: Stage | None = None) -> Stage:
    """Return the stage of a subject; meshes of the same head are those of `before`."""
    if before is not None and before.subject.head is subject.head:
        kept = tuple(each for each in before.meshes if each.group in ("skin", "parts"))
    else:
        head = subject.head
        kept = tuple(_part_mesh(head, kind, part) for kind, part in head.parts.items())
    kept += tuple(_bone_mesh(name, bone, before) for name, bone in _bones(subject).items())
    shapes = None
    bodies: Mapping[str, TriMesh] = {}
    if subject.bench is not None:
        shapes = MuscleShapes.of(subject.bench.face, subject.space)
        bodies = shapes.meshes
    elif isinstance(subject.face, FaithfulFace):
        shapes = FaithfulBodies.of(subject.face)
        bodies = shapes.meshes
    elif isinstance(subject.face, SpringFace):
        shapes = SpringBodies.of(subject.face)
        bodies = shapes.meshes
    elif subject.vector_face is not None:
        bodies = vector_bodies(subject.vector_face)
    muscles = tuple(
        SceneMesh(name, "muscles", mesh, _muscle_colour(mesh)) for name, mesh in bodies.items()
    )
    return Stage(subject, kept + muscles, shapes)


def _bones(subject: Subject) -> dict[str, TriMesh]:
    """Return cranium and mandible as the muscles lie on them."""
    bones = {"cranium": subject.fitted.cranium, "mandible": subject.fitted.mandible}
    if not isinstance(subject.face, FaithfulFace):
        return bones
    anatomy = subject.face.muscles.anatomy
    first = {name: anatomy.surfaces[name].first for name in bones}
    return {
        name: bone.at(anatomy.positions[first[name] : first[name] + bone.vertex_count])
        for name, bone in bones.items()
    }


def _bone_mesh(name: str, bone: TriMesh, before: Stage | None) -> SceneMesh:
    known = before.mesh(name) if before is not None else None
    if known is not None and known.mesh is bone:
        return known
    return SceneMesh(name, "skull", bone, _flat(_BONE, bone.vertex_count))


def _part_mesh(head: Head, kind: str, part: Part) -> SceneMesh:
    group = "skin" if kind == "skin" else "parts"
    solid = _CARDS if kind.startswith("lashes") and _has_cards(part.mesh) else 1.0
    return SceneMesh(kind, group, part.mesh, _part_colour(head, kind, part), solid)


def _has_cards(mesh: TriMesh) -> bool:
    """Tell whether lashes are cards that a texture would cut into hairs."""
    a, b, c = (mesh.positions[mesh.faces[:, corner]] for corner in range(3))
    sides = np.stack([np.linalg.norm(edge, axis=1) for edge in (b - a, c - b, a - c)])
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    return float(np.median(area / np.maximum(sides.max(axis=0), 1e-9))) > _HAIR


def _part_colour(head: Head, kind: str, part: Part) -> npt.NDArray[np.uint8]:
    """Return the colour of every vertex: of its materials, or of the part as a whole."""
    mesh = head.source
    names = mesh.materials.names
    if not len(mesh.materials.of_polygon) or kind.startswith(("teeth", "tongue", "gums", "lashes")):
        return _plain(kind, part)
    tones = np.array([colour_of_material(name) for name in names])
    unknown = np.array(colour_of_material(""))
    if (tones == unknown).all():
        return _plain(kind, part)
    tones[(tones == unknown).all(axis=1)] = colour_of_material(kind)
    table = np.full(mesh.vertex_count, -1, np.int32)
    table[part.source] = part.welded
    corners = table[mesh.triangles]
    material = mesh.materials.of_polygon[mesh.triangle_polygon]
    rows = (corners >= 0).all(axis=1) & (material >= 0)
    total = np.zeros((part.vertex_count, 3))
    count = np.zeros(part.vertex_count)
    for corner in range(3):
        np.add.at(total, corners[rows, corner], tones[material[rows]])
        np.add.at(count, corners[rows, corner], 1.0)
    plain = np.array(colour_of_material(kind))
    mean = np.where(count[:, None] > 0, total / np.maximum(count, 1.0)[:, None], plain)
    return display_rgb(mean)


def _plain(kind: str, part: Part) -> npt.NDArray[np.uint8]:
    if kind.startswith("eye_") and part.vertex_count >= 12:
        direction, ramp = eye_paint(part.mesh.positions)
        angle = np.degrees(np.arccos(np.clip(direction[:, 2], -1.0, 1.0)))
        return display_rgb(ramp[np.minimum(4.0 * angle, len(ramp) - 1).astype(int)])
    colour = np.array(colour_of_material("brow" if kind == "attached" else kind))
    return np.broadcast_to(display_rgb(colour), (part.vertex_count, 3)).copy()


def _flat(code: str, count: int) -> npt.NDArray[np.uint8]:
    return np.tile(_rgb(code).astype(np.uint8), (count, 1))


def _rgb(code: str) -> FloatArray:
    return np.array([int(code[at : at + 2], 16) for at in (1, 3, 5)], np.float64)


def _muscle_colour(mesh: TriMesh) -> npt.NDArray[np.uint8]:
    """Return red bellies with light ends, as tendons are."""
    points = mesh.positions
    centred = points - points.mean(axis=0)
    axis = np.linalg.svd(centred[:: max(len(points) // 64, 1)], full_matrices=False)[2][0]
    along = centred @ axis
    share = np.abs(along) / max(float(np.abs(along).max()), 1e-9)
    tendon = np.clip((share - 0.72) / 0.28, 0.0, 1.0)[:, None] ** 1.5
    grain = 1.0 + 0.07 * np.where(np.arange(len(points)) % 2, 1.0, -1.0)[:, None]
    colour = ((1.0 - tendon) * _rgb(_BELLY) + tendon * _rgb(_TENDON)) * grain
    return np.clip(colour, 0, 255).astype(np.uint8)
