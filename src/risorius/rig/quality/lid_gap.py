"""What a closing lid leaves open."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from risorius._check import FloatArray, IntArray
from risorius.head.head import Head
from risorius.head.part_geometry import fit_sphere
from risorius.mesh.core import TriMesh
from risorius.mesh.lids import LidMargins
from risorius.spatial.raycast import Scene

__all__ = ["LID_PLACES", "LidGap", "LidSight", "lid_gaps"]

LID_PLACES = np.linspace(0.1, 0.9, 9)
"""(9,) where the gap is measured, along the eye from the inner corner (0) to the outer one (1)."""

# Lines of sight at one place [rad]: the step between them, and how far beyond the neutral's
# opening they reach, for eyes that open wide.
_STEP, _BEYOND = np.radians(0.25), np.radians(15.0)
_STEEPEST = np.radians(60.0)
# Where the line of sight starts behind the corners if there is no eyeball, in eye widths.
_DEPTH = 0.38


@dataclass(frozen=True)
class LidGap:
    """What is left between the lids of one eye, in percent of the neutral's largest opening.

    Parameters
    ----------
    left : float
        Largest gap at nine places over the middle 80 % of the eye; 100 where nothing moves, 0 in
        a perfect blink [%].
    overlap : float
        How far the traced margins pass each other where they do so most [%].
    """

    left: float
    overlap: float


def lid_gaps(head: Head, margins: LidMargins, side: str, deltas: FloatArray) -> list[LidGap]:
    """Measure one eye in all shapes.

    The gap at a place is the angle over which one looks from the centre of the eyeball outwards
    without meeting skin; it depends on no traced margin. Places are angles about the same centre,
    so that a lid that turns about the line of the corners keeps them.

    Parameters
    ----------
    head : Head
    margins : LidMargins
        Of this eye.
    side : str
        ``"l"`` or ``"r"``.
    deltas : (s, w, 3) float64
        Displacements of the welded skin [mm].

    Returns
    -------
    list of LidGap
        One per shape; empty if the neutral's lids cover the eye.

    Notes
    -----
    Lines of sight are a quarter of a degree apart, about 1 % of an ordinary opening.
    """
    view = LidSight(head, margins, side)
    if not view.opening > 0.0:
        return []
    lines = (margins.slit.upper, margins.slit.lower)
    result: list[LidGap] = []
    for moved in deltas:
        if not moved[view.vertices].any():
            result.append(LidGap(100.0, 0.0))
            continue
        left = view.gaps(moved).max() / view.opening
        passed = max(float(-view.apart(lines, moved).min()), 0.0) / view.opening
        result.append(LidGap(100.0 * float(left), 100.0 * passed))
    return result


class LidSight:
    """Lines of sight from the centre of one eye, and the skin around it that may stop them.

    Parameters
    ----------
    head : Head
    margins : LidMargins
        Of this eye.
    side : str
        ``"l"`` or ``"r"``.

    Attributes
    ----------
    opening : float
        Largest gap of the neutral, 0 where lids cover the eye [rad].
    vertices : (k,) int32
        Vertices of the welded skin around the eye.
    centre : (3,) float64
        Of the eyeball [mm].
    """

    def __init__(self, head: Head, margins: LidMargins, side: str) -> None:
        mesh = head.skin.mesh
        self._rest = mesh.positions
        inner, outer = self._rest[list(margins.slit.corners)]
        self.centre = _centre(head, side, 0.5 * (inner + outer), margins.width)
        across = (outer - inner) * [1.0, 1.0, 0.0] * np.sign(outer[0] - inner[0])
        self._axis = across / np.linalg.norm(across)
        self._up = np.cross([0.0, 0.0, 1.0], self._axis)
        self._corners = tuple(self._aside(corner - self.centre) for corner in (inner, outer))
        near = (margins.distance < margins.width)[mesh.faces].all(axis=1)
        self.vertices, faces = np.unique(mesh.faces[near], return_inverse=True)
        self._faces: IntArray = faces.reshape(-1, 3).astype(np.int32)
        self._pitches = np.arange(-_STEEPEST, _STEEPEST, _STEP)
        self.opening = 0.0
        rest = np.zeros_like(self._rest)
        margin = self._rest[np.union1d(margins.slit.upper, margins.slit.lower)] - self.centre
        low, high = np.quantile(np.arctan2(margin @ self._up, margin[:, 2]), [0.0, 1.0])
        within = (self._pitches > low - _BEYOND) & (self._pitches < high + _BEYOND)
        self._pitches = self._pitches[within]
        if len(self._faces) and len(self._pitches):
            self.opening = float(self.gaps(rest).max())

    def gaps(self, moved: FloatArray) -> FloatArray:
        """Return the open angle (9,) at each place [rad]."""
        start, end = self._corners
        aside = (start + LID_PLACES * (end - start))[:, None]
        ahead, up = np.cos(self._pitches), np.sin(self._pitches)
        square = ahead[:, None] * [0.0, 0.0, 1.0] + up[:, None] * self._up
        sights = np.sin(aside)[..., None] * self._axis + np.cos(aside)[..., None] * square
        skin = TriMesh((self._rest + moved)[self.vertices], self._faces)
        origins = np.broadcast_to(self.centre, (sights.size // 3, 3))
        hit = Scene([skin]).cast(origins, sights.reshape(-1, 3)).hit
        return _STEP * (~hit).reshape(len(LID_PLACES), -1).sum(axis=1)

    def apart(self, lines: tuple[IntArray, IntArray], moved: FloatArray) -> FloatArray:
        """Return how far (9,) the upper margin lies above the lower one, < 0 below it [rad]."""
        contours: list[FloatArray] = []
        for line in lines:
            points = self._rest[line] + moved[line]
            place = self.places(points)
            order = np.argsort(place, kind="stable")
            arm = points - self.centre
            pitch = np.arctan2(arm @ self._up, arm[:, 2])
            contours.append(np.interp(LID_PLACES, place[order], pitch[order]))
        return contours[0] - contours[1]

    def places(self, points: FloatArray) -> FloatArray:
        """Return where (k,) points (k, 3) lie between the inner corner, 0, and the outer, 1."""
        start, end = self._corners
        return (self._aside(points - self.centre) - start) / (end - start)

    def _aside(self, arm: FloatArray) -> FloatArray:
        """Return the angle (...) between arms and the plane square to the axis [rad]."""
        length = np.sqrt((arm * arm).sum(axis=-1))
        return np.arcsin(np.clip(arm @ self._axis / np.maximum(length, 1e-12), -1.0, 1.0))


def _centre(head: Head, side: str, middle: FloatArray, width: float) -> FloatArray:
    fallback = middle - [0.0, 0.0, _DEPTH * width]
    part = head.part({"l": "eye_left", "r": "eye_right"}[side])
    if part is None or part.vertex_count < 4:
        return fallback
    centre = fit_sphere(part.mesh.positions)[0]
    return centre if np.linalg.norm(centre - fallback) < width else fallback
