"""Muscles of the layered face as a person draws them: sheets and sphincters on a skull."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from risorius._check import FloatArray
from risorius.errors import ParameterError

__all__ = [
    "BONES",
    "EyeAction",
    "Lip",
    "MouthAction",
    "Muscle",
    "Ring",
    "Sheet",
    "SheetAction",
    "mirrored_name",
]

Lip = Literal["upper", "lower"]

BONES = ("cranium", "mandible")
"""Surfaces that every muscle map may build on."""

_MIRROR = np.array([-1.0, 1.0, 1.0])


@dataclass(frozen=True)
class SheetAction:
    """What a sheet does to the skin when it contracts.

    Parameters
    ----------
    fixed_point : float
        Place along the fibre that stays, 0 the origin, 1 the insertion.
    stiffness : float
        How strongly it holds the skin, in units of a plain muscle.
    reach : float
        Skin within this distance of its fibres follows [mm].
    tangential : float
        Share of the pull across the skin that is dropped: skin slides over bone.
    arch : float
        Share of the depth that follows the dental arch where tissue slides sideways.
    corner : float
        How far it spares the body of the lips: muscles of the mouth corner hold the modiolus.
    push : float
        Outward push at full contraction, negative inwards [mm].
    bulge : float
        The same at the origin only, fading towards the insertion [mm].
    sideways : float
        Motion away from the midline at full contraction, fading towards the insertion [mm].
    slide : float
        How far the skin is let go towards the origin: 1 holds it at the insertion only.
    seal : bool
        Whether the lips stay together under its pull.
    lip : {"upper", "lower"} or None
        The only lip that it moves.
    """

    fixed_point: float = 0.0
    stiffness: float = 1.0
    reach: float = 20.0
    tangential: float = 0.0
    arch: float = 0.0
    corner: float = 0.0
    push: float = 0.0
    bulge: float = 0.0
    sideways: float = 0.0
    slide: float = 0.0
    seal: bool = False
    lip: Lip | None = None


@dataclass(frozen=True)
class MouthAction:
    """What a part of the orbicularis oris does, in units of half the mouth's width.

    Parameters
    ----------
    lips : tuple of {"upper", "lower"}
        The lips that it moves.
    narrow : float
        How far the lips draw together sideways.
    forward : float
        How far their middle comes forward.
    squeeze : float
        How far their height shrinks; negative opens.
    turn : float
        Turn of the lip about its own length; positive rolls it in [deg].
    window : (float, float)
        Distance from the lip line with full and with no effect, on the built-in head [mm].
    stiffness : float
        As of a sheet.
    """

    lips: tuple[Lip, ...]
    narrow: float = 0.0
    forward: float = 0.0
    squeeze: float = 0.0
    turn: float = 0.0
    window: tuple[float, float] = (10.0, 27.0)
    stiffness: float = 1.0


@dataclass(frozen=True)
class EyeAction:
    """What a part of the orbicularis oculi does, in units of half the eye's width.

    Parameters
    ----------
    centre : (float, float)
        Where it draws the skin to, outwards and up from the middle of the eye.
    axes : (float, float)
        Half axes of the ellipses that `window` counts.
    window : (float, float, float, float)
        No effect inside the first ellipse, full between the second and third, none beyond.
    sector : (float, float)
        Direction of its middle, counter-clockwise from outwards, and half opening [deg].
    pull : (float, float)
        Share of the contraction sideways and upwards.
    stiffness : float
        As of a sheet.
    """

    centre: tuple[float, float] = (0.0, 0.0)
    axes: tuple[float, float] = (1.0, 1.0)
    window: tuple[float, float, float, float] = (0.9, 1.5, 2.2, 3.6)
    sector: tuple[float, float] = (0.0, 180.0)
    pull: tuple[float, float] = (1.0, 1.0)
    stiffness: float = 1.0


@dataclass(frozen=True, eq=False)
class Sheet:
    """Shape of a sheet muscle.

    Parameters
    ----------
    line : (k, 3) float64
        Centre line from origin to insertion, skull space [mm].
    half_width : (k,) float64
        Half width at each of its points [mm].
    direction : (3,) float64 or None
        Direction along which it is laid on what lies beneath; outwards from the skull if None.
    """

    line: FloatArray
    half_width: FloatArray
    direction: FloatArray | None = None


@dataclass(frozen=True, eq=False)
class Ring:
    """Shape of a sphincter: two ellipses in the frontal plane.

    Parameters
    ----------
    centre : (3,) float64
        Skull space [mm].
    inner, outer : (2,) float64
        Half axes sideways and upwards [mm].
    """

    centre: FloatArray
    inner: FloatArray
    outer: FloatArray


@dataclass(frozen=True, eq=False)
class Muscle:
    """One entry of a muscle map.

    Parameters
    ----------
    name : str
        Name of its control, without side.
    layer : int
        1 on the bone, higher ones above.
    shape : Sheet or Ring
    action : SheetAction, MouthAction, EyeAction or None
        What the default profile makes of it; None for passive tissue.
    on : tuple of str
        What it lies on: names of `BONES` and of muscles of deeper layers (without side: those of
        its own side). Empty for a muscle that bridges free tissue where it is drawn.
    thickness : float
        [mm].
    sections : (int, int)
        Fibres across and samples along of a sheet; columns around and rows of a ring.
    shortening : float
        Contraction of the fibres at control 1; real muscles shorten by a quarter to a half.
    active : bool
        False for tissue that only carries others.
    mirror : bool
        Drawn on the left and copied to the right.
    together : bool
        Left and right share one control.
    extended : bool
        Not in the published map; left out of the faithful profile.
    """

    name: str
    layer: int
    shape: Sheet | Ring
    action: SheetAction | MouthAction | EyeAction | None
    on: tuple[str, ...]
    thickness: float
    sections: tuple[int, int]
    shortening: float = 0.0
    active: bool = True
    mirror: bool = True
    together: bool = False
    extended: bool = False

    @property
    def kind(self) -> Literal["sheet", "sphincter"]:
        """Kind of its shape."""
        return "sheet" if isinstance(self.shape, Sheet) else "sphincter"

    @property
    def control_names(self) -> tuple[str, ...]:
        """Left and right control of a paired muscle, else its only one."""
        if self.mirror and not self.together:
            return (f"{self.name}_l", f"{self.name}_r")
        return (self.name,)

    def mirrored(self) -> Muscle:
        """Return its mirror image; the name is without side and stays."""
        if isinstance(self.shape, Ring):
            return replace(self, shape=replace(self.shape, centre=self.shape.centre * _MIRROR))
        direction = self.shape.direction
        flipped = Sheet(
            self.shape.line * _MIRROR,
            self.shape.half_width,
            None if direction is None else direction * _MIRROR,
        )
        return replace(self, shape=flipped)


def mirrored_name(control: str) -> str:
    """Return the control of the other side; itself on the midline.

    Raises
    ------
    ParameterError
        If `control` is empty.
    """
    if not control:
        raise ParameterError("control: a name is needed, got an empty text")
    sides = {"_l": "_r", "_r": "_l"}
    return control[:-2] + sides[control[-2:]] if control[-2:] in sides else control
