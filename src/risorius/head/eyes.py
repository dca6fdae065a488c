"""The eyelids of a head: the shared detector, fed with the head's landmarks."""

from __future__ import annotations

from risorius.errors import MeshError
from risorius.head.head import Head
from risorius.mesh.lids import LidMargins, find_lids

__all__ = ["EYE_LANDMARKS", "find_head_lids"]

EYE_LANDMARKS = {"l": ("3.11", "3.7", "3.1", "3.3"), "r": ("3.8", "3.12", "3.2", "3.4")}
"""Inner corner, outer corner, upper and lower margin of each eye."""

_NAMES = {"l": "left", "r": "right"}


def find_head_lids(head: Head, *, notes: list[str] | None = None) -> dict[str, LidMargins]:
    """Trace the lids of both eyes.

    Parameters
    ----------
    head : Head
    notes : list of str, optional
        Receives a sentence for each eye that is left out.

    Returns
    -------
    dict of str to LidMargins
        By side, ``"l"`` and ``"r"``; an eye that cannot be traced or is closed is absent.
    """
    result: dict[str, LidMargins] = {}
    left_out: list[str] = [] if notes is None else notes
    for side, names in EYE_LANDMARKS.items():
        missing = head.landmarks.missing(names)
        if missing:
            left_out.append(
                f"{_NAMES[side]} eyelids left out: landmarks {', '.join(missing)} are missing"
            )
            continue
        inner, outer, upper, lower = (head.skin_vertex(name) for name in names)
        try:
            found = find_lids(head.skin.mesh, inner=inner, outer=outer, upper=upper, lower=lower)
        except MeshError as error:
            left_out.append(f"{_NAMES[side]} eyelids left out: {error}")
            continue
        if found.height < 0.02 * found.width:
            left_out.append(
                f"{_NAMES[side]} eyelids left out: the eye is closed in the neutral head"
            )
            continue
        result[side] = found
    return result
