"""The outline recipe: what a person draws, in terms that fit any head."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from risorius._check import FloatArray
from risorius.controls.standard import SINGLE_MUSCLES
from risorius.errors import LandmarkError, ParameterError
from risorius.landmarks.feature_points import mirror_name
from risorius.springmuscle.measure import FaceMeasure
from risorius.springmuscle.muscle import MuscleKind

__all__ = ["MuscleOutline", "OutlinePoint", "OutlineRecipe", "OutlineSettings", "Ring"]

Thickness = float | Mapping[str, float]

_MIRROR = np.array([-1.0, 1.0, 1.0])


@dataclass(frozen=True)
class OutlinePoint:
    """A place on any face: the mean of landmarks, moved in units of the face.

    Parameters
    ----------
    anchors : tuple of str
        Names of landmarks.
    offset : tuple of float
        In widths, heights and widths of the face (`FaceMeasure.unit`), +X left, +Y up, +Z forward.
    weights : tuple of float
        How much each anchor counts; empty where all count alike.
    """

    anchors: tuple[str, ...]
    offset: tuple[float, float, float] = (0.0, 0.0, 0.0)
    weights: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        if not self.anchors:
            raise ParameterError("outline point: has no landmark to hang on")
        if self.weights and (len(self.weights) != len(self.anchors) or not min(self.weights) > 0.0):
            raise ParameterError(
                f"outline point {'+'.join(self.anchors)}: needs one weight above 0 per landmark, "
                f"got {list(self.weights)}"
            )

    def place(self, measure: FaceMeasure) -> FloatArray:
        """Return where the point lies (3,) on a face [mm].

        Raises
        ------
        LandmarkError
            If the face lacks a landmark.
        """
        missing = [name for name in self.anchors if name not in measure.landmarks]
        if missing:
            raise LandmarkError(
                f"landmarks: the outline needs {', '.join(missing)}; add it to the landmark file "
                "or anchor the point elsewhere"
            )
        places = [measure.landmarks[name] for name in self.anchors]
        middle = np.average(places, axis=0, weights=self.weights or None)
        return middle + np.array(self.offset) * measure.unit

    def mirrored(self) -> OutlinePoint:
        """Return the point on the other side of the face."""
        x, y, z = self.offset
        names = tuple(mirror_name(name) for name in self.anchors)
        return OutlinePoint(names, (-x, y, z), self.weights)


@dataclass(frozen=True)
class Ring:
    """How a sphincter contracts.

    Parameters
    ----------
    centre : OutlinePoint
        What it contracts towards.
    ahead : float
        How far in front of the centre the aim lies; a mouth cannot pucker in its own plane
        (finding S4). The faithful profile leaves it out [mm at `REFERENCE_WIDTH`].
    line : tuple of OutlinePoint
        Left and right end of a line that bends through the centre; each point of the ring is
        drawn to the part of the line nearest to it, as lids are (finding S6). Empty for a point.
    turn : float
        Instead of drawing its points to the line, turn them about it by so much at contraction 1,
        the front going down [deg]: how a lip rolls over the teeth. Needs a line.
    around_eye : bool
        Whether the fibres slide around the eyeball of their side.
    closed : bool
        Whether the last row joins the first.
    shares : tuple of float
        How much of the contraction acts at each row; empty for all of it.
    """

    centre: OutlinePoint
    ahead: float = 0.0
    line: tuple[OutlinePoint, ...] = ()
    turn: float = 0.0
    around_eye: bool = False
    closed: bool = True
    shares: tuple[float, ...] = ()


@dataclass(frozen=True)
class OutlineSettings:
    """What can be set for each muscle; lengths are millimetres at `REFERENCE_WIDTH`.

    Parameters
    ----------
    skin : float or mapping of str to float, optional
        Thickness of the skin above the muscle: one number, or a map of landmarks to thickness,
        between which the nearer ones count more. None takes that of the fit parameters.
    thickness : tuple of float, optional
        Least and most thickness of the muscle.
    radius : float, optional
        Skin within this distance is bound to it.
    max_contraction : float
        Contraction at control 1.
    stiffness : float
        How strongly it holds the skin, in units of a plain muscle.
    fixed_point : float
        Place along the fibre that stays; see `MuscleAction`.
    bulge : float
        Gain of height per strain; see `MuscleAction`.
    seal : bool
        Whether the lips stay together while it pulls; see `MuscleAction`.
    host : bool
        Whether ends of other muscles merge with it; off for a second action on the same ring.
    """

    skin: Thickness | None = None
    thickness: tuple[float, float] | None = None
    radius: float | None = None
    max_contraction: float = 1.0
    stiffness: float = 1.0
    fixed_point: float = 0.0
    bulge: float = 2.0
    seal: bool = False
    host: bool = True


@dataclass(frozen=True)
class MuscleOutline:
    """One muscle as drawn.

    Parameters
    ----------
    name : str
        Without side in a recipe; with it after `OutlineRecipe.sided`.
    kind : {"linear", "sheet", "curved", "sphincter"}
    rows : tuple of tuple of OutlinePoint
        At least two rows of at least two points, the fixed end first; fibres run from row to row.
        Rows of a sphincter run around it, each from inside to outside.
    mirror : bool
        Whether the muscle exists left (as drawn) and right.
    control : str
        What contracts it; empty for the muscle's own name.
    ring : Ring or None
        Of a sphincter.
    settings : OutlineSettings
    """

    name: str
    kind: MuscleKind
    rows: tuple[tuple[OutlinePoint, ...], ...]
    mirror: bool = True
    control: str = ""
    ring: Ring | None = None
    settings: OutlineSettings = field(default_factory=OutlineSettings)

    def __post_init__(self) -> None:
        where = f"outline {self.name}"
        if len(self.rows) < 2:
            raise ParameterError(f"{where}: has {len(self.rows)} row(s), at least 2 are needed")
        for number, row in enumerate(self.rows):
            if len(row) < 2:
                raise ParameterError(f"{where}: row {number} has {len(row)} point(s), 2 are needed")
        if (self.ring is None) != (self.kind != "sphincter"):
            raise ParameterError(
                f"{where}: a sphincter needs a ring with a centre, and only a sphincter has one"
            )
        if self.ring is not None and self.ring.turn and not self.ring.line:
            raise ParameterError(f"{where}: turns about a line, but has none; give its ends")
        shares = self.ring.shares if self.ring else ()
        if shares and len(shares) != len(self.rows):
            raise ParameterError(
                f"{where}: has {len(shares)} shares for {len(self.rows)} rows; give one per row"
            )

    def sided(self, side: int) -> MuscleOutline:
        """Return the left (1) or right (-1) muscle of a paired outline, named with its side."""
        ending = "_l" if side > 0 else "_r"
        control = self.control or self.name
        if control not in SINGLE_MUSCLES:
            control += ending
        named = replace(self, name=self.name + ending, control=control, mirror=False)
        return named if side > 0 else named._flipped()

    def mirrors(self, other: MuscleOutline) -> bool:
        """Return whether this muscle is drawn as the mirror image of `other`."""
        return replace(self._flipped(), name=other.name, control=other.control) == other

    def _flipped(self) -> MuscleOutline:
        rows = tuple(tuple(point.mirrored() for point in row) for row in self.rows)
        ring = self.ring
        if ring is not None:
            line = tuple(point.mirrored() for point in reversed(ring.line))
            ring = replace(ring, centre=ring.centre.mirrored(), line=line)
        skin = self.settings.skin
        if isinstance(skin, Mapping):
            skin = {mirror_name(name): value for name, value in skin.items()}
        return replace(self, rows=rows, ring=ring, settings=replace(self.settings, skin=skin))


@dataclass(frozen=True)
class OutlineRecipe:
    """Outlines of all muscles of a face.

    Parameters
    ----------
    muscles : tuple of MuscleOutline
        Paired ones once, drawn on the left; names are unique.
    """

    muscles: tuple[MuscleOutline, ...]

    def __post_init__(self) -> None:
        names = [outline.name for outline in self.sided()]
        twice = sorted({name for name in names if names.count(name) > 1})
        if twice:
            raise ParameterError(f"recipe: {', '.join(twice)} is there twice; names are unique")

    def sided(self) -> tuple[MuscleOutline, ...]:
        """Return one outline per muscle, left before right, named with their sides."""
        result: list[MuscleOutline] = []
        for outline in self.muscles:
            if outline.mirror:
                result.extend((outline.sided(1), outline.sided(-1)))
            else:
                result.append(replace(outline, control=outline.control or outline.name))
        return tuple(result)

    def outline(self, name: str) -> MuscleOutline:
        """Return the outline of muscle `name`, with its side.

        Raises
        ------
        ParameterError
            If there is none.
        """
        for outline in self.sided():
            if outline.name == name:
                return outline
        raise ParameterError(
            f"recipe: no muscle {name!r}; there are "
            f"{', '.join(outline.name for outline in self.sided())}"
        )

    def replaced(self, *outlines: MuscleOutline) -> OutlineRecipe:
        """Return the recipe with some muscles replaced by others of the same names."""
        changed = {outline.name: outline for outline in outlines}
        unknown = sorted(changed.keys() - {outline.name for outline in self.muscles})
        if unknown:
            raise ParameterError(f"recipe: has no {', '.join(unknown)} to replace")
        kept = tuple(changed.get(outline.name, outline) for outline in self.muscles)
        return OutlineRecipe(kept)


def thickness_at(thickness: Thickness, points: FloatArray, measure: FaceMeasure) -> FloatArray:
    """Return the skin's thickness (q,) at `points` (q, 3), in millimetres of this head.

    A map counts by inverse squared distance from its landmarks (Shepard), so that it is met
    exactly at each of them.
    """
    if not isinstance(thickness, Mapping):
        return np.full(len(points), float(thickness) * measure.scale)
    names = [name for name in thickness if name in measure.landmarks]
    if not names:
        raise LandmarkError(
            "landmarks: none of the map of thickness is on this head; it names "
            f"{', '.join(thickness)}"
        )
    places = np.array([measure.landmarks[name] for name in names])
    values = np.array([thickness[name] for name in names])
    square = ((points[:, None] - places[None]) ** 2).sum(axis=2)
    weight = 1.0 / np.maximum(square, 1e-9 * measure.width**2)
    return (weight @ values) / weight.sum(axis=1) * measure.scale
