"""The bar that a rig must reach."""

from __future__ import annotations

import re
from collections.abc import Iterator

from risorius.rig.quality.report import QualityReport, ShapeQuality

__all__ = ["shortcomings"]

_OPENING = 0.6
_LID_LEFT = 5.0
_DRIFT = 1.0
_JAW_OPEN = re.compile(r"jaw_?(open|pitch)$", re.IGNORECASE)
_BLINK = re.compile(r"blink", re.IGNORECASE)
_ONE_EYE = {
    "l": re.compile(r"(left|_l)$", re.IGNORECASE),
    "r": re.compile(r"(right|_r)$", re.IGNORECASE),
}
_EYES = {"l": "left", "r": "right"}


def shortcomings(report: QualityReport) -> tuple[str, ...]:
    """Return a sentence for everything that keeps a rig below the bar; none if it is good.

    The bar: no vertex of the lip seam moves with the wrong lip; ``jawOpen`` (or ``jaw_pitch``)
    opens the lips by at least 60 % of the chin's travel; a shape called blink leaves at most 5 %
    of the eye open; no seam cracks; no still zone moves over a millimetre. Bent triangles and
    penetration are reported, but a person must judge them: corrective shapes such as
    ``mouthClose`` are wrong alone and right together with others.
    """
    return tuple(sentence for shape in report.shapes for sentence in _of_shape(shape))


def _of_shape(shape: ShapeQuality) -> Iterator[str]:
    name, seam, drift = shape.name, shape.seam, shape.drift
    if seam is not None:
        wrong = len(seam.lost) + len(seam.invented)
        if wrong:
            first = (*seam.lost, *seam.invented)[0]
            yield f"{name}: {wrong} of the lip seam move with the wrong lip (vertex {first})"
        if _JAW_OPEN.search(name) and (seam.opening or 0.0) < _OPENING:
            yield (
                f"{name}: the lips open by {seam.gap:.1f} mm where the chin travels "
                f"{seam.chin:.1f} mm; at least {_OPENING:.0%} is expected"
            )
    if _BLINK.search(name):
        for side, gap in shape.lids.items():
            other = "r" if side == "l" else "l"
            if gap.left > _LID_LEFT and not _ONE_EYE[other].search(name):
                yield f"{name}: {gap.left:.0f} % of the {_EYES[side]} eye stay open"
    if shape.cracks:
        yield f"{name}: {shape.cracks} vertices on seams part from their copies and leave cracks"
    if drift is not None and drift.largest > _DRIFT:
        yield f"{name}: {drift.zone} moves {drift.largest:.1f} mm and should be still"
