"""What a closing lid leaves open."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from risorius._check import FloatArray, IntArray
from risorius.head.head import Head
from risorius.head.part_geometry import fit_sphere
from risorius.mesh.lids import LidMargins

__all__ = ["LidGap", "lid_gaps"]

# Where the gap is measured, along the eye from the inner corner (0) to the outer one (1).
_PLACES = np.linspace(0.1, 0.9, 9)
# Where the line of sight starts behind the corners if there is no eyeball, in eye widths.
_DEPTH = 0.38


@dataclass(frozen=True)
class LidGap:
    """What is left between the margins of one eye, in percent of the neutral's largest opening.

    Parameters
    ----------
    left : float
        Largest gap at nine places over the middle 80 % of the eye; 100 where nothing moves, 0 in
        a perfect blink [%].
    overlap : float
        How far the margins pass each other where they do so most [%].
    """

    left: float
    overlap: float


def lid_gaps(head: Head, margins: LidMargins, side: str, deltas: FloatArray) -> list[LidGap]:
    """Measure one eye in all shapes.

    The gap at a place is the pitch of the upper margin less that of the lower one, as seen from
    the centre of the eyeball: lids that lie on the ball are closed where they cover each other
    in these directions, however thick they are.

    Parameters
    ----------
    head : Head
    margins : LidMargins
        Of this eye.
    side : str
        ``"l"`` or ``"r"``.
    deltas : (s, w, 3) float64
        Displacements of the welded skin [mm].
    """
    rest = head.skin.mesh.positions
    inner, outer = rest[list(margins.slit.corners)]
    across = (outer - inner) / margins.width
    centre = _centre(head, side, 0.5 * (inner + outer), margins.width)
    axis = (across if across[0] > 0.0 else -across) * [1.0, 1.0, 0.0]
    axis /= np.linalg.norm(axis)
    up = np.cross([0.0, 0.0, 1.0], axis)

    def contour(line: IntArray, moved: FloatArray, *, lowest: bool) -> FloatArray:
        points = rest[line] + moved[:, line]
        place = (points - inner) @ across / margins.width
        arm = points - centre
        pitch = np.arctan2(arm @ up, arm[..., 2])
        return _envelope(place, pitch, lowest=lowest)

    def gap(moved: FloatArray) -> FloatArray:
        above = contour(margins.slit.upper, moved, lowest=True)
        below = contour(margins.slit.lower, moved, lowest=False)
        # A place that a margin does not reach any more, in a head squeezed to a point, is closed.
        return np.nan_to_num(above - below, nan=0.0)

    opening = float(gap(np.zeros((1, *rest.shape))).max())
    if not opening > 0.0:
        return []
    share = 100.0 * gap(deltas) / opening
    left = np.maximum(share, 0.0).max(axis=1)
    overlap = np.maximum(-share, 0.0).max(axis=1)
    return [LidGap(float(a), float(b)) for a, b in zip(left, overlap)]


def _centre(head: Head, side: str, middle: FloatArray, width: float) -> FloatArray:
    fallback = middle - [0.0, 0.0, _DEPTH * width]
    part = head.part({"l": "eye_left", "r": "eye_right"}[side])
    if part is None or part.vertex_count < 4:
        return fallback
    centre = fit_sphere(part.mesh.positions)[0]
    return centre if np.linalg.norm(centre - fallback) < width else fallback


def _envelope(place: FloatArray, pitch: FloatArray, *, lowest: bool) -> FloatArray:
    """Return (s, 9): the lowest or highest pitch of each polyline (s, k) over the places.

    A margin that is traced along the front and the back edge of a lid by turns passes a place
    several times; what reaches farthest into the opening is what one sees.
    """
    start, end = place[:, :-1, None], place[:, 1:, None]
    span = end - start
    along = (_PLACES - start) / np.where(span != 0.0, span, 1.0)
    crosses = (along >= 0.0) & (along <= 1.0) & (span != 0.0)
    value = pitch[:, :-1, None] + along * (pitch[:, 1:, None] - pitch[:, :-1, None])
    if lowest:
        found = np.where(crosses, value, np.inf).min(axis=1)
    else:
        found = np.where(crosses, value, -np.inf).max(axis=1)
    return np.where(np.isfinite(found), found, np.nan)
