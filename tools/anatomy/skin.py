"""The skin: loops and fill of the left half, evened out, labelled and mirrored."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .brow import Brow, brow
from .eye_loops import eye_loops
from .fill import fill_skin
from .loops import loop_polygons
from .mouth_loops import BORDER_ROW, mouth_loops
from .part import triangles_of
from .projecting import slide
from .topology import half_edges, vertex_mean

__all__ = ["HalfSkin", "half_skin", "mirror_half"]


@dataclass(frozen=True)
class HalfSkin:
    """Left half of the skin with what is known of its build.

    Parameters
    ----------
    positions : (n, 3) ndarray
        Vertices [mm].
    polygons : list of tuple of int
    mouth_rows, eye_rows : list of (c,) int ndarray
        Vertex indices of the loops, outermost first.
    mouth_margin, eye_margin : int
        Position of the margin of the opening in the rows.
    kind : list of str
        Per polygon: "fill", "ear", "mouth", "eye" or "brow".
    band, column : (m,) int ndarray
        Row pair and column of the loop polygons, -1 elsewhere.
    brow : Brow
    brow_start : int
        Vertex of the first point of the eyebrow's outline.
    """

    positions: np.ndarray
    polygons: list
    mouth_rows: list
    eye_rows: list
    mouth_margin: int
    eye_margin: int
    kind: list
    band: np.ndarray
    column: np.ndarray
    brow: Brow
    brow_start: int


def _oriented(quads, fill_edges):
    """Return `quads` turned so that the row they share with the fill runs against its edges."""
    return quads if (int(quads[0, 0]), int(quads[0, 3])) in fill_edges else quads[:, ::-1]


def _shorter_diagonal(quads, positions):
    """Return `quads` started so that the fan diagonal is the shorter one."""
    first = np.linalg.norm(positions[quads[:, 0]] - positions[quads[:, 2]], axis=1)
    second = np.linalg.norm(positions[quads[:, 1]] - positions[quads[:, 3]], axis=1)
    return np.where((first <= second)[:, None], quads, np.roll(quads, -1, axis=1))


def _closing(row, turned):
    """Return the polygons that close the bag between the columns of its last row."""
    count = len(row) // 2
    upper, lower, corner = row[:count], row[:count:-1], int(row[count])
    quads = [
        (int(upper[k]), int(lower[k]), int(lower[k + 1]), int(upper[k + 1]))
        for k in range(count - 1)
    ]
    polygons = [*quads, (int(upper[-1]), int(lower[-1]), corner)]
    return [polygon[::-1] for polygon in polygons] if turned else polygons


def _even_out(positions, polygons, mouth_rows):
    """Slide the rows of the lips outside of the vermilion border towards their neighbours."""
    margin_to_skin = mouth_rows[: -BORDER_ROW - 1]
    chosen = np.concatenate([row for row in margin_to_skin])
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


def half_skin(landmarks):
    """Return the left half of the skin; `landmarks` (k, 3) become vertices [mm]."""
    mouth, eye, eyebrow = mouth_loops(), eye_loops(), brow()
    fill = fill_skin(mouth.outer[-1], [eye.outer[-1], eyebrow.ring], landmarks)
    stacks, count = [fill.positions], len(fill.positions)
    indexed = []
    start = 0
    for loops in (mouth, eye):
        rows = [start + np.arange(loops.column_count)]
        start += loops.column_count
        for row in loops.rows()[1:]:
            rows.append(count + np.arange(len(row)))
            stacks.append(row)
            count += len(row)
        indexed.append(rows)
    brow_start, brow_inner = start, count
    stacks.append(eyebrow.inner)
    positions = np.vstack(stacks)
    positions[np.abs(positions[:, 0]) < 1e-4, 0] = 0.0
    edges = set(map(tuple, half_edges(fill.faces).tolist()))
    polygons = [tuple(face) for face in fill.faces.tolist()]
    kind = ["ear" if ear else "fill" for ear in fill.in_ear]
    band, column = [np.full(len(polygons), -1)], [np.full(len(polygons), -1)]
    for name, loops, rows in (("mouth", mouth, indexed[0]), ("eye", eye, indexed[1])):
        quads, bands = loop_polygons(rows, closed=loops.closed)
        per_band = len(quads) // (len(rows) - 1)
        turned = _oriented(quads, edges)
        polygons += [tuple(q) for q in _shorter_diagonal(turned, positions).tolist()]
        band.append(bands)
        column.append(np.tile(np.arange(per_band), len(rows) - 1))
        if name == "mouth":
            closing = _closing(rows[-1], turned=turned is not quads)
            polygons += closing
            band.append(np.full(len(closing), len(rows) - 1))
            column.append(np.arange(len(closing)))
        kind += [name] * (len(polygons) - len(kind))
    ring_count = len(eyebrow.ring)
    polygons += [
        tuple(int(brow_start + v if v < ring_count else brow_inner + v - ring_count) for v in quad)
        for quad in eyebrow.quads
    ]
    for labels in (band, column):
        labels.append(np.full(len(eyebrow.quads), -1))
    kind += ["brow"] * len(eyebrow.quads)
    mouth_margin, eye_margin = len(mouth.outer) - 1, len(eye.outer) - 1
    positions = _even_out(positions, polygons, indexed[0][: mouth_margin + 1])
    return HalfSkin(
        positions,
        polygons,
        indexed[0],
        indexed[1],
        mouth_margin,
        eye_margin,
        kind,
        np.concatenate(band),
        np.concatenate(column),
        eyebrow,
        brow_start,
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
