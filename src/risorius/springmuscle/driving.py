"""What a pose asks of the springs: where muscles, bones and jaw take their anchors."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree

from risorius._check import BoolArray, FloatArray
from risorius.anatomy.jaw import JawPose, rotate
from risorius.anatomy.mechanics import Mechanics
from risorius.solvers.leapfrog import edge_forces
from risorius.solvers.springs import SpringControl
from risorius.springmuscle.contraction import Contracted, Contraction
from risorius.springmuscle.parameters import SpringParameters
from risorius.springmuscle.skin import SkinSprings

__all__ = ["Drive", "Driver", "jaw_pose"]

# Skin vertices whose share of the jaw's motion a point of a muscle takes.
_NEAREST = 6


@dataclass(frozen=True, eq=False)
class Drive:
    """One pose, as the springs feel it.

    Parameters
    ----------
    control : SpringControl
    reference : (n, 3) float64
        Where the jaw alone would take the skin [mm].
    feet, partners : (a, 3) float64
        Displacement of the muscle springs' feet and partners beyond that of their skin [mm].
    activity : (a,) float64
        Stiffness of each muscle spring over that of an active muscle.
    contracted : Contracted
        The muscles.
    guess : (n, 3) float64
        Where the skin would be if every muscle moved it by what it does alone [mm]; the reference
        where that is not known.
    """

    control: SpringControl
    reference: FloatArray
    feet: FloatArray
    partners: FloatArray
    activity: FloatArray
    contracted: Contracted
    guess: FloatArray


def jaw_pose(values: Mapping[str, float]) -> JawPose:
    """Return where `values` put the jaw."""
    return JawPose(
        values.get("jaw_pitch", 0.0),
        values.get("jaw_yaw", 0.0),
        values.get("jaw_protrusion", 0.0),
    )


@dataclass(frozen=True, eq=False)
class Driver:
    """Turns controls into what the springs feel.

    Parameters
    ----------
    springs : SkinSprings
    contraction : Contraction
        Of the muscles.
    mechanics : Mechanics
    parameters : SpringParameters
    fields : mapping of str to (n, 3) float64
        Displacement of the skin by every muscle control alone at 1 [mm]; with them muscles ride
        on skin that others move.
    seals : mapping of str to (n, 3) float64
        Forces between the lips that belong to the fields of muscles that seal them.
    """

    springs: SkinSprings
    contraction: Contraction
    mechanics: Mechanics
    parameters: SpringParameters
    fields: Mapping[str, FloatArray] = field(default_factory=dict[str, FloatArray])
    seals: Mapping[str, FloatArray] = field(default_factory=dict[str, FloatArray])

    def drive(self, values: Mapping[str, float]) -> Drive:
        """Return what `values` ask for."""
        return self._carried(values) if self.parameters.carried else self._dragged(values)

    def reference(self, values: Mapping[str, float]) -> FloatArray:
        """Return where the skin (n, 3) is without muscles [mm]."""
        rest, jaw = self.springs.skin.positions, jaw_pose(values)
        if jaw.at_rest or not self.parameters.carried:
            return rest
        return self.mechanics.jaw.move(rest, jaw, share=self.mechanics.jaw_share)

    def uncarried(self, positions: FloatArray, values: Mapping[str, float]) -> FloatArray:
        """Return `positions` (n, 3) with the jaw's motion of the reference taken back [mm]."""
        jaw = jaw_pose(values)
        if jaw.at_rest or not self.parameters.carried:
            return positions
        axes, share = self.mechanics.jaw, self.mechanics.jaw_share
        points = positions - share[:, None] * (jaw.protrusion * axes.forward)
        for axis, angle in ((axes.yaw_axis, jaw.yaw), (axes.pitch_axis, jaw.pitch)):
            turn = -share * np.radians(angle)
            points = rotate(points, about=axes.hinge, axis=axis, angle=turn)
        return points

    def active(self, values: Mapping[str, float]) -> BoolArray:
        """Return which muscles (k,) contract."""
        return self.contraction.muscles.contractions(values) > 0.0

    def _carried(self, values: Mapping[str, float]) -> Drive:
        """The reference is carried by the jaw; contraction is felt relative to it."""
        springs, muscles = self.springs, self.contraction.muscles
        amounts = muscles.contractions(values)
        jaw = jaw_pose(values)
        reference = self.reference(values)
        base, pairs = springs.rest_feet, (springs.feet, springs.partners)
        if jaw.at_rest:
            contracted = self.contraction(amounts)
            relaxed = [base, 2.0 * springs.skin.positions[springs.vertices] - base]
        else:
            move, share = self.mechanics.jaw.move, self.mechanics.jaw_share
            base = move(base, jaw, share=share[springs.vertices])
            points = move(muscles.points, jaw, share=self._point_shares)
            aims = move(muscles.aims, jaw, share=self._aim_shares)
            contracted = self.contraction(amounts, points=points, aims=aims)
            still = self.contraction(np.zeros_like(amounts), points=points, aims=aims)
            relaxed = [still.positions(springs.segments, local) for local in pairs]
        feet, partners = (
            contracted.positions(springs.segments, local) - start
            for local, start in zip(pairs, relaxed, strict=True)
        )
        mirrored = 2.0 * reference[springs.vertices] - base
        return self._drive(
            (base + feet, mirrored + partners), (feet, partners), reference, values, contracted,
            jaw,
        )  # fmt: skip

    def _dragged(self, values: Mapping[str, float]) -> Drive:
        """Only muscles and bones move, as published."""
        springs, muscles = self.springs, self.contraction.muscles
        amounts = muscles.contractions(values)
        jaw = jaw_pose(values)
        rest = springs.skin.positions
        points, aims = muscles.moved_with_jaw(self.mechanics.jaw, jaw)
        contracted = self.contraction(amounts, points=points, aims=aims)
        feet = contracted.positions(springs.segments, springs.feet)
        partners = contracted.positions(springs.segments, springs.partners)
        # Where the skin starts: with the jaw, as far as it is known to follow (finding S9).
        start = self.mechanics.jaw.move(rest, jaw, share=self.mechanics.jaw_share)
        taken = (start - rest)[springs.vertices]
        mirrored = 2.0 * rest[springs.vertices] - springs.rest_feet
        moved = (feet - springs.rest_feet - taken, partners - mirrored - taken)
        return self._drive((feet, partners), moved, start, values, contracted, jaw)

    def _rest_shape(self, reference: FloatArray, jaw: JawPose) -> dict[str, FloatArray]:
        """Return what keeps the network at rest in `reference` (n, 3)."""
        if jaw.at_rest or not self.parameters.carried:
            return {}
        p, network = self.parameters, self.springs.network
        ends = reference[network.edges]
        length = np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1)
        shape = {
            "rest_lengths": (1.0 - p.pretension) * length,
            "knee_lengths": (1.0 + p.knee_strain) * length,
        }
        load = -edge_forces(network, reference, SpringControl(**shape))
        return {**shape, "load": load}

    def _drive(
        self,
        anchors: tuple[FloatArray, FloatArray],
        moved: tuple[FloatArray, FloatArray],
        reference: FloatArray,
        values: Mapping[str, float],
        contracted: Contracted,
        jaw: JawPose,
    ) -> Drive:
        p, springs = self.parameters, self.springs
        muscles = self.contraction.muscles.muscles
        share = np.array([values.get(m.action.control, 0.0) for m in muscles])
        awake = (share > 0.0).astype(np.float64)
        if p.waking > 0.0:
            awake = np.clip(share / p.waking, 0.0, 1.0)
        activity = (p.resting + (1.0 - p.resting) * awake)[springs.muscles]
        guess = reference
        if self.fields:
            guess = self._guess(values, jaw)
            ride = self._ride(values, reference, jaw)
            anchors = (anchors[0] + ride, anchors[1] + ride)
            moved = (moved[0] + ride, moved[1] + ride)
        stiffness = springs.stiffness * activity
        bones = self._bone_anchors(jaw)
        both = 2 if p.mirrors else 1
        n = len(reference)
        grip = p.grip * stiffness
        middle = 0.5 * (anchors[0] + anchors[1])
        hold = springs.tissue + np.bincount(springs.vertices, grip, n)
        home = reference if p.carried else springs.skin.positions
        target = springs.tissue[:, None] * home
        for axis in range(3):
            target[:, axis] += np.bincount(springs.vertices, grip * middle[:, axis], n)
        known = hold > 0.0
        target[known] /= hold[known, None]
        target[~known] = home[~known]
        control = SpringControl(
            anchors=np.concatenate([*anchors[:both], *bones[:both]]),
            anchor_stiffness=np.concatenate([np.tile(stiffness, both), springs.bone_stiffness]),
            hold_targets=target, hold_stiffness=hold, **self._load(values, reference, jaw),
        )  # fmt: skip
        return Drive(control, reference, *moved, activity, contracted, guess)

    def expected(self, values: Mapping[str, float]) -> FloatArray:
        """Return the sum (n, 3) of what each muscle does alone, before the jaw [mm]."""
        return self._sum(self.fields, values)

    def _sum(self, parts: Mapping[str, FloatArray], values: Mapping[str, float]) -> FloatArray:
        """Return the sum (n, 3) of `parts` (n, 3) by name, each times its control."""
        total = np.zeros_like(self.springs.skin.positions)
        # In the order of the parts, so that the order of the values does not matter.
        for name, part in parts.items():
            amount = values.get(name, 0.0)
            if amount > 0.0:
                total += min(amount, 1.0) * part
        return total

    def _load(
        self, values: Mapping[str, float], reference: FloatArray, jaw: JawPose
    ) -> dict[str, FloatArray]:
        """Return the shape that springs rest in, and the load with what holds the lips together."""
        shape = self._rest_shape(reference, jaw)
        if not any(values.get(name, 0.0) > 0.0 for name in self.seals):
            return shape
        force = self._sum(self.seals, values)
        if not jaw.at_rest:
            rest, share = self.springs.skin.positions, self.mechanics.jaw_share
            force = self.mechanics.jaw.move(rest + force, jaw, share=share) - reference
        return {**shape, "load": shape.get("load", self.springs.network.load) + force}

    def _guess(self, values: Mapping[str, float], jaw: JawPose) -> FloatArray:
        """Return where the skin (n, 3) would be if all that muscles do alone added up [mm]."""
        moved = self.springs.skin.positions + self.expected(values)
        if jaw.at_rest:
            return moved
        return self.mechanics.jaw.move(moved, jaw, share=self.mechanics.jaw_share)

    def _ride(self, values: Mapping[str, float], reference: FloatArray, jaw: JawPose) -> FloatArray:
        """Return how far (a, 3) each muscle spring is taken along by what others do [mm]."""
        springs, vertices = self.springs, self.springs.vertices
        total = self.expected(values)
        ride = total[vertices]
        for number, muscle in enumerate(self.contraction.muscles.muscles):
            amount = values.get(muscle.action.control, 0.0)
            if amount > 0.0:
                own = springs.muscles == number
                field = self.fields[muscle.action.control]
                ride[own] -= min(amount, 1.0) * field[vertices[own]]
        if jaw.at_rest:
            return ride
        start, share = springs.skin.positions[vertices], self.mechanics.jaw_share[vertices]
        return self.mechanics.jaw.move(start + ride, jaw, share=share) - reference[vertices]

    def _bone_anchors(self, jaw: JawPose) -> tuple[FloatArray, FloatArray]:
        """Return the feet (b, 3) on bones and their mirrored partners (b, 3) [mm]."""
        springs = self.springs
        vertices = springs.bone_vertices
        feet = springs.bone_feet
        partners = 2.0 * springs.skin.positions[vertices] - feet
        if jaw.at_rest:
            return feet, partners
        if self.parameters.carried:
            share = self.mechanics.jaw_share[vertices]
        else:
            share = springs.on_jaw.astype(np.float64)
        move = self.mechanics.jaw.move
        return move(feet, jaw, share=share), move(partners, jaw, share=share)

    @cached_property
    def _point_shares(self) -> FloatArray:
        """Share (P,) of the jaw's motion of each control point: that of the skin over it."""
        return self._shares(self.contraction.muscles.points)

    @cached_property
    def _aim_shares(self) -> FloatArray:
        """Share (P,) of the jaw's motion of each aim of a sphincter."""
        muscles = self.contraction.muscles
        shares = self._point_shares.copy()
        for number, ring in enumerate(muscles.ring_muscles):
            if ring:
                own = muscles.point_muscle == number
                shares[own] = shares[own].mean()
        return shares

    def _shares(self, points: FloatArray) -> FloatArray:
        skin = self.springs.skin
        seen = np.flatnonzero(~skin.hidden)
        distance, nearest = cKDTree(skin.positions[seen]).query(points, k=_NEAREST)
        weight = 1.0 / (np.asarray(distance) + 1.0)
        share = self.mechanics.jaw_share[seen[nearest]]
        return (weight * share).sum(axis=1) / weight.sum(axis=1)
