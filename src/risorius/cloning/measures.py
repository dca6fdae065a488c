"""How much two rigs of one mesh differ: the errors by which clones are judged."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.sparse import csr_matrix, diags

from risorius._check import FloatArray, IntArray
from risorius.errors import ParameterError, ShapeError
from risorius.mesh.connectivity import edge_faces, edges
from risorius.mesh.core import TriMesh
from risorius.mesh.normals import vertex_areas
from risorius.mesh.welding import weld
from risorius.rig.quality import QualityReport, inspect_rig
from risorius.rig.rig import Rig

__all__ = [
    "Comparison",
    "ShapeComparison",
    "absolute_error",
    "compare_rigs",
    "direction_cosine",
    "motion_error",
    "roughness",
]

# Vertices below this share of a shape's largest motion do not count for its direction.
_MOVES = 0.05


def absolute_error(rest: FloatArray, truth: FloatArray, made: FloatArray) -> float:
    """Return equation 6.1 for one shape, in per cent.

    e = 100 sum |S_i - T_i| / sum |S_i|, with S = rest + truth, T = rest + made, both about the
    neutral's centroid: as printed the value depends on where the origin is (erratum E9).

    Parameters
    ----------
    rest, truth, made : (n, 3) float64
        Neutral positions, and the two displacements [one unit].

    References
    ----------
    Fratarcangeli 2008, equation 6.1.
    """
    _require_same(truth, made)
    size = _norm(rest - rest.mean(axis=0) + truth).sum()
    return float(100.0 * _norm(truth - made).sum() / max(size, 1e-300))


def motion_error(truth: FloatArray, made: FloatArray) -> float:
    """Return 100 sum |dS - dT| / sum |dS|, in per cent.

    Parameters
    ----------
    truth, made : (n, 3) float64
        Displacements dS and dT [one unit].

    Notes
    -----
    0 where neither moves, infinite where only `made` does.
    """
    _require_same(truth, made)
    size, missed = _norm(truth).sum(), _norm(truth - made).sum()
    if size == 0.0:
        return 0.0 if missed == 0.0 else float("inf")
    return float(100.0 * missed / size)


def direction_cosine(truth: FloatArray, made: FloatArray) -> float:
    """Return the mean cosine between displacements, weighted by the truth's length.

    Parameters
    ----------
    truth, made : (n, 3) float64
        Displacements [one unit].

    Notes
    -----
    Vertices below 5 % of the largest motion do not count; those that `made` leaves at rest
    count 0. 1 where nothing moves.
    """
    _require_same(truth, made)
    length, other = _norm(truth), _norm(made)
    if not length.any():
        return 1.0
    moves = length > _MOVES * length.max()
    dot = (truth * made).sum(axis=1)[moves]
    cosine = dot / np.maximum(length * other, 1e-300)[moves]
    return float((cosine * length[moves]).sum() / length[moves].sum())


def roughness(mesh: TriMesh, deltas: FloatArray) -> float:
    """Return how strongly a displacement field (n, 3) bends over the mesh [1 / mm^2].

    Root mean square, by area, of the umbrella operator by edge lengths (Fujiwara 1995) over that
    of the field; vertices of open borders do not count. 0 where nothing moves.
    """
    return _bent(_umbrella(mesh), deltas)


@dataclass(frozen=True)
class ShapeComparison:
    """One shape of two rigs.

    Parameters
    ----------
    name : str
    absolute, motion : float
        `absolute_error` and `motion_error` [%].
    cosine : float
        `direction_cosine` [1].
    amplitude : float
        Sum of the second's motion over that of the first [1].
    roughness : float or None
        The second's over the first's; None where one does not move [1].
    lost, invented : int or None
        Lip vertices of the second on the wrong side, see `risorius.rig.quality.Seam`.
    gap, gap_first : float or None
        How far the lips part, in the second and in the first [mm].
    lids, lids_first : float or None
        Largest part of an eye still open, in the second and in the first [%].
    """

    name: str
    absolute: float
    motion: float
    cosine: float
    amplitude: float
    roughness: float | None
    lost: int | None
    invented: int | None
    gap: float | None
    gap_first: float | None
    lids: float | None
    lids_first: float | None


@dataclass(frozen=True)
class Comparison:
    """Two rigs of one mesh, shape by shape; names that only one of them has."""

    shapes: tuple[ShapeComparison, ...]
    only_first: tuple[str, ...]
    only_second: tuple[str, ...]

    def to_json(self) -> dict[str, Any]:
        """Return plain values."""
        return asdict(self)


def compare_rigs(first: Rig, second: Rig) -> Comparison:
    """Compare two rigs of the same vertices; the first counts as the truth.

    Raises
    ------
    ShapeError
        If the meshes have different vertices.
    ParameterError
        If no name of a shape is common.
    """
    n = first.mesh.vertex_count
    if second.mesh.vertex_count != n:
        raise ShapeError(
            f"compare: the rigs have {n} and {second.mesh.vertex_count} vertices; only rigs of "
            "one mesh can be compared"
        )
    scale = first.mesh.tri_mesh().size
    off = float(np.abs(first.mesh.positions - second.mesh.positions).max(initial=0.0))
    if off > 1e-4 * scale:
        raise ShapeError(
            f"compare: the neutral heads differ by up to {off:.3g} of {scale:.3g}; only rigs of "
            "one mesh can be compared"
        )
    names = [name for name in first.names if name in second.by_name]
    if not names:
        raise ParameterError(
            "compare: the rigs share no name of a shape; the first has "
            f"{', '.join(first.names[:5])}, the second {', '.join(second.names[:5])}"
        )
    joined = weld(first.mesh.positions)
    factor = first.frame.scale
    mesh = TriMesh(factor * first.mesh.positions[joined.first], joined.faces(first.mesh.triangles))
    umbrella = _umbrella(mesh)
    quality = [inspect_rig(rig.subset(names)) for rig in (first, second)]
    shapes: list[ShapeComparison] = []
    for name in names:
        deltas = [factor * rig.target(name).dense(n)[joined.first] for rig in (first, second)]
        shapes.append(_compare(name, mesh, umbrella, deltas, quality))
    return Comparison(
        tuple(shapes),
        tuple(name for name in first.names if name not in second.by_name),
        tuple(name for name in second.names if name not in first.by_name),
    )


def _compare(
    name: str,
    mesh: TriMesh,
    umbrella: tuple[csr_matrix, FloatArray],
    deltas: list[FloatArray],
    quality: list[QualityReport],
) -> ShapeComparison:
    truth, made = deltas
    size = float(_norm(truth).sum())
    rough = [_bent(umbrella, field) for field in deltas]
    a, b = (report.shape(name) for report in quality)
    lids = [max((gap.left for gap in shape.lids.values()), default=None) for shape in (a, b)]
    return ShapeComparison(
        name=name,
        absolute=absolute_error(mesh.positions, truth, made),
        motion=motion_error(truth, made),
        cosine=direction_cosine(truth, made),
        amplitude=float(_norm(made).sum()) / size if size > 0.0 else 1.0,
        roughness=rough[1] / rough[0] if min(rough) > 0.0 else None,
        lost=None if b.seam is None else len(b.seam.lost),
        invented=None if b.seam is None else len(b.seam.invented),
        gap=None if b.seam is None else b.seam.gap,
        gap_first=None if a.seam is None else a.seam.gap,
        lids=lids[1],
        lids_first=lids[0],
    )


def _umbrella(mesh: TriMesh) -> tuple[csr_matrix, FloatArray]:
    n = mesh.vertex_count
    pairs: IntArray = edges(mesh.faces)
    length = _norm(mesh.positions[pairs[:, 0]] - mesh.positions[pairs[:, 1]])
    # Slivers must not dominate.
    weight = 1.0 / np.maximum(length, 0.25 * float(np.median(length)) if len(length) else 1.0)
    rows, columns = np.concatenate([pairs, pairs[:, ::-1]]).T
    matrix = csr_matrix((np.tile(weight, 2), (rows, columns)), shape=(n, n))
    total = np.bincount(rows, np.tile(1.0 / weight, 2), n)
    degree = diags(np.asarray(matrix.sum(axis=1)).ravel())
    operator = diags(2.0 / np.maximum(total, 1e-300)) @ (matrix - degree)
    area = vertex_areas(mesh.positions, mesh.faces)
    table = edge_faces(mesh.faces)
    area[np.unique(table.edges[table.counts != 2])] = 0.0
    return csr_matrix(operator), area


def _bent(umbrella: tuple[csr_matrix, FloatArray], deltas: FloatArray) -> float:
    operator, area = umbrella
    size = (area * (deltas**2).sum(axis=1)).sum()
    if size == 0.0:
        return 0.0
    return float(np.sqrt((area * ((operator @ deltas) ** 2).sum(axis=1)).sum() / size))


def _norm(vectors: FloatArray) -> npt.NDArray[np.float64]:
    return np.linalg.norm(vectors, axis=-1)


def _require_same(truth: FloatArray, made: FloatArray) -> None:
    if truth.shape != made.shape or truth.ndim != 2 or truth.shape[1] != 3:
        raise ShapeError(
            f"made: expected displacements like the truth's {truth.shape}, got {made.shape}"
        )
