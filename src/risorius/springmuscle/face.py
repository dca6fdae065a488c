"""The spring-muscle face: ellipsoid muscles under a skin of springs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from risorius._check import FloatArray, IntArray
from risorius.anatomy.contact import Contact
from risorius.anatomy.mechanics import Mechanics
from risorius.anatomy.skin import build_skin, mirror_partners
from risorius.anatomy.skull import Skull, builtin_skull
from risorius.anatomy.skull_fit import MIRROR, fit_skull, hidden_skin
from risorius.controls.control import Control, Pose, resolve_pose
from risorius.controls.presets import mirrored
from risorius.head.head import Head
from risorius.solvers.leapfrog import Moved, settle
from risorius.solvers.springs import SpringState
from risorius.springmuscle.bones import Bones, BoneWay, SkinBones, find_bones
from risorius.springmuscle.contraction import Contraction
from risorius.springmuscle.driving import Drive, Driver
from risorius.springmuscle.fit import Ground, fit_muscles
from risorius.springmuscle.fit_parameters import FitParameters
from risorius.springmuscle.live import LiveFace
from risorius.springmuscle.muscle_set import MuscleSet
from risorius.springmuscle.parameters import Profile, SpringParameters
from risorius.springmuscle.recipe import OutlineRecipe
from risorius.springmuscle.recipe_file import default_recipe
from risorius.springmuscle.relax import start_of
from risorius.springmuscle.skin import SkinSprings, build_springs
from risorius.springmuscle.volume import Volume

__all__ = ["SpringFace"]


@dataclass(frozen=True, eq=False)
class SpringFace:
    """Spring muscles bound to a head (`risorius.rig.Face`).

    Parameters
    ----------
    head : Head
    mechanics : Mechanics
    muscles : MuscleSet
        Fitted under the skin.
    springs : SkinSprings
    driver : Driver
        From controls to what the springs feel.
    contact : Contact or None
    volume : Volume or None
        What tissue does that is pushed together.
    controls : tuple of Control
    parameters : SpringParameters
    notes : tuple of str
        What was left out, and why.
    attachment : SkinBones or None
        Bone beneath each vertex.
    ground : Ground or None
        What the muscles were fitted to, for fitting one anew.
    """

    head: Head
    mechanics: Mechanics
    muscles: MuscleSet
    springs: SkinSprings
    driver: Driver
    contact: Contact | None
    volume: Volume | None
    controls: tuple[Control, ...]
    parameters: SpringParameters
    notes: tuple[str, ...] = ()
    attachment: SkinBones | None = None
    ground: Ground | None = None

    @staticmethod
    def build(
        head: Head,
        recipe: OutlineRecipe | None = None,
        *,
        bones: BoneWay = "builtin",
        skull: Skull | None = None,
        mechanics: Mechanics | None = None,
        profile: Profile = "improved",
        parameters: SpringParameters | None = None,
    ) -> SpringFace:
        """Fit the muscles of a recipe under the skin of a head and hang the skin on them.

        Parameters
        ----------
        head : Head
        recipe : OutlineRecipe, optional
            The default outlines if left out.
        bones : {"builtin", "cut", "given"}
            Where skull and jaw come from: the built-in skull, the head's own mesh, or `skull`.
        skull : Skull, optional
            For `bones` ``"given"``.
        mechanics : Mechanics, optional
            Already built for this head.
        profile : {"improved", "faithful"}
        parameters : SpringParameters, optional
            Those of the profile if left out.

        Raises
        ------
        LandmarkError
            If the head lacks landmarks of mouth, eyes and chin, or some that outlines need.
        MeshError
            If the lips are welded.
        ParameterError
            If a word is not one of its choices, or an outline cannot be laid on this head.
        """
        p = parameters or SpringParameters.of_profile(profile)
        moving = mechanics or Mechanics.build(head)
        fit = FitParameters.of_profile(profile)
        ground = Ground.build(moving, find_bones(moving, bones, skull=skull), fit)
        muscles = fit_muscles(recipe or default_recipe(), ground)
        face = SpringFace.of_muscles(
            head, muscles, bones=ground.bones, attachment=ground.skin_bones, mechanics=moving,
            parameters=p,
        )  # fmt: skip
        return replace(face, ground=ground)

    @staticmethod
    def of_muscles(
        head: Head,
        muscles: MuscleSet,
        *,
        bones: Bones | None = None,
        attachment: SkinBones | None = None,
        mechanics: Mechanics | None = None,
        parameters: SpringParameters | None = None,
    ) -> SpringFace:
        """Hang the skin of a head on muscles that have been fitted already.

        Parameters
        ----------
        head : Head
        muscles : MuscleSet
        bones : Bones, optional
            Tissue is measured down to them; the built-in skull if left out.
        attachment : SkinBones, optional
            Bone beneath each vertex; needed where the parameters hold the skin by bones.
        mechanics : Mechanics, optional
            Already built for this head.
        parameters : SpringParameters, optional
            The improved profile if left out.

        Raises
        ------
        LandmarkError
            If the head lacks the landmarks of mouth, eyes and chin.
        MeshError
            If the lips are welded.
        """
        p = parameters or SpringParameters.of_profile("improved")
        moving = mechanics or Mechanics.build(head)
        partner = mirror_partners(head.skin.mesh)
        hidden = hidden_skin(moving.lips, moving.margins)
        fitted = fit_skull(builtin_skull(), head, symmetric=partner is not None, hidden=hidden)
        if bones is not None:
            fitted = replace(fitted, cranium=bones.skull, mandible=bones.jaw)
        skin = build_skin(moving, fitted, partner)
        springs = build_springs(skin, muscles, attachment, moving, p)
        driver = Driver(springs, _contraction(muscles, p), moving, p)
        contact = Contact.build(skin, moving) if p.contact else None
        volume = None
        if p.volume:
            volume = Volume.build(skin, moving, springs.network.fixed, p.volume)
        controls = muscles.controls + moving.controls
        face = SpringFace(
            head, moving, muscles, springs, driver, contact, volume, controls, p, moving.notes,
            attachment,
        )  # fmt: skip
        return face.with_fields({}) if p.riding else face

    def with_muscles(self, muscles: MuscleSet) -> SpringFace:
        """Return the face on other muscles, such as `queries.refit` returns while one is drawn.

        Only what changed is computed: muscles that are the same objects keep what they do alone.
        """
        p, moving = self.parameters, self.mechanics
        springs = build_springs(self.springs.skin, muscles, self.attachment, moving, p)
        face = replace(
            self, muscles=muscles, springs=springs, controls=muscles.controls + moving.controls,
            driver=Driver(springs, _contraction(muscles, p), moving, p),
        )  # fmt: skip
        if not p.riding:
            return face
        before, after = ({id(m): m for m in s.muscles} for s in (self.muscles, muscles))
        known = dict(self.driver.fields)
        # Muscles that hold each other, by rest or by links, all change together.
        if p.resting > 0.0 or p.linked:
            known = {}
        for key in before.keys() ^ after.keys():
            known.pop((before.get(key) or after[key]).action.control, None)
        return face.with_fields(known)

    def with_fields(self, known: Mapping[str, FloatArray]) -> SpringFace:
        """Return the face with what every muscle control does alone, so that muscles ride.

        Parameters
        ----------
        known : mapping of str to (n, 3) float64
            What some of the controls do [mm].
        """
        alone = replace(self, driver=replace(self.driver, fields={}, seals={}))
        tight = replace(self.springs, network=self.springs.sealed)
        sealed = replace(alone, springs=tight, driver=replace(alone.driver, springs=tight))
        sealing = {m.action.control for m in self.muscles.muscles if m.action.seal}
        fields: dict[str, FloatArray] = {}
        seals: dict[str, FloatArray] = {}
        partner = self._partner
        for control in self.muscles.controls:
            other = control.mirror
            if control.name in known:
                fields[control.name] = known[control.name]
            elif (
                partner is not None and other in fields and self.muscles.twins(control.name, other)
            ):
                fields[control.name] = fields[other][partner] * MIRROR
            else:
                face = sealed if control.name in sealing else alone
                fields[control.name] = face.displace_skin({control.name: 1.0})
            if control.name in sealing:
                seals[control.name] = self.springs.seal_forces(fields[control.name])
        return replace(self, driver=replace(self.driver, fields=fields, seals=seals))

    def settled(self, values: Mapping[str, float]) -> tuple[Drive, Moved]:
        """Return what a pose asks of the springs and where they come to rest."""
        drive = self.driver.drive(values)
        start = start_of(self.springs, drive, passes=self.parameters.relaxation)
        moved = settle(
            self.springs.network, SpringState.still(start), drive.control,
            parameters=self.parameters.motion,
        )  # fmt: skip
        return drive, moved

    def displace_skin(self, values: Mapping[str, float]) -> FloatArray:
        """Return the displacement (w, 3) [mm] of the welded skin by muscles alone.

        Before the jaw, if the shape is carried by it; else the jaw's drag is part of it.
        """
        rest = self.springs.skin.positions
        moving = self.driver.active(values).any()
        if not self.parameters.carried:
            jaw = any(values.get(name, 0.0) for name in ("jaw_pitch", "jaw_yaw", "jaw_protrusion"))
            moving = moving or jaw
        if not moving:
            return np.zeros_like(rest)
        partner = self._partner
        return self._settled_skin(values) if partner is None else self._even_skin(values, partner)

    def displace(self, pose: Pose) -> FloatArray:
        """Return the displacement (n, 3) [mm, canonical frame] of every input vertex.

        Converged from the same start, so that it depends on the pose only.

        Raises
        ------
        ParameterError
            If a control is unknown or not finite.
        """
        values = resolve_pose(self.controls, pose).values
        return self.spread(self.displace_skin(values), values)

    def pose(self, pose: Pose) -> FloatArray:
        """Return the posed positions (n, 3) [mm, canonical frame] of every input vertex."""
        return self.head.positions + self.displace(pose)

    def live(self) -> LiveFace:
        """Return a session at rest that is stepped frame by frame."""
        return LiveFace(self)

    def spread(self, skin: FloatArray, values: Mapping[str, float]) -> FloatArray:
        """Return the displacement (n, 3) of all input vertices from the skin's (w, 3) [mm].

        Bone and teeth take their part of what goes inwards, tissue swells; jaw, lids and all other
        parts follow, then contact.
        """
        part = self.head.skin
        skin = self.springs.supported(skin, self.parameters.support)
        if self.volume is not None:
            skin = self.volume.swollen(skin)
        if self.parameters.carried:
            result = self.mechanics.pose(skin, values)
        else:
            result = self._dragged_parts(skin, values)
        if self.contact is None or not any(values.values()):
            return result
        moved = result[part.first_source()]
        part.spread(self.contact.resolve(moved, values), result)
        return result

    @cached_property
    def _partner(self) -> IntArray | None:
        """Vertex opposite to each (w,), where skin and muscles are their own mirror images."""
        even = self.parameters.even and self.muscles.symmetric
        return self.springs.skin.partner if even else None

    def _dragged_parts(self, skin: FloatArray, values: Mapping[str, float]) -> FloatArray:
        """Let springs move the skin with the jaw, and mechanics all the rest."""
        result = self.mechanics.pose(np.zeros_like(skin), values)
        still = {name: value for name, value in values.items() if not name.startswith("jaw_")}
        without = self.mechanics.pose(skin, still)
        part = self.head.skin
        part.spread(without[part.first_source()], result)
        for kind, follower in self.mechanics.followers.items():
            self.head.parts[kind].spread(follower.displace(skin), result)
        return result

    def _settled_skin(self, values: Mapping[str, float]) -> FloatArray:
        _, moved = self.settled(values)
        found = self.driver.uncarried(moved.state.positions, values)
        result = found - self.springs.skin.positions
        result[self.springs.network.fixed] = 0.0
        return result

    def _even_skin(self, values: Mapping[str, float], partner: IntArray) -> FloatArray:
        controls = {control.name: control for control in self.controls}
        opposite = dict(mirrored(values, controls))
        own = self._settled_skin(values)
        other = own if opposite == dict(values) else self._settled_skin(opposite)
        return 0.5 * (own + other[partner] * MIRROR)


def _contraction(muscles: MuscleSet, parameters: SpringParameters) -> Contraction:
    return Contraction(muscles) if parameters.linked else Contraction(muscles, sweeps=0)
