"""The face at hand as a rig that pages play alone, baked in the background."""

from __future__ import annotations

import asyncio

from risorius.controls.shape_sets import SHAPE_SETS
from risorius.errors import Cancelled, ParameterError, RisoriusError
from risorius.studio.jobs import Job
from risorius.studio.stage_rig import StageRig
from risorius.studio.workshop import Workshop, same_face

__all__ = ["Bakery"]

_PACE = 0.2


class Bakery:
    """Bakes while some page wants it; an edit of the face stops it, and the new face is next.

    Parameters
    ----------
    shop : Workshop
        Told of progress ("bake").
    """

    def __init__(self, shop: Workshop) -> None:
        self.shop = shop
        self.job: Job | None = None
        self.number = 0
        self.problem = ""
        self._done: StageRig | None = None
        self._wanted: set[object] = set()
        self._task: asyncio.Task[None] | None = None
        shop.listeners.add(self.hear)

    @property
    def ready(self) -> StageRig | None:
        """The baked face, if it is the one at hand."""
        done, stage = self._done, self.shop.stage
        if done is None or stage is None or done.stage.subject.face is not stage.subject.face:
            return None
        work = self.shop.draft or self.shop.document.work
        return done if same_face(work, stage.subject.work) else None

    def want(self, page: object) -> None:
        """Bake, because a page plays."""
        self._wanted.add(page)
        self._begin()

    def leave(self, page: object) -> None:
        """Forget a page; what nobody wants any more is stopped."""
        self._wanted.discard(page)
        if not self._wanted:
            self.cancel()

    def cancel(self) -> None:
        """Stop what is under way."""
        if self.job is not None:
            self.job.cancel()

    async def rig(self) -> StageRig:
        """Return the baked face, as soon as it is there.

        Raises
        ------
        ParameterError
            If baking failed or was stopped.
        """
        while (done := self.ready) is None:
            task = self._begin()
            if task is None:
                raise ParameterError("bake: the face is still being built; a moment")
            await asyncio.wait({task})
            if self.ready is None and not self.is_busy:
                raise ParameterError(self.problem or "bake: stopped; open the take again")
        return done

    @property
    def is_busy(self) -> bool:
        """Whether something is being baked."""
        return self._task is not None

    def hear(self, what: str) -> None:
        """Follow the face."""
        if what not in ("document", "face") or self.ready is not None:
            return
        stage = self.shop.stage
        if what == "document" and stage is not None:
            if not same_face(self.shop.document.work, stage.subject.work):
                self.cancel()
        elif what == "face":
            self.cancel()
            if self._wanted:
                self._begin()

    def _begin(self) -> asyncio.Task[None] | None:
        """Return the task that bakes; None before there is a face, or where all is done."""
        if self.ready is None and self._task is None and self.shop.stage is not None:
            self._task = asyncio.create_task(self._bake())
        return self._task

    async def _bake(self) -> None:
        stage = self.shop.stage
        assert stage is not None
        job = self.job = Job("bake")
        self.problem = ""

        def work() -> StageRig:
            rig = self.shop.rig(SHAPE_SETS, job)
            if self.shop.stage is not stage:
                raise Cancelled("bake: the face has changed")
            return StageRig.build(stage, rig, job)

        task = asyncio.create_task(asyncio.to_thread(work))
        try:
            while not task.done():
                self.shop.tell("bake")
                await asyncio.wait({task}, timeout=_PACE)
            self._done = task.result()
            self.number += 1
        except Cancelled:
            pass
        except RisoriusError as error:
            self.problem = str(error)
        finally:
            self.job = self._task = None
        if self._wanted and self.shop.stage is not stage:
            self._begin()
        self.shop.tell("bake")
