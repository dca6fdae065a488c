"""Fratarcangeli's own face: muscles, skin and their layers by position-based dynamics."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from risorius._check import FloatArray, IntArray
from risorius.anatomy.jaw import JawPose
from risorius.anatomy.lip_contact import LipContact
from risorius.anatomy.mechanics import Mechanics
from risorius.anatomy.skin import build_skin, mirror_partners
from risorius.anatomy.skull import Skull, builtin_skull
from risorius.anatomy.skull_fit import MIRROR, FittedSkull, fit_skull
from risorius.controls.control import Control, Pose, resolve_pose
from risorius.controls.presets import mirrored
from risorius.controls.standard import controls_of_muscles
from risorius.head.head import Head
from risorius.layered.faithful.anatomy import Anatomy, lay_anatomy, rebuilt
from risorius.layered.faithful.binding import Anchors, bind_skin
from risorius.layered.faithful.influence import influence_map
from risorius.layered.faithful.lift import lifted_bones
from risorius.layered.faithful.lips import joined_contacts, lip_contacts
from risorius.layered.faithful.live import LiveFace
from risorius.layered.faithful.motion import MovingMuscles
from risorius.layered.faithful.parameters import FaithfulParameters
from risorius.layered.faithful.settling import settled_skins
from risorius.layered.faithful.skin import SkinModel, build_skin_model
from risorius.layered.faithful.teeth import Teeth, build_teeth
from risorius.layered.muscle_map import MuscleMap, default_muscle_map
from risorius.solvers.constraints import Contacts

__all__ = ["FaithfulFace"]

_STILL_GROUPS = ("gaze", "tongue")


@dataclass(frozen=True, eq=False)
class FaithfulFace:
    """The published layered face bound to a head (`risorius.rig.Face`).

    Parameters
    ----------
    head : Head
    mechanics : Mechanics
        Jaw axes, lids and parts; the skin follows muscles and bones by its anchors.
    muscles : MovingMuscles
        On the fitted skull.
    anchors : Anchors
    influence : (n,) float64
        Of every skin vertex.
    skin : SkinModel
    teeth : Teeth
    lips : LipContact
    partner : (n,) int32 or None
        Vertex opposite to each on a symmetric skin.
    controls : tuple of Control
    parameters : FaithfulParameters
    """

    head: Head
    mechanics: Mechanics
    muscles: MovingMuscles
    anchors: Anchors
    influence: FloatArray
    skin: SkinModel
    teeth: Teeth
    lips: LipContact
    partner: IntArray | None
    controls: tuple[Control, ...]
    parameters: FaithfulParameters

    @staticmethod
    def build(
        head: Head,
        muscle_map: MuscleMap | None = None,
        *,
        skull: Skull | None = None,
        mechanics: Mechanics | None = None,
        parameters: FaithfulParameters | None = None,
    ) -> FaithfulFace:
        """Lay the published muscles on a skull, fit both into a head and hang its skin on them.

        Parameters
        ----------
        head : Head
        muscle_map : MuscleMap, optional
            The published part of the default map if left out.
        skull : Skull, optional
            The built-in skull if left out.
        mechanics : Mechanics, optional
            Already built for this head.
        parameters : FaithfulParameters, optional

        Raises
        ------
        LandmarkError
            If the head lacks the landmarks of mouth, eyes and chin.
        MeshError
            If the lips are welded, or the skin hangs on too little.
        """
        p = parameters or FaithfulParameters()
        bones = skull or builtin_skull()
        moving = mechanics or Mechanics.build(head)
        mesh = head.skin.mesh
        partner = mirror_partners(mesh)
        hidden = moving.lips.inside.copy()
        for margins in moving.margins.values():
            hidden |= margins.slit.inside
        fitted = fit_skull(bones, head, symmetric=partner is not None, hidden=hidden)
        drawn = lay_anatomy((muscle_map or default_muscle_map()).published, bones, p)
        inside = _fitted_bones(bones, fitted)
        if p.lift:
            inside = lifted_bones(
                drawn, inside, moving, scale=fitted.scale, symmetric=partner is not None
            )
        anatomy = rebuilt(drawn, inside, scale=fitted.scale)
        anchors = bind_skin(anatomy, moving, fitted.scale, p)
        influence = influence_map(
            moving, anchors,
            reach=p.influence_reach * head.height, jaw_reach=p.jaw_reach * head.height,
        )  # fmt: skip
        places = anchors.places(anatomy.positions, anatomy.faces)
        skin = build_skin_model(moving, anchors, places, influence, p, scale=fitted.scale)
        names = tuple(dict.fromkeys(laid.control for laid in anatomy.muscles if laid.control))
        return FaithfulFace(
            head, moving, MovingMuscles(anatomy, p), anchors, influence, skin,
            build_teeth(moving, fitted.scale),
            LipContact.build(build_skin(moving, fitted, partner), moving.lips), partner,
            controls_of_muscles(names) + moving.controls, p,
        )  # fmt: skip

    @property
    def notes(self) -> tuple[str, ...]:
        """What was left out, and why."""
        return self.mechanics.notes + self.skin.notes

    @property
    def constraint_count(self) -> int:
        """Number of constraints of the skin, its anchors among them, without lids."""
        constraints = self.skin.model.constraints
        return constraints.count - len(constraints.holds.particles)

    def displace(self, pose: Pose) -> FloatArray:
        """Return the displacement (n, 3) [mm, canonical frame] of every input vertex.

        Converged from rest, so that it depends on the pose only.

        Raises
        ------
        ParameterError
            If a control is unknown or not finite.
        """
        return self.displace_all([pose])[0]

    def displace_all(self, poses: Sequence[Pose]) -> list[FloatArray]:
        """Return the displacement (n, 3) of every pose, many solved side by side.

        What `displace` returns but for rounding: see `settled_skins`.

        Raises
        ------
        ParameterError
            If a control is unknown or not finite.
        """
        resolved = [resolve_pose(self.controls, pose).values for pose in poses]
        still = {c.name for c in self.controls if c.group in _STILL_GROUPS}
        rows = [
            row
            for row, values in enumerate(resolved)
            if any(value for name, value in values.items() if name not in still)
        ]
        rest = np.zeros_like(self.head.skin.mesh.positions)
        moved = dict(zip(rows, self._skins([resolved[row] for row in rows]))) if rows else {}
        return [self.spread(moved.get(row, rest), values) for row, values in enumerate(resolved)]

    def pose(self, pose: Pose) -> FloatArray:
        """Return the posed positions (n, 3) [mm, canonical frame] of every input vertex."""
        return self.head.positions + self.displace(pose)

    def live(self) -> LiveFace:
        """Return a session at rest that is stepped frame by frame."""
        return LiveFace(self)

    def jaw_of(self, values: Mapping[str, float]) -> JawPose:
        """Return where `values` put the jaw."""
        return JawPose(
            values.get("jaw_pitch", 0.0),
            values.get("jaw_yaw", 0.0),
            values.get("jaw_protrusion", 0.0),
        )

    def bones(self, values: Mapping[str, float]) -> FloatArray:
        """Return the anatomy (n, 3) with its jaw in place and its muscles at rest [mm]."""
        anatomy: Anatomy = self.muscles.anatomy
        result = anatomy.positions.copy()
        jaw = self.jaw_of(values)
        if not jaw.at_rest:
            mandible = anatomy.surfaces["mandible"]
            part = slice(mandible.first, mandible.last)
            result[part] = self.mechanics.jaw.move(result[part], jaw)
        return result

    def lids(self, values: Mapping[str, float]) -> FloatArray:
        """Return the skin (n, 3) at rest with its lids in place [mm]."""
        result = self.head.skin.mesh.positions
        for side, lids in self.mechanics.lids.items():
            upper, lower = (values.get(f"lid_{name}_{side}", 0.0) for name in ("upper", "lower"))
            result = lids.move(result, upper=upper, lower=lower)
        return result

    def muscle_positions(self, pose: Pose) -> FloatArray:
        """Return all vertices (n, 3) of bones and muscles in a pose [mm]."""
        return self.anatomy_at(resolve_pose(self.controls, pose).values)

    def finished(self, simulated: FloatArray, values: Mapping[str, float]) -> FloatArray:
        """Return the displacement (n, 3) of the skin from its `simulated` positions (n, 3) [mm].

        Blended with the rest by the influence; cheeks that are puffed and lips that are held
        together, which the published face lacks, come on top.
        """
        rest = self.head.skin.mesh.positions
        moved = self.influence[:, None] * (simulated - rest)
        for side, field in self.mechanics.cheeks.items():
            moved = moved + values.get(f"cheek_puff_{side}", 0.0) * field
        return moved + values.get("lips_together", 0.0) * self.mechanics.seal

    def contacts(self, teeth: Teeth, skin: FloatArray) -> Contacts | None:
        """Return what the `skin` (n, 3) [mm] must leave: placed `teeth`, and its other lip."""
        return joined_contacts([teeth.contacts(skin), lip_contacts(self.lips, skin)])

    def spread(self, skin: FloatArray, values: Mapping[str, float]) -> FloatArray:
        """Return the displacement (n, 3) of all input vertices from the skin's (w, 3) [mm]."""
        result = self.mechanics.pose(np.zeros_like(skin), values)
        self.head.skin.spread(skin, result)
        for kind, follower in self.mechanics.followers.items():
            self.head.parts[kind].spread(follower.displace(skin), result)
        return result

    def anatomy_at(self, values: Mapping[str, float]) -> FloatArray:
        """Return all vertices (n, 3) of bones and muscles, at rest under `values` [mm]."""
        contractions = self.muscles.contractions(values)
        if self.jaw_of(values).at_rest and not any(contractions.values()):
            return self.muscles.anatomy.positions
        return self.muscles.settle(self.bones(values), contractions)

    def _skins(self, poses: Sequence[Mapping[str, float]]) -> list[FloatArray]:
        """Return the displacement (n, 3) of the skin in every pose [mm]."""
        controls = {control.name: control for control in self.controls}
        even = self.partner is not None and self.parameters.even
        opposite = [dict(mirrored(pose, controls)) if even else dict(pose) for pose in poses]
        # A pose and its mirror image are often asked for together: each is solved once.
        wanted = {_key(pose): pose for pose in (*poses, *opposite)}
        found = dict(zip(wanted, settled_skins(self, list(wanted.values()))))
        rest = self.head.skin.mesh.positions
        result: list[FloatArray] = []
        for pose, other in zip(poses, opposite):
            moved = self.finished(found[_key(pose)], pose)
            if self.partner is not None and even:
                mirror = self.finished(found[_key(other)], other)
                moved = 0.5 * (moved + mirror[self.partner] * MIRROR)
            teeth = self.teeth.moved(self.mechanics.jaw, self.jaw_of(pose))
            result.append(teeth.pushed_out(rest + self.lips.part(moved)) - rest)
        return result


def _key(values: Mapping[str, float]) -> tuple[tuple[str, float], ...]:
    return tuple(sorted(values.items()))


def _fitted_bones(skull: Skull, fitted: FittedSkull) -> dict[str, FloatArray]:
    """Return the vertices of cranium and mandible, each with its arch, inside the head."""
    arches = [fitted.carry(arch.positions) for arch in skull.arches]
    return {
        "cranium": np.concatenate([fitted.cranium.positions, *arches[:1]]),
        "mandible": np.concatenate([fitted.mandible.positions, *arches[1:]]),
    }
