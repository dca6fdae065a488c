"""Plain looks that make the parts of a head recognisable in any viewer."""

from __future__ import annotations

from dataclasses import dataclass

from risorius.head.part_names import kind_of_name

__all__ = ["Look", "look_of"]


@dataclass(frozen=True)
class Look:
    """How a material looks: linear RGB, roughness, and whether its back side may be seen."""

    colour: tuple[float, float, float]
    roughness: float
    both_sides: bool


_LOOKS = {
    "skin": Look((0.72, 0.45, 0.36), 0.55, True),
    "eye": Look((0.85, 0.83, 0.80), 0.15, False),
    "teeth": Look((0.78, 0.73, 0.62), 0.30, False),
    "gums": Look((0.50, 0.17, 0.16), 0.40, True),
    "tongue": Look((0.47, 0.15, 0.15), 0.45, True),
    "mouth": Look((0.30, 0.08, 0.08), 0.60, True),
    "lashes": Look((0.02, 0.015, 0.012), 0.70, True),
    "attached": Look((0.05, 0.035, 0.028), 0.80, True),
}
_OTHER = Look((0.50, 0.50, 0.50), 0.70, True)


def look_of(*names: str) -> Look:
    """Return the look that the first telling name (of a material, then of its part) suggests."""
    kinds = (kind_of_name(name) or name for name in names)
    stems = (kind.split("_", maxsplit=1)[0] for kind in kinds)
    return next((_LOOKS[stem] for stem in stems if stem in _LOOKS), _OTHER)
