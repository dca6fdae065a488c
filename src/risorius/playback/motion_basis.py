"""Motion that no rig made, as few morph targets and their weights over time.

The frames D (f, 3m) of a simulation are D = U S V'; the first k columns of V are the targets and
those of U S their weights over time, with the least error that k targets can have. U and S come
from D D', as frames are fewer than coordinates.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray
from risorius.errors import FormatError
from risorius.rig.rig import MorphTarget, Rig

__all__ = ["MotionBasis", "motion_basis"]

_MOST_NUMBERS = 1 << 27  # coordinates that are held, 4 bytes each
_ENOUGH = 0.02  # error that nobody sees, root mean square over vertices in the worst frame [mm]
_STILL = 1e-4  # motion that is none [mm]


@dataclass(frozen=True, eq=False)
class MotionBasis:
    """A rig whose targets are the components of a motion.

    Parameters
    ----------
    rig : Rig
        Neutral and the targets ``motion_1`` .. ``motion_k``.
    weights : (f, k) float32
        Of every frame; within -1..1.
    error : float
        Of the worst frame, root mean square over the vertices that move [mm].
    """

    rig: Rig
    weights: npt.NDArray[np.float32]
    error: float


def motion_basis(
    rig: Rig, frames: Iterable[npt.NDArray[np.floating]], *, source: str, enough: float = _ENOUGH
) -> MotionBasis:
    """Return the fewest components that follow a motion.

    Parameters
    ----------
    rig : Rig
        Whose neutral the frames start from.
    frames : iterable of (n, 3) float
        Positions of all vertices [file frame].
    source : str
        Where they come from, for messages.
    enough : float
        Largest error of a frame, root mean square over the vertices that move [mm].

    Raises
    ------
    FormatError
        If there are no frames, or too many to be held.
    """
    scale = rig.frame.scale
    rows: list[npt.NDArray[np.float32]] = []
    for posed in frames:
        rows.append(((posed - rig.mesh.positions) * scale).astype(np.float32))
        if len(rows) * rows[0].size > _MOST_NUMBERS:
            raise FormatError(
                f"{source}: more than {len(rows) - 1} frames of this head do not fit into one "
                "animation of live physics; give a folder for pictures, or play a part"
            )
    if not rows:
        raise FormatError(f"{source}: holds no frames")
    moved = np.stack(rows)
    moving = np.flatnonzero((np.abs(moved) > _STILL).any(axis=(0, 2))).astype(np.int32)
    table = moved[:, moving].reshape(len(rows), -1).astype(np.float64)
    shapes, weights, error = _components(table, enough)
    targets = [
        MorphTarget(f"motion_{n}", moving, shape.reshape(-1, 3) / scale)
        for n, shape in enumerate(shapes, start=1)
    ]
    return MotionBasis(rig.with_targets(targets), weights.astype(np.float32), error)


def _components(table: FloatArray, enough: float) -> tuple[FloatArray, FloatArray, float]:
    """Return shapes (k, 3m), weights (f, k) and the error of the worst frame [mm]."""
    vertices = max(table.shape[1] // 3, 1)
    values, vectors = np.linalg.eigh(table @ table.T)
    order = np.argsort(-values)
    order = order[values[order] > 1e-12 * max(float(values.max()), 1e-300)]
    weights = vectors[:, order] * np.sqrt(values[order])
    whole = (table**2).sum(axis=1)
    left = whole[:, None] - np.cumsum(weights**2, axis=1)
    worst = np.sqrt(np.maximum(left, 0.0).max(axis=0) / vertices)
    count = int(np.searchsorted(-worst, -enough)) + 1 if len(order) else 0
    count = min(count, len(order))
    weights = weights[:, :count]
    shapes = (weights / values[order[:count]]).T @ table
    # Weights of size 1 at most, the largest positive, so that signs depend on no library.
    if count:
        peak = weights[np.abs(weights).argmax(axis=0), np.arange(count)]
        weights, shapes = weights / peak, shapes * peak[:, None]
    error = float(worst[count - 1]) if count else 0.0
    return shapes, weights, error
