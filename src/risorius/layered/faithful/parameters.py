"""Every number of the published face; the defaults are printed ones, clamps are our own."""

from __future__ import annotations

from dataclasses import dataclass, field

from risorius._check import as_number
from risorius.solvers.parameters import Parameters
from risorius.solvers.surface import SurfaceStiffness

__all__ = ["FaithfulParameters", "RingStiffness", "SheetStiffness"]


@dataclass(frozen=True)
class SheetStiffness:
    """Stiffness k of a sheet's constraints (spec 3.1); what is not named is 0."""

    across_upper: float = 1.0
    along_upper: float = 0.1
    connection: float = 1.0
    bend: float = 0.4
    volume: float = 1.0
    position: float = 0.2
    origin: float = 1.0
    """Of the whole origin row, which the text wants fixed; ours, 0.2 is the published value."""


@dataclass(frozen=True)
class RingStiffness:
    """Stiffness k of a sphincter's constraints (spec 3.1); what is not named is 0.

    Fibres run around it, so that what the thesis calls latitudinal joins inner and outer line.
    """

    across_upper: float = 0.2
    connection: float = 1.0
    shear_upper: float = 0.3
    shear_lower: float = 0.3
    bend: float = 1.0
    volume: float = 1.0
    position: float = 0.2


def _muscle_solver() -> Parameters:
    return Parameters(bend_step_limit=0.2, tolerance=2e-4, iteration_limit=60)


def _skin_solver() -> Parameters:
    return Parameters(
        iterations=4, sweeps="alternating", bend_step_limit=0.2, area_step_limit=0.2,
        tolerance=4e-5, iteration_limit=300,
    )  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class FaithfulParameters:
    """Parameters of `FaithfulFace`; lengths in millimetres of the built-in head.

    Parameters
    ----------
    sheet, ring, skin
        Stiffness of the constraints of sheets, sphincters and of the skin.
    muscle_solver, skin_solver : Parameters
        How a step is taken; the step limits are finding S2.
    anchor, bone_anchor : float
        Stiffness between the skin and what it hangs on: muscle, bone. Published: one number.
    shortening_limit : float
        Share of each muscle's limit of the map that control 1 reaches (finding S1).
    largest_contraction, largest_ring_contraction : float
        Clamps of the contraction, at which samples would coincide.
    protrusion : float
        Forward shift of a sphincter as a share of its mean motion in its plane; not published,
        about 2 lets lips pucker (finding S4).
    lift : bool
        Whether landmarks of the skull are lifted onto the muscles that cover them (spec 2.9), and
        bone sinks where muscle would come through the skin.
    wide : float
        A sheet wider than this has a fibre line in every column [mm].
    split_gap, split_tolerance, split_levels
        Splitting of segments: deepest free space that is bridged and offset that is left alone,
        as shares of a segment, and the largest depth.
    anchor_reach : float
        Longest ray inwards from the skin [mm] (finding S10).
    facing : float
        Least cosine between the skin's normal and that of what it hangs on (finding S10).
    lining_gap : float
        The lining of the mouth hangs on bone from this distance to the lip lines on [mm].
    corner_hold, corner_reach : float
        Share of the stiffness of anchors that is left at the mouth corners, and how far from them
        it is whole again [mm]. Skin there is torn between what goes with the skull and what goes
        with the jaw, and tears at full stiffness.
    lid_pinned : float
        Lid vertices that follow their margin by more than this share are moved by it alone.
    lid_hold : float
        Stiffness that the others are held with, times that share.
    influence_reach, jaw_reach : float
        Distance along the skin from what hangs on a muscle, or on the jaw, to where nothing
        moves, as share of the head's height; the jaw reaches farther, or the neck folds under it.
    contact_rounds : int
        How often contacts with teeth and between lips are looked for in one pose.
    ramp_steps, ramp_sweeps : int
        Stages over which a pose is entered, and sweeps in each.
    even : bool
        Whether a symmetric head's pose is averaged with the mirror image of the mirrored pose,
        which removes the trace of the constraints' order (acceptance 19); takes twice as long.
    """

    sheet: SheetStiffness = field(default_factory=SheetStiffness)
    ring: RingStiffness = field(default_factory=RingStiffness)
    skin: SurfaceStiffness = field(default_factory=SurfaceStiffness)
    muscle_solver: Parameters = field(default_factory=_muscle_solver)
    skin_solver: Parameters = field(default_factory=_skin_solver)
    anchor: float = 0.2
    bone_anchor: float = 0.2
    shortening_limit: float = 1.0
    largest_contraction: float = 0.99
    largest_ring_contraction: float = 0.95
    protrusion: float = 0.0
    lift: bool = True
    wide: float = 8.0
    split_gap: float = 0.25
    split_tolerance: float = 0.01
    split_levels: int = 6
    anchor_reach: float = 45.0
    facing: float = 0.1
    lining_gap: float = 8.0
    corner_hold: float = 0.02
    corner_reach: float = 18.0
    lid_pinned: float = 0.5
    lid_hold: float = 0.2
    influence_reach: float = 0.25
    jaw_reach: float = 0.55
    contact_rounds: int = 3
    ramp_steps: int = 5
    ramp_sweeps: int = 12
    even: bool = True

    def __post_init__(self) -> None:
        for name in ("anchor", "bone_anchor", "largest_contraction", "largest_ring_contraction",
                     "lid_pinned", "lid_hold", "shortening_limit", "corner_hold"):  # fmt: skip
            as_number(name, getattr(self, name), low=0.0, high=1.0)
        for name in ("ramp_steps", "ramp_sweeps", "contact_rounds"):
            as_number(name, getattr(self, name), low=1)
        for name in ("anchor_reach", "corner_reach", "influence_reach", "jaw_reach"):
            as_number(name, getattr(self, name), low=1e-6)
