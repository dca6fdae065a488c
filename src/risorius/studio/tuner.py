"""Tuning by choosing: nine faces of one expression, the same engine as the command line."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, replace

from risorius._check import FloatArray
from risorius.controls.control import Pose
from risorius.controls.presets import EMOTIONS
from risorius.errors import ParameterError
from risorius.studio.jobs import Job
from risorius.studio.scene import Stage
from risorius.studio.subject import Subject
from risorius.studio.work import Work
from risorius.tuning.candidates import Candidates, Gallery, PoseCandidates, sensitivity_of
from risorius.tuning.genome import Genome
from risorius.tuning.map_genes import MapCandidates, apply_map_genes, map_muscles
from risorius.tuning.muscle_genes import MuscleCandidates
from risorius.tuning.outline_genes import OutlineCandidates, outline_muscles
from risorius.tuning.session import Session

__all__ = ["SUBJECTS", "Tuner", "muscle_of"]

SUBJECTS = ("pose", "muscles")
"""What may be tuned: how far each muscle goes, or the muscles themselves."""

Change = Callable[[Work, Mapping[str, float]], Work]


@dataclass(frozen=True, eq=False)
class Tuner:
    """One tuning under way; make one with `begin`.

    Parameters
    ----------
    expression : str
    what : str
        One of `SUBJECTS`.
    candidates : Candidates
    session : Session
    gallery : Gallery
        Makes the faces.
    """

    expression: str
    what: str
    candidates: Candidates
    session: Session
    gallery: Gallery
    _change: Change

    @staticmethod
    def begin(
        subject: Subject,
        expression: str,
        job: Job,
        *,
        what: str,
        locked: Collection[str] = (),
        seed: int = 0,
    ) -> Tuner:
        """Begin with the expression as it is now.

        Parameters
        ----------
        subject : Subject
        expression : str
            An emotion, or a pose that a person keeps.
        job : Job
            Told of every face that is made.
        what : str
            One of `SUBJECTS`; muscles are those that the expression contracts.
        locked : collection of str
            Muscles (without side) that stay as they are.
        seed : int

        Raises
        ------
        ParameterError
            If there is no such expression, or it has nothing to tune.
        Cancelled
            If a person stopped it.
        """
        pose = _pose_of(subject, expression)
        if what == "muscles":
            candidates, change = _muscles(subject, pose)
        else:
            candidates = PoseCandidates(subject.face, pose)
            change = _kept_pose(candidates, expression)
        if not len(candidates.genome):
            raise ParameterError(f"tuning: {expression!r} has nothing to tune on this face")
        job.step("looking at what each number does")
        told = _Told(candidates, job, 1 + len(candidates.genome))
        fixed = [name for name in candidates.genome.names if muscle_of(name) in locked]
        if len(fixed) == len(candidates.genome):
            raise ParameterError(
                f"tuning: all muscles of {expression!r} are locked; unlock one in the list"
            )
        free = [name for name in candidates.genome.names if name not in fixed]
        session = Session(
            candidates.genome, strategy="preference", seed=seed,
            sensitivity=sensitivity_of(told, names=free),
        )  # fmt: skip
        session.lock(fixed)
        return Tuner(expression, what, candidates, session, Gallery(candidates), change)

    def faces(self, stage: Stage) -> list[dict[str, FloatArray]]:
        """Return the vertices (k, 3) of every mesh of the nine faces, by name [mm]."""
        made = self.gallery.faces(self.session.generation.candidates)
        return [stage.posed({}, positions, {"skin", "parts"}) for positions in made]

    def accepted(self, work: Work, pick: int | None = None) -> Work:
        """Return the work with a face of the nine in it, or with the best so far."""
        return self._change(work, self.session.accept(pick))

    def next(self, picks: Sequence[int]) -> None:
        """Choose and go to the next nine; other faces where nothing is chosen."""
        self.session.pick(picks)


def muscle_of(parameter: str) -> str:
    """Return the muscle (without side) that a parameter belongs to."""
    stem = parameter.split(".", maxsplit=1)[0]
    return stem[:-2] if stem.endswith(("_l", "_r")) else stem


class _Told:
    """Candidates that tell of every face."""

    def __init__(self, candidates: Candidates, job: Job, count: int) -> None:
        self._candidates = candidates
        self._job = job
        self._count = count
        self._done = 0

    @property
    def genome(self) -> Genome:
        return self._candidates.genome

    def positions(self, values: Mapping[str, float]) -> FloatArray:
        self._job.tick(self._done, self._count, f"face {self._done + 1} of {self._count}")
        self._done += 1
        return self._candidates.positions(values)


def _pose_of(subject: Subject, expression: str) -> dict[str, float]:
    """Return what an expression moves on the face at hand."""
    kept = subject.work.poses.get(expression)
    wanted = kept if kept is not None else subject.presets.emotions.get(expression)
    if wanted is None:
        raise ParameterError(
            f"tuning: there is no expression {expression!r}; choose one of "
            f"{', '.join((*EMOTIONS, *subject.work.poses))}"
        )
    fitted = subject.presets.fit(wanted, subject.face.controls).pose
    pose = {name: value for name, value in fitted.items() if value}
    if not pose:
        raise ParameterError(f"tuning: {expression!r} moves nothing on this face")
    return pose


def _kept_pose(candidates: PoseCandidates, expression: str) -> Change:
    def change(work: Work, values: Mapping[str, float]) -> Work:
        pose = {name: float(value) for name, value in candidates.pose_of(values).items()}
        name = expression if expression in work.poses else f"my {expression}"
        project = replace(work.project, poses={**work.project.poses, name: pose})
        return replace(work, project=project, pose=pose)

    return change


def _muscles(subject: Subject, pose: Pose) -> tuple[Candidates, Change]:
    """Return the muscles that a pose contracts as candidates, and what they do to the work."""
    work, vectors, springs = subject.work, subject.vector_face, subject.spring_face
    if subject.bench is not None:
        names = map_muscles(work.muscle_map, pose)

        def on_map(work: Work, values: Mapping[str, float]) -> Work:
            return replace(work, muscle_map=apply_map_genes(work.muscle_map, values), pose=pose)

        return MapCandidates.of_bench(subject.bench, names, pose), on_map
    if springs is not None:
        drawn = OutlineCandidates(springs, work.recipe, outline_muscles(work.recipe, pose), pose)

        def on_recipe(work: Work, values: Mapping[str, float]) -> Work:
            return replace(work, recipe=drawn.recipe_of(values), pose=pose)

        return drawn, on_recipe
    if vectors is not None:
        names = tuple(name for name in pose if name in vectors.bound)
        carried = MuscleCandidates(vectors, names, pose, _width(subject))

        def on_vectors(work: Work, values: Mapping[str, float]) -> Work:
            changed = vectors.vectors.replaced(carried.muscles(values))
            return replace(work, vectors=changed, pose=pose)

        return carried, on_vectors
    raise ParameterError(
        "tuning: muscles of the faithful profile take minutes to be laid anew; tune their strength "
        "here, or the muscles in the improved profile"
    )


def _width(subject: Subject) -> float:
    marks = subject.head.landmarks
    names = ("10.7", "10.8") if not marks.missing(("10.7", "10.8")) else ("3.7", "3.12")
    ends = marks.positions(names)
    return float(abs(ends[0, 0] - ends[1, 0])) * (1.0 if names[0] == "10.7" else 1.6)
