"""The true expressions of ICT-FaceKit, and heads of other identities with the same truths."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from risorius import _formats
from risorius._check import FloatArray, IntArray
from risorius.head.head import Head
from risorius.mesh.laplacian import mass
from risorius.mesh.polygon_mesh import PolygonMesh

# The first vertices of the data set are the face; motion behind them does not count.
FACE_VERTICES = 9409
_MILLIMETRES = 10.0

JUDGED = (
    "mouthSmile", "mouthFrown", "browInnerUp", "browDown", "browOuterUp", "jawOpen",
    "mouthPucker", "mouthUpperUp", "mouthLowerDown", "mouthStretch", "noseSneer", "eyeBlink",
)  # fmt: skip
"""The twelve shapes that the mean is taken over."""

FURTHER = (
    "mouthFunnel", "cheekSquint", "eyeSquint", "eyeWide", "mouthRollUpper", "mouthRollLower",
    "mouthShrugLower", "mouthShrugUpper", "mouthDimple", "mouthPress",
)  # fmt: skip


@dataclass(frozen=True, eq=False)
class Truths:
    """Heads and true expressions.

    Parameters
    ----------
    mesh : PolygonMesh
        The neutral head as its file holds it [file unit].
    landmarks : Path
    expressions : dict of str to (n, 3) float64
        Displacement of every vertex, left and right together [mm].
    identities : (i, n, 3) float64
        Displacements of the identity basis [file unit].
    """

    mesh: PolygonMesh
    landmarks: Path
    expressions: dict[str, FloatArray]
    identities: FloatArray

    @staticmethod
    def load(folder: Path) -> Truths:
        """Read the folder ``ict_facekit`` of the real data."""
        mesh, _ = _formats.read_head(folder / "ict_neutral.obj")
        with np.load(folder / "ict_facekit.npz", allow_pickle=False) as data:
            distance, row = cKDTree(data["vertices"]).query(mesh.positions)
            assert float(np.max(distance)) < 1e-3, "the mesh is not the data set's neutral"
            names = [str(name) for name in data["expression_names"]]
            deltas = data["expression_deltas"][:, row].astype(np.float64)
            identities = data["identity_deltas"][:, row].astype(np.float64)
        expressions: dict[str, FloatArray] = {}
        for name in (*JUDGED, *FURTHER):
            sides = [f"{name}_L", f"{name}_R"] if f"{name}_L" in names else [name]
            if all(side in names for side in sides):
                rows = [names.index(side) for side in sides]
                expressions[name] = _MILLIMETRES * deltas[rows].sum(axis=0)
        return Truths(mesh, folder / "landmarks.json", expressions, identities)

    def head(self, seed: int | None = None) -> Head:
        """Return the neutral head, or a random identity: the same expressions are true for it."""
        mesh = self.mesh
        if seed is not None:
            share = np.random.default_rng(seed).standard_normal(len(self.identities))
            moved = mesh.positions + np.tensordot(share, self.identities, axes=1)
            mesh = replace(mesh, positions=moved)
        return Head.from_mesh(mesh, _formats.read_landmarks(self.landmarks))


def face_weights(head: Head) -> tuple[IntArray, FloatArray]:
    """Return the input vertices (k,) that count and the area (k,) that each stands for [mm^2]."""
    skin = head.skin
    area = np.zeros(head.vertex_count)
    area[skin.first_source()] = mass(skin.mesh.positions, skin.mesh.faces)
    face = np.flatnonzero((np.arange(head.vertex_count) < FACE_VERTICES) & (area > 0.0))
    return face.astype(np.int32), area[face]
