"""Bones and muscles of one skull as one set of surfaces, laid on one another in layers."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np

from risorius._check import FloatArray, IntArray
from risorius.anatomy.outwards import outwards, unit
from risorius.anatomy.skull import Skull
from risorius.anatomy.template import builtin_head
from risorius.errors import ShapeError
from risorius.layered.faithful.action_line import Ground
from risorius.layered.faithful.muscle_mesh import MuscleMesh, box_mesh, ring_mesh
from risorius.layered.faithful.parameters import FaithfulParameters
from risorius.layered.faithful.sheet import SheetLines, lay_sheet
from risorius.layered.faithful.sphincter import RingLines, lay_ring
from risorius.layered.muscle import Muscle, Ring, Sheet
from risorius.layered.muscle_map import MuscleMap
from risorius.mesh.normals import vertex_normals

__all__ = ["Anatomy", "LaidMuscle", "Surface", "lay_anatomy", "lay_muscle", "rebuilt"]


@dataclass(frozen=True, eq=False)
class Surface:
    """Part of the surfaces of an anatomy.

    Parameters
    ----------
    name : str
    first, last : int
        Its vertices are first to last - 1.
    rows : (k,) int32
        Its faces.
    """

    name: str
    first: int
    last: int
    rows: IntArray


@dataclass(frozen=True, eq=False)
class LaidMuscle:
    """One muscle of one side, laid on what lies beneath.

    Parameters
    ----------
    name : str
        With its side.
    control : str
        What contracts it; empty for passive tissue.
    muscle : Muscle
    lines : SheetLines or RingLines
    mesh : MuscleMesh
    surface : Surface
    """

    name: str
    control: str
    muscle: Muscle
    lines: SheetLines | RingLines
    mesh: MuscleMesh
    surface: Surface


@dataclass(eq=False)
class Anatomy:
    """All surfaces at rest.

    Parameters
    ----------
    positions : (n, 3) float64
        Vertices of bones, then of muscles from deep to superficial [mm].
    faces : (m, 3) int32
    surfaces : dict of str to Surface
    muscles : list of LaidMuscle
        Deep before superficial.
    """

    positions: FloatArray = field(default_factory=lambda: np.zeros((0, 3)))
    faces: IntArray = field(default_factory=lambda: np.zeros((0, 3), np.int32))
    surfaces: dict[str, Surface] = field(default_factory=dict[str, Surface])
    muscles: list[LaidMuscle] = field(default_factory=list[LaidMuscle])

    def add(self, name: str, positions: FloatArray, faces: IntArray) -> Surface:
        """Append a surface; pieces added under one name one after the other are one."""
        first, row = len(self.positions), len(self.faces)
        self.positions = np.concatenate([self.positions, positions])
        self.faces = np.concatenate([self.faces, faces + np.int32(first)]).astype(np.int32)
        rows = np.arange(row, len(self.faces), dtype=np.int32)
        known = self.surfaces.get(name)
        if known is not None:
            first, rows = known.first, np.concatenate([known.rows, rows])
        surface = Surface(name, first, len(self.positions), rows)
        self.surfaces[name] = surface
        return surface

    def rows_of(self, names: tuple[str, ...]) -> IntArray:
        """Return the faces (k,) of some surfaces."""
        return np.concatenate([self.surfaces[name].rows for name in names])

    @property
    def layers(self) -> list[list[LaidMuscle]]:
        """Muscles by layer, deep before superficial."""
        numbers = sorted({laid.muscle.layer for laid in self.muscles})
        return [[m for m in self.muscles if m.muscle.layer == number] for number in numbers]

    def supports(self) -> dict[str, set[str]]:
        """Return by muscle all bones and muscles that its lines have points on, or theirs have."""
        owner = np.empty(len(self.faces), object)
        for name, surface in self.surfaces.items():
            owner[surface.rows] = name
        result: dict[str, set[str]] = {}
        for laid in self.muscles:
            found = {str(owner[f]) for line in laid.lines.drawn for f in line.points.faces}
            result[laid.name] = found.union(*(result.get(name, set()) for name in found))
        return result


def lay_anatomy(muscle_map: MuscleMap, skull: Skull, parameters: FaithfulParameters) -> Anatomy:
    """Lay every muscle of a map on a skull, deep before superficial.

    Parameters
    ----------
    muscle_map : MuscleMap
    skull : Skull
        In the canonical frame of the built-in head.
    parameters : FaithfulParameters
    """
    anatomy = Anatomy()
    for name, meshes in skull.surfaces.items():
        for mesh in meshes:
            anatomy.add(name, mesh.positions, mesh.faces)
    frame = builtin_head().frame

    def carried(points: FloatArray) -> FloatArray:
        place = frame.to_canonical(points)
        return place if skull.carry is None else skull.carry(place)

    for muscle in muscle_map.muscles:
        sides = (("_l", muscle), ("_r", muscle.mirrored())) if muscle.mirror else (("", muscle),)
        for side, drawn in sides:
            control = "" if not muscle.active else muscle.name
            if control and side and not muscle.together:
                control += side
            lay_muscle(anatomy, drawn, side, control=control, parameters=parameters, carry=carried)
    return anatomy


def lay_muscle(
    anatomy: Anatomy,
    muscle: Muscle,
    side: str,
    *,
    control: str,
    parameters: FaithfulParameters,
    carry: Callable[[FloatArray], FloatArray] | None = None,
) -> LaidMuscle:
    """Lay one muscle on what `anatomy` holds and append it.

    Parameters
    ----------
    anatomy : Anatomy
    muscle : Muscle
        Already mirrored for the right side.
    side : str
        ``"_l"``, ``"_r"`` or empty.
    control : str
        What contracts it; empty for passive tissue.
    parameters : FaithfulParameters
    carry : callable, optional
        From the map's space (q, 3) to that of the anatomy (q, 3).

    Raises
    ------
    ShapeError
        If one of its lines is no line, or its contour is open or crosses itself.
    MeshError
        If it encloses nothing.
    """
    name = muscle.name + side
    names = [
        full
        for base in muscle.on
        for full in (base, base + side, *((base + "_l", base + "_r") if not side else ()))
        if full in anatomy.surfaces
    ]
    direction = muscle.shape.direction if isinstance(muscle.shape, Sheet) else None

    def out(points: FloatArray) -> FloatArray:
        if direction is None:
            return outwards(points)
        return np.broadcast_to(unit(direction), points.shape)

    rows = anatomy.rows_of(tuple(dict.fromkeys(names)))
    ground = Ground(anatomy.positions, anatomy.faces, rows, out, parameters)
    moved = carry or (lambda points: points)
    lines, mesh = _laid(muscle, name, ground, moved)
    places = muscle_places(anatomy, lines, rows, muscle.thickness)
    mesh = mesh.outwards(places, name=name)
    surface = anatomy.add(name, places, mesh.faces)
    laid = LaidMuscle(name, control, muscle, lines, mesh, surface)
    anatomy.muscles.append(laid)
    return laid


def _laid(
    muscle: Muscle, name: str, ground: Ground, carry: Callable[[FloatArray], FloatArray]
) -> tuple[SheetLines | RingLines, MuscleMesh]:
    """Return lines and mesh of a muscle; a refusal names it."""
    shape, p = muscle.shape, ground.parameters
    try:
        if isinstance(shape, Ring):
            centre = carry(np.asarray(shape.centre, np.float64)[None])[0]
            ring = lay_ring(shape, centre, ground, sections=muscle.sections)
            return ring, ring_mesh(ring.rows, ring.columns, p.ring)
        sheet = lay_sheet(shape, carry(shape.line), ground, sections=muscle.sections)
    except ShapeError as error:
        raise ShapeError(f"muscle {name}: {error}") from error
    return sheet, box_mesh(sheet.rows, sheet.columns, p.sheet)


def muscle_places(
    anatomy: Anatomy, lines: SheetLines | RingLines, rows: IntArray, thickness: float
) -> FloatArray:
    """Return bottom and top vertices (2*h*w, 3) of a muscle at rest [mm].

    Parameters
    ----------
    anatomy : Anatomy
    lines : SheetLines or RingLines
    rows : (k,) int32
        Faces of what lies beneath.
    thickness : float
        [mm].
    """
    positions, faces = anatomy.positions, anatomy.faces
    # Normals are asked for on the lines alone, which touch few of the faces.
    touched = np.zeros(len(positions), bool)
    for line in lines.drawn:
        touched[faces[line.points.faces]] = True
    near = rows[touched[faces[rows]].any(axis=1)]
    normals = vertex_normals(positions, faces[near])
    bottom = lines.bottom(positions, faces)
    top = bottom + thickness * lines.upwards(positions, normals, faces)
    return np.concatenate([bottom, top])


def rebuilt(anatomy: Anatomy, bones: Mapping[str, FloatArray], *, scale: float) -> Anatomy:
    """Return the anatomy on a fitted skull: surface points follow, muscles are built anew.

    Parameters
    ----------
    anatomy : Anatomy
    bones : mapping of str to (k, 3) float64
        Places of the vertices of every bone [mm].
    scale : float
        Thickness of every muscle over that of the map.
    """
    result = Anatomy(anatomy.positions.copy(), anatomy.faces.copy(), dict(anatomy.surfaces))
    for name, places in bones.items():
        surface = anatomy.surfaces[name]
        result.positions[surface.first : surface.last] = places
    for laid in anatomy.muscles:
        surface = laid.surface
        rows = np.arange(surface.rows[0], dtype=np.int32)
        places = muscle_places(result, laid.lines, rows, laid.muscle.thickness * scale)
        result.positions[surface.first : surface.last] = places
        result.muscles.append(laid)
    return result
