"""Which set the name of a morph target belongs to."""

from __future__ import annotations

from functools import cache

from risorius.controls.arkit import arkit_shapes
from risorius.controls.pair_names import pair_of
from risorius.controls.presets import EMOTIONS
from risorius.controls.standard_sets import STANDARD_SETS

__all__ = ["TARGET_SETS", "set_of"]

TARGET_SETS = ("singles", "emotions", "arkit", *STANDARD_SETS, "fap")
"""Sets that targets are told apart by; what belongs to no standard counts among the singles."""


@cache
def _whole_names() -> dict[str, str]:
    return {
        **dict.fromkeys(EMOTIONS, "emotions"),
        **{shape.name: "arkit" for shape in arkit_shapes()},
    }


def set_of(name: str) -> str:
    """Return the set of `TARGET_SETS` that the target `name` belongs to.

    Correctives of pairs belong to the set ``"pairs"``, which nobody asks for by itself.
    """
    if pair_of(name):
        return "pairs"
    for section, standard in STANDARD_SETS.items():
        if name.startswith(standard.prefix):
            return section
    return "fap" if name.startswith("fap_") else _whole_names().get(name, "singles")
