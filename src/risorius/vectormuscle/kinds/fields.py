"""Entries that several muscle kinds share."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, cast

from risorius.errors import ParameterError

__all__ = ["read_regions"]


def read_regions(entry: Mapping[str, Any], where: str) -> tuple[str, ...]:
    """Return the region names of a recipe entry; empty where it names none.

    Raises
    ------
    ParameterError
        If the entry is not a list of words.
    """
    regions = entry.get("regions", [])
    if not isinstance(regions, list) or not all(
        isinstance(name, str) for name in cast(list[Any], regions)
    ):
        raise ParameterError(f"{where}: regions must be a list of region names")
    return tuple(cast(list[str], regions))
