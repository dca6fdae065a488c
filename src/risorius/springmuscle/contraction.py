"""Contract the muscles of a face: points, linked ends, bulge and the motion of ellipsoids."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray, IntArray, as_points
from risorius.errors import ShapeError
from risorius.springmuscle.kernels.contraction import contract_points, hold_links
from risorius.springmuscle.muscle_set import MuscleSet

__all__ = ["Contracted", "Contraction", "bulge_factors", "turn_between"]

# Sweeps over the links: they over-constrain, more would not converge (finding S8).
_SWEEPS = 40
# Sweeps end when no point moves by more than this share of the longest fibre.
_STILL = 1e-6
# A stretched ellipsoid keeps this share of its height (erratum E3).
_THINNEST = 0.2


@dataclass(frozen=True, eq=False)
class Contracted:
    """Muscles at one instant.

    Parameters
    ----------
    points : (p, 3) float64
        Control points [mm].
    centres : (s, 3) float64
        Of the ellipsoids [mm].
    axes : (s, 3, 3) float64
        Maps local coordinates of the relaxed ellipsoid, in millimetres along its frame, into
        space: ``x = centre + axes @ local``.
    heights : (s,) float64
        Height over relaxed height.
    sweeps : int
        Over the links.
    residual : float
        Motion in the last sweep [mm].
    """

    points: FloatArray
    centres: FloatArray
    axes: FloatArray
    heights: FloatArray
    sweeps: int
    residual: float

    def positions(self, segments: IntArray, local: FloatArray) -> FloatArray:
        """Return where points (n, 3) with `local` (n, 3) coordinates on `segments` (n,) are."""
        return self.centres[segments] + np.einsum("nij,nj->ni", self.axes[segments], local)


@dataclass(frozen=True, eq=False)
class Contraction:
    """Contracts a muscle set; holds what does not change from pose to pose.

    Parameters
    ----------
    muscles : MuscleSet
    sweeps : int
        Most Gauss-Seidel sweeps over the links.
    """

    muscles: MuscleSet
    sweeps: int = _SWEEPS

    def __call__(
        self,
        contractions: npt.ArrayLike,
        *,
        points: FloatArray | None = None,
        aims: FloatArray | None = None,
    ) -> Contracted:
        """Return the muscles contracted.

        Parameters
        ----------
        contractions : (k,) array_like
            c of every muscle, clamped to 0..1; see `MuscleSet.contractions`.
        points, aims : (p, 3) float64, optional
            Relaxed points and aims after the jaw has moved [mm].

        Notes
        -----
        Points slide first, then linked ends are brought together, then bulge and shape follow
        (Kaehler et al. 2001, section 4; errata E1 to E3). Deterministic: links are swept in order.
        """
        rest = self.muscles
        amounts = np.clip(np.asarray(contractions, np.float64), 0.0, 1.0)
        if amounts.shape != (len(rest.muscles),):
            raise ShapeError(
                f"contractions: expected one per muscle ({len(rest.muscles)},), got {amounts.shape}"
            )
        relaxed = rest.points if points is None else as_points("points", points)
        goals = rest.aims if aims is None else as_points("aims", aims)
        if len(relaxed) != len(rest.points) or len(goals) != len(rest.points):
            raise ShapeError(f"points, aims: expected {len(rest.points)} rows each")
        moved = np.empty_like(relaxed)
        tables = self._tables
        contract_points(
            relaxed, goals, rest.shares, rest.fibre_starts, rest.fibre_muscle, rest.ring_muscles,
            amounts, tables["fixed_points"], tables["pivots"], np.empty(len(relaxed)), moved,
        )  # fmt: skip
        # Closed rings: the last point is the first one.
        moved[tables["ring_last"]] = moved[tables["ring_first"]]
        sweeps, residual = self._hold(moved, amounts, bool((moved != rest.points).any()))
        return self._shaped(moved, sweeps, residual)

    def _hold(self, moved: FloatArray, amounts: FloatArray, stirred: bool) -> tuple[int, float]:
        links, rest, tables = self.muscles.links, self.muscles, self._tables
        if not len(links.ends) or not stirred:
            return 0, 0.0
        active = (amounts > 0.0)[rest.point_muscle]
        sweeps, residual = hold_links(
            moved, tables["places"], rest.fibre_starts, links.ends, tables["hosts"],
            tables["link_lengths"], active, tables["fixed"], tables["twins"], links.yielding,
            self.sweeps, tables["still"],
        )  # fmt: skip
        return int(sweeps), float(residual)

    def _shaped(self, moved: FloatArray, sweeps: int, residual: float) -> Contracted:
        rest, first = self.muscles, self.muscles.segment_points
        along = moved[first + 1] - moved[first]
        length = np.linalg.norm(along, axis=1)
        stretch = length / rest.lengths
        heights = bulge_factors(stretch, self._tables["bells"], self._tables["gains"])
        turn = turn_between(rest.frames[:, :, 0], along / np.maximum(length, 1e-12)[:, None])
        scale = np.stack([stretch, np.ones_like(stretch), heights], axis=1)
        axes = (turn @ rest.frames) * scale[:, None, :]
        centres = 0.5 * (moved[first + 1] + moved[first])
        return Contracted(moved, centres, axes, heights, sweeps, residual)

    @cached_property
    def _tables(self) -> dict[str, Any]:
        rest, links = self.muscles, self.muscles.links
        starts = rest.fibre_starts
        closed = np.array([m.closed for m in rest.muscles], bool)[rest.fibre_muscle]
        ring_first, ring_last = starts[:-1][closed], starts[1:][closed] - 1
        twins = np.arange(len(rest.points), dtype=np.int32)
        twins[ring_first], twins[ring_last] = ring_last, ring_first
        fixed = np.zeros(len(rest.points), bool)
        fixed[starts[:-1][~rest.ring_muscles[rest.fibre_muscle]]] = True
        hosts = rest.segment_points[links.hosts[:, 1]] if len(links.hosts) else np.zeros(0, int)
        hosts = np.stack([hosts, hosts + 1], axis=1).astype(np.int32)
        gaps = rest.points[hosts] - rest.points[links.ends[:, 1]][:, None]
        return {
            "fixed_points": np.array([m.action.fixed_point for m in rest.muscles]),
            "pivots": np.array(
                [np.full(3, np.nan) if m.pivot is None else m.pivot for m in rest.muscles]
            ).reshape(-1, 3),
            "ring_first": ring_first,
            "ring_last": ring_last,
            "twins": twins,
            "fixed": fixed,
            "hosts": hosts,
            "link_lengths": np.linalg.norm(gaps, axis=2),
            "places": _places(rest),
            "still": _STILL * float(rest.lengths.sum() / max(len(rest.muscles), 1)),
            "bells": _bells(rest),
            "gains": np.array([m.action.bulge for m in rest.muscles])[rest.segment_muscle],
        }


def bulge_factors(stretch: FloatArray, bells: FloatArray, gains: FloatArray) -> FloatArray:
    """Return height over relaxed height (s,) of segments stretched by `stretch` (s,).

    `bells` (s,) is the share of a segment's strain that shows, `gains` (s,) the gain of height.
    ``max(0.2, 1 + gain s)`` with ``s = bell (1 - stretch)``: published with gain 2; elongated
    segments get thinner, but never vanish (erratum E3). Elongation acts everywhere alike.
    """
    strain = 1.0 - stretch
    strain = np.where(strain > 0.0, strain * bells, strain)
    return np.maximum(_THINNEST, 1.0 + gains * strain)


def turn_between(source: FloatArray, target: FloatArray) -> FloatArray:
    """Return the least rotations (s, 3, 3) that take unit `source` (s, 3) to `target` (s, 3).

    ``R = I + K + K K / (1 + cos)`` with K the cross product matrix of source x target; opposite
    vectors, which have no smallest rotation, turn about any axis across them.
    """
    axis = np.cross(source, target)
    cosine = np.einsum("sd,sd->s", source, target)
    cross = np.zeros((len(source), 3, 3))
    cross[:, 0, 1], cross[:, 0, 2], cross[:, 1, 2] = -axis[:, 2], axis[:, 1], -axis[:, 0]
    cross -= cross.transpose(0, 2, 1)
    turn = np.eye(3) + cross + (cross @ cross) / np.maximum(1.0 + cosine, 1e-9)[:, None, None]
    opposite = np.flatnonzero(cosine < -1.0 + 1e-9)
    for s in opposite:
        across = np.cross(source[s], np.eye(3)[int(np.argmin(np.abs(source[s])))])
        across /= np.linalg.norm(across)
        turn[s] = 2.0 * np.outer(across, across) - np.eye(3)
    return turn


def _places(rest: MuscleSet) -> FloatArray:
    """Return the relaxed share (p,) of its fibre's length at each point; 1 all along a ring."""
    places = np.ones(len(rest.points))
    for f, m in enumerate(rest.fibre_muscle):
        if rest.ring_muscles[m]:
            continue
        first, last = rest.fibre_starts[f], rest.fibre_starts[f + 1]
        lengths = np.concatenate([[0.0], np.cumsum(rest.lengths[first - f : last - f - 1])])
        places[first:last] = lengths / lengths[-1]
    return places


def _bells(rest: MuscleSet) -> FloatArray:
    """Return the share (s,) of its strain that each segment shows as bulge.

    ``1 - (2 i / (n - 2) - 1)^2`` along linear fibres of three and more segments, so that the ends
    stay flat; 1 on shorter ones and all around sphincters (Kaehler et al. 2001, eq. 4; erratum E2).
    """
    bells = np.ones(len(rest.segment_fibre))
    for f, m in enumerate(rest.fibre_muscle):
        first, last = rest.fibre_starts[f] - f, rest.fibre_starts[f + 1] - f - 1
        count = int(last - first)
        if count >= 3 and not rest.ring_muscles[m]:
            bells[first:last] = 1.0 - (2.0 * np.arange(count) / (count - 1) - 1.0) ** 2
    return bells
