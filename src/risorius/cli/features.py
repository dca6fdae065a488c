"""What landmarks and parts are good for: the tables behind `check` and `landmarks`."""

from __future__ import annotations

from dataclasses import dataclass

from risorius.anatomy.template import SURE_LANDMARKS
from risorius.head.eyes import EYE_LANDMARKS

__all__ = ["FEATURES", "PARTS", "Feature", "purpose_of"]


@dataclass(frozen=True)
class Feature:
    """Something that landmarks make possible.

    Parameters
    ----------
    name : str
        The feature in words.
    names : tuple of str
        Its landmarks.
    without : str
        What happens without them.
    required : bool
        Whether no head is rigged without them.
    """

    name: str
    names: tuple[str, ...]
    without: str
    required: bool = False


_NOT_RIGGED = "the head cannot be rigged"

FEATURES = (
    Feature("frame and unit", ("3.7", "3.11", "3.8", "3.12", "2.1"), _NOT_RIGGED, required=True),
    Feature("sides", ("9.3",), _NOT_RIGGED, required=True),
    Feature("lips", ("2.2", "2.3", "2.4", "2.5", "8.1", "8.2"), _NOT_RIGGED, required=True),
    Feature("left eyelids", EYE_LANDMARKS["l"], "the left eye does not blink"),
    Feature("right eyelids", EYE_LANDMARKS["r"], "the right eye does not blink"),
    Feature("jaw joint", ("condyle_l", "condyle_r"), "it is carried over from the built-in head"),
    Feature("jaw axis", ("7.1", "2.10", "11.4"), "it is taken from the joint alone"),
    Feature("cheeks", ("2.13", "2.14"), "their middle is guessed from the mouth"),
    Feature("muscle places", SURE_LANDMARKS, "the muscles sit less exactly"),
)
"""In the order of their importance."""

PARTS = {
    "eye_left": "the left eye has no gaze, its lids close without an eyeball beneath",
    "eye_right": "the right eye has no gaze, its lids close without an eyeball beneath",
    "teeth_upper": "nothing shows behind the upper lip",
    "teeth_lower": "nothing shows behind the lower lip",
    "tongue": "tongue shapes are left out, unless it is one piece with the gums",
}
"""Parts that a head should have, and what happens without them."""


def purpose_of(landmark: str) -> tuple[str, ...]:
    """Return the features that a landmark serves."""
    return tuple(feature.name for feature in FEATURES if landmark in feature.names)
