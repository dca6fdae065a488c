"""Sections of a presets file beyond emotions and ARKit: which entries they may have."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType

from risorius.controls.facs import action_units
from risorius.controls.visemes import mpeg4_visemes, oculus_visemes

__all__ = ["STANDARD_SETS", "StandardSet"]


@dataclass(frozen=True)
class StandardSet:
    """A set of shapes of a standard.

    Parameters
    ----------
    prefix : str
        Of the names of its targets.
    entries : callable
        Names of the entries in order, without the prefix; a side may follow (``30_l``).
    left_out : callable
        Entries that no face makes, with the reason.
    """

    prefix: str
    entries: Callable[[], tuple[str, ...]]
    left_out: Callable[[], Mapping[str, str]]


def _nothing() -> Mapping[str, str]:
    return {}


def _mpeg4() -> tuple[str, ...]:
    return tuple(viseme.name for viseme in mpeg4_visemes())


def _oculus() -> tuple[str, ...]:
    return tuple(viseme.name for viseme in oculus_visemes())


def _facs() -> tuple[str, ...]:
    return tuple(str(number) for number in action_units())


def _facs_left_out() -> Mapping[str, str]:
    return {str(unit.number): unit.left_out for unit in action_units().values() if unit.left_out}


STANDARD_SETS: Mapping[str, StandardSet] = MappingProxyType(
    {
        "visemes_mpeg4": StandardSet("viseme_mpeg4_", _mpeg4, _nothing),
        "visemes_oculus": StandardSet("viseme_oculus_", _oculus, _nothing),
        "facs": StandardSet("au_", _facs, _facs_left_out),
    }
)
"""By section of the presets file, which is also the name of the set for ``--shapes``."""
