"""The skin: loops and fill of the left half, evened out and mirrored."""

from __future__ import annotations

import numpy as np

from .brow import brow
from .eye_loops import eye_loops
from .fill import fill_skin
from .half_skin import HalfSkin, SkinAssembly
from .mouth_loops import BORDER_ROW, mouth_loops
from .part import triangles_of
from .projecting import slide
from .topology import vertex_mean

__all__ = ["build_half_skin", "mirror_half"]


def _even_out(positions, polygons, rows):
    """Slide the vertices of `rows` along the skin towards their neighbours."""
    chosen = np.concatenate(rows)
    mean = vertex_mean(triangles_of(polygons), len(positions))
    on_midline = positions[chosen, 0] < 1e-6
    for _ in range(4):
        target = (mean @ positions)[chosen]
        target[on_midline] = positions[chosen][on_midline]
        moved = slide(positions[chosen], target, 0.35)
        moved[on_midline, 0] = 0.0
        positions = positions.copy()
        positions[chosen] = moved
    return positions


def build_half_skin(landmarks):
    """Return the left half of the skin; `landmarks` (k, 3) become vertices [mm]."""
    mouth, eye, eyebrow = mouth_loops(), eye_loops(), brow()
    fill = fill_skin(mouth.outer[-1], [eye.outer[-1], eyebrow.ring], landmarks)
    eye_start = mouth.column_count
    brow_start = eye_start + eye.column_count
    assembly = SkinAssembly(fill)
    mouth_rows, turned = assembly.add_loops("mouth", mouth, 0)
    assembly.add_closing(mouth_rows[-1], turned=turned, band=len(mouth_rows) - 1)
    eye_rows, _ = assembly.add_loops("eye", eye, eye_start)
    assembly.add_brow(eyebrow, brow_start)
    mouth_margin = len(mouth.outer) - 1
    outside_of_border = mouth_rows[: mouth_margin - BORDER_ROW]
    return HalfSkin(
        positions=_even_out(assembly.positions(), assembly.polygons, outside_of_border),
        polygons=assembly.polygons,
        labels=assembly.labels,
        mouth_rows=mouth_rows,
        eye_rows=eye_rows,
        mouth_margin=mouth_margin,
        eye_margin=len(eye.outer) - 1,
        brow=eyebrow,
        brow_start=brow_start,
    )


def mirror_half(positions, polygons):
    """Mirror half a polygon mesh over x = 0.

    Returns
    -------
    positions : (n, 3) ndarray
    polygons : list of tuple of int
        Those of the left half, then their images in the same order.
    image : (h,) int ndarray
        Index of the mirror image of each vertex of the left half.
    """
    middle = positions[:, 0] == 0.0
    image = np.arange(len(positions))
    image[~middle] = len(positions) + np.arange((~middle).sum())
    both = np.vstack([positions, positions[~middle] * [-1, 1, 1]])
    flipped = [tuple(int(image[v]) for v in (p[0], *p[:0:-1])) for p in polygons]
    return both, [*polygons, *flipped], image
