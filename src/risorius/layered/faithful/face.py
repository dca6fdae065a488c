"""Fratarcangeli's own face: muscles, skin and their layers by position-based dynamics."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

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
from risorius.layered.faithful.skin import SkinModel, build_skin_model
from risorius.layered.faithful.teeth import Teeth, build_teeth
from risorius.layered.muscle_map import MuscleMap, default_muscle_map
from risorius.solvers.constraints import Contacts
from risorius.solvers.model import State
from risorius.solvers.pbd import Solver

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
        values = resolve_pose(self.controls, pose).values
        still = {c.name for c in self.controls if c.group in _STILL_GROUPS}
        moved = np.zeros_like(self.head.skin.mesh.positions)
        if any(value for name, value in values.items() if name not in still):
            moved = self._even_skin(values)
        return self.spread(moved, values)

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
        return self._anatomy_at(resolve_pose(self.controls, pose).values)

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

    def _even_skin(self, values: Mapping[str, float]) -> FloatArray:
        moved = self._settled_skin(values)
        if self.partner is not None and self.parameters.even:
            moved = self._evened(moved, values, self.partner)
        rest = self.head.skin.mesh.positions
        teeth = self.teeth.moved(self.mechanics.jaw, self.jaw_of(values))
        return teeth.pushed_out(rest + self.lips.part(moved)) - rest

    def _evened(
        self, moved: FloatArray, values: Mapping[str, float], partner: IntArray
    ) -> FloatArray:
        controls = {control.name: control for control in self.controls}
        opposite = dict(mirrored(values, controls))
        other = moved if opposite == dict(values) else self._settled_skin(opposite)
        return 0.5 * (moved + other[partner] * MIRROR)

    def _anatomy_at(self, values: Mapping[str, float]) -> FloatArray:
        contractions = self.muscles.contractions(values)
        if self.jaw_of(values).at_rest and not any(contractions.values()):
            return self.muscles.anatomy.positions
        return self.muscles.settle(self.bones(values), contractions)

    def _settled_skin(self, values: Mapping[str, float]) -> FloatArray:
        p, model, n = self.parameters, self.skin.model, self.skin.vertex_count
        faces = self.muscles.anatomy.faces
        start = self.anchors.places(self.muscles.anatomy.positions, faces)
        end = self.anchors.places(self._anatomy_at(values), faces)
        rest = self.head.skin.mesh.positions
        lids = self.lids(values)
        solver, quick = Solver(), replace(p.skin_solver, iteration_limit=p.ramp_sweeps)
        positions = model.rest_positions
        for stage in range(1, p.ramp_steps):
            share = stage / p.ramp_steps
            control = self.skin.control(start + share * (end - start), rest + share * (lids - rest))
            state = State(positions, np.zeros_like(positions))
            positions = solver.settle(model, state, control, parameters=quick).positions
        teeth, contacts = self.teeth.moved(self.mechanics.jaw, self.jaw_of(values)), None
        for _ in range(p.contact_rounds):
            state = State(positions, np.zeros_like(positions))
            control = self.skin.control(end, lids, contacts)
            positions = solver.settle(model, state, control, parameters=p.skin_solver).positions
            found = self.contacts(teeth, positions[:n])
            if found is None:
                break
            contacts = joined_contacts([contacts, found])
        return self.finished(positions[:n], values)


def _fitted_bones(skull: Skull, fitted: FittedSkull) -> dict[str, FloatArray]:
    """Return the vertices of cranium and mandible, each with its arch, inside the head."""
    arches = [fitted.carry(arch.positions) for arch in skull.arches]
    return {
        "cranium": np.concatenate([fitted.cranium.positions, *arches[:1]]),
        "mandible": np.concatenate([fitted.mandible.positions, *arches[1:]]),
    }
