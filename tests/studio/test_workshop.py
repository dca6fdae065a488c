"""The loop behind the pages: no wish is lost, and what is refused leaves everything as it was."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from risorius.errors import FormatError
from risorius.project import Project, read_project
from risorius.springmuscle.recipe import OutlineRecipe
from risorius.studio.document import Document
from risorius.studio.hub import Connection
from risorius.studio.work import Work
from risorius.studio.workshop import Workshop
from risorius.vectormuscle.editing import removed


class Page:
    """A page that draws only when it is told to."""

    def __init__(self, shop: Workshop) -> None:
        self.shop, self.got = shop, list[bytes]()
        self.busy = False
        self.connection = Connection(self._send)
        shop.hub.add(self.connection)
        self.stream = asyncio.create_task(self.connection.run())

    async def _send(self, message: bytes) -> None:
        self.got.append(message)
        if not self.busy:
            asyncio.get_running_loop().call_soon(self.draw)

    def draw(self) -> None:
        self.connection.reply("ack 9")
        self.shop.hub.noticed()


Steps = Callable[[Workshop, Page], Awaitable[None]]


def _in_shop(tmp_path: Path, steps: Steps, project: Project | None = None) -> None:
    async def run() -> None:
        document = Document.open(tmp_path / "work.json", project or Project(method="vector"))
        shop = Workshop(document)
        page = Page(shop)
        shop.start()
        try:
            await asyncio.wait_for(shop.built.wait(), 90)
            await steps(shop, page)
        finally:
            page.stream.cancel()
            shop.stop()

    asyncio.run(run())


async def _until(condition: Callable[[], bool]) -> None:
    for _ in range(1000):
        if condition():
            return
        await asyncio.sleep(0.02)
    raise AssertionError("waited in vain")


def _without(work: Work, name: str) -> Work:
    return replace(work, vectors=removed(work.vectors, name))


def test_a_face_that_is_wished_for_while_no_page_can_draw_is_built_all_the_same(
    tmp_path: Path,
) -> None:
    async def steps(shop: Workshop, page: Page) -> None:
        page.busy = True
        for value in (1.0, 2.0, 3.0, 4.0):
            shop.set_pose({"jaw_pitch": value})
            await asyncio.sleep(0.2)
        draft = _without(shop.document.work, "risorius_l")
        shop.try_out(draft)
        await asyncio.sleep(0.2)
        page.busy = False
        page.draw()
        await _until(lambda: shop.subject is not None and shop.subject.work is draft)
        assert "risorius_l" not in {control.name for control in shop.controls}

    _in_shop(tmp_path, steps)


def test_a_draft_that_is_refused_is_said_and_the_face_before_stays(tmp_path: Path) -> None:
    async def steps(shop: Workshop, page: Page) -> None:
        heard: list[str] = []
        shop.listeners.add(heard.append)
        before, work = shop.subject, shop.document.work
        assert before is not None
        outline = next(each for each in work.recipe.muscles if each.name == "risorius")
        first, *rows = outline.rows
        crossed = replace(outline, rows=(first[::-1], *rows))
        shop.try_out(replace(work, recipe=OutlineRecipe((crossed, *_others(work)))))
        await _until(lambda: "draft" in heard)
        assert "cross" in shop.draft_problem
        assert shop.subject is before and shop.problem == ""
        shop.draft = None
        shop.change("Risorius alone", replace(work, recipe=OutlineRecipe((outline,))))
        await _until(lambda: shop.subject is not before)
        assert shop.draft_problem == ""
        assert shop.subject is not None and shop.subject.spring_face is not None
        names = [muscle.name for muscle in shop.subject.spring_face.muscles.muscles]
        assert names == ["risorius_l", "risorius_r"]

    def _others(work: Work):
        return tuple(each for each in work.recipe.muscles if each.name != "risorius")

    _in_shop(tmp_path, steps, Project(method="springs"))


def test_what_is_posed_for_a_draft_does_not_outlive_it(tmp_path: Path) -> None:
    async def steps(shop: Workshop, page: Page) -> None:
        work = shop.document.work
        shop.set_pose({"risorius_l": 1.0, "jaw_pitch": 3.0})
        shop.try_out(_without(work, "risorius_l"))
        await _until(lambda: "risorius_l" not in shop.pose)
        assert shop.pose == {"jaw_pitch": 3.0}
        shop.set_pose({"risorius_l": 1.0})
        count = len(page.got)
        shop.set_pose({"jaw_pitch": 4.0})
        await _until(lambda: len(page.got) > count)
        assert shop.problem == "", "a control that has gone does not stop the others"

    _in_shop(tmp_path, steps)


def test_a_step_that_cannot_be_kept_is_told_of_and_done_nevertheless(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    async def steps(shop: Workshop, page: Page) -> None:
        shop.change("Without risorius", _without(shop.document.work, "risorius_l"))

        def full(content: bytes) -> None:
            raise FormatError("work.json: cannot be written (No space left on device)")

        monkeypatch.setattr(shop.document.keeper, "write", full)
        with pytest.raises(FormatError, match="No space left"):
            shop.undo()
        assert shop.document.undo_label == ""
        await _until(lambda: shop.subject is not None and "risorius_l" in _controls(shop))
        shop.change("Jaw", replace(shop.document.work, pose={"jaw_pitch": 2.0}))
        assert "No space left" in shop.problem
        assert shop.pose == {"jaw_pitch": 2.0}

    _in_shop(tmp_path, steps)
    assert "vector_set" in read_project(tmp_path / "work.json").inline


def _controls(shop: Workshop) -> set[str]:
    return {control.name for control in shop.controls}


def test_the_skin_that_a_chosen_spring_muscle_moves_is_painted(tmp_path: Path) -> None:
    async def steps(shop: Workshop, page: Page) -> None:
        shop.present(influenced="risorius_l")
        await _until(lambda: b'"painted":["skin"]' in page.got[-1])
        shop.present(influenced="")
        await _until(lambda: b'"painted":[]' in page.got[-1])
        shop.present(heat="influence", selected="risorius_l")
        await _until(lambda: b'"painted":["skin"]' in page.got[-1])

    _in_shop(tmp_path, steps, Project(method="springs"))


def test_undone_and_done_again_the_face_is_the_same_to_the_last_bit(tmp_path: Path) -> None:
    async def steps(shop: Workshop, page: Page) -> None:
        assert shop.subject is not None
        before = shop.subject.face.pose({"zygomaticus_major_l": 1.0})
        first = shop.subject
        shop.change("Without risorius", _without(shop.document.work, "risorius_l"))
        await _until(lambda: shop.subject is not first)
        shop.undo()
        await _until(lambda: "risorius_l" in _controls(shop))
        after = shop.subject.face.pose({"zygomaticus_major_l": 1.0})
        assert np.array_equal(before, after)

    _in_shop(tmp_path, steps)
