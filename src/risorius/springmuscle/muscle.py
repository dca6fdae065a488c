"""A muscle fitted under the skin of one head: fibres, ellipsoids, how it contracts."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray
from risorius.errors import ParameterError, ShapeError

__all__ = ["JAW", "SKULL", "Fibre", "FitReport", "FittedMuscle", "MuscleAction", "MuscleKind"]

Int8Array = npt.NDArray[np.int8]
MuscleKind = Literal["linear", "sheet", "curved", "sphincter"]

SKULL, JAW = 1, 2
"""Bones that points are attached to; 0 is neither."""


@dataclass(frozen=True)
class MuscleAction:
    """What contraction does; lengths in millimetres of this head.

    Parameters
    ----------
    control : str
        Name of the control that contracts the muscle.
    max_contraction : float
        Contraction c at control 1: the share of its length that a living muscle gives up.
    stiffness : float
        How strongly it holds the skin, in units of a plain muscle.
    radius : float
        Skin within this distance of its ellipsoids is bound to it [mm].
    fixed_point : float
        Place along the fibre that stays, 0 the origin (as published), 1 the insertion. A muscle
        that ends in a loose aponeurosis, such as the frontalis in the galea, draws both its ends
        together.
    seal : bool
        Whether the lips stay together while the muscle pulls at one of them.
    bulge : float
        Gain of height per strain: 2 as published.
    host : bool
        Whether ends of other muscles merge with it.
    """

    control: str
    max_contraction: float = 1.0
    stiffness: float = 1.0
    radius: float = 8.0
    fixed_point: float = 0.0
    bulge: float = 2.0
    seal: bool = False
    host: bool = True


@dataclass(frozen=True, eq=False)
class Fibre:
    """A row of p control points with p - 1 ellipsoids between them.

    Parameters
    ----------
    points : (p, 3) float64
        Relaxed control points, the fixed end first; a closed fibre repeats its first point [mm].
    bones : (p,) int8
        `SKULL` or `JAW`, what each point is attached to.
    half_axes : (p - 1, 3) float64
        Half length along the fibre, half width along the skin, half height out of it [mm].
    frames : (p - 1, 3, 3) float64
        Columns are the unit vectors along the fibre, along the skin, out of the skin.
    lips : (p - 1,) int8
        1 under the upper lip, -1 under the lower, 0 elsewhere: skin of the other lip never binds.
    aims : (p, 3) float64 or None
        Where the points of a sphincter are drawn to [mm]; None for fibres with a fixed end.
    shares : (p,) float64
        How much of the muscle's contraction acts at each point of a sphincter.
    """

    points: FloatArray
    bones: Int8Array
    half_axes: FloatArray
    frames: FloatArray
    lips: Int8Array
    aims: FloatArray | None = None
    shares: FloatArray | None = None

    def __post_init__(self) -> None:
        count = len(self.points)
        if count < 2 or self.points.shape != (count, 3):
            raise ShapeError(f"fibre: needs at least two points (p, 3), got {self.points.shape}")
        expected = {
            "bones": (count,), "half_axes": (count - 1, 3), "frames": (count - 1, 3, 3),
            "lips": (count - 1,),
        }  # fmt: skip
        for name, shape in expected.items():
            if getattr(self, name).shape != shape:
                raise ShapeError(
                    f"fibre: {name} has shape {getattr(self, name).shape}, {count} points need "
                    f"{shape}"
                )
        lengths = np.linalg.norm(np.diff(self.points, axis=0), axis=1)
        if not (lengths > 0.0).all():
            raise ParameterError(
                f"fibre: points {int(np.argmin(lengths))} and {int(np.argmin(lengths)) + 1} are "
                "the same; merge them"
            )

    @property
    def centres(self) -> FloatArray:
        """Centres of the ellipsoids (p - 1, 3) [mm]."""
        return 0.5 * (self.points[1:] + self.points[:-1])

    @property
    def lengths(self) -> FloatArray:
        """Relaxed lengths of the segments (p - 1,) [mm]."""
        return np.linalg.norm(np.diff(self.points, axis=0), axis=1)


@dataclass(frozen=True, eq=False)
class FitReport:
    """How well a grid lies in the layer between skin and bone.

    Parameters
    ----------
    near, far : (r - 1, c - 1) float64
        Way that a cell's shallowest and deepest sample would have to go to lie in the allowed
        range; 0 inside it [mm].
    thickness : (r - 1, c - 1) float64
        Of the muscle in each cell [mm].
    final : (r - 1, c - 1) bool
        Cells that would have been divided, had they not been too small.
    inside : float
        Share of the samples in the allowed range, of those that have skin above them.
    passes : int
        Rounds of refinement.
    missed : int
        Points whose projection found no skin, or jumped, and which kept their interpolated place.
    stopped : {"fits", "small", "stagnation", "limit"}
        Why refinement ended: nothing to do, only cells too small to divide, no gain, too many.
    covered : float
        Share of the samples that have skin above them; the others lie below walls of folds or
        beside the skin.
    """

    near: FloatArray
    far: FloatArray
    thickness: FloatArray
    final: npt.NDArray[np.bool_]
    inside: float
    passes: int
    missed: int
    stopped: Literal["fits", "small", "stagnation", "limit"]
    covered: float = 1.0


@dataclass(frozen=True, eq=False)
class FittedMuscle:
    """A muscle on one head.

    Parameters
    ----------
    name : str
        Ends in ``_l`` or ``_r`` where the muscle is paired.
    kind : {"linear", "sheet", "curved", "sphincter"}
        A sphincter contracts towards its aims, all others towards their first row.
    action : MuscleAction
    fibres : tuple of Fibre
        One per column of cells, all with the same number of points.
    closed : bool
        Whether the fibres run in a ring; their first point is their last.
    pivot : (3,) float64 or None
        Centre of the eyeball that a sphincter slides around at constant distance [mm].
    grid, grid_normals : (r, c, 3) float64
        Refined grid in the middle of the muscle, and its unit normals out of the skin [mm].
    outline : (a, b, 3) float64
        The grid as drawn, filled up and laid on the skin [mm].
    report : FitReport
    """

    name: str
    kind: MuscleKind
    action: MuscleAction
    fibres: tuple[Fibre, ...]
    closed: bool
    pivot: FloatArray | None
    grid: FloatArray
    grid_normals: FloatArray
    outline: FloatArray
    report: FitReport

    def __post_init__(self) -> None:
        if not self.fibres:
            raise ShapeError(f"muscle {self.name}: has no fibre; its grid needs two columns")

    @property
    def sphincter(self) -> bool:
        """Whether the muscle contracts towards aims instead of its first row."""
        return self.kind == "sphincter"

    @property
    def base_name(self) -> str:
        """The name without its side."""
        return self.name[:-2] if self.name.endswith(("_l", "_r")) else self.name

    @property
    def side(self) -> int:
        """1 for a left muscle, -1 for a right one, 0 for one on the midline."""
        return {"_l": 1, "_r": -1}.get(self.name[-2:], 0)
