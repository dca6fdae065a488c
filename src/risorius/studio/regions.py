"""Which group of the panel a control stands in, and how it is called there."""

from __future__ import annotations

from collections.abc import Iterable

from risorius.controls.control import Control
from risorius.controls.standard import MUSCLES, SINGLE_MUSCLES

__all__ = ["REGIONS", "Row", "region_of", "rows_of", "title_of"]

REGIONS = ("My muscles", "Brows", "Eyes", "Nose and cheeks", "Lips and chin", "Jaw", "Tongue")
"""Groups of controls from top to bottom."""

_STEMS = {
    "Brows": ("frontalis", "corrugator", "procerus", "orbicularis_oculi_upper"),
    "Eyes": ("orbicularis_oculi", "lid_", "gaze_"),
    "Nose and cheeks": ("nasalis", "levator_alae", "cheek_puff", "zygomaticus_minor"),
    "Jaw": ("jaw_",),
    "Tongue": ("tongue_",),
}
_OWN = "My muscles"


class Row:
    """A control, or the two sides of one.

    Parameters
    ----------
    name : str
        Without side.
    controls : list of Control
        One, or left and right.
    """

    def __init__(self, name: str, controls: list[Control]) -> None:
        self.name = name
        self.controls = controls

    @property
    def is_mirrored(self) -> bool:
        """Whether the two sides move alike with opposite numbers."""
        return self.controls[0].mirror_sign < 0.0


def region_of(name: str) -> str:
    """Return the group of a control by its name without side."""
    for region, stems in _STEMS.items():
        if name.startswith(stems):
            return region
    known = name in MUSCLES or name in SINGLE_MUSCLES or name == "lips_together"
    return "Lips and chin" if known else _OWN


def title_of(name: str) -> str:
    """Return a name as people read it."""
    return name.replace("_", " ")


def rows_of(controls: Iterable[Control]) -> dict[str, list[Row]]:
    """Return the rows of each region in order, the sides of a control in one row."""
    rows: dict[str, Row] = {}
    for control in controls:
        sided = control.name.endswith(("_l", "_r")) and control.mirror != control.name
        stem = control.name[:-2] if sided else control.name
        if stem in rows:
            rows[stem].controls.append(control)
        else:
            rows[stem] = Row(stem, [control])
    result: dict[str, list[Row]] = {region: [] for region in REGIONS}
    for stem, row in rows.items():
        result[region_of(stem)].append(row)
    return {region: found for region, found in result.items() if found}
