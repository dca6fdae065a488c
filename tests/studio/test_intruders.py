"""Strangers and nonsense at the door of a running studio."""

from __future__ import annotations

import http.client
import random
from pathlib import Path

from websockets.exceptions import ConnectionClosed, InvalidHandshake
from websockets.sync.client import connect

from tests.studio.server import studio


def _answer(port: int, path: str, **headers: str) -> tuple[int, bytes]:
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=20)
    connection.putrequest("GET", path, skip_host="Host" in headers)
    for name, value in headers.items():
        connection.putheader(name, value)
    connection.endheaders()
    answer = connection.getresponse()
    return answer.status, answer.read()


def _refuses(address: str, origin: str) -> bool:
    try:
        with connect(address, origin=origin, open_timeout=10):  # pyright: ignore
            return False
    except InvalidHandshake:
        return True


def test_foreign_pages_names_and_paths_get_nothing_and_nonsense_breaks_nothing(
    tmp_path: Path,
) -> None:
    secret = tmp_path / "secret.txt"
    secret.write_text("precious")
    folder = tmp_path / "work"
    folder.mkdir()
    with studio(folder / "work.json") as (port, process):
        own = f"http://127.0.0.1:{port}"
        assert _answer(port, "/")[0] == 200
        assert _answer(port, "/", Origin=own)[0] == 200
        assert _answer(port, "/", Origin="http://evil.example")[0] == 403
        assert _answer(port, "/", Host=f"evil.example:{port}")[0] == 403
        for path in (
            "/../secret.txt",
            "/%2e%2e/secret.txt",
            "/work.json",
            "/_nicegui/../work.json",
        ):
            assert b"precious" not in _answer(port, path)[1]
            assert b"risorius/project" not in _answer(port, path)[1]
        stream = f"ws://127.0.0.1:{port}/studio/stream"
        assert _refuses(stream, "http://evil.example")
        sockets = f"ws://127.0.0.1:{port}/_nicegui_ws/socket.io/?EIO=4&transport=websocket"
        assert _refuses(sockets, "http://evil.example")
        chance = random.Random(5)
        for number in range(12):
            with connect(stream, origin=own, max_size=None) as page:  # pyright: ignore
                noise = bytes(chance.randrange(256) for _ in range(chance.randrange(40)))
                try:
                    page.send(noise if number % 2 else noise.decode("latin-1"))
                    for _ in range(8):
                        page.recv(timeout=3)
                except (ConnectionClosed, TimeoutError):
                    pass
        assert process.poll() is None
        assert _answer(port, "/")[0] == 200
        assert sorted(file.name for file in folder.iterdir()) == [".work.json.lock", "work.log"]
