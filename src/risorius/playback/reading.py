"""Read low-level MPEG-4 parameters off a displaced head."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray
from risorius.controls.fap import Fap, faps
from risorius.head.head import Head
from risorius.landmarks.landmark_set import LandmarkSet, resolve
from risorius.playback.face_units import face_units
from risorius.playback.tongue_points import TONGUE_PARTS, tongue_points
from risorius.rig.rig import Rig

__all__ = ["DIRECTIONS", "FapReading"]

DIRECTIONS: Mapping[str, tuple[float, float, float]] = {
    "up": (0.0, 1.0, 0.0),
    "down": (0.0, -1.0, 0.0),
    "left": (1.0, 0.0, 0.0),
    "right": (-1.0, 0.0, 0.0),
    "forward": (0.0, 0.0, 1.0),
}
"""Unit vectors (3,) of the ways in which points go, canonical frame."""

_EYES = {"3.5": "eye_left", "3.6": "eye_right"}
_PARTS = (*_EYES.values(), *TONGUE_PARTS)
_THRUSTS = (27, 28)
_FEWEST = 12  # vertices by which an eye's turn can be told
_WHY_NOT = {
    "grow": "pupils are painted, not moved",
    "curl": "no control rolls the tongue",
    "head": "no morph target; players turn the whole head as one",
}


@dataclass(frozen=True, eq=False)
class FapReading:
    """Where a head's feature points are, to read parameters off displacements.

    Parameters
    ----------
    positions : (n, 3) float64
        Neutral head, canonical frame [mm].
    numbers : tuple of int
        Parameters that can be read, ascending; values come in this order.
    left_out : mapping of int to str
        The others, with the reason.
    unit : (k,) float64
        Unit of each value [mm or rad].
    direction : (k, 3) float64
        Way of each; zero for turns.
    vertices : (k, 3) int32
        Corners that carry each point.
    shares : (k, 3) float64
        Their weights.
    eyes : mapping of str to array
        Vertices (e,) of the eyeballs by the name of their pupil.
    """

    positions: FloatArray
    numbers: tuple[int, ...]
    left_out: Mapping[int, str]
    unit: FloatArray
    direction: FloatArray
    vertices: npt.NDArray[np.int32]
    shares: FloatArray
    eyes: Mapping[str, npt.NDArray[np.intp]]

    @staticmethod
    def of_head(head: Head) -> FapReading:
        """Return the reading of a head."""
        parts = {
            kind: np.asarray(head.parts[kind].source, np.intp)
            for kind in _PARTS
            if kind in head.parts
        }
        return FapReading.build(head.positions, head.landmarks, parts)

    @staticmethod
    def of_rig(rig: Rig) -> FapReading:
        """Return the reading of a rig, by the landmarks that it carries.

        Raises
        ------
        LandmarkError
            If it carries too few.
        """
        positions = rig.frame.to_canonical(rig.mesh.positions)
        marks = LandmarkSet((), positions)
        if rig.landmarks:
            marks = resolve(rig.landmarks, rig.mesh).at(positions)
        parts = {
            kind: np.flatnonzero(rig.part_of_vertex == rig.part_names.index(kind))
            for kind in _PARTS
            if kind in rig.part_names
        }
        return FapReading.build(positions, marks, parts)

    @staticmethod
    def build(
        positions: FloatArray,
        landmarks: LandmarkSet,
        parts: Mapping[str, npt.NDArray[np.intp]],
    ) -> FapReading:
        """Bind the table of parameters to `positions` (n, 3) [mm], landmarks and parts' vertices.

        Points of the tongue that have no landmark are found by its shape.

        Raises
        ------
        LandmarkError
            If the face's units cannot be measured.
        """
        units = face_units(landmarks)
        eyes = {pupil: parts[kind] for pupil, kind in _EYES.items() if kind in parts}
        round_eyes = {name: rows for name, rows in eyes.items() if len(rows) >= _FEWEST}
        found = tongue_points(positions, parts, landmarks)
        kept: list[Fap] = []
        left_out: dict[int, str] = {}
        for fap in faps().values():
            reason = _why_not(fap, {*landmarks, *found}, round_eyes)
            if reason:
                left_out[fap.number] = reason
            else:
                kept.append(fap)
        vertices = np.zeros((len(kept), 3), np.int32)
        shares = np.zeros((len(kept), 3))
        for row, fap in enumerate(kept):
            if fap.point in landmarks:
                mark = landmarks[fap.point]
                vertices[row, : len(mark.vertices)] = mark.vertices
                shares[row, : len(mark.vertices)] = mark.weights
            elif fap.point in found:
                vertices[row, 0], shares[row, 0] = found[fap.point], 1.0
        return FapReading(
            positions,
            tuple(fap.number for fap in kept),
            left_out,
            np.array([units[fap.unit] for fap in kept]),
            np.array([DIRECTIONS.get(fap.way, (0.0, 0.0, 0.0)) for fap in kept]).reshape(-1, 3),
            vertices,
            shares,
            round_eyes,
        )

    def point_motion(self, deltas: FloatArray) -> FloatArray:
        """Return how each parameter's point moves (k, 3) [mm] under `deltas` (n, 3) [mm]."""
        moved = np.einsum("kc,kcx->kx", self.shares, deltas[self.vertices])
        for row, number in enumerate(self.numbers):
            if number in _THRUSTS:  # of the eyeball's centre, which stays where it only turns
                moved[row] = self._thrust(self.eyes[faps()[number].point], deltas)
        return moved

    def values(self, deltas: FloatArray) -> FloatArray:
        """Return the parameters (k,) [FAPU] of a head displaced by `deltas` (n, 3) [mm]."""
        result = (self.point_motion(deltas) * self.direction).sum(axis=1) / self.unit
        turns = {pupil: self._turn(rows, deltas) for pupil, rows in self.eyes.items()}
        for row, number in enumerate(self.numbers):
            fap = faps()[number]
            if fap.way == "turn_left":
                result[row] = turns[fap.point][0] / self.unit[row]
            elif fap.way == "turn_down":
                result[row] = turns[fap.point][1] / self.unit[row]
        return result

    def _thrust(self, rows: npt.NDArray[np.intp], deltas: FloatArray) -> FloatArray:
        """Return how far the centre of an eyeball goes (3,) [mm], whatever it turns by."""
        rest = self.positions[rows]
        away = rest.mean(axis=0) - _centre(rest)
        turned = self._rotation(rows, deltas) @ away
        return deltas[rows].mean(axis=0) - (turned - away)

    def _rotation(self, rows: npt.NDArray[np.intp], deltas: FloatArray) -> FloatArray:
        """Return the rotation (3, 3) that is nearest to an eye's motion (Kabsch 1976)."""
        if not deltas[rows].any():
            return np.eye(3)
        rest = self.positions[rows]
        posed = rest + deltas[rows]
        u, _, vt = np.linalg.svd((rest - rest.mean(axis=0)).T @ (posed - posed.mean(axis=0)))
        keep = np.array([1.0, 1.0, np.sign(np.linalg.det(u @ vt))])
        return (vt.T * keep) @ u.T

    def _turn(self, rows: npt.NDArray[np.intp], deltas: FloatArray) -> tuple[float, float]:
        """Return how far an eye turns left and down [rad]."""
        gaze = self._rotation(rows, deltas) @ np.array([0.0, 0.0, 1.0])
        return float(np.arctan2(gaze[0], gaze[2])), -float(np.arcsin(np.clip(gaze[1], -1.0, 1.0)))


def _centre(points: FloatArray) -> FloatArray:
    """Return the centre (3,) of the sphere that is nearest to points (n, 3): |p|^2 = 2 c.p + k."""
    middle = points.mean(axis=0)
    near = points - middle
    table = np.column_stack([2.0 * near, np.ones(len(near))])
    return middle + np.linalg.lstsq(table, (near**2).sum(axis=1), rcond=None)[0][:3]


def _why_not(
    fap: Fap, points: Collection[str], eyes: Mapping[str, npt.NDArray[np.intp]]
) -> str | None:
    if fap.turns_head:
        return _WHY_NOT["head"]
    if fap.way in _WHY_NOT:
        return _WHY_NOT[fap.way]
    if fap.point in _EYES:
        return None if fap.point in eyes else f"the head has no {_EYES[fap.point]}"
    return None if fap.point in points else f"the head has no landmark {fap.point}"
