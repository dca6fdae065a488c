"""Everything of a face that is not muscle: jaw, lids, eyes, tongue, teeth and what hangs on them.

Every method displaces the skin by its muscles and hands the result to `Mechanics.pose`, which
moves the rest the same way for all of them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from risorius._check import FloatArray
from risorius.anatomy.cheeks import cheek_fields
from risorius.anatomy.condyles import condyles
from risorius.anatomy.eyelids import Eyelids, LidParameters, build_eyelids
from risorius.anatomy.eyes import Eyeball, fit_eyeball
from risorius.anatomy.follow import Follower, follow_skin
from risorius.anatomy.jaw import JawAxes, JawPose, jaw_axes
from risorius.anatomy.jaw_skin import jaw_share_inside, jaw_share_of_skin
from risorius.anatomy.lip_seal import lip_seal
from risorius.anatomy.tongue import Tongue, build_tongue, tongue_in_gums
from risorius.controls.control import Control
from risorius.controls.standard import device_controls
from risorius.head.eyes import find_head_lids
from risorius.head.head import Head
from risorius.head.mouth import find_head_lips
from risorius.landmarks.sides import require
from risorius.mesh.lids import LidMargins
from risorius.mesh.lips import LipSides

__all__ = ["Mechanics"]

_SIDES = {"l": "left", "r": "right"}
_REFERENCE_OPENING = 18.0


@dataclass(frozen=True, eq=False)
class Mechanics:
    """The moving parts of one head, bound to it.

    Parameters
    ----------
    head : Head
    lips : LipSides
    jaw : JawAxes
    jaw_share : (w,) float64
        How far each skin vertex follows the jaw.
    margins, lids, eyes : mapping of side to part
        Sides are ``"l"`` and ``"r"``; a missing eye is absent.
    seal : (w, 3) float64
        Displacement of the skin that closes the lips of the fully opened jaw [mm].
    notes : tuple of str
        What was left out, and why.
    """

    head: Head
    lips: LipSides
    jaw: JawAxes
    jaw_share: FloatArray
    margins: Mapping[str, LidMargins]
    lids: Mapping[str, Eyelids]
    eyes: Mapping[str, Eyeball]
    part_share: Mapping[str, FloatArray]
    tongue: Tongue | None
    tongue_part: str
    cheeks: Mapping[str, FloatArray]
    seal: FloatArray
    followers: Mapping[str, Follower]
    notes: tuple[str, ...]

    @staticmethod
    def build(head: Head, *, lid_parameters: LidParameters | None = None) -> Mechanics:
        """Find lips, lids, jaw and the other parts of `head`.

        Raises
        ------
        LandmarkError
            If landmarks of mouth, chin or eyes are missing.
        MeshError
            If the lips are welded together.
        """
        require(head.landmarks, ("2.1", "2.2", "2.3", "2.4", "2.5", "9.3"), purpose="a face")
        mesh = head.skin.mesh
        notes: list[str] = []
        lips = find_head_lips(head)
        left, right = condyles(head)
        jaw = jaw_axes(condyle_left=left, condyle_right=right, landmarks=head.landmarks)
        share = jaw_share_of_skin(head, lips, jaw.hinge)
        eyes = {
            side: fit_eyeball(head.parts[f"eye_{name}"].mesh)
            for side, name in _SIDES.items()
            if f"eye_{name}" in head.parts
        }
        margins = find_head_lids(head, notes=notes)
        lids = {
            side: build_eyelids(
                mesh,
                margin,
                head.parts[f"eye_{_SIDES[side]}"].mesh if side in eyes else None,
                eyes[side].centre if side in eyes else None,
                parameters=lid_parameters,
            )
            for side, margin in margins.items()
        }
        parts = {
            kind: jaw_share_inside(part.mesh, head, float(head.landmarks.position("2.2")[1]))
            for kind, part in head.parts.items()
            if kind in ("gums", "mouth_inside")
        }
        tongue_part, tongue = _tongue(head, lips, parts, notes)
        opened = jaw.move(mesh.positions, JawPose(_REFERENCE_OPENING), share=share)
        followers = _followers(head, margins)
        return Mechanics(
            head,
            lips,
            jaw,
            share,
            margins,
            lids,
            eyes,
            parts,
            tongue,
            tongue_part,
            cheek_fields(head, lips),
            lip_seal(mesh, lips, opened),
            followers,
            tuple(notes),
        )

    @property
    def controls(self) -> tuple[Control, ...]:
        """The device controls that this head can answer to."""
        groups = {"jaw", "lips", "cheek"}
        if self.tongue is not None:
            groups.add("tongue")
        sided = {"lid": self.lids, "gaze": self.eyes}
        return tuple(
            control
            for control in device_controls()
            if control.group in groups
            or (control.group in sided and control.name[-1] in sided[control.group])
        )

    def pose(self, skin: FloatArray, values: Mapping[str, float]) -> FloatArray:
        """Return the displacement (n, 3) [mm] of every input vertex.

        Parameters
        ----------
        skin : (w, 3) float64
            Displacement of the welded skin by muscles [mm].
        values : mapping of str to float
            Resolved controls, inside their ranges.
        """
        rest = self.head.skin.mesh.positions
        moved = rest + skin
        for side, field in self.cheeks.items():
            amount = values.get(f"cheek_puff_{side}", 0.0)
            if amount:
                moved = moved + amount * field
        for side, lids in self.lids.items():
            moved = lids.move(
                moved,
                upper=values.get(f"lid_upper_{side}", 0.0),
                lower=values.get(f"lid_lower_{side}", 0.0),
                gaze=(
                    values.get(f"gaze_yaw_{side}", 0.0),
                    values.get(f"gaze_pitch_{side}", 0.0),
                ),
            )
        jaw = JawPose(
            values.get("jaw_pitch", 0.0),
            values.get("jaw_yaw", 0.0),
            values.get("jaw_protrusion", 0.0),
        )
        if not jaw.at_rest:
            moved = self.jaw.move(moved, jaw, share=self.jaw_share)
        together = values.get("lips_together", 0.0)
        if together:
            moved = moved + together * self.seal
        result = np.zeros((self.head.vertex_count, 3))
        # Where nothing moved the difference is exactly zero, so neutral stays the input.
        self.head.skin.spread(moved - rest, result)
        self._pose_parts(jaw, values, moved - rest, result)
        return result

    def _pose_parts(
        self, jaw: JawPose, values: Mapping[str, float], skin: FloatArray, result: FloatArray
    ) -> None:
        for kind, part in self.head.parts.items():
            if kind in ("skin", "teeth_upper", "other"):
                continue
            rest = part.mesh.positions
            if kind in self.followers:
                part.spread(self.followers[kind].displace(skin), result)
                continue
            side = {"eye_left": "l", "eye_right": "r"}.get(kind)
            if side is not None:
                yaw = values.get(f"gaze_yaw_{side}", 0.0)
                pitch = values.get(f"gaze_pitch_{side}", 0.0)
                if yaw or pitch:
                    turned = self.eyes[side].turn(rest, yaw=yaw, pitch=pitch)
                    part.spread(turned - rest, result)
                continue
            moved = rest
            if kind == self.tongue_part and self.tongue is not None:
                moved = rest + self.tongue.displace(
                    out=values.get("tongue_out", 0.0),
                    up=values.get("tongue_up", 0.0),
                    side=values.get("tongue_side", 0.0),
                )
            if not jaw.at_rest:
                moved = self.jaw.move(moved, jaw, share=self.part_share.get(kind, 1.0))
            part.spread(moved - rest, result)


def _followers(head: Head, margins: Mapping[str, LidMargins]) -> dict[str, Follower]:
    """Bind lashes to the lid margins and everything else that lies on the skin to the skin."""
    result: dict[str, Follower] = {}
    mesh = head.skin.mesh
    for kind, side in (("attached", ""), ("lashes_left", "l"), ("lashes_right", "r")):
        part = head.parts.get(kind)
        if part is None:
            continue
        only = None
        if side in margins:
            slit = margins[side].slit
            only = np.union1d(slit.upper, slit.lower)
        result[kind] = follow_skin(part.mesh.positions, mesh, only=only)
    return result


def _tongue(
    head: Head, lips: LipSides, shares: dict[str, FloatArray], notes: list[str]
) -> tuple[str, Tongue | None]:
    front = float(head.landmarks.positions(("2.2", "2.3"))[:, 2].max())
    if "tongue" in head.parts:
        return "tongue", build_tongue(head.parts["tongue"].mesh.positions, front)
    if "gums" in head.parts:
        found = tongue_in_gums(head, lips.width, front)
        if found is not None:
            return "gums", found
    notes.append("no tongue found: tongue controls left out")
    return "", None
