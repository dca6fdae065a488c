"""Tuning by choosing: nine faces of one expression, the same engine as the command line."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from risorius._check import FloatArray
from risorius.controls.presets import EMOTIONS
from risorius.errors import ParameterError
from risorius.studio.scene import Stage
from risorius.studio.subject import Subject
from risorius.tuning.candidates import Candidates, PoseCandidates, sensitivity_of
from risorius.tuning.muscle_genes import MuscleCandidates
from risorius.tuning.session import Session
from risorius.vectormuscle.vector_set import VectorSet

__all__ = ["SUBJECTS", "Tuner"]

SUBJECTS = ("pose", "muscles")
"""What may be tuned: how far each muscle goes, or the muscles themselves (vector muscles)."""


@dataclass(frozen=True, eq=False)
class Tuner:
    """One tuning under way.

    Parameters
    ----------
    expression : str
    what : str
        One of `SUBJECTS`.
    candidates : Candidates
    session : Session
    """

    expression: str
    what: str
    candidates: Candidates
    session: Session

    @staticmethod
    def begin(subject: Subject, expression: str, *, what: str, seed: int = 0) -> Tuner:
        """Begin with the expression as it is now.

        Parameters
        ----------
        subject : Subject
        expression : str
            An emotion, or a pose that a person keeps.
        what : str
        seed : int

        Raises
        ------
        ParameterError
            If there is no such expression, or it has nothing to tune.
        """
        kept = subject.work.poses.get(expression)
        wanted = kept if kept is not None else subject.presets.emotions.get(expression)
        if wanted is None:
            raise ParameterError(
                f"tuning: there is no expression {expression!r}; choose one of "
                f"{', '.join((*EMOTIONS, *subject.work.poses))}"
            )
        pose = subject.presets.fit(wanted, subject.face.controls).pose
        pose = {name: value for name, value in pose.items() if value}
        if not pose:
            raise ParameterError(f"tuning: {expression!r} moves nothing on this face")
        candidates: Candidates = PoseCandidates(subject.face, pose)
        face = subject.vector_face
        if what == "muscles":
            if face is None:
                raise ParameterError("tuning: only vector muscles can be tuned themselves")
            names = tuple(name for name in pose if name in face.bound)
            candidates = MuscleCandidates(face, names, pose, _width(subject))
        sensitivity = sensitivity_of(candidates)
        session = Session(
            candidates.genome, strategy="preference", seed=seed, sensitivity=sensitivity
        )
        return Tuner(expression, what, candidates, session)

    def faces(self, stage: Stage) -> list[dict[str, FloatArray]]:
        """Return the vertices (k, 3) of every mesh of the nine faces, by name [mm]."""
        genome = self.candidates.genome
        return [
            stage.posed({}, self.candidates.positions(genome.named(values)), {"skin", "parts"})
            for values in self.session.generation.candidates
        ]

    def pose(self, values: Mapping[str, float]) -> Mapping[str, float]:
        """Return the pose that `values` make."""
        if isinstance(self.candidates, PoseCandidates):
            return self.candidates.pose_of(values)
        assert isinstance(self.candidates, MuscleCandidates)
        return self.candidates.pose

    def vectors(self, values: Mapping[str, float]) -> VectorSet | None:
        """Return the vector set that `values` make; None where the pose is tuned."""
        if not isinstance(self.candidates, MuscleCandidates):
            return None
        return self.candidates.face.vectors.replaced(self.candidates.muscles(values))

    def next(self, picks: Sequence[int]) -> None:
        """Choose and go to the next nine."""
        self.session.pick(picks)


def _width(subject: Subject) -> float:
    marks = subject.head.landmarks
    names = ("10.7", "10.8") if not marks.missing(("10.7", "10.8")) else ("3.7", "3.12")
    ends = marks.positions(names)
    return float(abs(ends[0, 0] - ends[1, 0])) * (1.0 if names[0] == "10.7" else 1.6)
