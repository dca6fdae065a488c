"""Takes in the browser: brought by chooser and by dropping, played alone, recorded."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from risorius.controls.stream import Stream, StreamFrame
from risorius.io.motion import write_stream
from risorius.playback.pictures import has_ffmpeg
from risorius.rig.rig import Rig
from tests.studio.server import pages, studio
from tests.studio.visitor import Visitor

# What a page shows alone, and a frame of the studio, each to half a step [mm].
NEAR = 1.0 / 128.0 + 1.0 / 512.0
# Largest difference of a colour between the two, and the mean one; of 255.
PICTURE = """async () => {
  const { views, canvas } = risoriusViewport, gl = views.renderer.getContext();
  const shot = () => {
    views.draw();
    const all = new Uint8Array(4 * canvas.width * canvas.height);
    gl.readPixels(0, 0, canvas.width, canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, all);
    return all;
  };
  const now = shot(), before = window.picture_before;
  window.picture_before = now;
  if (!before) return [0, 0];
  let sum = 0, most = 0;
  for (let k = 0; k < now.length; k++) {
    const apart = Math.abs(now[k] - before[k]);
    sum += apart;
    most = Math.max(most, apart);
  }
  return [most, sum / now.length];
}"""


def _stream(rate: float, *frames: Mapping[str, float]) -> Stream:
    names = tuple(dict.fromkeys(name for frame in frames for name in frame))

    def rows() -> Iterator[StreamFrame]:
        for number, values in enumerate(frames):
            yield StreamFrame(number / rate, values)

    return Stream("made", rate, names, rows)


def _state(visitor: Visitor, what: str) -> Any:
    return visitor.page.evaluate(f"risoriusViewport.{what}")


def _alone(visitor: Visitor) -> None:
    visitor.until(lambda: _state(visitor, "player.alone()"), "the page has all it needs")
    visitor.until(lambda: _state(visitor, "meshes.morph.active"), "and shows it")


def test_takes_are_brought_played_alone_and_recorded(tmp_path: Path) -> None:
    project = tmp_path / "work.json"
    outside = tmp_path / "outside"
    outside.mkdir()
    smile = {"mouthSmileLeft": 1.0, "jawOpen": 0.6, "head_yaw": 20.0}
    write_stream(_stream(10.0, {}, smile, {"joy": 1.0}), outside / "smile.csv")
    write_stream(_stream(10.0, {"fap_3": 0.0}, {"fap_3": 250.0, "fap_48": 9e3}), outside / "a.fap")
    (outside / "bad.fap").write_text("2.1 x 25 1\n0 1\n1 2\n")
    with pages((1280, 800)) as new_page, studio(project) as (port, _):
        visitor = Visitor(new_page(), port)
        page = visitor.page
        rest = visitor.positions("skin")

        visitor.drop(outside / "smile.csv")
        title = visitor.mark("take-title")
        visitor.until(lambda: title.count() and "smile.csv" in title.inner_text(), "it is open")
        visitor.slide("timeline", 0.5)
        visitor.until(
            lambda: np.abs(visitor.positions("skin") - rest).max() > 2.0,
            "the face itself shows it before it is baked",
        )
        _alone(visitor)
        visitor.slide("timeline", 0.3)
        visitor.settle()
        visitor.page.evaluate(PICTURE)
        shown = {name: visitor.positions(name) for name in ("skin", "teeth_lower", "mandible")}
        visitor.picture("8_alone")
        page.evaluate("risoriusViewport.set({painted: true})")
        visitor.until(lambda: not _state(visitor, "meshes.morph.active"), "frames of the studio")
        visitor.settle()
        for name, alone in shown.items():
            if name != "mandible":  # hidden, so that the studio does not send it
                assert np.abs(visitor.positions(name) - alone).max() < NEAR, name
        most, mean = visitor.page.evaluate(PICTURE)
        assert mean < 0.05, "shaded by the same normals"
        assert most < 64
        assert np.abs(shown["mandible"] - visitor.positions("mandible")).max() > 3.0
        page.evaluate("risoriusViewport.set({painted: false})")
        _alone(visitor)

        page.evaluate("risoriusViewport.stream.socket.close()")
        visitor.until(lambda: _state(visitor, "stats.sceneCount") == 2, "the stream comes back")
        _alone(visitor)

        served, drawn = _state(visitor, "stats.serial"), _state(visitor, "stats.alone")
        page.keyboard.press("Space")
        visitor.until(lambda: _state(visitor, "stats.alone") > drawn + 5, "it plays")
        assert _state(visitor, "stats.serial") == served, "without a frame of the studio"
        page.keyboard.press("Space")
        visitor.until(lambda: not _state(visitor, "player.playing"), "it pauses")

        with page.expect_file_chooser() as chooser:
            page.locator('[data-mark="take-upload"] .q-uploader__header .q-btn').last.click()
        chooser.value.set_files(outside / "a.fap")
        visitor.until(lambda: "a.fap" in title.inner_text(), "parameters of MPEG-4")
        visitor.slide("timeline", 1.0)
        _alone(visitor)
        moved = visitor.positions("skin")
        assert np.abs(moved - rest).max() > 1.0
        assert _state(visitor, "meshes.root.matrix.elements[6]") != 0.0, "the head nods"
        visitor.drop(outside / "bad.fap", '[data-mark="take-upload"]')
        visitor.until(lambda: "line 2" in page.locator("body").inner_text(), "it is refused")
        assert not (tmp_path / "bad.fap").exists()
        (outside / "picture.gif").write_text("GIF89a")
        visitor.drop(outside / "picture.gif")
        visitor.until(
            lambda: "picture.gif: the studio takes" in page.locator("body").inner_text(), "so is it"
        )

        with page.expect_download(timeout=60_000) as download:
            visitor.click("record-glb")
        assert download.value.suggested_filename == "work take.glb"
        if has_ffmpeg():
            visitor.click("record-mp4")
            visitor.until((tmp_path / "work take.mp4").exists, "the film is there")
        visitor.panel("Face")
        visitor.until(lambda: np.abs(visitor.positions("skin") - rest).max() < 0.01, "rest again")
        assert visitor.complaints == []
    assert "jawOpen" in Rig.load(tmp_path / "work take.glb").names
