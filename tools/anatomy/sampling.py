"""Where the vertices of the free part of the skin start from."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.spatial import cKDTree

from .size_field import edge_length
from .table import NECK_Y

__all__ = ["Samples", "border_samples", "poisson_pick", "ring_samples"]


@dataclass(frozen=True)
class Samples:
    """Points on the dense half head with their place in the disc.

    Parameters
    ----------
    positions : (n, 3) ndarray
        Places on the surface [mm].
    disc : (n, 2) ndarray
        Places in the unit disc.
    """

    positions: np.ndarray
    disc: np.ndarray

    def __len__(self):
        return len(self.positions)


def _arc_length(points):
    step = np.linalg.norm(np.diff(points, axis=0), axis=1)
    return np.concatenate([[0.0], np.cumsum(step)])


def _columns_at(at, arc, values):
    return np.stack([np.interp(at, arc, column) for column in values.T], axis=1)


def _stations(place, arc):
    """Return arc lengths at the wanted spacing; the corners of midline and neck are among them."""
    wanted = edge_length(place)
    density = np.concatenate([[0.0], np.cumsum(np.diff(arc) / (0.5 * (wanted[1:] + wanted[:-1])))])
    on_neck = np.flatnonzero(place[:, 1] < NECK_Y + 1e-6)
    corners = [0, on_neck[0], on_neck[-1], len(place) - 1]
    at = [np.zeros(1)]
    for a, b in pairwise(corners):
        count = max(2, round(density[b] - density[a]))
        at.append(np.interp(np.linspace(density[a], density[b], count + 1)[1:], density, arc))
    return np.concatenate(at)


def border_samples(dense, *, mouth_span, landmarks):
    """Sample the midline and the neck border of the half head, without the gap of the mouth.

    Parameters
    ----------
    dense : Dense
    mouth_span : (float, float)
        Lowest and highest y of the outermost row of the mouth on the midline [mm].
    landmarks : (k, 3) ndarray
        Places on the midline that must become vertices [mm].
    """
    place = dense.positions[dense.border]
    front = (place[:, 0] < 1e-6) & (place[:, 2] > 60)
    gap = front & (place[:, 1] < mouth_span[1] + 2.2) & (place[:, 1] > mouth_span[0] - 2.2)
    start = int(np.flatnonzero(gap & ~np.roll(gap, 1))[0])
    order = np.roll(np.arange(len(gap)), -start)
    order = order[~gap[order]]
    place, disc_place = place[order], dense.disc[dense.border][order]
    arc = _arc_length(place)
    at = _stations(place, arc)
    for landmark in landmarks:
        exact = arc[np.linalg.norm(place - landmark, axis=1).argmin()]
        at[np.abs(at - exact).argmin()] = exact
    disc_at = _columns_at(at, arc, disc_place)
    disc_at /= np.linalg.norm(disc_at, axis=1)[:, None]
    return Samples(_columns_at(at, arc, place), disc_at)


def ring_samples(positions, loop):
    """Return about evenly spaced vertices of a closed `loop` at the wanted edge length."""
    place = positions[loop]
    arc = _arc_length(np.vstack([place, place[:1]]))
    count = round(arc[-1] / edge_length(place).mean())
    chosen = np.unique(np.searchsorted(arc[:-1], np.arange(count) / count * arc[-1]))
    return loop[chosen[chosen < len(loop)]]


def poisson_pick(positions, candidates, *, spacing=0.8, seed=7):
    """Return a subset of `candidates` no two of which are closer than the wanted edge length."""
    candidates = candidates.copy()
    np.random.default_rng(seed).shuffle(candidates)
    tree = cKDTree(positions)
    radius = spacing * edge_length(positions)
    alive = np.zeros(len(positions), bool)
    alive[candidates] = True
    picked = []
    for index in candidates:
        if alive[index]:
            picked.append(index)
            alive[tree.query_ball_point(positions[index], radius[index])] = False
    return np.array(picked, int)
