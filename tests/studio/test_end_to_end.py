"""A person makes a smile of their own, from opening to a valid GLB; nothing is ever lost."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import numpy as np
import pytest

from risorius.anatomy.template import builtin_head
from risorius.io.motion import write_stream
from risorius.playback.emotion_timing import emotion_stream
from risorius.project import read_project
from risorius.rig.rig import Rig
from tests.studio.server import pages, studio
from tests.studio.visitor import Visitor
from tests.tools import require_node_package, require_tool

# A zygomaticus on the left of the built-in skull: cheekbone, cheek, beside the mouth corner.
LINE = np.array([[50.0, -25.0, 68.0], [41.0, -46.0, 77.0], [29.0, -64.0, 85.0]])
# What a page may say that makes no sense; the server's log is looked at when it ends.
JUNK = [
    None, 3, "x", [], {}, {"mesh": "../../etc/passwd"}, {"mesh": "skin", "face": -1},
    {"mesh": "skin", "face": 1e300, "bary": ["a", None, {}]}, {"id": {"a": 1}}, {"id": "99999"},
    {"index": "nine"}, {"index": -5},
]  # fmt: skip
SIZES = [(1280, 800), (1920, 1080)]


def _take(path: Path) -> None:
    write_stream(emotion_stream({"joy": 1.0}, rate=10.0), path)


def _validated(path: Path) -> dict[str, int]:
    require_node_package("gltf-validator")
    script = (
        "const v=require('gltf-validator'),fs=require('fs');"
        "v.validateBytes(new Uint8Array(fs.readFileSync(process.argv[1])))"
        ".then(r=>console.log(JSON.stringify(r.issues)))"
    )
    folder = require_node_package("gltf-validator").parent.parent
    done = subprocess.run(
        [require_tool("node"), "-e", script, str(path)],
        cwd=folder, capture_output=True, text=True, check=True, timeout=120,
    )  # fmt: skip
    return json.loads(done.stdout)


@pytest.fixture(params=SIZES, ids=lambda size: f"{size[0]}x{size[1]}")
def size(request: pytest.FixtureRequest) -> tuple[int, int]:
    return request.param


def test_a_muscle_is_drawn_mirrored_and_moves_the_mouth_corner(
    tmp_path: Path, size: tuple[int, int]
) -> None:
    project = tmp_path / "work.json"
    head = builtin_head()
    places = head.frame.to_canonical(LINE)
    with pages(size) as new_page:
        with studio(project) as (port, process):
            visitor = Visitor(new_page(), port)
            visitor.picture("1_open")
            assert not project.exists(), "nothing was done, nothing is written"
            visitor.panel("Muscles")
            visitor.mark("new-name").locator("visible=true").first.fill("smiler")
            visitor.click("draw-a-sheet")
            for place in places:
                visitor.click_at(place)
                visitor.page.wait_for_timeout(150)
            visitor.until(lambda: visitor.has("smiler_l"), "the muscle appears as it is drawn")
            visitor.picture("2_drawing")
            visitor.page.keyboard.press("Enter")
            visitor.page.wait_for_timeout(150)
            visitor.page.keyboard.press("Enter")
            visitor.until(project.exists, "the muscle is kept at once")
            visitor.until(lambda: visitor.has("smiler_r"), "its mirror image is there")
            visitor.settle()
            corner = head.skin_vertex("8.3")
            rest = visitor.positions("skin")[corner]
            visitor.slide("contract", 0.98)
            visitor.until(
                lambda: visitor.positions("skin")[corner][1] > rest[1] + 2.0,
                "the mouth corner goes up on screen",
            )
            assert visitor.spot(visitor.positions("skin")[corner])[1] < visitor.spot(rest)[1] - 3.0
            visitor.picture("3_smile_inside")
            visitor.panel("Face")
            visitor.settle()
            visitor.picture("4_smile")
            kept = project.read_bytes()
            assert visitor.complaints == []
            assert visitor.foreign == []
            process.kill()
            process.wait()
        assert project.read_bytes() == kept
        if size != SIZES[0]:
            return
        with studio(project) as (port, _):
            visitor = Visitor(new_page(), port)
            visitor.until(lambda: visitor.has("smiler_l"), "the muscle is there again")
            moved = visitor.positions("skin")[corner]
            assert moved[1] > rest[1] + 2.0, "the pose was kept, too"
            assert project.read_bytes() == kept, "opening changes nothing"
            other = Visitor(new_page(), port)
            visitor.click("emotion-joy")
            other.until(
                lambda: (
                    np.allclose(other.positions("skin"), visitor.positions("skin"))
                    and not np.allclose(other.positions("skin")[corner], moved)
                ),
                "two tabs show the same work",
            )
            other.page.keyboard.press("Control+z")
            visitor.until(
                lambda: np.allclose(visitor.positions("skin")[corner], moved, atol=0.01),
                "what one tab undoes is undone in the other",
            )
            assert project.read_bytes() == kept
    again = read_project(project)
    names = [muscle["name"] for muscle in again.inline["muscle_map"]["muscles"]]
    assert "smiler" in names


def test_three_generations_twenty_steps_a_take_and_a_valid_file(tmp_path: Path) -> None:
    project = tmp_path / "work.json"
    _take(tmp_path / "joy.csv")
    with pages(SIZES[0]) as new_page, studio(project) as (port, _):
        visitor = Visitor(new_page(), port)
        page = visitor.page
        box = page.locator(".rv-canvas").bounding_box()

        visitor.panel("Tune")
        visitor.click("tune-begin")
        for generation in range(3):
            visitor.until(
                lambda g=generation: (
                    f"generation {g + 1};" in visitor.mark("generation").inner_text()
                ),
                "nine faces",
            )
            visitor.settle()
            for pick in (generation, 8):
                page.mouse.click(
                    box["x"] + box["width"] * (pick % 3 + 0.5) / 3,
                    box["y"] + box["height"] * (pick // 3 + 0.5) / 3,
                )
                page.wait_for_timeout(150)
            wanted = f"chosen: {generation + 1}, 9"
            visitor.until(lambda w=wanted: w in visitor.mark("generation").inner_text(), wanted)
            visitor.picture(f"5_tune_{generation + 1}")
            if generation < 2:
                visitor.click("tune-next-faces")
        visitor.click("tune-accept")
        visitor.until(project.exists, "the accepted pose is kept")
        assert "my joy" in read_project(project).poses

        visitor.panel("Face")
        for step in range(19):
            page.keyboard.press("Escape")
            visitor.click("emotion-anger" if step % 2 else "emotion-sadness")
            page.wait_for_timeout(60)
        visitor.settle()
        for _ in range(20):
            page.keyboard.press("Control+z")
            page.wait_for_timeout(60)
        visitor.until(lambda: not read_project(project).poses, "twenty steps back is the start")

        visitor.panel("Play")
        visitor.mark("take-file").click()
        page.get_by_role("option", name="joy.csv").click()
        visitor.until(
            lambda: "joy.csv" in visitor.mark("take-title").inner_text(), "the take is open"
        )
        visitor.settle()
        start = visitor.positions("skin")
        visitor.slide("timeline", 0.45)
        visitor.until(
            lambda: np.abs(visitor.positions("skin") - start).max() > 2.0,
            "scrubbing moves the face",
        )
        visitor.picture("6_play")

        visitor.panel("Muscles")
        for name in ("select", "place", "finish", "dragging", "dropped", "handle", "choose"):
            for junk in JUNK:
                page.evaluate("([n, j]) => risoriusViewport.emit(n, j)", [name, junk])
        visitor.panel("Export")
        with page.expect_download(timeout=60_000) as download:
            visitor.click("export")
        assert download.value.suggested_filename == "work.glb"
        visitor.picture("7_export")
        assert visitor.complaints == []
        assert visitor.foreign == []
    rig = Rig.load(tmp_path / "work.glb")
    assert {"joy", "jawOpen", "zygomaticus_major_l"} <= set(rig.names)
    issues = _validated(tmp_path / "work.glb")
    assert issues["numErrors"] == 0
