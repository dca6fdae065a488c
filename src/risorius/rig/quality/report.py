"""The quality report: what was measured in every shape."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

from risorius.errors import ParameterError
from risorius.rig.quality.lid_gap import LidGap
from risorius.rig.quality.motion import Motion
from risorius.rig.quality.penetration import Penetration
from risorius.rig.quality.seam import Seam
from risorius.rig.quality.still import Drift
from risorius.rig.quality.symmetry import Asymmetry
from risorius.rig.quality.triangles import TriangleFaults

__all__ = ["QualityReport", "ShapeQuality"]

Cell = str | int | float | None


@dataclass(frozen=True)
class ShapeQuality:
    """One shape; None or empty where something could not be measured.

    Parameters
    ----------
    name : str
        Of the morph target.
    motion : Motion
    cracks : int or None
        Copies of seam vertices that leave their place; None without landmarks.
    skin_faults, hidden_faults, part_faults : TriangleFaults
        Of the visible skin, of the skin that lies inside (mouth bag, sockets), and of all other
        parts. Without landmarks everything counts as visible skin.
    seam : Seam or None
        The lips.
    penetration : mapping of str to Penetration
        By part.
    lids : mapping of str to LidGap
        By side, ``"l"`` and ``"r"``.
    drift : Drift or None
    asymmetry : Asymmetry or None
    """

    name: str
    motion: Motion
    cracks: int | None
    skin_faults: TriangleFaults
    hidden_faults: TriangleFaults
    part_faults: TriangleFaults
    seam: Seam | None
    penetration: Mapping[str, Penetration]
    lids: Mapping[str, LidGap]
    drift: Drift | None
    asymmetry: Asymmetry | None

    def row(self, size: float) -> dict[str, Cell]:
        """Return the shape as one row of a table: column name -> value.

        Parameters
        ----------
        size : float
            Of the head, in the report's unit.
        """
        seam, drift, mirror = self.seam, self.drift, self.asymmetry
        depth = max((each.depth for each in self.penetration.values()), default=None)
        deepest = max(self.penetration, key=lambda kind: self.penetration[kind].added, default="")
        added = self.penetration[deepest].added if deepest else None
        return {
            "shape": self.name,
            "moved": self.motion.moved,
            "largest": self.motion.largest,
            "mean": self.motion.mean,
            "percent": 100.0 * self.motion.largest / size if size else 0.0,
            "lost": None if seam is None else len(seam.lost),
            "invented": None if seam is None else len(seam.invented),
            "gap": None if seam is None else seam.gap,
            "opening": None if seam is None else seam.opening,
            "depth": depth,
            "added": added,
            "into": deepest if added else "",
            "lid_l": self.lids["l"].left if "l" in self.lids else None,
            "lid_r": self.lids["r"].left if "r" in self.lids else None,
            "inverted": self.skin_faults.inverted,
            "collapsed": self.skin_faults.collapsed,
            "stretched": self.skin_faults.stretched,
            "inside": sum(
                faults.inverted + faults.collapsed + faults.stretched
                for faults in (self.hidden_faults, self.part_faults)
            ),
            "cracks": self.cracks,
            "drift": None if drift is None else drift.largest,
            "asymmetry": None if mirror is None else mirror.largest,
        }

    def to_json(self) -> dict[str, Any]:
        """Return everything as plain numbers, texts, lists and mappings."""
        result = asdict(self)
        if self.seam is not None:
            result["seam"]["opening"] = self.seam.opening
        return result


@dataclass(frozen=True)
class QualityReport:
    """All shapes of one rig.

    Parameters
    ----------
    unit : str
        ``"mm"``, or ``"file unit"`` without landmarks: of every length in the report.
    size : float
        Diagonal of the neutral head's bounding box, in that unit.
    vertex_count : int
        Vertices of the file.
    shapes : tuple of ShapeQuality
        In the order of the rig's targets.
    notes : tuple of str
        What could not be measured, and why.
    """

    unit: str
    size: float
    vertex_count: int
    shapes: tuple[ShapeQuality, ...]
    notes: tuple[str, ...]

    def shape(self, name: str) -> ShapeQuality:
        """Return the shape called `name`.

        Raises
        ------
        ParameterError
            If there is none.
        """
        for shape in self.shapes:
            if shape.name == name:
                return shape
        raise ParameterError(f"report: no shape {name!r}")

    def rows(self) -> list[dict[str, Cell]]:
        """Return one row per shape, column name -> value; None where nothing was measured.

        Columns: `largest`, `mean`, `gap`, `depth`, `added` and `drift` are lengths in `unit`,
        `percent` is `largest` in percent of `size`, `opening` the lip gap over the chin's travel,
        `lid_l`, `lid_r` and `asymmetry` percent, `inside` the faulty triangles that do not show,
        the others counts.
        """
        return [shape.row(self.size) for shape in self.shapes]

    def to_json(self) -> dict[str, Any]:
        """Return the report as plain numbers, texts, lists and mappings."""
        return {
            "unit": self.unit,
            "size": self.size,
            "vertex_count": self.vertex_count,
            "notes": list(self.notes),
            "shapes": [shape.to_json() for shape in self.shapes],
        }
