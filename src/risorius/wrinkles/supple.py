"""Where skin wrinkles finely, coarsely, or hardly at all."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from risorius._check import FloatArray
from risorius.anatomy.smooth_step import smooth_step
from risorius.errors import LandmarkError
from risorius.rig.quality.subject import Subject

__all__ = ["Suppleness", "suppleness_of"]

# Skin is thinnest at the lids and the lips; over this distance it becomes that of the face [mm].
_THIN, _THICK = 5.0, 25.0
# Distance from wrinkle to wrinkle there, on the forehead, and on the fat of the cheek [mm].
_FINE, _FOREHEAD, _CHEEK = 3.5, 6.5, 11.5
# Fat fills the cheek, which folds little; from this far below the eyes on [mm].
_BELOW_EYES = 15.0
_CHEEK_SHARE = 0.35
# The margins of lids and lips themselves stay smooth [mm].
_SMOOTH_MARGIN, _MARGIN_END = 1.5, 5.0


@dataclass(frozen=True, eq=False)
class Suppleness:
    """How the skin of a head wrinkles.

    Parameters
    ----------
    spacing : (n,) float64
        Distance from wrinkle to wrinkle [mm].
    share : (n,) float64
        How readily wrinkles form, 0 on skin that does not show [1].
    """

    spacing: FloatArray
    share: FloatArray


def suppleness_of(subject: Subject) -> Suppleness:
    """Return how the skin of a rig's head wrinkles.

    Raises
    ------
    LandmarkError
        If neither lids nor lips were found.
    """
    head = subject.head
    margins = list(subject.lids.values())
    if head is None or not margins or subject.lips is None:
        told = "; ".join(subject.notes) or "no lids were found"
        raise LandmarkError(f"wrinkles: lids and lips say how fine skin is ({told})")
    points = head.skin.mesh.positions
    distance = np.minimum.reduce([*(m.distance for m in margins), subject.lips.distance])
    eyes = np.concatenate([points[list(m.slit.corners), 1] for m in margins]).mean()
    below = smooth_step((eyes - points[:, 1]) / _BELOW_EYES)
    thick = smooth_step((distance - _THIN) / (_THICK - _THIN))
    spacing = _FINE + thick * ((1.0 - below) * _FOREHEAD + below * _CHEEK - _FINE)
    share = smooth_step((distance - _SMOOTH_MARGIN) / (_MARGIN_END - _SMOOTH_MARGIN))
    share *= 1.0 - (1.0 - _CHEEK_SHARE) * thick * below
    share[~subject.visible] = 0.0
    return Suppleness(spacing, share)
