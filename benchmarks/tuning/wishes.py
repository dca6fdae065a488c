"""A true expression of ICT-FaceKit as the hidden wish of a made-up user."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from benchmarks.expressive.truths import FACE_VERTICES, Truths
from risorius._check import FloatArray
from risorius.controls.presets import default_presets
from risorius.mesh.laplacian import mass
from risorius.rig.face import Face
from risorius.tuning import Genome, MuscleCandidates, PoseCandidates
from risorius.tuning.companions import companions_of
from risorius.tuning.looks import Looks
from risorius.tuning.plausible import Plausible
from risorius.vectormuscle import VectorFace
from risorius.vectormuscle.export_points import find_features

SHAPES = {
    "mouthSmile": ("mouthSmileLeft", "mouthSmileRight"),
    "mouthFrown": ("mouthFrownLeft", "mouthFrownRight"),
    "browInnerUp": ("browInnerUp",),
    "browDown": ("browDownLeft", "browDownRight"),
    "mouthUpperUp": ("mouthUpperUpLeft", "mouthUpperUpRight"),
}
GENES = ("published", "all", "intensities")


@dataclass(frozen=True, eq=False)
class Wish:
    """Candidates for one expression, on the welded skin, and the distance of each from the truth.

    Parameters
    ----------
    poses : PoseCandidates
        How far each muscle goes.
    muscles : MuscleCandidates or None
        The muscles themselves.
    intensities : bool
        Whether the former are tuned.
    truth : (w, 3) float64
        Displacement of the skin [mm].
    weights : (w,) float64
        Area of the face that each vertex stands for, 0 behind it.
    """

    poses: PoseCandidates
    muscles: MuscleCandidates | None
    intensities: bool
    truth: FloatArray
    weights: FloatArray

    @staticmethod
    def of(face: Face, truths: Truths, shape: str, *, genes: str = "all") -> Wish:
        """Return the wish for a true shape on ICT-FaceKit's own head.

        Parameters
        ----------
        face : Face
        truths : Truths
        shape : str
        genes : {"published", "all", "intensities"}
            Ten numbers of the shape's vector muscles; all of them and how far these and their
            companions go; the latter alone, for faces of any method.
        """
        presets = default_presets()
        pose: dict[str, float] = {}
        for name in SHAPES[shape]:
            for control, value in presets.fit(presets.arkit[name], face.controls).pose.items():
                pose[control] = max(pose.get(control, 0.0), value)
        muscles = None
        if genes != "intensities":
            assert isinstance(face, VectorFace)
            width = find_features(face.head).width
            names = tuple(name for name in pose if name in face.bound)
            chosen = "published" if genes == "published" else "all"
            muscles = MuscleCandidates(face, names, pose, width, genes=chosen)
        if genes != "published":
            pose |= dict.fromkeys(companions_of(face, pose), 0.0)
        skin = face.head.skin
        first = skin.first_source()
        weights = mass(skin.mesh.positions, skin.mesh.faces)
        weights[first >= FACE_VERTICES] = 0.0
        truth = truths.expressions[shape][first]
        return Wish(PoseCandidates(face, pose), muscles, genes != "published", truth, weights)

    @cached_property
    def genome(self) -> Genome:
        """What may be tuned."""
        own = self.poses.genome.parameters if self.intensities else ()
        return Genome((*(self.muscles.genome.parameters if self.muscles else ()), *own))

    def positions(self, values: Mapping[str, float]) -> FloatArray:
        """Return the welded skin (w, 3) [mm]."""
        face = self.poses.face if self.muscles is None else self.muscles.face_of(values)
        pose = self.poses.pose_of(values) if self.intensities else self.poses.pose
        skin = face.head.skin
        if isinstance(face, VectorFace):
            return skin.mesh.positions + face.displace_skin(pose)
        return skin.mesh.positions + (face.pose(pose) - face.head.positions)[skin.first_source()]

    @cached_property
    def looks(self) -> Looks:
        """The candidates as strategies see them."""
        return Looks(self, weights=self.weights)

    @cached_property
    def judge(self) -> Plausible:
        """Says whether a face is neither folded nor torn."""
        judge = Plausible.of(self.poses.face.head)
        judge = replace(judge, vertices=np.arange(len(self.truth), dtype=np.int32))
        first = self.looks.positions(self.genome.named(self.genome.start))
        return replace(judge, allowed=judge.allowed + judge.faults(first))

    def admit(self, values: FloatArray) -> bool:
        """Return whether a candidate may be shown."""
        return self.judge(self.looks.positions(self.genome.named(values)))

    def distance(self, values: FloatArray, *, axes: tuple[int, ...] = (0, 1, 2)) -> float:
        """Return the root mean square error [mm] over the face, along some axes."""
        made = self.looks.positions(self.genome.named(values))
        apart = made - self.poses.face.head.skin.mesh.positions - self.truth
        squared = (apart[:, list(axes)] ** 2).sum(axis=1)
        return float(np.sqrt(np.average(squared, weights=self.weights)))
