"""The floor of the mouth: skin under the chin goes with the mandible."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from risorius.anatomy.jaw import JawPose
from risorius.anatomy.mechanics import Mechanics
from risorius.anatomy.skin import Skin
from risorius.anatomy.skull_fit import FittedSkull
from risorius.anatomy.smooth_step import smooth_step
from risorius.layered.pulls.pull import Pull

__all__ = ["REFERENCE_PITCH", "submental_pull"]

REFERENCE_PITCH = 18.0
"""Opening of the jaw that the pull belongs to [deg]."""

_STIFFNESS = 2.0
# Skin this near to the mandible follows fully, and from there on less [mm].
_NEAR, _FAR = 12.0, 30.0
_SHARE = 0.4


def submental_pull(skin: Skin, mechanics: Mechanics, fitted: FittedSkull) -> Pull:
    """Return what the skin under the chin still lacks to follow the opened jaw.

    The shared jaw keeps the whole neck calm; here the skin that lies on the underside of the
    fitted mandible goes with it.
    """
    points, scale = skin.positions, skin.scale
    distance = np.asarray(cKDTree(fitted.mandible.positions).query(points)[0])
    near = smooth_step(1.0 - (distance / scale - _NEAR) / (_FAR - _NEAR))
    below = smooth_step((-0.25 - skin.broad_normals[:, 1]) / 0.4)
    hinge = mechanics.jaw.hinge
    chin = mechanics.head.landmarks.position("2.1")
    ahead = smooth_step((points[:, 2] - hinge[2]) / (0.8 * (chin[2] - hinge[2])))
    lower = points[:, 1] < chin[1] + 12.0 * scale
    weight = skin.even(near * below * ahead * lower * ~skin.hidden)
    opened = JawPose(REFERENCE_PITCH)
    whole = mechanics.jaw.move(points, opened)
    now = mechanics.jaw.move(points, opened, share=mechanics.jaw_share)
    return Pull(_STIFFNESS * weight, skin.even_vectors(_SHARE * (whole - now)))
