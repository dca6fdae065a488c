"""The palpebral part of the orbicularis oculi: closing lids are drawn towards the nose."""

from __future__ import annotations

import numpy as np

from risorius._check import FloatArray
from risorius.anatomy.skin import Skin
from risorius.anatomy.smooth_step import smooth_step
from risorius.layered.pulls.pull import Pull
from risorius.mesh.lids import LidMargins

__all__ = ["lower_lid_pull", "upper_lid_pull"]

# Against the tarsal plates, which hold the lids still under all other muscles.
_STIFFNESS = 10.0
# How far the lower lid slides inwards and the outer corner comes down, in eye widths.
_INWARDS, _DOWN = 0.1, 0.08
_BAND, _CORNER = 0.35, 0.3


def lower_lid_pull(skin: Skin, margins: LidMargins) -> Pull:
    """Return the pull on the lower lid of one eye that closes: inwards along its margin."""
    inner, outer = skin.positions[list(margins.slit.corners)]
    across = (outer - inner) / margins.width
    place = (skin.positions - inner) @ across / margins.width
    near = np.where(np.isfinite(margins.to_lower), margins.to_lower, np.inf)
    weight = smooth_step(1.0 - near / (_BAND * margins.width)) * margins.lower
    weight = weight * smooth_step((place + 0.1) / 0.3) * smooth_step((1.25 - place) / 0.3)
    return Pull(
        _STIFFNESS * weight * ~skin.hidden, _along(skin, -_INWARDS * margins.width * across)
    )


def upper_lid_pull(skin: Skin, margins: LidMargins) -> Pull:
    """Return the pull on the outer corner of an eye whose upper lid closes: down."""
    outer = skin.positions[margins.slit.corners[1]]
    distance = np.linalg.norm(skin.positions - outer, axis=1)
    weight = smooth_step(1.0 - distance / (_CORNER * margins.width)) * ~skin.hidden
    return Pull(_STIFFNESS * weight, _along(skin, np.array([0.0, -_DOWN * margins.width, 0.0])))


def _along(skin: Skin, motion: FloatArray) -> FloatArray:
    """Return `motion` (3,) laid along the skin at each vertex (n, 3)."""
    normal = (skin.broad_normals @ motion)[:, None] * skin.broad_normals
    return motion - normal
