"""From a shape to the controls that come nearest to it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import lsq_linear

from risorius._check import FloatArray, IntArray
from risorius.controls.control import Control, Pose
from risorius.errors import ShapeError
from risorius.landmarks.sides import require
from risorius.rig.face import Face

__all__ = ["Solved", "landmark_target", "solve_pose"]

# Groups whose controls take part, and the step of each for a difference quotient.
_STEPS = {"muscle": 1.0, "lid": 1.0, "jaw": 6.0}
_RIDGE = 1e-6
_ROUNDS = 4
_HALVINGS = 3


def landmark_target(face: Face, places: Mapping[str, FloatArray]) -> tuple[FloatArray, IntArray]:
    """Return displacements (k, 3) [mm] and input vertices (k,) that bring landmarks to `places`.

    Parameters
    ----------
    face : Face
    places : mapping of str to (3,) float64
        Where landmarks shall be [mm, canonical frame].

    Raises
    ------
    LandmarkError
        If the head has no landmark of a name.
    """
    head = face.head
    require(head.landmarks, tuple(places), purpose="the target")
    vertices = np.array([head.landmarks.vertex(name) for name in places], np.int32)
    moved = [np.asarray(place) - head.landmarks.position(name) for name, place in places.items()]
    return np.array(moved), vertices


@dataclass(frozen=True)
class Solved:
    """The pose found for a target.

    Parameters
    ----------
    pose : Pose
        Controls inside their ranges.
    explained : float
        Share of the target's motion energy that the posed face makes,
        ``1 - sum w |posed - target|^2 / sum w |target|^2``.
    linear : float
        The same for the best sum of the controls' own displacements, before correctives.
    residual : float
        Root mean square distance that is left [mm].
    """

    pose: Pose
    explained: float
    linear: float
    residual: float


@dataclass(frozen=True)
class _Variable:
    names: tuple[str, ...]
    low: float
    high: float
    step: float


def solve_pose(
    face: Face,
    target: FloatArray,
    vertices: IntArray,
    *,
    weights: FloatArray | None = None,
    together: bool = False,
    leave_out: Sequence[str] = (),
) -> Solved:
    """Find the controls of muscles, jaw and lids whose pose comes nearest to a shape.

    A bounded linear least squares problem on the displacement of every control alone, then
    Gauss-Newton steps on the posed face, which see rotations, volume and contact; a step is
    halved until it helps.

    Parameters
    ----------
    face : Face
    target : (k, 3) float64
        Wanted displacement [mm, canonical frame].
    vertices : (k,) int32
        Input vertices that it belongs to: all of the skin, or a few landmarks.
    weights : (k,) float64, optional
        Importance of each vertex, such as its area; alike if left out.
    together : bool
        Move left and right alike.
    leave_out : sequence of str
        Controls that rest.

    Raises
    ------
    ShapeError
        If the arrays do not agree.
    """
    if target.shape != (len(vertices), 3):
        raise ShapeError(f"target: expected shape ({len(vertices)}, 3), got {target.shape}")
    share = np.ones(len(vertices)) if weights is None else weights
    if share.shape != (len(vertices),):
        raise ShapeError(f"weights: expected shape ({len(vertices)},), got {share.shape}")
    problem = _Problem(face, target, vertices, np.sqrt(share))
    variables = _variables(face.controls, together, leave_out)
    low = np.array([variable.low for variable in variables])
    high = np.array([variable.high for variable in variables])
    columns = np.stack([problem.alone(variable) for variable in variables], axis=1)
    x, linear = _bounded(columns, problem.wanted, low, high)
    best = problem.energy_left(_pose(variables, x))
    for _ in range(_ROUNDS):
        left = problem.left(_pose(variables, x))
        step, _ = _bounded(columns, left, low - x, high - x)
        for halving in range(_HALVINGS):
            trial = np.clip(x + step * 0.5**halving, low, high)
            energy = problem.energy_left(_pose(variables, trial))
            if energy < best:
                break
        else:
            break
        gained = best - energy
        x, best = trial, energy
        if gained < 1e-3 * problem.energy:
            break
    total = max(problem.energy, 1e-12)
    pose = {n: float(v) for n, v in _pose(variables, x).items() if abs(v) > 5e-3}
    energy = problem.energy_left(pose)
    residual = float(np.sqrt(energy / max(float(share.sum()), 1e-12)))
    return Solved(pose, 1.0 - energy / total, linear, residual)


class _Problem:
    def __init__(
        self, face: Face, target: FloatArray, vertices: IntArray, weights: FloatArray
    ) -> None:
        self._face, self._vertices, self._weights = face, vertices, weights[:, None]
        self.wanted = (target * self._weights).ravel()
        self.energy = float(self.wanted @ self.wanted)

    def made(self, pose: Pose) -> FloatArray:
        return (self._face.displace(pose)[self._vertices] * self._weights).ravel()

    def alone(self, variable: _Variable) -> FloatArray:
        """Return the displacement of one variable by itself, for one unit of it."""
        step = min(variable.step, variable.high) if variable.high > 0.0 else variable.low
        return self.made(dict.fromkeys(variable.names, step)) / step

    def left(self, pose: Mapping[str, float]) -> FloatArray:
        return self.wanted - self.made(pose)

    def energy_left(self, pose: Mapping[str, float]) -> float:
        rest = self.left(pose)
        return float(rest @ rest)


def _variables(
    controls: Sequence[Control], together: bool, leave_out: Sequence[str]
) -> list[_Variable]:
    result: list[_Variable] = []
    seen: set[str] = set(leave_out)
    for control in controls:
        if control.group not in _STEPS or control.name in seen:
            continue
        if together and control.mirror_sign < 0.0:
            continue
        names = (control.name, control.mirror) if together else (control.name,)
        seen.update(names)
        names = tuple(dict.fromkeys(names))
        step = _STEPS[control.group]
        if control.group == "lid":
            # A lid opens and closes by different laws.
            result.append(_Variable(names, 0.0, control.high, step))
            result.append(_Variable(names, control.low, 0.0, step))
            continue
        result.append(_Variable(names, control.low, control.high, step))
    return result


def _pose(variables: Sequence[_Variable], x: FloatArray) -> dict[str, float]:
    pose: dict[str, float] = {}
    for variable, value in zip(variables, x):
        for name in variable.names:
            pose[name] = pose.get(name, 0.0) + float(value)
    return pose


def _bounded(
    columns: FloatArray, wanted: FloatArray, low: FloatArray, high: FloatArray
) -> tuple[FloatArray, float]:
    """Return the best bounded combination and the share of the wanted energy that it makes."""
    scale = np.maximum(np.linalg.norm(columns, axis=0), 1e-9)
    scaled = columns / scale
    gram = scaled.T @ scaled
    gram[np.diag_indices_from(gram)] += _RIDGE * np.trace(gram) / len(gram)
    factor = np.linalg.cholesky(gram)
    right = np.linalg.solve(factor, scaled.T @ wanted)
    low, high = low * scale, np.maximum(high * scale, low * scale + 1e-12)
    found = np.asarray(lsq_linear(factor.T, right, bounds=(low, high)).x)
    rest = wanted - scaled @ found
    energy = max(float(wanted @ wanted), 1e-12)
    return found / scale, 1.0 - float(rest @ rest) / energy
