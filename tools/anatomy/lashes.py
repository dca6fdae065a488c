"""Eyelashes: one slender closed cone per lash, rooted on the margin of the lids."""

from __future__ import annotations

import numpy as np

from .part import Part

__all__ = ["lashes_part"]

# lashes, length in the middle of the lid, thickness at the root [mm]
_UPPER, _LOWER = (34, 6.8, 0.36), (22, 3.0, 0.24)
# share of the lid from the inner to the outer corner that carries lashes
_SPAN = (0.16, 0.98)


def _cone(root, middle, tip, thickness):
    """Return the 7 vertices of a bent cone with a triangular section."""
    along = (middle - root) / np.linalg.norm(middle - root)
    side = np.cross(along, [0.0, 1.0, 0.0])
    side /= np.linalg.norm(side)
    up = np.cross(side, along)
    turn = 2 * np.pi * np.arange(3) / 3
    section = 0.5 * thickness * (np.cos(turn)[:, None] * side + np.sin(turn)[:, None] * up)
    return np.vstack([root + section, middle + 0.6 * section, tip])


_CONE = [(0, 3, 4, 1), (1, 4, 5, 2), (2, 5, 3, 0), (3, 6, 4), (4, 6, 5), (5, 6, 3), (0, 1, 2)]


def _lid_lashes(margin, eye_centre, setting, *, sign):
    """Return the vertices (k, 7, 3) of the lashes of one lid.

    Parameters
    ----------
    margin : (c, 3) ndarray
        Lid margin from the inner to the outer corner [mm].
    eye_centre : (3,) ndarray
    setting : (int, float, float)
        Number, length and thickness of the lashes.
    sign : float
        +1 for the upper lid, -1 for the lower one.
    """
    count, length, thickness = setting
    arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(margin, axis=0), axis=1))])
    share = np.linspace(*_SPAN, count)
    roots = np.stack([np.interp(share * arc[-1], arc, column) for column in margin.T], axis=1)
    cones = []
    for k, (t, root) in enumerate(zip(share, roots)):
        away = (root - eye_centre) / np.linalg.norm(root - eye_centre)
        fan = np.array([1.1 * (t - 0.45), sign, 0.0])
        fan /= np.linalg.norm(fan)
        long = length * (0.55 + 0.45 * np.sin(np.pi * t**1.3)) * (1.0 - 0.15 * (k % 2))
        start = away + 0.15 * fan
        middle = root + 0.5 * long * start / np.linalg.norm(start)
        bend = 0.45 * away + 0.9 * fan
        tip = middle + 0.5 * long * bend / np.linalg.norm(bend)
        cones.append(_cone(root - 0.2 * away, middle, tip, thickness))
    return np.array(cones)


def lashes_part(half, eye_centre):
    """Return the lashes of the left eye."""
    margin = half.positions[half.eye_rows[half.eye_margin]]
    outer = int(margin[:, 0].argmax())
    upper = margin[: outer + 1]
    lower = np.vstack([margin[:1], margin[: outer - 1 : -1]])
    cones = np.concatenate(
        [
            _lid_lashes(upper, eye_centre, _UPPER, sign=1.0),
            _lid_lashes(lower, eye_centre, _LOWER, sign=-1.0),
        ]
    )
    polygons = [tuple(7 * k + v for v in face) for k in range(len(cones)) for face in _CONE]
    count = len(polygons)
    return Part(
        "lashes_left", cones.reshape(-1, 3), polygons, ["lashes_left"] * count, ["lashes"] * count
    )
