"""Which vertices a finding of the quality report is about."""

from __future__ import annotations

from risorius.rig.quality.report import ShapeQuality

__all__ = ["offenders_of"]


def offenders_of(shape: ShapeQuality) -> dict[str, tuple[int, ...]]:
    """Return the vertices of the file behind each finding of a shape, by what is wrong."""
    found: dict[str, tuple[int, ...]] = {}
    if shape.seam is not None:
        found["stays with the other lip"] = shape.seam.lost
        found["moves with the other lip"] = shape.seam.invented
    for kind, depth in shape.penetration.items():
        if depth.vertex >= 0 and depth.added > 0.0:
            found[f"into {kind} by {depth.added:.2f} mm"] = (depth.vertex,)
    if shape.motion.vertex >= 0:
        found[f"moves most, {shape.motion.largest:.1f} mm"] = (shape.motion.vertex,)
    return {what: vertices for what, vertices in found.items() if vertices}
