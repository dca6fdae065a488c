"""Visemes: the mouth shapes of speech, as MPEG-4 and Oculus number them.

Both lists agree in order and meaning; Oculus adds silence in front.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

from risorius.controls.tables import table_rows

__all__ = ["MPEG4_EXPRESSIONS", "Viseme", "mpeg4_visemes", "oculus_visemes"]

MPEG4_EXPRESSIONS = ("joy", "sadness", "anger", "fear", "disgust", "surprise")
"""Expressions 1..6 of the parameter group 2; 0 is the neutral face."""


@dataclass(frozen=True)
class Viseme:
    """A mouth shape: number, short name, its sounds (SAMPA) and words that have them."""

    number: int
    name: str
    sounds: str
    examples: str


@cache
def oculus_visemes() -> tuple[Viseme, ...]:
    """Return the 15 visemes of Oculus, silence first."""
    return tuple(
        Viseme(int(row["number"]), row["name"], row["sounds"], row["examples"])
        for row in table_rows("visemes")
    )


@cache
def mpeg4_visemes() -> tuple[Viseme, ...]:
    """Return visemes 1..14 of MPEG-4; 0 is the neutral face."""
    spoken = {row["name"] for row in table_rows("visemes") if row["mpeg4"] == "yes"}
    return tuple(viseme for viseme in oculus_visemes() if viseme.name in spoken)
