"""Wrinkles: relief of the skin where a shape presses it together, as normal maps."""

from risorius.wrinkles.maps import (
    DEFAULT_GROUPS,
    WrinkleGroup,
    WrinkleMap,
    WrinkleSet,
    parse_group,
    wrinkle_maps,
)
from risorius.wrinkles.relief import Relief, Wrinkler

__all__ = [
    "DEFAULT_GROUPS",
    "Relief",
    "WrinkleGroup",
    "WrinkleMap",
    "WrinkleSet",
    "Wrinkler",
    "parse_group",
    "wrinkle_maps",
]
