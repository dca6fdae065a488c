"""Latency and memory of the studio in headless Chromium with software rendering.

``python -m benchmarks.studio.latency [HEAD.obj] [--seconds 600]`` prints one table. Numbers of a
machine without a graphics card are upper bounds.
"""

from __future__ import annotations

import argparse
import os
import statistics
import tempfile
import time
from dataclasses import replace
from pathlib import Path

import numpy as np

from risorius.anatomy.template import builtin_head
from risorius.project import Project, write_project
from risorius.studio.scene import stage_of
from risorius.studio.showing import Show, frame_of
from risorius.studio.subject import build_subject
from risorius.studio.work import work_of
from tests.studio.server import pages, studio
from tests.studio.visitor import Visitor

POSE = {"zygomaticus_major_l": 0.8, "jaw_pitch": 6.0}
LINE = np.array([[50.0, -25.0, 68.0], [41.0, -46.0, 77.0], [29.0, -64.0, 85.0]])


def server_cost(project: Project, name: str) -> None:
    """Processor time of one frame in the server, with and without muscles."""
    stage = stage_of(build_subject(work_of(project)))
    count = sum(each.mesh.vertex_count for each in stage.meshes)
    for groups in ({"skin", "parts", "skull"}, {"skin", "parts", "skull", "muscles"}):
        message = frame_of(stage, POSE, Show(), groups, (1, 1))
        assert len(message) > 1000
        start = time.process_time()
        for _ in range(10):
            frame_of(stage, POSE, Show(), groups, (1, 1))
        cost = 100.0 * (time.process_time() - start)
        what = "with" if "muscles" in groups else "without"
        print(f"{name}: {count} vertices, {what} muscles: {cost:.1f} ms, {len(message)} bytes")


def _resident(process_id: int) -> float:
    words = Path(f"/proc/{process_id}/statm").read_text().split()
    return int(words[1]) * 4096 / 1e6


def _key_to_frame(visitor: Visitor) -> float:
    before = visitor.page.evaluate("risoriusViewport.stats.serial")
    start = time.perf_counter()
    visitor.page.keyboard.press("ArrowRight")
    visitor.page.wait_for_function(f"risoriusViewport.stats.serial > {before}", polling=5)
    return 1e3 * (time.perf_counter() - start)


def in_browser(project: Project, seconds: float) -> None:
    """Measure one page."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "work.json"
        write_project(project, path)
        with pages((1280, 800)) as new_page, studio(path) as (port, process):
            start = time.perf_counter()
            visitor = Visitor(new_page(), port)
            print(f"page to first frame: {time.perf_counter() - start:.2f} s")
            slider = visitor.mark("control-zygomaticus_major")
            slider.scroll_into_view_if_needed()
            slider.evaluate(
                "e => (e.matches('[tabindex]') ? e : e.querySelector('[tabindex]')).focus()"
            )
            times = [_key_to_frame(visitor) for _ in range(25)][5:]
            print(
                f"slider to drawn frame: median {statistics.median(times):.0f} ms, "
                f"worst {max(times):.0f} ms"
            )
            visitor.panel("Muscles")
            visitor.click("draw-a-sheet")
            visitor.page.wait_for_timeout(800)
            clicks: list[float] = []
            for number, place in enumerate(builtin_head().frame.to_canonical(LINE)):
                start = time.perf_counter()
                visitor.click_at(place)
                visitor.page.wait_for_function(
                    f"risoriusViewport.overlay.handles.length == {number + 1}", polling=5
                )
                clicks.append(1e3 * (time.perf_counter() - start))
            print(f"click to drawn point: median {statistics.median(clicks):.0f} ms")
            visitor.page.keyboard.press("Escape")
            visitor.panel("Play")
            visitor.click("play-joy")
            visitor.page.wait_for_function("risoriusViewport.player.alone()", timeout=120_000)
            print(f"drawing on the processor: {_cost_of_drawing(visitor)}")
            visitor.click("play")
            print("played by the page alone:")
            _memory(visitor, process.pid, 0.5 * seconds)
            visitor.page.evaluate("risoriusViewport.set({painted: true})")
            print("played from frames of the server:")
            _memory(visitor, process.pid, 0.5 * seconds)


def _cost_of_drawing(visitor: Visitor) -> str:
    """Time of the two passes that move all vertices, and of the picture [ms]."""
    moved, drawn = visitor.page.evaluate(
        """() => {
          const { views, meshes, player } = risoriusViewport, gl = views.renderer.getContext();
          const pixel = new Uint8Array(4), count = 10;
          const timed = (work) => {
            const start = performance.now();
            for (let k = 0; k < count; k++) {
              work();
              gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
            }
            return (performance.now() - start) / count;
          };
          return [timed(() => player.draw()), timed(() => views.draw())];
        }"""
    )
    return f"targets {moved:.0f} ms, picture {drawn:.0f} ms"


def _memory(visitor: Visitor, process_id: int, seconds: float) -> None:
    script = (
        "() => [risoriusViewport.stats.drawn, risoriusViewport.stats.bytes,"
        " performance.memory ? performance.memory.usedJSHeapSize / 1e6 : 0]"
    )
    start, steps, busy = time.monotonic(), 5, _processor_time(process_id)
    for step in range(steps + 1):
        if step:
            visitor.page.wait_for_timeout(1e3 * seconds / steps)
        drawn, sent, heap = visitor.page.evaluate(script)
        print(
            f"  {time.monotonic() - start:5.0f} s: {drawn} frames drawn, {sent / 1e6:.0f} MB "
            f"received, server {_resident(process_id):.0f} MB, page {heap:.0f} MB"
        )
    print(f"  processor time of the server: {_processor_time(process_id) - busy:.1f} s")


def _processor_time(process_id: int) -> float:
    fields = Path(f"/proc/{process_id}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("head", nargs="?", type=Path)
    parser.add_argument("--seconds", type=float, default=600.0)
    given = parser.parse_args()
    project = Project()
    server_cost(project, "built-in")
    if given.head is not None:
        server_cost(replace(project, head=given.head), given.head.name)
    in_browser(project, given.seconds)


if __name__ == "__main__":
    main()
