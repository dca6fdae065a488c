"""Numbers of the fit: how muscles are laid between skin and bone."""

from __future__ import annotations

import math
from dataclasses import dataclass

from risorius._check import as_number, one_of
from risorius.errors import ParameterError

__all__ = ["FitParameters"]


@dataclass(frozen=True)
class FitParameters:
    """Lengths in millimetres at `REFERENCE_WIDTH`; what a recipe sets for a muscle goes first.

    Parameters
    ----------
    skin : float
        Thickness of the skin, tau_s. No number is published for this and the next three.
    least, most : float
        Thickness of the muscle layer, tau_min and tau_max.
    radius : float
        Skin within this distance of a muscle is bound to it, or within twice the mean edge.
    bone_depth : float
        Deepest that bone may lie below the skin it holds.
    rows, columns, passes : int
        Most rows and columns of a grid and rounds of refinement (finding S5).
    part : float
        Smallest part that a cut may leave of a cell, in mean extents of the triangles around.
    jump : float
        A new point whose projection goes farther than this keeps its place (finding S5).
    turn : float
        Skin turned by more than this against its surroundings is not fitted under: the groove
        beside the nose, folds [deg].
    overlap : float
        Factor of width and length of inner ellipsoids ("slightly enlarged").
    segment, breadth : float
        Longest segment and widest fibre; larger cells are divided before the refinement. Infinite
        as published: there the skin alone divides them.
    settle : int
        Rounds in which grid points move along their normals to the middle of what their cells
        leave them, after the refinement; none as published.
    ahead : bool
        Whether sphincters aim in front of their plane (finding S4).
    lines : bool
        Whether sphincters may be drawn to a line and around the eyeball (finding S6).
    loose_origins : bool
        Whether `MuscleAction.fixed_point` counts; the origin stays as published.
    merge : bool
        Whether ends that lie in other muscles are linked to them.
    yielding : float
        Share of a link's correction that a contracting muscle takes, against 1 of a resting one:
        1 as published (both halves are equal), 0.2 in the improved profile (finding S3).
    """

    skin: float = 2.0
    least: float = 1.0
    most: float = 4.0
    radius: float = 14.0
    bone_depth: float = 16.0
    rows: int = 24
    columns: int = 9
    passes: int = 30
    part: float = 0.6
    jump: float = 9.0
    turn: float = 50.0
    overlap: float = 1.1
    segment: float = 10.0
    breadth: float = 10.0
    settle: int = 6
    ahead: bool = True
    lines: bool = True
    loose_origins: bool = True
    merge: bool = True
    yielding: float = 0.2

    def __post_init__(self) -> None:
        if not 0.0 < self.least <= self.most:
            raise ParameterError(
                f"muscle thickness: least {self.least:g} and most {self.most:g} must be above 0, "
                "least first"
            )
        for name in ("skin", "radius", "bone_depth", "jump", "passes", "settle"):
            as_number(name, getattr(self, name), low=0.0)
        for name, low, high in (
            ("overlap", 1.0, 2.0),
            ("turn", 0.0, 180.0),
            ("yielding", 0.01, 1.0),
            ("part", 0.1, 10.0),
            ("rows", 2.0, 500.0),
            ("columns", 2.0, 500.0),
        ):
            as_number(name, getattr(self, name), low=low, high=high)
        if not (self.segment > 0.0 and self.breadth > 0.0):
            raise ParameterError(
                f"segment {self.segment:g} and breadth {self.breadth:g} must be above 0; infinite "
                "leaves the division to the skin"
            )

    @staticmethod
    def of_profile(profile: str) -> FitParameters:
        """Return the numbers of profile ``"improved"`` or ``"faithful"``."""
        one_of("profile", profile, ("improved", "faithful"))
        if profile == "improved":
            return FitParameters()
        return FitParameters(
            radius=8.0,
            bone_depth=10.0,
            rows=32,
            columns=16,
            passes=20,
            part=1.0,
            turn=90.0,
            segment=math.inf,
            breadth=math.inf,
            settle=0,
            ahead=False,
            lines=False,
            loose_origins=False,
            yielding=1.0,
        )
