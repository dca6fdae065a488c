"""Contact of the posed skin with teeth and eyeballs, of lips with lips, of lining with skin."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_matrix
from scipy.spatial import cKDTree

from risorius._check import BoolArray, FloatArray, IntArray
from risorius.anatomy.jaw import JawPose
from risorius.anatomy.kernels.hull_push import hull_shortfall
from risorius.anatomy.lining_contact import LiningContact
from risorius.anatomy.lip_contact import LipContact
from risorius.anatomy.mechanics import Mechanics
from risorius.anatomy.outwards import unit
from risorius.anatomy.radial_surface import RadialSurface
from risorius.anatomy.skin import Skin
from risorius.anatomy.skull_fit import MIRROR
from risorius.anatomy.unfolding import Unfolding
from risorius.head.head import Head
from risorius.mesh.connectivity import edges
from risorius.spatial.hull import convex_hull

__all__ = ["Contact"]

# Lips and cheeks over the teeth keep this share of their thickness, up to so thick [mm].
_LEFT, _THICKEST = 0.35, 10.0
# Skin that was farther from the teeth keeps at least this distance [mm].
_CLEAR = 0.3
# Skin within this distance of the mouth's middle may meet teeth [mm].
_REACH = 55.0
_ROUNDS, _PASSES, _GAIN = 4, 8, 1.3
_DEEPEST = 8.0
# What is left of a penetration is taken away vertex by vertex [mm].
_SLIGHT = 0.05
# Planes that face backwards more than this push nothing.
_BACK = -0.2
_EYE_CLEAR = 0.15
# Gums this near to teeth support the lips as well [mm].
_GUMS = 6.0


@dataclass(frozen=True, eq=False)
class _Arch:
    """One convex hull of teeth and the skin that may meet it."""

    planes: FloatArray
    offsets: FloatArray
    push: FloatArray
    least: FloatArray
    middle_least: FloatArray
    box: FloatArray

    def shortfall(self, points: FloatArray, *, middles: bool = False) -> FloatArray:
        """Return how far (q, 3) points, or middles of sides, must move to be clear of the hull."""
        result = np.empty_like(points)
        least = self.middle_least if middles else self.least
        hull_shortfall(
            points, self.planes, self.offsets, self.push, least, self.box, _DEEPEST, result
        )
        return result


@dataclass(frozen=True, eq=False)
class _Eye:
    side: str
    vertices: IntArray
    centre: FloatArray
    surface: RadialSurface
    least: FloatArray


@dataclass(frozen=True, eq=False)
class Contact:
    """What the posed skin may not run into, bound to one head.

    Parameters
    ----------
    skin : Skin
    mechanics : Mechanics
    vertices : (k,) int32
        Skin vertices that may meet teeth.
    average : (k, k) sparse
        Mean over the neighbours among them.
    shown : (k,) bool
        Which of them can be seen; the hidden ones are not pushed.
    sides : (e, 2) int32
        Edges between seen ones, numbered among them; their middles meet teeth as well.
    arches : mapping
        Upper and lower teeth.
    eyes : tuple
        Eyeballs and the skin round them.
    lips : LipContact
    lining : LiningContact
    folds : Unfolding
    """

    skin: Skin
    mechanics: Mechanics
    vertices: IntArray
    average: csr_matrix
    shown: BoolArray
    sides: IntArray
    arches: Mapping[str, _Arch]
    eyes: tuple[_Eye, ...]
    lips: LipContact
    lining: LiningContact
    folds: Unfolding

    @staticmethod
    def build(skin: Skin, mechanics: Mechanics) -> Contact:
        """Bind the teeth, eyeballs and lips of one head."""
        middle = skin.mouth.line[np.argmin(np.abs(skin.mouth.place))]
        away = skin.even(np.linalg.norm(skin.positions - middle, axis=1))
        near = away < _REACH * skin.scale
        shown = ~skin.hidden | (mechanics.lips.inside & (mechanics.lips.distance < 8.0))
        vertices = np.flatnonzero(near & (skin.mass > 1e-9)).astype(np.int32)
        sides = _sides(skin, vertices, shown)
        arches = {
            kind: _arch(_teeth_and_gums(mechanics.head, kind), skin, vertices, sides)
            for kind in ("teeth_upper", "teeth_lower")
            if kind in mechanics.head.parts
        }
        eyes = tuple(
            _eye(side, skin, lids.centre, lids.surface)
            for side, lids in mechanics.lids.items()
            if lids.surface is not None
        )
        return Contact(
            skin,
            mechanics,
            vertices,
            csr_matrix(skin.average[vertices][:, vertices]),
            shown[vertices],
            sides,
            arches,
            eyes,
            LipContact.build(skin, mechanics.lips),
            LiningContact.build(skin, mechanics.lips),
            Unfolding.build(skin),
        )

    def resolve(self, moved: FloatArray, values: Mapping[str, float]) -> FloatArray:
        """Return the displacement (n, 3) [mm] of the skin without what ran into something.

        Parameters
        ----------
        moved : (n, 3) float64
            Displacement of the posed skin [mm].
        values : mapping of str to float
            Resolved controls; the jaw's carry the lower teeth.
        """
        moved = self.folds.relieve(self.lips.part(moved))
        for kind, arch in self.arches.items():
            jaw = self._jaw(values) if kind == "teeth_lower" else None
            moved = self._clear_teeth(moved, arch, jaw)
        for eye in self.eyes:
            yaw = values.get(f"gaze_yaw_{eye.side}", 0.0)
            pitch = values.get(f"gaze_pitch_{eye.side}", 0.0)
            moved = self._clear_eye(moved, eye, yaw=yaw, pitch=pitch)
        return self.lining.hold_back(moved)

    def _jaw(self, values: Mapping[str, float]) -> tuple[FloatArray, FloatArray] | None:
        """Return rotation (3, 3) and shift (3,) of the jaw, None at rest."""
        pose = JawPose(
            values.get("jaw_pitch", 0.0),
            values.get("jaw_yaw", 0.0),
            values.get("jaw_protrusion", 0.0),
        )
        if pose.at_rest:
            return None
        frame = self.mechanics.jaw.move(np.vstack([np.zeros(3), np.eye(3)]), pose)
        return (frame[1:] - frame[0]).T, frame[0]

    def _clear_teeth(
        self, moved: FloatArray, arch: _Arch, jaw: tuple[FloatArray, FloatArray] | None
    ) -> FloatArray:
        rest = self.skin.positions[self.vertices]
        for number in range(_ROUNDS):
            points = rest + moved[self.vertices]
            if jaw is not None:
                points = (points - jaw[1]) @ jaw[0]
            push = self._with_sides(arch.shortfall(points) * self.shown[:, None], arch, points)
            deepest = float(np.abs(push).max(initial=0.0))
            if deepest == 0.0:
                break
            if jaw is not None:
                push = push @ jaw[0].T
            last = number == _ROUNDS - 1 or deepest < _SLIGHT
            if not last:
                # The skin around gives way too, so that no single vertex sticks out.
                for _ in range(_PASSES):
                    push = self.average @ push
                push = _GAIN * push
            moved = moved.copy()
            moved[self.vertices] += push
            if last:
                break
        return moved

    def _with_sides(self, push: FloatArray, arch: _Arch, points: FloatArray) -> FloatArray:
        """Return pushes (k, 3) that also clear the middles of the sides.

        A vertex moves as far as the farthest of its middles and it itself must, in their mean
        direction by how far, which no order of theirs changes.
        """
        first, second = self.sides.T
        middle = arch.shortfall(0.5 * (points[first] + points[second]), middles=True)
        size = np.sqrt((middle * middle).sum(axis=1))
        hit = size > 0.0
        if not hit.any():
            return push
        own = np.sqrt((push * push).sum(axis=1))
        farthest, total = own.copy(), own[:, None] * push
        for end in (first[hit], second[hit]):
            np.maximum.at(farthest, end, size[hit])
            np.add.at(total, end, size[hit, None] * middle[hit])
        length = np.sqrt((total * total).sum(axis=1))
        return total * (farthest / np.maximum(length, 1e-12))[:, None]

    def _clear_eye(self, moved: FloatArray, eye: _Eye, *, yaw: float, pitch: float) -> FloatArray:
        """Lift lids off the eyeball; the cornea of a turned eye raises them."""
        travel = moved[eye.vertices]
        turned = yaw != 0.0 or pitch != 0.0
        if not turned and not travel.any():
            return moved
        arm = self.skin.positions[eye.vertices] + travel - eye.centre
        distance = np.linalg.norm(arm, axis=1)
        surface = eye.surface.radius(arm, yaw=yaw, pitch=pitch)
        lift = np.maximum(surface + eye.least - distance, 0.0)
        if not turned:
            lift[~travel.any(axis=1)] = 0.0
        if not lift.any():
            return moved
        moved = moved.copy()
        moved[eye.vertices] += arm * (lift / np.maximum(distance, 1e-9))[:, None]
        return moved


def _teeth_and_gums(head: Head, kind: str) -> FloatArray:
    """Return the teeth of one arch and the gums beside them (k, 3)."""
    teeth = head.parts[kind].mesh.positions
    gums = head.part("gums")
    if gums is None:
        return teeth
    distance = cKDTree(teeth).query(gums.mesh.positions)[0]
    return np.concatenate([teeth, gums.mesh.positions[np.asarray(distance) < _GUMS]])


def _sides(skin: Skin, vertices: IntArray, shown: BoolArray) -> IntArray:
    """Return the edges (e, 2) among `vertices` whose ends can both be seen."""
    place = np.full(len(skin.positions), -1, np.int32)
    place[vertices] = np.arange(len(vertices), dtype=np.int32)
    place[~shown] = -1
    pairs = place[edges(skin.mesh.faces)]
    return np.ascontiguousarray(pairs[(pairs >= 0).all(axis=1)])


def _arch(teeth: FloatArray, skin: Skin, vertices: IntArray, sides: IntArray) -> _Arch:
    if skin.partner is not None:
        teeth = np.concatenate([teeth, teeth * MIRROR])
    rest = skin.positions
    hull = convex_hull(teeth)
    # Flat faces of the hull are split into triangles: one plane of each is enough.
    _, first = np.unique(
        np.column_stack([hull.plane_normals, hull.plane_offsets]).round(3),
        axis=0,
        return_index=True,
    )
    planes, offsets = hull.plane_normals[first], hull.plane_offsets[first]
    push = unit(planes * [1.0, 0.0, 1.0]) * (planes[:, 2:] > _BACK)
    own = (rest @ planes.T - offsets).max(axis=1)
    least = _least(skin.even(own)[vertices], own[vertices])
    middles = 0.5 * (rest[vertices[sides[:, 0]]] + rest[vertices[sides[:, 1]]])
    between = (middles @ planes.T - offsets).max(axis=1)
    # What a middle keeps between the ends' own shares is enough: it is there to catch bulges.
    middle_least = np.minimum(_CLEAR, between)
    reach = float(least.max(initial=0.0))
    box = np.stack([teeth.min(axis=0) - reach, teeth.max(axis=0) + reach])
    # Planes that face forwards first: they are most often the ones that count.
    order = np.argsort(-planes[:, 2], kind="stable")
    return _Arch(
        np.ascontiguousarray(planes[order]), offsets[order], push[order], least, middle_least, box
    )


def _least(height: FloatArray, own: FloatArray) -> FloatArray:
    """Return the heights (k,) over the teeth that skin keeps, from its heights at rest [mm]."""
    tissue = _LEFT * np.clip(height, 0.0, _THICKEST)
    # The skin at rest is never pushed.
    return np.minimum(np.maximum(np.minimum(height, _CLEAR), tissue), own)


def _eye(side: str, skin: Skin, centre: FloatArray, surface: RadialSurface) -> _Eye:
    arm = skin.positions - centre
    gap = np.linalg.norm(arm, axis=1) - surface.radius(arm)
    near = (gap < 8.0 * skin.scale) & (arm[:, 2] > 0.0) & ~skin.hidden
    vertices = np.flatnonzero(near).astype(np.int32)
    return _Eye(side, vertices, centre, surface, np.minimum(gap[vertices], _EYE_CLEAR))
