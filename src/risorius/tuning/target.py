"""A sculpted shape that muscles are fitted to: checked against the head it was made from."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import numpy.typing as npt

from risorius import _formats
from risorius._check import FloatArray
from risorius.errors import ParameterError, ShapeError
from risorius.head.head import Head
from risorius.io.npz_archive import Archive
from risorius.rig.rig import Rig
from risorius.warp.similarity import Similarity, fit_similarity

__all__ = ["may_have_shapes", "read_target", "require_target"]

_ROUNDS = 6
# What a sculpted head may differ in from the neutral one as a whole: factor, turn [deg], and shift
# as share of its height. More than half of the vertices hardly move in any expression.
_FACTOR, _TURN, _SHIFT = 1.03, 3.0, 0.03
# Vertices that fit no better than this share of the head are in another order.
_STRANGE = 0.05
# Less than this share of the head is no expression.
_STILL = 1e-4


def read_target(
    path: Path, head: Head, *, expression: str, shapes: Mapping[str, float] | None = None
) -> FloatArray:
    """Return the sculpted shape (n, 3) of a file in the canonical frame [mm].

    Parameters
    ----------
    path : Path
        A mesh that is `head` sculpted; an archive with `positions` (n, 3); or a rig of the head, of
        which a shape is taken.
    head : Head
    expression : str
        The shape of a rig that is meant if no other is named.
    shapes : mapping of str to float, optional
        Weights of shapes of a rig, added up: its two sides, or half a smile.

    Raises
    ------
    FormatError
        If the file is missing or malformed.
    ShapeError, ParameterError
        As `require_target`, or if a rig lacks the shape.
    """
    source = f"target {path}"
    if path.suffix.lower() == ".npz" and path.is_file():
        archive = Archive(path)
        if "positions" in archive:
            return require_target(head, archive.floats("positions", 3), source=source)
    rig = _rig_of(path)
    if rig is None:
        if shapes:
            name = next(iter(shapes))
            raise ParameterError(f"{source}: is no rig, it has no shape {name!r}; leave it out")
        mesh, _ = _formats.read_head(path)
        return require_target(head, mesh.positions, source=source)
    names = rig.names
    wanted = shapes or {names[0] if len(names) == 1 else expression: 1.0}
    for name in wanted:
        if name not in names:
            raise ParameterError(
                f"{source}: this rig has no shape {name!r}; name one of its {len(names)} with "
                f"--target-shape: {', '.join(names[:8])}{' ...' if len(names) > 8 else ''}"
            )
    return require_target(head, rig.posed(wanted), source=f"{source}, {'+'.join(wanted)}")


def may_have_shapes(path: Path) -> bool:
    """Return whether a path is of a kind that can hold a rig."""
    return path.is_dir() or path.suffix.lower() in (".npz", ".glb", ".gltf")


def _rig_of(path: Path) -> Rig | None:
    """Return the rig of a file or folder that has shapes; None of other meshes."""
    if not may_have_shapes(path):
        return None
    rig = _formats.read_rig(path)
    return rig if rig.names else None


def require_target(head: Head, positions: npt.ArrayLike, *, source: str) -> FloatArray:
    """Return a target (n, 3) in the canonical frame [mm] if it is `head` in an expression.

    Parameters
    ----------
    head : Head
    positions : (n, 3) array_like
        Of every vertex of the head's file, in its frame and unit.
    source : str
        Where it comes from; opens every message.

    Raises
    ------
    ShapeError
        If it has another number of vertices, or some are not finite.
    ParameterError
        If it stands elsewhere, has another size or order of vertices, or is the neutral head.
    """
    given = np.asarray(positions, np.float64)
    if given.shape != head.positions.shape:
        raise ShapeError(
            f"{source}: has {len(given)} vertices, the head has {len(head.positions)}; export the "
            "sculpted head with all its parts, without splitting, merging or adding vertices"
        )
    bad = np.flatnonzero(~np.isfinite(given).all(axis=1))
    if len(bad):
        raise ShapeError(
            f"{source}: vertex {bad[0]} is {given[bad[0]].tolist()}; all must be finite numbers"
        )
    goal = head.frame.to_canonical(given)
    rest = head.positions
    whole, left = _placed(rest, goal)
    extent = float(np.linalg.norm(np.ptp(goal, axis=0)))
    if left > _STRANGE * max(extent, 1e-12):
        raise ParameterError(
            f"{source}: its vertices do not correspond to those of the head: it is another head, "
            "or its vertices were exported in another order (keep the vertex order)"
        )
    if not 1.0 / _FACTOR < whole.scale < _FACTOR:
        raise ParameterError(
            f"{source}: is {whole.scale:.4g} times as large as the head; export it in the head's "
            f"unit ({head.frame.unit})"
        )
    cosine = float(np.clip(0.5 * (np.trace(whole.rotation) - 1.0), -1.0, 1.0))
    turn = float(np.degrees(np.arccos(cosine)))
    centre = rest.mean(axis=0)
    shift = float(np.linalg.norm(whole.apply(centre[None])[0] - centre))
    if turn > _TURN or shift > _SHIFT * head.height:
        raise ParameterError(
            f"{source}: the whole head is turned by {turn:.1f} deg and shifted by {shift:.1f} mm; "
            "export it in the pose of the head, only its expression may differ"
        )
    if float(np.abs(goal - rest).max()) < _STILL * head.height:
        raise ParameterError(
            f"{source}: is the neutral head itself; give the head sculpted in the expression"
        )
    return goal


def _placed(rest: FloatArray, goal: FloatArray) -> tuple[Similarity, float]:
    """Return the map of the half of the vertices that move least, and their largest residual."""
    weights = np.ones(len(rest))
    whole = fit_similarity(rest, goal)
    left = np.zeros(len(rest))
    for _ in range(_ROUNDS):
        left = np.linalg.norm(whole.apply(rest) - goal, axis=1)
        weights = (left <= np.median(left)).astype(np.float64)
        whole = fit_similarity(rest, goal, weights=weights)
    return whole, float(left[weights > 0.0].max(initial=0.0))
