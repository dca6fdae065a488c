"""What a person makes in the studio: immutable states, their history, and the file they live in."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import ExitStack
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from risorius.controls.control import Pose
from risorius.errors import ParameterError, RisoriusError
from risorius.io.landmarks import landmarks_to_json
from risorius.landmarks.landmark_set import LandmarkSpec
from risorius.layered.muscle_map import MuscleMap
from risorius.project import Project, landmarks_of, read_mesh, vectors_of
from risorius.project.layered import muscle_map_of
from risorius.studio.keeper import Keeper
from risorius.vectormuscle.vector_set import VectorSet

__all__ = ["CURRENT", "Document", "Step", "Work", "originals_of", "project_of", "work_of"]

CURRENT = "current"
"""Name under which a project keeps the pose that its sliders show."""

_LONGEST_HISTORY = 500
_HANDED_ON = ("presets", "recipe")


@dataclass(frozen=True, eq=False)
class Work:
    """Everything human-made, at one moment.

    Parameters
    ----------
    project : Project
        Head, method, settings; without the recipes below.
    muscle_map : MuscleMap
    vectors : VectorSet
    landmarks : mapping of str to LandmarkSpec
        Of the head, as its file counts.
    pose : mapping of str to float
        What the sliders show.
    """

    project: Project
    muscle_map: MuscleMap
    vectors: VectorSet
    landmarks: Mapping[str, LandmarkSpec]
    pose: Pose = field(default_factory=dict[str, float])

    @property
    def poses(self) -> Mapping[str, Pose]:
        """Poses that a person keeps, by name."""
        return {name: pose for name, pose in self.project.poses.items() if name != CURRENT}


@dataclass(frozen=True, eq=False)
class Step:
    """One entry of the history: what was done, and what it led to."""

    label: str
    work: Work
    gesture: str = ""


def work_of(project: Project) -> Work:
    """Read everything that a project names.

    Raises
    ------
    RisoriusError
        If something is missing or malformed.
    """
    _, carried = read_mesh(project)
    return Work(
        project=replace(project, inline=_untouched(project)),
        muscle_map=muscle_map_of(project),
        vectors=vectors_of(project),
        landmarks=dict(landmarks_of(project, carried)),
        pose=dict(project.poses.get(CURRENT, {})),
    )


def project_of(
    work: Work, before: Project, originals: Mapping[str, dict[str, Any] | None]
) -> Project:
    """Return the project with every recipe in it that a person has changed.

    Parameters
    ----------
    work : Work
    before : Project
        As it was opened.
    originals : mapping of str to dict
        Recipes as they ship or stand in files that the project names; see `originals_of`.
    """
    inline: dict[str, Mapping[str, Any]] = {}
    for name in _HANDED_ON:
        if name in before.inline:
            inline[name] = before.inline[name]
    content = {
        "muscle_map": work.muscle_map.to_json(),
        "vector_set": work.vectors.to_json(),
        "landmarks": _landmark_document(work.landmarks),
    }
    for name, now in content.items():
        foreign = name == "landmarks" and before.head != work.project.head
        if foreign or now != originals.get(name):
            inline[name] = now
    poses = dict(work.poses)
    if work.pose:
        poses[CURRENT] = dict(work.pose)
    return replace(work.project, inline=inline, poses=poses)


def originals_of(project: Project) -> dict[str, dict[str, Any] | None]:
    """Return the recipes that a project gets from outside itself, as they stand in files.

    None where such a file has gone: what was read of it is then kept in the project.
    """
    bare = replace(project, inline={})
    readers: dict[str, Callable[[], dict[str, Any]]] = {
        "muscle_map": lambda: muscle_map_of(bare).to_json(),
        "vector_set": lambda: vectors_of(bare).to_json(),
        "landmarks": lambda: _landmark_document(landmarks_of(bare, read_mesh(bare)[1])),
    }
    return {name: _quiet(reader) for name, reader in readers.items()}


class Document:
    """A history of works and the file that always holds the present one.

    Parameters
    ----------
    keeper : Keeper
        Of the file.
    project : Project
        As opened.
    work : Work
    """

    def __init__(self, keeper: Keeper, project: Project, work: Work) -> None:
        self.keeper = keeper
        self._opened = project
        self._originals = originals_of(project)
        self._steps = [Step("Opened", work)]
        self._place = 0

    @staticmethod
    def open(path: Path, project: Project | None = None) -> Document:
        """Open a project file, or start one that does not exist yet.

        Parameters
        ----------
        path : Path
            Where the work is kept.
        project : Project, optional
            What a new one starts from; the built-in head if left out.

        Raises
        ------
        RisoriusError
            If the file or something that it names is refused, or another studio has it open.
        """
        keeper = Keeper.take(path)
        with ExitStack() as refused:
            refused.callback(keeper.release)
            found = keeper.read() or project or Project()
            document = Document(keeper, found, work_of(found))
            refused.pop_all()
        return document

    @property
    def work(self) -> Work:
        """The present state."""
        return self._steps[self._place].work

    @property
    def history(self) -> tuple[tuple[str, ...], int]:
        """Labels of all steps, and which of them is the present one."""
        return tuple(step.label for step in self._steps), self._place

    @property
    def undo_label(self) -> str:
        """What would be undone; empty at the start."""
        return self._steps[self._place].label if self._place else ""

    @property
    def redo_label(self) -> str:
        """What would be done again; empty at the end."""
        ahead = self._place + 1
        return self._steps[ahead].label if ahead < len(self._steps) else ""

    def apply(self, label: str, work: Work, *, gesture: str = "") -> None:
        """Make `work` the present state and keep it.

        Steps of the same `gesture`, such as one slider, that follow one another become one.

        Raises
        ------
        FormatError
            If the file cannot be written; the step is done nevertheless.
        """
        del self._steps[self._place + 1 :]
        if gesture and self._steps[-1].gesture == gesture:
            self._steps[-1] = Step(label, work, gesture)
        else:
            self._steps.append(Step(label, work, gesture))
        if len(self._steps) > _LONGEST_HISTORY:
            del self._steps[0]
        self._place = len(self._steps) - 1
        self.keep()

    def undo(self) -> str:
        """Go one step back; return what was undone.

        Raises
        ------
        ParameterError
            If nothing was done yet.
        """
        if not self._place:
            raise ParameterError("undo: this is where you started")
        label = self.undo_label
        self._place -= 1
        self.keep()
        return label

    def redo(self) -> str:
        """Go one step ahead; return what was done again.

        Raises
        ------
        ParameterError
            If nothing was undone.
        """
        if not self.redo_label:
            raise ParameterError("redo: nothing was undone")
        self._place += 1
        self.keep()
        return self.undo_label

    def keep(self) -> None:
        """Write the present state to the file.

        Raises
        ------
        FormatError
            If it cannot be written.
        """
        self.keeper.write(project_of(self.work, self._opened, self._originals))


def _untouched(project: Project) -> dict[str, Mapping[str, Any]]:
    """Return the recipes in a project that the studio hands on as they are."""
    return {name: project.inline[name] for name in _HANDED_ON if name in project.inline}


def _quiet(reader: Callable[[], dict[str, Any]]) -> dict[str, Any] | None:
    try:
        return reader()
    except RisoriusError:
        return None


def _landmark_document(specs: Mapping[str, LandmarkSpec]) -> dict[str, Any]:
    return {
        "schema": "risorius/landmarks",
        "version": 1,
        "landmarks": landmarks_to_json(specs),
    }
