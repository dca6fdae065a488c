"""The judge: how near a clone is to the true shapes, and what is wrong with it.

Everything is measured on the skin, in the target's canonical frame; H is chin to crown. Means
over shapes unless said otherwise.

error      100 sum|true - made| / sum|true|                        [%]
absolute   Eq. 6.1, coordinates centred on the neutral's centroid    [%]
rms        over the vertices that move in the truth                 [% H]
cosine     direction, weighted by the motion
leak       100 sum|made| over vertices at rest in this shape / sum|true|   [%]
drift      largest motion of a vertex that no true shape moves       [% H]
rough      bending of the field relative to the truth's, median
tears      edges longer than 2.5 x the longer of rest and truth, by more than 0.5 % H
flips      triangles turned over that the truth does not turn
opening    growth of the lips' gap in jawOpen relative to the truth  [%]
wrong      seam vertices that follow the other lip, largest of four shapes  [%]
lid, lid_true   gap that blinks leave, made and true                [%]
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.sparse import csr_matrix, diags

from risorius._check import IntArray
from risorius.head import Head
from risorius.head.eyes import find_head_lids
from risorius.head.mouth import find_head_lips
from risorius.mesh.connectivity import edge_faces, edges
from risorius.mesh.normals import face_normals, vertex_areas
from risorius.rig.quality.lid_gap import lid_gaps
from risorius.rig.quality.seam import SeamTest

FloatArray = npt.NDArray[np.float64]
_SEAM = ("jawOpen", "mouthSmile_L", "mouthSmile_R", "mouthPucker", "mouthClose")


@dataclass(frozen=True, eq=False)
class Score:
    """Summary over all shapes, and the motion error of each."""

    summary: dict[str, float]
    shapes: dict[str, float]


class Judge:
    """Judges clones on one target."""

    def __init__(self, target: Head, names: tuple[str, ...], truth: FloatArray) -> None:
        self.target, self.names = target, names
        part = target.skin
        self.rest, self.faces = part.mesh.positions, part.mesh.faces
        self.first = part.first_source()
        self.truth = target.frame.vectors_to_canonical(truth[:, self.first])
        lengths = target.landmarks
        self.height = float(np.linalg.norm(lengths.position("11.4") - lengths.position("2.1")))
        self.bending = _bending(self.rest, self.faces)
        self.edges = edges(self.faces)

    def score(self, made: FloatArray) -> Score:
        """Judge displacements (s, n, 3) of the target's vertices [target's file unit]."""
        t = self.target.frame.vectors_to_canonical(made[:, self.first])
        s, height = self.truth, self.height
        moves = _norm(s)
        total = moves.sum(axis=1)
        miss = _norm(s - t)
        error = 100.0 * miss.sum(axis=1) / total
        centred = self.rest - self.rest.mean(axis=0)
        still = moves < 1e-6 * height
        out = {
            "error": error.mean(),
            "absolute": (100.0 * miss.sum(axis=1) / _norm(centred + s).sum(axis=1)).mean(),
            "rms": 100.0 / height * np.mean([self._rms(m, e) for m, e in zip(moves, miss)]),
            "cosine": np.mean([_cosine(a, b) for a, b in zip(s, t)]),
            "leak": (100.0 * np.where(still, _norm(t), 0.0).sum(axis=1) / total).mean(),
        }
        never = still.all(axis=0)
        out["drift"] = 100.0 / height * _norm(t)[:, never].max(initial=0.0)
        rough = [self._rough(b) / max(self._rough(a), 1e-12) for a, b in zip(s, t)]
        out["rough"] = float(np.median(rough))
        tears = [self._tears(a, b) for a, b in zip(s, t)]
        out["tears"] = float(np.mean(tears))
        out["flips"] = np.mean([self._flips(a, b) for a, b in zip(s, t)])
        if "jawOpen" in self.names:
            out["tears_jaw"] = tears[self.names.index("jawOpen")]
        out |= self._contacts(s, t)
        return Score({k: float(v) for k, v in out.items()}, dict(zip(self.names, error.tolist())))

    def _rms(self, moves: FloatArray, miss: FloatArray) -> float:
        moved = moves > 0.05 * moves.max()
        return float(np.sqrt((miss[moved] ** 2).mean()))

    def _rough(self, field: FloatArray) -> float:
        operator, area = self.bending
        bent = operator @ field
        return float(
            np.sqrt((area * (bent**2).sum(1)).sum() / max((area * (field**2).sum(1)).sum(), 1e-30))
        )

    def _tears(self, s: FloatArray, t: FloatArray) -> int:
        def length(points: FloatArray) -> FloatArray:
            return _norm(points[self.edges[:, 0]] - points[self.edges[:, 1]])

        reference = np.maximum(length(self.rest), length(self.rest + s))
        made = length(self.rest + t)
        return int(((made > 2.5 * reference) & (made - reference > 0.005 * self.height)).sum())

    def _flips(self, s: FloatArray, t: FloatArray) -> int:
        rest = face_normals(self.rest, self.faces)

        def turned(moved: FloatArray) -> npt.NDArray[np.bool_]:
            return (face_normals(self.rest + moved, self.faces) * rest).sum(axis=1) < 0.0

        return int((turned(t) & ~turned(s)).sum())

    def _contacts(self, s: FloatArray, t: FloatArray) -> dict[str, float]:
        out: dict[str, float] = {}
        lips = find_head_lips(self.target)
        place = {name: row for row, name in enumerate(self.names)}
        pairs = lips.pairs(self.rest)
        if "jawOpen" in place:
            row = place["jawOpen"]
            gap = s[row][pairs[:, 0]] - s[row][pairs[:, 1]]
            grown = t[row][pairs[:, 0]] - t[row][pairs[:, 1]]
            out["opening"] = 100.0 * (grown * gap).sum() / max((gap * gap).sum(), 1e-30)
        rows = [place[name] for name in _SEAM if name in place]
        seams = SeamTest(self.target, lips).seams(t[rows])
        true = SeamTest(self.target, lips).seams(s[rows])
        out["lost"] = max(len(set(a.lost) - set(b.lost)) for a, b in zip(seams, true))
        out["invented"] = max(len(set(a.invented) - set(b.invented)) for a, b in zip(seams, true))
        left: list[tuple[float, float]] = []
        for side, margins in find_head_lids(self.target).items():
            name = f"eyeBlink_{side.upper()}"
            if name in place:
                both = np.stack([s[place[name]], t[place[name]]])
                true_gap, made_gap = lid_gaps(self.target, margins, side, both)
                left.append((true_gap.left - true_gap.overlap, made_gap.left - made_gap.overlap))
        if left:
            out["lid_true"], out["lid"] = np.mean(left, axis=0)
        return out


def _norm(vectors: FloatArray) -> FloatArray:
    return np.linalg.norm(vectors, axis=-1)


def _cosine(s: FloatArray, t: FloatArray) -> float:
    length = _norm(s)
    moved = length > 0.05 * length.max()
    both = np.maximum(length * _norm(t), 1e-30)
    agreed = np.where(_norm(t) > 1e-3 * length.max(), (s * t).sum(axis=1) / both, 0.0)
    return float((agreed * length)[moved].sum() / length[moved].sum())


def _bending(positions: FloatArray, faces: IntArray) -> tuple[csr_matrix, FloatArray]:
    """Return the umbrella operator by edge lengths (Fujiwara), and areas, 0 on borders."""
    n = len(positions)
    pairs = edges(faces)
    length = _norm(positions[pairs[:, 0]] - positions[pairs[:, 1]])
    weight = 1.0 / np.maximum(length, 0.25 * np.median(length))
    rows, columns = np.concatenate([pairs, pairs[:, ::-1]]).T
    matrix = csr_matrix((np.tile(weight, 2), (rows, columns)), shape=(n, n))
    total = np.bincount(rows, np.tile(1.0 / weight, 2), n)
    degree = diags(np.asarray(matrix.sum(axis=1)).ravel())
    operator = diags(2.0 / np.maximum(total, 1e-300)) @ (matrix - degree)
    area = vertex_areas(positions, faces)
    table = edge_faces(faces)
    area[np.unique(table.edges[table.counts != 2])] = 0.0
    return csr_matrix(operator), area
