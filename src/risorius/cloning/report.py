"""What a clone says about itself."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

__all__ = ["CloneReport", "ShapeReport"]


@dataclass(frozen=True)
class ShapeReport:
    """One cloned shape.

    Parameters
    ----------
    name : str
    moved : int
        Target vertices that move.
    largest : float
        Largest displacement [mm].
    kept : float
        Mean cosine between the displacements of the landmarks on both heads, weighted by the
        source's; 1 where every landmark moves the same way [1].
    size : float
        Motion of the landmarks over that of the source's, up to the similarity [1].
    """

    name: str
    moved: int
    largest: float
    kept: float | None
    size: float | None


@dataclass(frozen=True)
class CloneReport:
    """How two heads were matched and what became of each shape.

    Parameters
    ----------
    landmark_count : int
        Landmarks that both heads have.
    landmark_miss : float
        What the best similarity leaves of them, root mean square [mm].
    scale : float
        Size of the target's face over the source's [1].
    residual_mean, residual_largest : float
        Distance of the fitted source's skin to the target's [mm].
    unmapped : int
        Target skin vertices without a place on the source: they stay at rest.
    folded : float
        Share of the source's faces that the fit turns over [1].
    shapes : tuple of ShapeReport
    notes : tuple of str
    seconds : mapping of str to float
    """

    landmark_count: int
    landmark_miss: float
    scale: float
    residual_mean: float
    residual_largest: float
    unmapped: int
    folded: float
    shapes: tuple[ShapeReport, ...]
    notes: tuple[str, ...]
    seconds: dict[str, float]

    def to_json(self) -> dict[str, Any]:
        """Return the report as plain values."""
        return asdict(self)
