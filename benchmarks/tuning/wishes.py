"""A true expression of ICT-FaceKit as the hidden wish of a made-up user."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from benchmarks.expressive.truths import FACE_VERTICES, Truths
from risorius._check import FloatArray
from risorius.controls.presets import default_presets
from risorius.mesh.laplacian import mass
from risorius.tuning import MuscleCandidates
from risorius.tuning.muscle_genes import Genes
from risorius.vectormuscle import VectorFace
from risorius.vectormuscle.export_points import find_features

SHAPES = {
    "mouthSmile": ("mouthSmileLeft", "mouthSmileRight"),
    "mouthFrown": ("mouthFrownLeft", "mouthFrownRight"),
    "browInnerUp": ("browInnerUp",),
    "browDown": ("browDownLeft", "browDownRight"),
    "mouthUpperUp": ("mouthUpperUpLeft", "mouthUpperUpRight"),
}


@dataclass(frozen=True, eq=False)
class Wish:
    """Candidates for one expression and the distance of each from the truth.

    Parameters
    ----------
    candidates : MuscleCandidates
    truth : (w, 3) float64
        Displacement of the welded skin [mm].
    weights : (w,) float64
        Area of the face that each vertex stands for, 0 behind it.
    """

    candidates: MuscleCandidates
    truth: FloatArray
    weights: FloatArray

    @staticmethod
    def of(face: VectorFace, truths: Truths, shape: str, *, genes: Genes = "all") -> Wish:
        """Return the wish for a true shape on ICT-FaceKit's own head."""
        presets = default_presets()
        poses = [presets.fit(presets.arkit[name], face.controls).pose for name in SHAPES[shape]]
        pose: dict[str, float] = {}
        for each in poses:
            for name, value in each.items():
                pose[name] = max(pose.get(name, 0.0), value)
        names = tuple(name for name in pose if name in face.bound)
        skin = face.head.skin
        first = skin.first_source()
        weights = mass(skin.mesh.positions, skin.mesh.faces)
        weights[first >= FACE_VERTICES] = 0.0
        width = find_features(face.head).width
        shown = {name: pose[name] for name in names}
        candidates = MuscleCandidates(face, names, shown, width, genes=genes)
        return Wish(candidates, truths.expressions[shape][first], weights)

    def skin(self, values: FloatArray) -> FloatArray:
        """Return the displacement (w, 3) of the skin for values (p,) [mm]."""
        made = self.candidates
        named = made.genome.named(values)
        return made.face.with_muscles(made.muscles(named)).displace_skin(made.pose)

    def distance(self, values: FloatArray) -> float:
        """Return the root mean square error [mm] over the face."""
        squared = ((self.skin(values) - self.truth) ** 2).sum(axis=1)
        return float(np.sqrt(np.average(squared, weights=self.weights)))

    def sensitivity(self) -> FloatArray:
        """Return the effect (k, p) of each gene over its range on the skin, weighted."""
        genome = self.candidates.genome
        root = np.sqrt(self.weights / self.weights.sum())[:, None]
        rest = self.skin(genome.start)
        columns: list[FloatArray] = []
        for row in range(len(genome)):
            moved = genome.start
            reach = 0.25 * (genome.high[row] - genome.low[row])
            sign = 1.0 if moved[row] + reach <= genome.high[row] else -1.0
            moved[row] += sign * reach
            columns.append(4.0 * sign * (root * (self.skin(moved) - rest)).ravel())
        return np.stack(columns, axis=1)
