"""FACS action units: what single muscles and groups of them do to a face (Ekman and Friesen)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from types import MappingProxyType

from risorius.controls.tables import table_rows

__all__ = ["ActionUnit", "action_units"]


@dataclass(frozen=True)
class ActionUnit:
    """One action unit: number, name, region of the face, muscles, and why it is not made."""

    number: int
    name: str
    region: str
    muscles: str
    left_out: str

    @property
    def target(self) -> str:
        """Name of its morph target: ``au_12``; one-sided ones end in ``_l`` or ``_r``."""
        return f"au_{self.number}"


@cache
def action_units() -> Mapping[int, ActionUnit]:
    """Return the action units by number."""
    return MappingProxyType(
        {
            int(row["number"]): ActionUnit(
                int(row["number"]), row["name"], row["region"], row["muscles"], row["left_out"]
            )
            for row in table_rows("action_units")
        }
    )
