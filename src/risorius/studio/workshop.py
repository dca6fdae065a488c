"""The one studio of a server: document, face, pose, and what the pages see of them."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from typing import Any, TypeVar

from risorius.controls.control import Control, Pose
from risorius.errors import ParameterError, RisoriusError
from risorius.rig.rig import Rig
from risorius.studio import frames
from risorius.studio.baking import bake_subject
from risorius.studio.document import Document
from risorius.studio.hub import Hub
from risorius.studio.jobs import Job
from risorius.studio.scene import GROUPS, Stage, stage_of
from risorius.studio.showing import Show, facts_of, frame_of
from risorius.studio.subject import Subject, build_subject
from risorius.studio.work import Work

__all__ = ["Workshop", "same_face"]

Result = TypeVar("Result")


class Workshop:
    """Everything that the pages of one server share.

    Faces are built and posed in one worker thread, and of several wishes only the newest is
    answered; the pages stay quick whatever the face costs.

    Parameters
    ----------
    document : Document
    """

    def __init__(self, document: Document) -> None:
        self.document = document
        self.hub = Hub()
        self.subject: Subject | None = None
        self.stage: Stage | None = None
        self.pose: dict[str, float] = dict(document.work.pose)
        self.show = Show()
        self.draft: Work | None = None
        self.draft_problem = ""
        self._refused: Work | None = None
        self._told = document.notice
        self.problem = ""
        self.built = asyncio.Event()
        self._wanted: dict[object, frozenset[str]] = {}
        self.listeners: set[Callable[[str], None]] = set()
        self.epoch = 0
        self._serial = 0
        self._wish = asyncio.Event()
        self._worker = ThreadPoolExecutor(1, thread_name_prefix="face")
        self._baked: tuple[Any, Rig] | None = None
        self._task: asyncio.Task[None] | None = None

    # -- life -------------------------------------------------------------------------------

    def start(self) -> None:
        """Begin to build and to pose."""
        self._task = asyncio.create_task(self._run())
        self._wish.set()

    def stop(self) -> None:
        """End; the document is kept already."""
        if self._task is not None:
            self._task.cancel()
        self._worker.shutdown(wait=False, cancel_futures=True)
        self.document.keeper.release()

    async def work(self, function: Callable[..., Result], *arguments: Any) -> Result:
        """Run a function in the worker thread, after what is under way there."""
        loop = asyncio.get_running_loop()
        return await loop.run_in_executor(self._worker, lambda: function(*arguments))

    def tell(self, what: str) -> None:
        """Tell all pages what changed.

        One of document, face, pose, show, draft, building, problem, bake and stream.
        """
        for listener in tuple(self.listeners):
            listener(what)

    # -- changes ----------------------------------------------------------------------------

    @property
    def controls(self) -> tuple[Control, ...]:
        """Controls of the face; empty until it is built."""
        return self.subject.face.controls if self.subject else ()

    def change(self, label: str, work: Work, *, gesture: str = "") -> None:
        """Make a work the present one, keep it, and build its face."""
        self.draft = None
        try:
            self.document.apply(label, work, gesture=gesture)
        except RisoriusError as error:
            self.complain(str(error))
        self._refresh()

    def try_out(self, work: Work) -> None:
        """Build the face of a work that is not kept: while a handle is dragged."""
        self.draft = work
        self._wish.set()

    def undo(self) -> str:
        """Go one step back; return what was undone."""
        return self._travel(self.document.undo)

    def redo(self) -> str:
        """Go one step ahead; return what was done."""
        return self._travel(self.document.redo)

    def _travel(self, go: Callable[[], str]) -> str:
        """Go to another step; where it is reached but not kept, the face follows all the same."""
        before = self.document.history[1]
        try:
            return go()
        finally:
            if self.document.history[1] != before:
                self.draft = None
                self._refresh()

    def set_pose(self, values: Mapping[str, float]) -> None:
        """Move the face; the document follows with `keep_pose`."""
        self.pose.update(values)
        self.show = replace(self.show, played=None)
        self._wish.set()

    def replace_pose(self, pose: Pose, label: str) -> None:
        """Set all sliders at once and keep them."""
        self.pose = dict(pose)
        self.show = replace(self.show, played=None)
        self.keep_pose(label)
        self._wish.set()

    def keep_pose(self, label: str, *, gesture: str = "") -> None:
        """Keep the pose as a step of the history."""
        pose = {name: value for name, value in self.pose.items() if value}
        if pose == dict(self.document.work.pose):
            return
        try:
            self.document.apply(label, replace(self.document.work, pose=pose), gesture=gesture)
        except RisoriusError as error:
            self.complain(str(error))
        self._announce()

    def present(self, **changes: Any) -> None:
        """Change what is shown beside the sliders."""
        self.show = replace(self.show, **changes)
        self._wish.set()
        if "played" not in changes:
            self.tell("show")

    def want(self, page: object, groups: Iterable[str]) -> None:
        """Move only groups that some page shows; none at all when a page leaves."""
        wanted = frozenset(groups)
        if wanted:
            self._wanted[page] = wanted
        else:
            self._wanted.pop(page, None)
        self._wish.set()

    def complain(self, sentence: str) -> None:
        """Show a problem on all pages."""
        self.problem = sentence
        self.tell("problem")

    def _refresh(self) -> None:
        self.pose = dict(self.document.work.pose)
        self.show = replace(self.show, played=None)
        self._wish.set()
        self._announce()

    def _announce(self) -> None:
        """Tell of a new state, and where it is kept if it had to move."""
        self.tell("document")
        self.tell("pose")
        if self.document.notice != self._told:
            self._told = self.document.notice
            self.complain(self._told)
        keeper = self.document.keeper
        if keeper.moved_from is not None:
            old, keeper.moved_from = keeper.moved_from, None
            self.complain(
                f"{old.name} was changed by another program and stays as it is; your work goes on "
                f"in {keeper.path.name}"
            )

    def rig(self, sets: Sequence[str], job: Job) -> Rig:
        """Bake the face at hand, or return what was baked of it before; runs in any thread.

        Raises
        ------
        ParameterError
            If there is no face yet.
        Cancelled
            If a person stopped it.
        """
        subject = self.subject
        if subject is None:
            raise ParameterError("face: still being built; a moment")
        key = (subject.face, tuple(sets), tuple(self.document.work.poses))
        if self._baked is None or self._baked[0] != key:
            current = replace(subject, work=self.document.work)
            self._baked = (key, bake_subject(current, sets, job))
        return self._baked[1]

    # -- the loop ---------------------------------------------------------------------------

    async def _run(self) -> None:
        while True:
            await self._wish.wait()
            self._wish.clear()
            work = self.draft or self.document.work
            if self._is_new(work):
                await self._build(work)
            if self.stage is not None:
                await self.hub.ready()
                self._wish.clear()
                if self._is_new(self.draft or self.document.work):
                    self._wish.set()  # wished while no page could draw
                else:
                    await self._pose()

    def _is_new(self, work: Work) -> bool:
        """Return whether the face of a work has to be built and was not refused just now."""
        known = [each for each in (self.subject and self.subject.work, self._refused) if each]
        return not any(same_face(work, each) for each in known)

    async def _build(self, work: Work) -> None:
        drafted = work is self.draft
        if self.subject is not None and work.project != self.subject.work.project:
            self.tell("building")
        try:
            stage = await self.work(_built, work, self.subject, self.stage)
        except RisoriusError as error:
            # Not again until something else is wished.
            self._refused = work
            if drafted:
                self.draft_problem = str(error)
                self.tell("draft")
            else:
                self.complain(str(error))
            return
        self._refused, self.draft_problem = None, ""
        same_head = self.stage is not None and stage.lasting == self.stage.lasting
        renewed = self.stage is None or stage.meshes != self.stage.meshes
        self.subject, self.stage = stage.subject, stage
        known = {control.name for control in self.controls}
        self.pose = {name: value for name, value in self.pose.items() if name in known}
        if renewed:
            self.epoch += 1
            self.hub.put(self.scene_message(only_muscles=same_head))
        self.built.set()
        self.tell("face")

    async def _pose(self) -> None:
        assert self.stage is not None
        self._serial += 1
        known = {control.name for control in self.controls}
        pose = {name: value for name, value in self.pose.items() if value and name in known}
        groups = {"skin"}.union(*self._wanted.values())
        try:
            message = await self.work(
                frame_of, self.stage, pose, self.show, groups, (self.epoch, self._serial)
            )
        except RisoriusError as error:
            self.complain(str(error))
            return
        self.hub.offer(message)

    def scene_message(self, *, only_muscles: bool = False) -> bytes:
        """Return the message with all meshes, or with the muscles alone."""
        assert self.stage is not None
        meshes = [each for each in self.stage.meshes if each.group == "muscles" or not only_muscles]
        replaced = ("muscles",) if only_muscles else GROUPS
        facts = {} if only_muscles else facts_of(self.stage)
        return frames.scene(meshes, epoch=self.epoch, replaced=replaced, facts=facts)

    def greet(self, put: Callable[[bytes], None]) -> None:
        """Send a page that has just come all that it needs."""
        if self.stage is not None:
            put(self.scene_message())
            self._wish.set()


def same_face(work: Work, other: Work) -> bool:
    """Tell whether two works have the same face, whatever its poses."""
    names = ("muscle_map", "vectors", "recipe", "landmarks")
    same = all(getattr(work, name) is getattr(other, name) for name in names)
    bare = {"poses": {}, "inline": {}, "shapes": ("singles",)}
    return same and replace(work.project, **bare) == replace(other.project, **bare)


def _built(work: Work, subject: Subject | None, stage: Stage | None) -> Stage:
    return stage_of(build_subject(work, subject), stage)
