"""Names of corrective pairs: targets that are driven by the product of two others' weights."""

from __future__ import annotations

__all__ = ["pair_name", "pair_of"]

_PREFIX = "pair_"
_JOINT = "__"


def pair_name(first: str, second: str) -> str:
    """Return the name of the corrective of two shapes: ``pair_jawOpen__mouthClose``."""
    return f"{_PREFIX}{first}{_JOINT}{second}"


def pair_of(name: str) -> tuple[str, str] | None:
    """Return the two shapes that a corrective called `name` belongs to, or None."""
    first, joint, second = name.removeprefix(_PREFIX).partition(_JOINT)
    return (first, second) if name.startswith(_PREFIX) and joint and first and second else None
