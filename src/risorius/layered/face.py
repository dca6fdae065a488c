"""The layered anatomical face: muscles on a fitted skull, a linear field each, correctives."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from risorius._check import FloatArray, IntArray
from risorius.anatomy.contact import Contact
from risorius.anatomy.jaw import JawPose
from risorius.anatomy.mechanics import Mechanics
from risorius.anatomy.skin import Skin, build_skin, mirror_partners
from risorius.anatomy.skull import Skull, builtin_skull
from risorius.anatomy.skull_fit import FittedSkull, fit_skull, hidden_skin
from risorius.controls.control import Control, Pose, resolve_pose
from risorius.controls.standard import controls_of_muscles
from risorius.head.head import Head
from risorius.layered.binding import bind_muscles
from risorius.layered.correctives import Correctives
from risorius.layered.fibres import contract, lay_fibres
from risorius.layered.muscle import SheetAction
from risorius.layered.muscle_map import MuscleMap, default_muscle_map
from risorius.layered.pulls import Pull
from risorius.layered.solve import Solved, solve_pose

__all__ = ["LayeredFace"]


@dataclass(frozen=True, eq=False)
class LayeredFace:
    """Muscles in layers bound to a head (`risorius.rig.Face`).

    Parameters
    ----------
    head : Head
    muscle_map : MuscleMap
    mechanics : Mechanics
    skull : FittedSkull
        The skull inside the head.
    skin : Skin
    fibres : mapping of str to (h, w, 3) float64
        Fibres at rest of every sheet muscle, by control [mm].
    pulls : mapping of str to Pull
        What every muscle wants of the skin, by control.
    fields : mapping of str to (n, 3) float64
        Displacement of the welded skin at full contraction, by control [mm].
    companions : mapping of str to (n, 3) float64
        What closing lids and the opening jaw take along, per unit of their controls [mm].
    correctives : Correctives
    contact : Contact
    controls : tuple of Control
    """

    head: Head
    muscle_map: MuscleMap
    mechanics: Mechanics
    skull: FittedSkull
    skin: Skin
    fibres: Mapping[str, FloatArray]
    pulls: Mapping[str, Pull]
    fields: Mapping[str, FloatArray]
    companions: Mapping[str, FloatArray]
    correctives: Correctives
    contact: Contact
    controls: tuple[Control, ...]

    @staticmethod
    def build(
        head: Head,
        muscle_map: MuscleMap | None = None,
        *,
        skull: Skull | None = None,
        mechanics: Mechanics | None = None,
    ) -> LayeredFace:
        """Fit skull and muscles to a head and solve the field of every muscle.

        Parameters
        ----------
        head : Head
        muscle_map : MuscleMap, optional
            The default map if left out.
        skull : Skull, optional
            The built-in skull if left out.
        mechanics : Mechanics, optional
            Already built for this head.

        Raises
        ------
        LandmarkError
            If the head lacks the landmarks of mouth, eyes and chin.
        MeshError
            If the lips are welded.
        """
        drawn = muscle_map or default_muscle_map()
        bones = skull or builtin_skull()
        moving = mechanics or Mechanics.build(head)
        partner = mirror_partners(head.skin.mesh)
        hidden = hidden_skin(moving.lips, moving.margins)
        fitted = fit_skull(bones, head, symmetric=partner is not None, hidden=hidden)
        skin = build_skin(moving, fitted, partner)
        binding = bind_muscles(drawn, lay_fibres(drawn, bones), fitted, skin, moving)
        controls = controls_of_muscles(tuple(binding.fields)) + moving.controls
        correctives = Correctives.build(skin, moving)
        return LayeredFace(
            head, drawn, moving, fitted, skin, binding.fibres, binding.pulls, binding.fields,
            binding.companions, correctives, Contact.build(skin, moving), controls,
        )  # fmt: skip

    def linear_skin(self, values: Mapping[str, float]) -> FloatArray:
        """Return the sum (w, 3) [mm] of the unit fields at `values`."""
        total = np.zeros_like(self.skin.positions)
        # In the order of the fields, so that the order of the values does not matter.
        for name, field in self.fields.items():
            amount = values.get(name, 0.0)
            if amount:
                total += amount * field
        for name, field in self.companions.items():
            amount = values.get(name, 0.0)
            if amount > 0.0:
                total += amount * field
        return total

    def displace_skin(self, values: Mapping[str, float]) -> FloatArray:
        """Return the displacement (w, 3) [mm] of the welded skin by muscles alone."""
        linear = self.linear_skin(values)
        # Lids alone need no correctives, they turn about the eyeball.
        if not any(values.get(name, 0.0) for name in self.fields):
            return linear
        return self.correctives.shape(linear)

    def displace(self, pose: Pose) -> FloatArray:
        """Return the displacement (n, 3) [mm, canonical frame] of every input vertex.

        Raises
        ------
        ParameterError
            If a control is unknown or not finite.
        """
        values = resolve_pose(self.controls, pose).values
        result = self.mechanics.pose(self.displace_skin(values), values)
        if not any(values.values()):
            return result
        part = self.head.skin
        moved = result[part.first_source()]
        part.spread(self.contact.resolve(moved, values), result)
        return result

    def pose(self, pose: Pose) -> FloatArray:
        """Return the posed positions (n, 3) [mm, canonical frame] of every input vertex."""
        return self.head.positions + self.displace(pose)

    def solve(
        self,
        target: FloatArray,
        vertices: IntArray,
        *,
        weights: FloatArray | None = None,
        together: bool = False,
    ) -> Solved:
        """Find the controls that come nearest to a shape; see `solve_pose`.

        Parameters
        ----------
        target : (k, 3) float64
            Wanted displacement [mm, canonical frame].
        vertices : (k,) int32
            Input vertices that it belongs to; `landmark_target` makes both from landmarks.
        weights : (k,) float64, optional
            Importance of each vertex.
        together : bool
            Move left and right alike.
        """
        return solve_pose(self, target, vertices, weights=weights, together=together)

    def posed_fibres(self, pose: Pose) -> dict[str, FloatArray]:
        """Return the fibres (h, w, 3) of every sheet in a pose, by muscle and side [mm].

        Shortened along themselves and carried by the jaw; for drawing.
        """
        values = resolve_pose(self.controls, pose).values
        jaw = JawPose(values["jaw_pitch"], values["jaw_yaw"], values["jaw_protrusion"])
        tree = cKDTree(self.skin.positions)
        result: dict[str, FloatArray] = {}
        for name, fibres in self.fibres.items():
            muscle = self.muscle_map.by_name[name.removesuffix("_l").removesuffix("_r")]
            control = muscle.name if muscle.together else name
            amount = muscle.shortening * values.get(control, 0.0)
            still = muscle.action.fixed_point if isinstance(muscle.action, SheetAction) else 0.0
            moved = contract(fibres, amount, fixed_point=still) if amount else fibres
            if not jaw.at_rest:
                near = tree.query(fibres.reshape(-1, 3))[1]
                share = self.mechanics.jaw_share[near]
                flat = self.mechanics.jaw.move(moved.reshape(-1, 3), jaw, share=share)
                moved = flat.reshape(moved.shape)
            result[name] = moved
        return result
