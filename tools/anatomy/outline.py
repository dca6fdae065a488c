"""What the free part of the skin must keep: rings of the loops, midline, neck, landmarks, ear."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .ear_patch import cut_patch
from .projecting import project
from .sampling import Samples, border_samples, ring_samples
from .topology import border_loops

__all__ = ["Outline", "outline_of"]


@dataclass(frozen=True)
class Outline:
    """Fixed vertices of the free part, in the order in which they are numbered.

    Parameters
    ----------
    samples : Samples
        Mouth row, closed rings, border, landmarks, ring of the ear.
    rings : list of ((r, 2) ndarray, bool)
        Rings in the disc and whether they are closed; inside of them nothing is filled.
    locked : (k, 2) int ndarray
        Edges of the rings.
    loop_count, ear_start : int
        Number of vertices that belong to the loops; first vertex of the ring of the ear.
    ear_patch : (j, 3) int ndarray
        Dense faces inside the ring of the ear.
    ear_ring : (r,) int ndarray
        Dense vertices of the ring of the ear.
    """

    samples: Samples
    rings: list
    locked: np.ndarray
    loop_count: int
    ear_start: int
    ear_patch: np.ndarray
    ear_ring: np.ndarray


def _ring_edges(start, count, *, closed):
    k = np.arange(count if closed else count - 1)
    return np.column_stack([start + k, start + (k + 1) % count])


def _mouth_on_disc(dense, mouth_row):
    """Return the mouth's row in the disc, its ends on the rim."""
    disc = dense.on_disc(mouth_row)
    disc[[0, -1]] /= np.linalg.norm(disc[[0, -1]], axis=1)[:, None]
    return disc


def outline_of(dense, mouth_row, closed_rings, landmarks):
    """Return the outline for loops and landmarks given as places on the skin [mm]."""
    middle = landmarks[:, 0] < 1e-6
    span = (mouth_row[-1, 1], mouth_row[0, 1])
    edge = border_samples(dense, mouth_span=span, landmarks=landmarks[middle])
    anchors = project(landmarks[~middle])
    patch = cut_patch(dense.positions, dense.faces)
    ear = ring_samples(dense.positions, border_loops(patch)[0])
    mouth_disc = _mouth_on_disc(dense, mouth_row)
    ring_discs = [dense.on_disc(ring) for ring in closed_rings]
    places = [mouth_row, *closed_rings, edge.positions, anchors, dense.positions[ear]]
    discs = [mouth_disc, *ring_discs, edge.disc, dense.on_disc(anchors), dense.disc[ear]]
    starts = np.cumsum([0, *map(len, places)])
    ring_count = len(closed_rings)
    locked = [_ring_edges(0, len(mouth_row), closed=False)]
    locked += [
        _ring_edges(starts[1 + k], len(ring), closed=True) for k, ring in enumerate(closed_rings)
    ]
    locked.append(_ring_edges(starts[-2], len(ear), closed=True))
    return Outline(
        samples=Samples(np.vstack(places), np.vstack(discs)),
        rings=[(mouth_disc, False), *((ring, True) for ring in ring_discs), (discs[-1], True)],
        locked=np.vstack(locked),
        loop_count=int(starts[1 + ring_count]),
        ear_start=int(starts[-2]),
        ear_patch=patch,
        ear_ring=ear,
    )
