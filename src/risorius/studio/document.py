"""What a person makes in the studio: states, their history, and the file they live in."""

from __future__ import annotations

from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path

from risorius.errors import FormatError
from risorius.project import Project
from risorius.project.files import parse_project, project_bytes, project_document
from risorius.studio.history import History, Step
from risorius.studio.journal import Journal
from risorius.studio.keeper import Keeper
from risorius.studio.work import Shelf, Work, originals_of, project_of, work_of

__all__ = ["Document"]


class Document:
    """A history of works and the file that always holds the present one.

    Parameters
    ----------
    keeper : Keeper
        Of the file.
    project : Project
        As opened.
    """

    def __init__(self, keeper: Keeper, project: Project) -> None:
        self.keeper = keeper
        self.notice = ""
        self._opened = project
        self._originals = originals_of(project)
        self._shelf = Shelf()
        work = work_of(project, self._shelf)
        content = keeper.content
        if content is None:
            content = project_bytes(project, keeper.path)
        self._journal = Journal(keeper.path)
        found = self._remembered(content)
        if found is None:
            record = self._journal.record(project_document(project, keeper.path), content)
            found = History([Step("Opened", work=work, record=record)])
        self._history = found
        self._history.steps[found.place] = replace(found.present, work=work)

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
            document = Document(keeper, keeper.read() or project or Project())
            refused.pop_all()
        return document

    def _remembered(self, content: bytes) -> History | None:
        """Return the history of the studio before; what cannot be read is told of in `notice`."""
        try:
            return self._journal.read(content)
        except FormatError as error:
            self.notice = f"{error}; the project is whole, but undo begins here"
        self._journal = Journal(self.keeper.path)
        return None

    @property
    def work(self) -> Work:
        """The present state."""
        work = self._history.present.work
        assert work is not None
        return work

    @property
    def history(self) -> tuple[tuple[str, ...], int]:
        """Labels of all steps, and which of them is the present one."""
        return tuple(step.label for step in self._history.steps), self._history.place

    @property
    def undo_label(self) -> str:
        """What would be undone; empty at the start."""
        return self._history.undo_label

    @property
    def redo_label(self) -> str:
        """What would be done again; empty at the end."""
        return self._history.redo_label

    def apply(self, label: str, work: Work, *, gesture: str = "") -> None:
        """Make `work` the present state and keep it.

        Steps of the same `gesture`, such as one slider, that follow one another become one.

        Raises
        ------
        FormatError
            If the file cannot be written; the step is done nevertheless.
        """
        self._keep(self._history.add(Step(label, gesture, work)))

    def undo(self) -> str:
        """Go one step back; return what was undone.

        Raises
        ------
        ParameterError
            If nothing was done yet.
        FormatError
            If the step cannot be read any more, and stays undone; or the file cannot be written.
        """
        label = self.undo_label
        self._go(-1)
        return label

    def redo(self) -> str:
        """Go one step ahead; return what was done again.

        Raises
        ------
        ParameterError
            If nothing was undone.
        FormatError
            As `undo`.
        """
        self._go(1)
        return self.undo_label

    def keep(self) -> None:
        """Write the present state to the file.

        Raises
        ------
        FormatError
            If it cannot be written.
        """
        self._keep(None)

    def _go(self, way: int) -> None:
        history = self._history
        place = history.beside(way)
        step = history.steps[place]
        if step.work is None:
            assert step.record is not None
            document = self._journal.document(step.record)
            project = parse_project(document, self.keeper.path)
            history.steps[place] = replace(step, work=work_of(project, self._shelf))
        history.place = place
        self._keep(None)

    def _keep(self, kept: int | None) -> None:
        """Write the journal, then the project.

        Parameters
        ----------
        kept : int, optional
            How many steps stay in front of the present one, if that is new.
        """
        history = self._history
        moved = self.keeper.settle()
        path = self.keeper.path
        project = project_of(self.work, self._opened, self._originals)
        content = project_bytes(project, path)
        record = self._journal.record(project_document(project, path), content)
        history.steps[history.place] = replace(history.present, record=record)
        if moved:
            self._journal.move(path)
        try:
            if kept is None:
                self._journal.go(history)
            else:
                self._journal.add(history, kept)
        except FormatError as error:
            self.notice = f"{error}; undo works until the studio is closed"
        self.keeper.write(content)
