"""Sphincters: closed lines round an opening, and how they close it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from risorius._check import FloatArray, IntArray
from risorius.anatomy.outwards import unit
from risorius.layered.faithful.action_line import ActionLine, Ground, sample_line
from risorius.layered.faithful.sheet import guarded
from risorius.layered.muscle import Ring

__all__ = ["RingLines", "constrict", "lay_ring", "paired"]

# How far the ring drawn in a plane bends back towards its sides [1/mm].
_BEND = 0.012
_FLAT = 1e-6


@dataclass(frozen=True, eq=False)
class RingLines:
    """The closed lines that a sphincter hangs on, from the inner to the outer one.

    Parameters
    ----------
    lines : tuple of ActionLine
    turns : tuple of (int, bool)
        How the samples of each are turned and flipped to pair with the inner ones.
    columns : int
        w around.
    outward : (h*w, 3) float64
        Directions out of the head at the bottom vertices when it was drawn.
    limit, protrusion : float
        Largest contraction and the forward shift.
    """

    lines: tuple[ActionLine, ...]
    turns: tuple[tuple[int, bool], ...]
    columns: int
    outward: FloatArray
    limit: float
    protrusion: float

    @property
    def rows(self) -> int:
        """Number of lines."""
        return len(self.lines)

    @property
    def drawn(self) -> tuple[ActionLine, ...]:
        """All lines, from the inner to the outer one."""
        return self.lines

    @property
    def held(self) -> tuple[IntArray, IntArray]:
        """No origin (0,), and all bottom vertices (h*w,)."""
        none = np.zeros(0, np.int32)
        return none, np.arange(self.rows * self.columns, dtype=np.int32)

    def targets(self, positions: FloatArray, faces: IntArray, contraction: float) -> FloatArray:
        """Return targets (h*w, 3) of the bottom vertices [mm]."""
        samples = self._samples(positions, positions, faces)
        c = min(contraction, self.limit)
        return constrict(samples, c, protrusion=self.protrusion).reshape(-1, 3)

    def bottom(self, positions: FloatArray, faces: IntArray) -> FloatArray:
        """Return the bottom vertices (h*w, 3) at rest [mm]."""
        return self._samples(positions, positions, faces).reshape(-1, 3)

    def upwards(self, positions: FloatArray, normals: FloatArray, faces: IntArray) -> FloatArray:
        """Return the directions (h*w, 3) from bottom to top.

        Parameters
        ----------
        positions, normals : (n, 3) float64
            Of all surfaces, with unit vertex normals.
        faces : (m, 3) int32
        """
        found = self._samples(positions, normals, faces).reshape(-1, 3)
        return guarded(unit(found), self.outward)

    def _samples(self, positions: FloatArray, values: FloatArray, faces: IntArray) -> FloatArray:
        along = values is not positions
        rows: list[FloatArray] = []
        for line, (turn, flip) in zip(self.lines, self.turns):
            sample = sample_line(
                line.places(values, faces),
                self.columns,
                closed=True,
                along=line.places(positions, faces) if along else None,
            )
            sample = np.roll(sample, -turn, axis=0)
            rows.append(np.roll(sample[::-1], 1, axis=0) if flip else sample)
        return np.stack(rows)


def paired(inner: FloatArray, outer: FloatArray) -> tuple[int, bool]:
    """Return the turn and flip of samples `outer` (w, 3) that lies nearest to `inner` (w, 3)."""
    best, answer = np.inf, (0, False)
    for turn in range(len(outer)):
        rolled = np.roll(outer, -turn, axis=0)
        for flip in (False, True):
            tried = np.roll(rolled[::-1], 1, axis=0) if flip else rolled
            total = float(np.linalg.norm(tried - inner, axis=1).sum())
            if total < best * (1.0 - 1e-9):
                best, answer = total, (turn, flip)
    return answer


def constrict(samples: FloatArray, contraction: float, *, protrusion: float = 0.0) -> FloatArray:
    """Return ring samples (h, w, 3) drawn towards the middle of the ring (thesis 4.3.2).

    With o the middle of the opening, x and y coordinates of an outer sample in the ring's plane
    and a, b its largest ones: ``rho = min(1, sqrt((x/a)^2 + (y/b)^2))`` and ``delta = c cos(pi/2
    (1 - rho)) (o - s_inner)`` moves the whole pair (errata E13-E17).

    Parameters
    ----------
    samples : (h, w, 3) float64
        At rest, inner line first [mm].
    contraction : float
        c.
    protrusion : float
        Forward shift as a share of the mean motion.
    """
    if contraction <= 0.0:
        return samples
    inner, outer = samples[0], samples[-1]
    flat = samples.reshape(-1, 3)
    middle = flat.mean(axis=0)
    normal = np.linalg.svd(flat - middle, full_matrices=False)[2][2]
    normal = normal if normal[2] >= 0.0 else -normal

    def in_plane(points: FloatArray) -> FloatArray:
        return points - ((points - middle) @ normal)[:, None] * normal

    first, last = in_plane(inner), in_plane(outer)
    guess = first.mean(axis=0)
    ray = unit(last - first)
    along = np.einsum("nd,nd->n", guess - first, ray)
    centre = (first + along[:, None] * ray).mean(axis=0)
    across = np.array([1.0, 0.0, 0.0]) - normal[0] * normal
    if np.linalg.norm(across) < _FLAT:
        across = np.linalg.svd(flat - middle, full_matrices=False)[2][0]
    across = unit(across)
    upwards = np.cross(normal, across)
    x, y = (last - centre) @ across, (last - centre) @ upwards
    a, b = max(np.abs(x).max(), 1e-12), max(np.abs(y).max(), 1e-12)
    rho = np.minimum(1.0, np.hypot(x / a, y / b))
    delta = (contraction * np.cos(0.5 * np.pi * (1.0 - rho)))[:, None] * (centre - inner)
    if protrusion:
        shift = protrusion * float(np.linalg.norm(delta, axis=1).mean())
        delta = delta + shift * np.array([0.0, 0.0, 1.0])
    return samples + delta


def lay_ring(
    ring: Ring, centre: FloatArray, ground: Ground, *, sections: tuple[int, int]
) -> RingLines:
    """Lay inner to outer lines of a sphincter on the `ground`.

    The lines begin below the middle, so that samples of a symmetric skull are symmetric.

    Parameters
    ----------
    ring : Ring
    centre : (3,) float64
        Its centre in the ground's frame [mm].
    ground : Ground
    sections : (int, int)
        w and h.
    """
    columns, rows = sections
    angle = 2.0 * np.pi * np.arange(columns) / columns - 0.5 * np.pi
    lines: list[ActionLine] = []
    drawn: list[FloatArray] = []
    for share in np.linspace(0.0, 1.0, rows):
        axes = (1.0 - share) * np.asarray(ring.inner) + share * np.asarray(ring.outer)
        x, y = np.cos(angle) * axes[0], np.sin(angle) * axes[1]
        points = centre + np.stack([x, y, -_BEND * x**2], axis=1)
        lines.append(ground.lay(points, closed=True))
        drawn.append(points)
    samples = [
        sample_line(line.places(ground.positions, ground.faces), columns, closed=True)
        for line in lines
    ]
    turns = tuple(paired(samples[0], row) for row in samples)
    p = ground.parameters
    return RingLines(
        tuple(lines), turns, columns, ground.out(np.concatenate(drawn)),
        p.largest_ring_contraction, p.protrusion,
    )  # fmt: skip
