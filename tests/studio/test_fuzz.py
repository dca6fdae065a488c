"""Nonsense of a page, of files and of their names: refused, and nothing else happens."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest

from risorius.io.motion import write_stream
from risorius.playback.emotion_timing import emotion_stream
from risorius.project import Project, read_project, write_project
from risorius.studio.guard import plain_name
from tests.studio.server import pages, studio
from tests.studio.visitor import Visitor

JUNK = [
    None, -1e300, "../../etc/passwd", [], {"value": "nine"}, {"x": "a", "y": None},
    {"mesh": "skin", "face": 1e300, "bary": ["a"]}, {"time": "x", "id": 3, "index": -5},
]  # fmt: skip
PANELS = ("Face", "Muscles", "Landmarks", "Tune", "Play", "Export", "Project")
# Says every nonsense to every listener of the page that was not spoken to before.
SPEAK = """async (junk) => {
  window.spoken ??= new Set();
  let count = 0;
  for (const [id, element] of Object.entries(mounted_app.elements)) {
    for (const { listener_id } of element.events ?? []) {
      if (window.spoken.has(listener_id)) continue;
      window.spoken.add(listener_id);
      for (const args of junk) {
        window.socket.emit("event", {
          id: Number(id), client_id: window.clientId, listener_id, args: [JSON.stringify(args)],
        });
        if (++count % 100 == 0) await new Promise((done) => setTimeout(done, 20));
      }
    }
  }
  return count;
}"""
UPLOAD = """async ([ending, name, bytes]) => {
  const form = new FormData();
  form.append("file", new File([new Uint8Array(bytes)], name));
  const address = risoriusViewport.settings.drops[ending];
  return (await fetch(address, { method: "POST", body: form })).status;
}"""
NAMES = (
    "../../outside{0}", "..{0}", "/tmp/x{0}", "a\\b{0}", "con{0}", ".hidden{0}", "x" * 90 + "{0}",
    "é{0}", "work.json", "good.exe",
)  # fmt: skip


def _project(folder: Path) -> Path:
    path = folder / "work.json"
    write_project(Project(method="vector"), path)
    return path


def _own_failures(log: Path) -> list[str]:
    """Return failures whose last own frame is of risorius, not of the page's library."""
    found: list[str] = []
    for trace in log.read_text().split("Traceback (most recent call last):")[1:]:
        frames = re.findall(r'File "([^"]+)", line \d+', trace.split("\n\n")[0])
        if frames and "/risorius/" in frames[-1]:
            found.append(trace[:1500])
    return found


@pytest.mark.slow
def test_every_listener_of_the_page_refuses_nonsense(tmp_path: Path) -> None:
    path = _project(tmp_path)
    with pages((1280, 800)) as new_page, studio(path, quiet=False) as (port, process):
        visitor = Visitor(new_page(), port)
        rest = visitor.positions("skin")
        said = 0
        for panel in PANELS:
            visitor.page.keyboard.press("Escape")
            visitor.page.get_by_role("tab", name=panel).click(force=True)
            visitor.page.wait_for_timeout(400)
            said += visitor.page.evaluate(SPEAK, JUNK)
        assert said > 2000
        assert process.poll() is None
        assert visitor.complaints == []
        again = Visitor(new_page(), port)
        again.click("rest")
        again.until(
            lambda: np.abs(again.positions("skin") - rest).max() < 0.1, "the studio still works"
        )
    assert _own_failures(path.with_suffix(".log")) == []
    kept = read_project(path)
    assert kept.profile in ("improved", "faithful")
    for name, value in kept.poses.get("current", {}).items():
        assert np.isfinite(value), name


def test_files_of_any_name_and_content_are_refused_or_kept_in_the_folder(tmp_path: Path) -> None:
    folder = tmp_path / "work"
    folder.mkdir()
    path = _project(folder)
    write_stream(emotion_stream({"joy": 1.0}, rate=5.0), tmp_path / "seed.csv")
    write_stream(emotion_stream({"joy": 1.0}, rate=5.0), tmp_path / "seed.json")
    square = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 4 3\n"
    ply = b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nend_header\n1\n2\n3\n"
    seeds = {
        ".csv": (tmp_path / "seed.csv").read_bytes(),
        ".json": (tmp_path / "seed.json").read_bytes(),
        ".fap": b"2.1 x 25 1\n" + b"0 0 1" + b" 0" * 65 + b"\n0 10\n",
        ".obj": square, ".ply": ply, ".stl": bytes(84), ".glb": b"glTF" + bytes(60),
    }  # fmt: skip
    chance = np.random.default_rng(11)
    before = json.dumps(read_project(path).poses)
    with pages((1280, 800)) as new_page, studio(path, quiet=False) as (port, process):
        visitor = Visitor(new_page(), port)
        for ending, seed in seeds.items():
            for number in range(6):
                data = np.frombuffer(seed, np.uint8).copy()
                places = chance.integers(0, len(data), 1 + number)
                data[places] = chance.integers(0, 256, len(places))
                cut = data[: chance.integers(1, len(data) + 1)] if number % 2 else data
                name = f"mutant{number}{ending}"
                status = visitor.page.evaluate(UPLOAD, [ending, name, cut.tolist()])
                assert status == 200
            for name in NAMES:
                named = name.format(ending)
                visitor.page.evaluate(UPLOAD, [ending, named, list(seed[:200])])
        visitor.settle()
        assert process.poll() is None
        assert visitor.complaints == []
    assert _own_failures(path.with_suffix(".log")) == []
    assert json.dumps(read_project(path).poses) == before
    assert read_project(path).head is None
    assert path.read_bytes().startswith(b"{")
    assert sorted(file.name for file in tmp_path.iterdir()) == ["seed.csv", "seed.json", "work"]
    for file in folder.iterdir():
        assert file.is_file()
        assert file.name.startswith(".work.json") or plain_name(file.name) == file.name
        assert file.suffix in (*seeds, ".log", ".lock", ".history")
