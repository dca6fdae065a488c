"""Read the part kind off the name of an object, group or material."""

from __future__ import annotations

import re

__all__ = ["kind_of_name"]

_WORDS = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+")
_LEFT = {"left", "l", "lft", "lt"}
_RIGHT = {"right", "r", "rgt", "rt"}
_UPPER = {"upper", "up", "top", "maxilla", "maxillary", "u"}
_LOWER = {"lower", "low", "bottom", "bot", "down", "mandible", "mandibular", "jaw"}

# Checked in this order; the first stem that begins a word of the name decides.
_ATTACHED = (
    "lash",
    "eyelash",
    "cilia",
    "brow",
    "eyebrow",
    "beard",
    "moustache",
    "mustache",
    "stubble",
    "tear",
    "occlusion",
)
_SKIN_FIRST = (
    "eyelid",
    "lid",
    "eyesocket",
    "socket",
    "skin",
    "head",
    "face",
    "body",
    "bust",
    "neck",
    "scalp",
    "ear",
    "lip",
    "vermilion",
)
_MOUTH = ("mouth", "oral", "mouthbag", "mouthsocket")
_TEETH = ("teeth", "tooth", "dent", "incisor", "molar")
_GUMS = ("gum", "gingiva")
_TONGUE = ("tongue", "lingua")
_EYE = ("eye", "sclera", "iris", "cornea", "pupil", "lens")


def _words(name: str) -> list[str]:
    return [word.lower() for word in _WORDS.findall(name)]


def _has(words: list[str], stems: tuple[str, ...]) -> bool:
    return any(word.startswith(stem) for word in words for stem in stems)


def kind_of_name(name: str) -> str | None:
    """Return the part kind that `name` speaks of, or None.

    A kind that needs a side or a jaw which the name does not tell comes back bare: ``"eye"``,
    ``"teeth"``, ``"lashes"``; geometry then decides.
    """
    words = _words(name)
    if not words:
        return None
    joined = set(words)
    left, right = bool(joined & _LEFT), bool(joined & _RIGHT)
    side = "_left" if left and not right else "_right" if right and not left else ""
    if _has(words, ("lash", "eyelash", "cilia")):
        return f"lashes{side}"
    if _has(words, _ATTACHED):
        return "attached"
    if _has(words, _TEETH):
        upper, lower = bool(joined & _UPPER), bool(joined & _LOWER)
        return "teeth_upper" if upper and not lower else "teeth_lower" if lower else "teeth"
    if _has(words, _GUMS):
        return "gums"
    if _has(words, _TONGUE):
        return "tongue"
    if _has(words, _SKIN_FIRST):
        return "skin"
    if _has(words, _MOUTH):
        return "mouth_inside"
    if _has(words, _EYE):
        return f"eye{side}"
    return None
