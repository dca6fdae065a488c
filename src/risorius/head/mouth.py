"""The lips of a head: the shared detector, fed with the head's landmarks."""

from __future__ import annotations

from risorius.errors import LandmarkError, MeshError
from risorius.head.head import Head
from risorius.landmarks.sides import require
from risorius.mesh.lips import LipSides, find_lips

__all__ = ["find_head_lips"]


def find_head_lips(head: Head) -> LipSides:
    """Label the lip sides of the head's skin.

    Raises
    ------
    LandmarkError
        If 2.2-2.5, 8.1 or 8.2 are missing, or upper and lower middle are the same vertex.
    MeshError
        If the lips are welded.
    """
    names = ("2.4", "2.5", "2.2", "2.3", "8.1", "8.2")
    require(head.landmarks, names, purpose="telling the lips apart")
    left, right, upper, lower, outer_upper, outer_lower = map(head.skin_vertex, names)
    if upper == lower:
        raise LandmarkError(
            "landmarks: '2.2' and '2.3' are the same vertex; the inner middle of the upper and of "
            "the lower lip are two points"
        )
    try:
        return find_lips(
            head.skin.mesh,
            corners=(left, right),
            upper=upper,
            lower=lower,
            outer=(outer_upper, outer_lower),
        )
    except MeshError as error:
        raise MeshError(
            f"head: the mouth cannot be opened ({error}); check 2.2 2.3 2.4 2.5"
        ) from error
