"""Who may talk to the studio, and where it may write."""

from __future__ import annotations

import asyncio
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from risorius.errors import FormatError, ParameterError
from risorius.studio.guard import Guard, inside, plain_name, require_allowed
from risorius.studio.uploads import keep_upload, trying_upload

HOST = "127.0.0.1:8420"


@pytest.mark.parametrize(
    ("host", "origin", "allowed"),
    [
        (HOST, "", True),
        (HOST, "http://127.0.0.1:8420", True),
        ("localhost:8420", "http://localhost:8420", True),
        (HOST, "http://evil.example", False),
        (HOST, "http://127.0.0.1:9999", False),
        (HOST, "http://localhost:8420", False),
        (HOST, "null", False),
        (HOST, "http://[", False),
        ("evil.example:8420", "http://evil.example:8420", False),
        ("evil.example:8420", "", False),
        ("", "", False),
    ],
)
def test_only_the_page_of_the_studio_itself_gets_in(host: str, origin: str, allowed: bool) -> None:
    assert Guard(None).allows(host, origin) is allowed


@pytest.mark.parametrize("kind", ["http", "websocket"])
def test_a_refused_request_never_reaches_the_application(kind: str) -> None:
    reached: list[str] = []
    sent: list[dict] = []

    async def application(scope, receive, send):
        reached.append(scope["type"])

    async def send(message):
        sent.append(message)

    def ask(origin: bytes) -> None:
        headers = [(b"host", HOST.encode()), (b"origin", origin)]
        asyncio.run(Guard(application)({"type": kind, "headers": headers}, None, send))

    ask(b"http://evil.example")
    assert reached == []
    assert sent[0].get("status", sent[0].get("code")) in (403, 1008)
    ask(b"http://127.0.0.1:8420")
    assert reached == [kind]


@pytest.mark.parametrize(
    "name",
    [
        "../x.glb", "..", ".", "", "a/b.glb", "a\\b.glb", "/etc/passwd", "C:evil.glb", ".hidden",
        "x\0.glb", "con", "NUL.glb", "x" * 81, "dot.", "tail ", "a\nb.glb", "ä.glb",
    ],
)  # fmt: skip
def test_a_name_that_leads_elsewhere_is_refused(tmp_path: Path, name: str) -> None:
    with pytest.raises(ParameterError, match="file name"):
        inside(tmp_path, name)


def test_a_name_of_another_ending_is_refused() -> None:
    assert plain_name("my head.glb", endings=(".glb",)) == "my head.glb"
    with pytest.raises(ParameterError, match="must end in"):
        plain_name("page.html", endings=(".glb",))


def test_a_link_out_of_the_folder_is_refused(tmp_path: Path) -> None:
    folder = tmp_path / "work"
    folder.mkdir()
    (folder / "rig.glb").symlink_to(tmp_path / "other.glb")
    with pytest.raises(FormatError, match="leads out"):
        inside(folder, "rig.glb")


@given(name=st.text(max_size=30), data=st.binary(max_size=20))
def test_no_upload_leaves_the_folder(
    tmp_path_factory: pytest.TempPathFactory, name: str, data: bytes
) -> None:
    base = tmp_path_factory.mktemp("upload")
    folder = base / "work"
    folder.mkdir()
    try:
        path = keep_upload(folder, name, data, endings=(".fap", ".csv"))
    except ParameterError:
        assert list(folder.iterdir()) == []
    else:
        assert path.parent == folder
        assert path.read_bytes() == data
    assert list(base.iterdir()) == [folder]


def test_an_upload_never_replaces_another_file(tmp_path: Path) -> None:
    first = keep_upload(tmp_path, "head.landmarks.json", b"one", endings=(".json",))
    again = keep_upload(tmp_path, "head.landmarks.json", b"one", endings=(".json",))
    other = keep_upload(tmp_path, "head.landmarks.json", b"two", endings=(".json",))
    assert again == first
    assert other.name == "head-2.landmarks.json"
    assert first.read_bytes() == b"one"


def test_what_is_refused_leaves_no_file_and_takes_none_away(tmp_path: Path) -> None:
    def refuse(name: str, data: bytes) -> None:
        with (
            pytest.raises(FormatError, match="no take"),
            trying_upload(tmp_path, name, data, endings=(".fap",)) as path,
        ):
            assert path.read_bytes() == data
            raise FormatError(f"{path}: no take")

    refuse("a.fap", b"one")
    assert list(tmp_path.iterdir()) == []
    with trying_upload(tmp_path, "a.fap", b"one", endings=(".fap",)) as path:
        pass
    refuse("a.fap", b"one")
    refuse("a.fap", b"two")
    assert list(tmp_path.iterdir()) == [path]
    assert path.read_bytes() == b"one"


def test_the_studio_listens_on_the_loopback_only() -> None:
    assert require_allowed("127.0.0.1", allow_remote=False) == "127.0.0.1"
    with pytest.raises(ParameterError, match="no password"):
        require_allowed("0.0.0.0", allow_remote=False)
