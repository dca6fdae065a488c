"""The stream to the pages: formats, and never more than a few messages under way."""

from __future__ import annotations

import asyncio
import json
import struct

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from risorius.mesh.core import TriMesh
from risorius.studio import frames
from risorius.studio.hub import WINDOW, Connection, Hub
from risorius.studio.moment import Moment
from risorius.studio.scene import SceneMesh

REST = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
MESH = SceneMesh("skin", "skin", TriMesh(REST, np.array([[0, 1, 2]])), np.full((3, 3), 7, np.uint8))


def _read(message: bytes) -> tuple[tuple[int, ...], dict, bytes]:
    head = struct.unpack_from("<IIII", message)
    end = 16 + head[3]
    assert head[3] % 4 == 0
    return head, json.loads(message[16:end]), message[end:]


def test_a_scene_brings_vertices_faces_and_colours() -> None:
    head, facts, blob = _read(
        frames.scene([MESH], epoch=4, replaced=["skin"], facts={"height": 230.0})
    )
    assert head[:2] == (frames.SCENE, 4)
    wanted = {"name": "skin", "group": "skin", "vertices": 3, "faces": 1, "solid": 1.0}
    assert facts["meshes"] == [wanted]
    assert np.array_equal(np.frombuffer(blob, "<f4", 9).reshape(3, 3), REST)
    assert np.array_equal(np.frombuffer(blob, "<u4", 3, 36), [0, 1, 2])
    assert blob[48:57] == bytes([7] * 9)
    assert len(blob) == 60


def test_a_frame_holds_displacements_to_a_few_micrometres() -> None:
    posed = REST + [[1.0 / 3.0, -40.0, 0.0]]
    message = frames.frame({"skin": REST}, Moment({"skin": posed}), epoch=1, serial=9)
    head, facts, blob = _read(message)
    assert head[:3] == (frames.FRAME, 1, 9)
    assert facts == {"moved": ["skin"], "painted": []}
    moved = np.frombuffer(blob, "<i2", 9).reshape(3, 3) * frames.STEP
    assert np.abs(moved - (posed - REST)).max() <= frames.STEP / 2


def test_a_motion_beyond_the_range_is_cut_off_not_wrapped() -> None:
    message = frames.frame({"skin": REST}, Moment({"skin": REST + 1000.0}), epoch=1, serial=1)
    assert np.frombuffer(_read(message)[2], "<i2", 9).min() == 32767


def test_a_frame_says_how_the_head_turns() -> None:
    turn = (0.0, 1.0, 2.0, 0.0, 0.0, 0.6, 0.8)
    message = frames.frame({"skin": REST}, Moment({"skin": REST}, turn), epoch=1, serial=1)
    assert _read(message)[1]["turn"] == list(turn)


def test_a_take_brings_only_targets_that_move() -> None:
    weights = np.array([[0.0, 0.5, 0.0], [0.0, 1.0, 0.25]])
    turns = np.tile([0.0, 0.0, 0.0, 1.0], (2, 1))
    head, facts, blob = _read(frames.take(weights, turns, epoch=3, facts={"number": 7}))
    assert head[:2] == (frames.TAKE, 3)
    assert facts == {"frames": 2, "columns": [1, 2], "turns": True, "number": 7}
    assert np.frombuffer(blob, "<f4", 4).tolist() == [0.5, 0.0, 1.0, 0.25]
    assert len(blob) == 4 * 4 + 2 * 16
    facts = _read(frames.take(weights, None, epoch=3, facts={}))[1]
    assert facts["turns"] is False


class _Slow:
    def __init__(self) -> None:
        self.got: list[bytes] = []

    async def send(self, message: bytes) -> None:
        self.got.append(message)


def _run(steps) -> None:
    asyncio.run(steps())


def test_only_the_newest_of_many_frames_is_sent_and_few_are_under_way() -> None:
    async def steps() -> None:
        page = _Slow()
        connection = Connection(page.send)
        task = asyncio.create_task(connection.run())
        for number in range(100):
            connection.offer(bytes([number]))
            await asyncio.sleep(0)
        await asyncio.sleep(0.01)
        assert len(page.got) == WINDOW
        assert connection.most_under_way == WINDOW
        assert connection.reply("ack 1")
        await asyncio.sleep(0.01)
        assert page.got[-1] == bytes([99])
        assert len(page.got) == WINDOW + 1
        task.cancel()

    _run(steps)


def test_scenes_arrive_all_and_in_order_and_void_older_frames() -> None:
    async def steps() -> None:
        page = _Slow()
        connection = Connection(page.send)
        connection.offer(b"old")
        for scene in (b"a", b"b", b"c"):
            connection.put(scene)
        task = asyncio.create_task(connection.run())
        for _ in range(4):
            await asyncio.sleep(0.005)
            connection.reply("ack 1")
        await asyncio.sleep(0.01)
        assert page.got == [b"a", b"b", b"c"]
        task.cancel()

    _run(steps)


def test_the_hub_waits_until_a_page_can_draw() -> None:
    async def steps() -> None:
        hub, page = Hub(), _Slow()
        waiting = asyncio.create_task(hub.ready())
        await asyncio.sleep(0.01)
        assert not waiting.done()
        hub.add(Connection(page.send))
        await asyncio.wait_for(waiting, 1.0)

    _run(steps)


def test_a_page_is_known_by_its_name() -> None:
    hub = Hub()
    own = Connection(_Slow().send, "a")
    for connection in (own, Connection(_Slow().send, "b")):
        hub.add(connection)
    assert hub.of("a") is own
    assert hub.of("c") is None
    hub.remove(own)
    assert hub.of("a") is None


@pytest.mark.parametrize("text", ["", "ack", "ack -1", "ack x", "ack 99999", "nack 1", "ack ²"])
def test_a_page_that_says_nonsense_is_not_listened_to(text: str) -> None:
    assert not Connection(_Slow().send).reply(text)


@given(text=st.text(max_size=60))
def test_no_reply_breaks_the_count(text: str) -> None:
    connection = Connection(_Slow().send)
    connection.reply(text)
    assert connection.under_way == 0
