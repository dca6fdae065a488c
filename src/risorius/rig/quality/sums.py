"""Sums of shapes, as engines play them: what looks right alone may not together."""

from __future__ import annotations

from collections.abc import Iterable

from risorius._check import as_number
from risorius.errors import ParameterError
from risorius.rig.rig import MorphTarget, Rig

__all__ = ["PLAYED", "parse_sum", "played_sums", "with_sums"]

_SIDES = ("Left", "Right")
PLAYED: tuple[str, ...] = (
    *(f"eyeBlink{s}+eyeLook{d}{s}" for s in _SIDES for d in ("Up", "Down", "In", "Out")),
    *(f"eyeWide{s}+eyeLookUp{s}" for s in _SIDES),
    *(f"eyeSquint{s}+eyeLookDown{s}" for s in _SIDES),
    *(f"eyeBlink{s}+cheekSquint{s}" for s in _SIDES),
    "jawOpen+mouthClose",
    "jawOpen+mouthFunnel",
    "jawOpen+mouthSmileLeft+mouthSmileRight",
    "jawOpen=0.5+mouthPucker=0.5",
    "jawOpen=0.5+mouthUpperUpLeft+mouthUpperUpRight",
    "jawOpen=0.3+mouthFrownLeft+mouthFrownRight",
    "mouthSmileLeft+mouthSmileRight+cheekSquintLeft+cheekSquintRight",
    "mouthSmileLeft+mouthSmileRight+browInnerUp",
    "browDownLeft+browDownRight+noseSneerLeft+noseSneerRight",
)
"""Sums of ARKit's shapes that takes of real faces are full of."""


def played_sums(rig: Rig) -> tuple[str, ...]:
    """Return those of `PLAYED` whose shapes the rig has."""
    known = set(rig.names)
    return tuple(text for text in PLAYED if known.issuperset(parse_sum(text)))


def with_sums(rig: Rig, sums: Iterable[str]) -> Rig:
    """Return the rig with sums of its shapes as further targets, named as they are written.

    Parameters
    ----------
    rig : Rig
    sums : iterable of str
        ``"A+B"`` or, with weights, ``"A=0.5+B"``; each once.

    Raises
    ------
    ParameterError
        If a sum is malformed or names a shape that the rig does not have.
    """
    made: list[MorphTarget] = []
    for text in dict.fromkeys(sums):
        moved = rig.posed(parse_sum(text)) - rig.mesh.positions
        made.append(MorphTarget.from_dense(text, moved))
    return rig.with_targets((*rig.targets, *made))


def parse_sum(text: str) -> dict[str, float]:
    """Return the weight of each shape of a sum such as ``"A+B"`` or ``"A=0.5+B"``.

    Raises
    ------
    ParameterError
        If it is malformed, or a single shape without a weight.
    """
    result: dict[str, float] = {}
    for term in text.split("+"):
        name, equals, number = (part.strip() for part in term.partition("="))
        if not name or name in result or (equals and not number):
            raise ParameterError(f"sum: {text!r} is not of the form A+B or A=0.5+B")
        try:
            weight = float(number) if equals else 1.0
        except ValueError:
            raise ParameterError(f"sum: {text!r}: {number!r} is no number") from None
        result[name] = as_number(f"sum: {text!r}: {name}", weight, low=-10.0, high=10.0)
    if len(result) < 2 and "=" not in text:
        raise ParameterError(f"sum: {text!r} is one shape; give two or more, such as A+B")
    return result
