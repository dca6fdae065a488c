"""The 66 low-level facial animation parameters (FAPs) of MPEG-4.

A parameter says how far one feature point goes in one direction, in units of the face itself
(FAPU), so that a stream made for one face fits every other. Parameters 1 and 2 are groups, visemes
and expressions; they are named here and not listed.

References
----------
ISO/IEC 14496-2, annex C.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache, lru_cache
from types import MappingProxyType
from typing import Literal, cast

from risorius.controls.tables import table_rows

__all__ = [
    "FAP_COUNT",
    "FIRST_LOW_LEVEL",
    "THESIS_LEAVES_OUT",
    "Fap",
    "FapUnit",
    "Way",
    "fap_name",
    "fap_number",
    "faps",
]

FAP_COUNT = 68
FIRST_LOW_LEVEL = 3
"""Number of the first parameter that moves a point; the two before it are groups."""

THESIS_LEAVES_OUT = (29, 30)
"""The two parameters that the set of 84 lacks: pupils, which are painted and not moved.

Fratarcangeli 2008 counts 64 low-level parameters of 66 and does not say which (erratum E2).
"""

FapUnit = Literal["IRISD", "ES", "ENS", "MNS", "MW", "AU"]
Way = Literal[
    "down", "up", "left", "right", "forward", "turn_left", "turn_down", "tilt_right", "grow", "curl"
]
_NAME = re.compile(r"fap_([1-9][0-9]?)")


@dataclass(frozen=True)
class Fap:
    """One parameter.

    Parameters
    ----------
    number : int
        3..68.
    name : str
        As the standard writes it.
    does : str
        What a positive value does.
    unit : str
        FAPU it counts in; ``"AU"`` is 1e-5 rad.
    way : str
        Direction of a positive value.
    one_way : bool
        Whether only positive values make sense.
    point : str
        Feature point that it moves.
    low, high : float
        Values outside are not sane and are clamped.
    """

    number: int
    name: str
    does: str
    unit: FapUnit
    way: Way
    one_way: bool
    point: str
    low: float
    high: float

    @property
    def target(self) -> str:
        """Name of its morph target: ``fap_3``."""
        return fap_name(self.number)

    @property
    def group(self) -> int:
        """Group of the standard: 2 jaw and inner lips, 3 eyes, ... 10 ears."""
        return int(self.point.partition(".")[0])

    @property
    def turns_head(self) -> bool:
        """Whether it turns the whole head, which no morph target does."""
        return self.group == 7


@cache
def faps() -> Mapping[int, Fap]:
    """Return the low-level parameters by number, in order."""
    return MappingProxyType(
        {
            int(row["number"]): Fap(
                int(row["number"]),
                row["name"],
                row["does"],
                cast(FapUnit, row["unit"]),
                cast(Way, row["direction"]),
                row["one_way"] == "yes",
                row["point"],
                float(row["low"]),
                float(row["high"]),
            )
            for row in table_rows("fap")
        }
    )


def fap_name(number: int) -> str:
    """Return the name of a parameter in streams and rigs: ``fap_3``."""
    return f"fap_{number}"


@lru_cache(4096)
def fap_number(name: str) -> int | None:
    """Return the number behind ``fap_3``, or None if `name` is no low-level parameter."""
    match = _NAME.fullmatch(name)
    number = int(match[1]) if match else 0
    return number if number in faps() else None
