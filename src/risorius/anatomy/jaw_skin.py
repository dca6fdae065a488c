"""How far each vertex of the skin, gums and mouth follows the jaw."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from risorius._check import BoolArray, FloatArray, IntArray
from risorius.anatomy.smooth_step import smooth_step
from risorius.head.head import Head
from risorius.mesh.core import TriMesh
from risorius.mesh.laplacian import SmoothField
from risorius.mesh.lips import LipSides
from risorius.mesh.slit import line_lengths

__all__ = ["jaw_share_inside", "jaw_share_of_skin"]

# Ends of the lip lines over which lower and upper lip fade into the commissure.
_FADE = 0.2


@dataclass(frozen=True, eq=False)
class _Pins:
    """What is known of a field: targets (n,) and how strongly they are held (n,)."""

    target: FloatArray
    strength: FloatArray

    def hold(self, where: BoolArray | IntArray, value: float | FloatArray, strength: float) -> None:
        self.target[where] = value
        self.strength[where] = strength


def jaw_share_of_skin(head: Head, lips: LipSides, hinge: FloatArray) -> FloatArray:
    """Return the share (n,) of the jaw's motion that each skin vertex makes.

    Chin and lower lip follow, everything above the upper lip, behind the condyles and down the
    neck stays, the rest is the smoothest field between them: a membrane with a little bending.
    The lips meet at one half in the commissures; inside the mouth the lining follows its lip.

    Parameters
    ----------
    head : Head
    lips : LipSides
        On the head's skin.
    hinge : (3,) float64
        Middle of the condyles [mm].
    """
    mesh = head.skin.mesh
    points = mesh.positions
    marks = head.landmarks
    width = lips.width
    pins = _Pins(np.full(len(points), 0.5), np.zeros(len(points)))
    corners = points[list(lips.slit.corners)]
    eye_floor = float(marks.positions(("3.3", "3.4"))[:, 1].min()) if "3.3" in marks else 0.0
    chin = marks.position("2.1")
    face_height = eye_floor - float(chin[1])
    # Still: brow and eyes, the head behind the condyles, ears, the neck below the jaw's reach.
    nose = marks.position("9.15") if "9.15" in marks else marks.position("9.3")
    still = (
        (points[:, 1] > eye_floor - 0.12 * face_height)
        | (points[:, 2] < hinge[2] + 0.05 * face_height)
        | (points[:, 1] < chin[1] - 0.45 * face_height)
        | (_ahead_of_lip(points, nose, width) & ~lips.inside)
    )
    pins.hold(still, 0.0, 1.0)
    # Follow: the chin, and the skin between chin and lower lip.
    for name in marks.common(("2.1", "2.10")):
        near = np.linalg.norm(points - marks.position(name), axis=1) < 0.22 * width
        pins.hold(near & ~lips.inside & lips.lower, 1.0, 1.0)
    middle = np.abs(points[:, 0] - corners[:, 0].mean())
    body = lips.lower & (lips.to_lower < 0.35 * width) & (middle < 0.28 * width) & ~lips.inside
    pins.hold(body, 1.0, 1.0)
    philtrum = lips.upper & (lips.to_upper < 0.35 * width) & (middle < 0.3 * width) & ~lips.inside
    pins.hold(philtrum, 0.0, 1.0)
    # The lining follows the lip that it continues. Teeth do not tell: upper incisors hang before
    # the lower ones, the lining behind the lower lip touches both.
    share = lips.share()[lips.inside]
    pins.hold(lips.inside, smooth_step(0.5 + 1.6 * (share - 0.5)), 0.3)
    for line, end in ((lips.slit.upper, 0.0), (lips.slit.lower, 1.0)):
        place = line_lengths(points, line)
        away = smooth_step(np.minimum(place, 1.0 - place) / _FADE)
        pins.hold(line, 0.5 + (end - 0.5) * away, 4.0)
    # Strengths count against the membrane: 1 holds within two millimetres on an adult mouth.
    field = SmoothField(mesh, 200.0 * pins.strength, length=0.6 * width, bend=0.12 * width)
    return np.clip(np.asarray(field.solve(pins.target)).reshape(-1), 0.0, 1.0)


def _ahead_of_lip(points: FloatArray, nose: FloatArray, width: float) -> BoolArray:
    """Return the mask of the nose: above its base and near the midline."""
    return (points[:, 1] > nose[1]) & (np.abs(points[:, 0] - nose[0]) < 0.45 * width)


def _points_of(head: Head, kinds: tuple[str, ...]) -> FloatArray | None:
    parts = [head.parts[kind].mesh.positions for kind in kinds if kind in head.parts]
    return np.concatenate(parts) if parts else None


def jaw_share_inside(mesh: TriMesh, head: Head, mouth_height: float) -> FloatArray:
    """Return the share (n,) for gums or a separate mouth lining.

    Gums that are one piece with the tongue are split by the teeth that they lie on, with a soft
    seam; without teeth the height of the mouth line decides.

    Parameters
    ----------
    mesh : TriMesh
        The part, canonical frame.
    head : Head
    mouth_height : float
        Height of the line between the lips [mm].
    """
    lower, upper = _points_of(head, ("teeth_lower",)), _points_of(head, ("teeth_upper",))
    points = mesh.positions
    if lower is None or upper is None:
        return smooth_step(0.5 - (points[:, 1] - mouth_height) / 8.0)
    to_lower = np.asarray(cKDTree(lower).query(points)[0])
    to_upper = np.asarray(cKDTree(upper).query(points)[0])
    certain = (np.minimum(to_lower, to_upper) < 3.0).astype(np.float64)
    raw = smooth_step(0.5 + (to_upper - to_lower) / 6.0)
    field = SmoothField(mesh, 0.02 + certain, length=1.0, bend=0.0)
    return np.clip(np.asarray(field.solve(raw)).reshape(-1), 0.0, 1.0)
