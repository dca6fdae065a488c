"""The skin as a network of springs: edges, springs to muscles and bones, what holds it."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
import numpy.typing as npt

from risorius._check import BoolArray, FloatArray, IntArray
from risorius.anatomy.mechanics import Mechanics
from risorius.anatomy.skin import Skin
from risorius.anatomy.smooth_step import smooth_step
from risorius.anatomy.support import support_directions
from risorius.errors import ParameterError
from risorius.mesh.boundary import boundary_loops
from risorius.mesh.connectivity import edges
from risorius.solvers.leapfrog import edge_forces
from risorius.solvers.spring_stiffness import edge_stiffness
from risorius.solvers.springs import SpringNetwork
from risorius.springmuscle.binding import bind_muscle
from risorius.springmuscle.bones import SkinBones
from risorius.springmuscle.lining import lining_pairs, sides_with_lids, touching_lips
from risorius.springmuscle.measure import FaceMeasure
from risorius.springmuscle.muscle import JAW
from risorius.springmuscle.muscle_set import MuscleSet
from risorius.springmuscle.parameters import SpringParameters
from risorius.springmuscle.surface import label_lips

__all__ = ["SkinSprings", "build_springs"]

# Springs that count by area have their plain stiffness at a vertex of so much skin [mm^2].
_AREA = 8.0
# Skin over a muscle that needs no reach; how far behind a lip's line skin still binds [mm].
_SKIN, _LINING = 2.0, 3.0
# Tissue holds lining this weakly, it goes with the skin.
_LINED = 0.005
# How much more strongly skin is held where it must be still, over a spring to a muscle.
_STILL = 20.0


def _no_pairs() -> IntArray:
    return np.zeros((0, 2), np.int32)


@dataclass(frozen=True, eq=False)
class SkinSprings:
    """The network of a skin with n vertices, and what its anchors hang on.

    The anchors of the network are, in this order: feet on muscles, their mirrored partners, feet
    on bones, their partners.

    Parameters
    ----------
    skin : Skin
    network : SpringNetwork
        With a load that balances the pretension.
    vertices, segments, muscles : (a,) int32
        Skin vertex, ellipsoid and muscle of each muscle spring.
    feet, partners : (a, 3) float64
        Foot and mirrored foot in the coordinates of the relaxed ellipsoid's frame [mm].
    rest_feet : (a, 3) float64
        The feet in space [mm].
    stiffness : (a,) float64
        Of each muscle spring while its muscle is active.
    shares : (a,) float64
        How fully each muscle spring takes part, 1 close to the muscle.
    bone_vertices : (b,) int32
    bone_feet : (b, 3) float64
        [mm].
    on_jaw : (b,) bool
    bone_stiffness : (c,) float64
        Of their springs, then of the partners if there are any.
    tissue : (n,) float64
        Stiffness of what draws the skin home, without grips.
    outwards : (n, 3) float64
        Unit normals of the bone and teeth beneath, smooth.
    across_count : int
        How many edges, the last ones, run from lining to the skin in front of it.
    seals : (q, 2) int32
        Vertices of the upper and the lower lip that touch.
    seal_stiffness : float
        Of springs that hold them together while a muscle that seals the lips pulls.
    """

    skin: Skin
    network: SpringNetwork
    vertices: IntArray
    segments: IntArray
    muscles: IntArray
    feet: FloatArray
    partners: FloatArray
    rest_feet: FloatArray
    stiffness: FloatArray
    shares: FloatArray
    bone_vertices: IntArray
    bone_feet: FloatArray
    on_jaw: BoolArray
    bone_stiffness: FloatArray
    tissue: FloatArray
    outwards: FloatArray
    across_count: int = 0
    seals: IntArray = field(default_factory=_no_pairs)
    seal_stiffness: float = 0.0

    def supported(self, moved: FloatArray, share: float) -> FloatArray:
        """Return displacements (n, 3) [mm] without a share of what goes inwards."""
        if share == 0.0:
            return moved
        inwards = np.minimum(np.einsum("nd,nd->n", moved, self.outwards), 0.0)
        return moved - (share * inwards)[:, None] * self.outwards

    @cached_property
    def sealed(self) -> SpringNetwork:
        """The network with the lips held together."""
        network, count = self.network, len(self.seals)
        k = np.full(count, self.seal_stiffness)
        return replace(
            network,
            edges=np.concatenate([network.edges, self.seals]),
            rest_lengths=np.concatenate([network.rest_lengths, np.zeros(count)]),
            stiffness=np.concatenate([network.stiffness, k]),
            knee_lengths=np.concatenate([network.knee_lengths, np.full(count, np.inf)]),
            load=network.load - self.seal_forces(self.skin.positions),
            mass=np.zeros(0),
        )

    def seal_forces(self, moved: FloatArray) -> FloatArray:
        """Return the forces (n, 3) between sealed lips displaced by `moved` (n, 3) [mm]."""
        upper, lower = self.seals.T
        pull = self.seal_stiffness * (moved[lower] - moved[upper])
        forces = np.zeros_like(moved)
        for axis in range(3):
            forces[:, axis] = np.bincount(upper, pull[:, axis], len(moved))
            forces[:, axis] -= np.bincount(lower, pull[:, axis], len(moved))
        return forces


def build_springs(
    skin: Skin,
    muscles: MuscleSet,
    attachment: SkinBones | None,
    mechanics: Mechanics,
    parameters: SpringParameters,
) -> SkinSprings:
    """Hang a skin on muscles and bones.

    Parameters
    ----------
    skin : Skin
    muscles : MuscleSet
        Fitted under it.
    attachment : SkinBones or None
        Which bone lies under each vertex, and where.
    mechanics : Mechanics
        Its lips and lids: a lip never hangs on the other's muscles.
    parameters : SpringParameters

    Raises
    ------
    ParameterError
        If the skin is to be held by bones and nothing is known of any.
    """
    p, positions = parameters, skin.positions
    if p.holding == "bone" and attachment is None:
        raise ParameterError("attachment: missing; these parameters hold the skin by bones")
    lips, sides = label_lips(mechanics.lips, FaceMeasure.of(mechanics.head.landmarks))
    pairs, k, unit, across_count = _edges(skin, sides_with_lids(sides, mechanics), p)
    length = np.linalg.norm(positions[pairs[:, 0]] - positions[pairs[:, 1]], axis=1)
    counted = _counted(skin, p) * unit
    bound = _bind(skin, muscles, lips, counted * p.muscle_stiffness, fall_off=p.fall_off)
    vertices, segments, numbers, feet, stiffness, shares = bound
    rest_feet = muscles.centres[segments] + np.einsum("nij,nj->ni", muscles.frames[segments], feet)
    mirrored = 2.0 * positions[vertices] - rest_feet - muscles.centres[segments]
    partners = np.einsum("nij,ni->nj", muscles.frames[segments], mirrored)
    bone_vertices, bone_stiffness = _bones(attachment, counted, p)
    bone_feet = np.zeros((0, 3)) if attachment is None else attachment.feet[bone_vertices]
    on_jaw = np.zeros(0, bool)
    if attachment is not None:
        on_jaw = attachment.bones[bone_vertices] == JAW
    tissue = _tissue(skin, attachment, counted, p)
    grips = np.bincount(vertices, p.grip * stiffness, len(positions))
    both = 2 if p.mirrors else 1
    reach = np.linalg.norm(positions[vertices] - rest_feet, axis=1)
    bone_reach = np.linalg.norm(positions[bone_vertices] - bone_feet, axis=1)
    outwards = support_directions(
        positions, hinge=mechanics.jaw.hinge, face_height=mechanics.head.height / 1.9
    )
    fixed = (skin.mobility <= 0.0) | (skin.mass <= 1e-9)
    fixed[_neck(skin)] = True
    network = SpringNetwork(
        positions, pairs, (1.0 - p.pretension) * length, k,
        knee_lengths=(1.0 + p.knee_strain) * length, stiffening=p.stiffening,
        anchored=np.concatenate([np.tile(vertices, both), np.tile(bone_vertices, both)]),
        anchor_lengths=np.concatenate([np.tile(reach, both), np.tile(bone_reach, both)]),
        anchor_stiffness=np.concatenate([np.tile(stiffness, both), np.tile(bone_stiffness, both)]),
        hold_stiffness=tissue + grips, fixed=fixed,
        mass=np.zeros(0) if p.masses == "stiffness" else np.ones(len(positions)),
    )  # fmt: skip
    network = replace(network, load=-edge_forces(network, positions))
    return SkinSprings(
        skin, network, vertices, segments, numbers, feet, partners, rest_feet, stiffness, shares,
        bone_vertices, bone_feet, on_jaw, np.tile(bone_stiffness, both), tissue,
        outwards, across_count, touching_lips(skin), p.seal * unit,
    )  # fmt: skip


def _edges(
    skin: Skin, sides: npt.NDArray[np.int8], p: SpringParameters
) -> tuple[IntArray, FloatArray, float, int]:
    """Return edges (e, 2), stiffness (e,), that of a plain edge, how many run through the skin."""
    pairs = edges(skin.mesh.faces)
    k = edge_stiffness(skin.mesh, pairs, least_length=p.least_length, least=p.least_stiffness)
    unit = float(np.median(k))
    soft = (skin.lids[pairs] > 0.0).all(axis=1)
    k = np.where(soft, p.lid_softness * k, k)
    if p.across == 0.0:
        return pairs, k, unit, 0
    through = lining_pairs(skin, sides)
    k = np.concatenate([k, np.full(len(through), p.across * unit)])
    return np.concatenate([pairs, through]), k, unit, len(through)


def _neck(skin: Skin) -> IntArray:
    """Return the rim (r,) of the neck, the lowest hole; it must not move (finding S9)."""
    loops = boundary_loops(skin.mesh.faces)
    if not loops:
        return np.zeros(0, np.int32)
    return min(loops, key=lambda loop: float(skin.positions[loop, 1].mean()))


def _counted(skin: Skin, p: SpringParameters) -> FloatArray:
    """Return how much (n,) of the skin each vertex stands for, 1 for a plain one."""
    if not p.by_area:
        return np.ones(len(skin.positions))
    return skin.mass / (_AREA * skin.scale**2)


def _bind(
    skin: Skin,
    muscles: MuscleSet,
    lips: npt.NDArray[np.int8],
    plain: FloatArray,
    *,
    fall_off: bool,
) -> tuple[IntArray, IntArray, IntArray, FloatArray, FloatArray, FloatArray]:
    """Return vertex, ellipsoid, muscle (a,), foot (a, 3), stiffness and share (a,) of springs."""
    # The lining of the mouth follows the lips, it is bound to no muscle but at their margin.
    open_skin = (~skin.hidden | (skin.mouth.distance < _LINING)) & (skin.lids < 1.0)
    strength = plain * skin.mobility * open_skin
    parts: list[tuple[IntArray, IntArray, IntArray, FloatArray, FloatArray, FloatArray]] = []
    for number, muscle in enumerate(muscles.muscles):
        found = bind_muscle(
            muscles, number, positions=skin.positions, normals=skin.normals, lips=lips
        )
        share = np.ones(len(found.vertices))
        if fall_off:
            beyond = (found.distances - _SKIN * skin.scale) / muscle.action.radius
            share = smooth_step(1.0 - beyond)
        stiffness = muscle.action.stiffness * share * strength[found.vertices]
        kept = stiffness > 0.0
        numbers = np.full(int(kept.sum()), number, np.int32)
        where = found.vertices[kept], found.segments[kept], numbers
        parts.append((*where, found.feet[kept], stiffness[kept], share[kept]))
    if not parts:
        none = np.zeros(0, np.int32)
        return none, none, none, np.zeros((0, 3)), np.zeros(0), np.zeros(0)
    vertices, segments, numbers, feet, stiffness, shares = (
        np.concatenate(column) for column in zip(*parts, strict=True)
    )
    return vertices, segments, numbers, feet, stiffness, shares


def _bones(
    attachment: SkinBones | None, counted: FloatArray, p: SpringParameters
) -> tuple[IntArray, FloatArray]:
    """Return the vertices (b,) that hang on bone and the stiffness (b,) of their springs."""
    if p.holding != "bone" or attachment is None:
        return np.zeros(0, np.int32), np.zeros(0)
    vertices = np.flatnonzero(attachment.bones > 0).astype(np.int32)
    on_jaw = attachment.bones[vertices] == JAW
    plain = np.where(on_jaw, p.jaw_stiffness, p.bone_stiffness)
    return vertices, plain * counted[vertices]


def _tissue(
    skin: Skin, attachment: SkinBones | None, counted: FloatArray, p: SpringParameters
) -> FloatArray:
    """Return the stiffness (n,) of what draws the skin home."""
    if p.holding == "bone":
        loose = np.ones(len(counted)) if attachment is None else attachment.bones == 0
        return p.home * counted * loose
    passive = np.where(skin.hidden, np.minimum(skin.passive, _LINED), skin.passive)
    still = _STILL * p.muscle_stiffness * (1.0 - skin.mobility) ** 2
    return (p.tissue * passive + still) * counted
