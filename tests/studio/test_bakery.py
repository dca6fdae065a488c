"""Baking in the background: only where wanted, and never of a face that is gone."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from risorius.errors import ParameterError
from risorius.project import Project
from risorius.studio.bakery import Bakery
from risorius.studio.document import Document
from risorius.studio.hub import Connection
from risorius.studio.workshop import Workshop
from risorius.vectormuscle.kinds import LinearMuscle


async def _until(condition: Callable[[], bool]) -> None:
    async with asyncio.timeout(60):
        while not condition():
            await asyncio.sleep(0.02)


def _with_shop(tmp_path: Path, steps) -> None:
    async def run() -> None:
        document = Document.open(tmp_path / "work.json", Project(method="vector"))
        shop = Workshop(document)
        bakery = Bakery(shop)

        async def draw(message: bytes) -> None:
            page.reply("ack 1")
            asyncio.get_running_loop().call_soon(shop.hub.noticed)

        page = Connection(draw)
        shop.hub.add(page)
        stream = asyncio.create_task(page.run())
        shop.start()
        try:
            await steps(shop, bakery)
        finally:
            bakery.cancel()
            stream.cancel()
            shop.stop()

    asyncio.run(run())


def test_nothing_is_baked_before_a_page_plays_and_then_once(tmp_path: Path) -> None:
    async def steps(shop: Workshop, bakery: Bakery) -> None:
        with pytest.raises(ParameterError, match="still being built"):
            await bakery.rig()
        await shop.built.wait()
        await asyncio.sleep(0.1)
        assert bakery.job is None and bakery.ready is None
        told: list[float] = []
        shop.listeners.add(lambda what: told.append(bakery.number) if what == "bake" else None)
        bakery.want("page")
        rig = await bakery.rig()
        assert rig.rig.names and bakery.ready is rig and bakery.number == 1
        bakery.want("other")
        assert await bakery.rig() is rig
        await _until(lambda: bool(told) and told[-1] == 1)

    _with_shop(tmp_path, steps)


def test_an_edit_stops_it_and_the_new_face_is_baked(tmp_path: Path) -> None:
    async def steps(shop: Workshop, bakery: Bakery) -> None:
        await shop.built.wait()
        bakery.want("page")
        await _until(lambda: bakery.job is not None and bakery.job.share > 0.0)
        job, stage = bakery.job, shop.stage
        work = shop.document.work
        muscle = next(each for each in work.vectors.muscles if isinstance(each, LinearMuscle))
        changed = work.vectors.replaced([replace(muscle, strength=0.5 * muscle.strength)])
        shop.change("Weaker", replace(work, vectors=changed))
        assert job is not None
        await _until(lambda: job.cancelled)
        await _until(lambda: shop.stage is not stage)
        rig = await bakery.rig()
        assert rig.stage is shop.stage

    _with_shop(tmp_path, steps)


def test_a_page_that_leaves_stops_it(tmp_path: Path) -> None:
    async def steps(shop: Workshop, bakery: Bakery) -> None:
        await shop.built.wait()
        bakery.want("page")
        await _until(lambda: bakery.job is not None)
        bakery.leave("page")
        await _until(lambda: not bakery.is_busy)
        assert bakery.ready is None

    _with_shop(tmp_path, steps)
