"""A person draws an outline row by row, sees it move at once, and loses nothing to a crash."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from risorius.anatomy.template import builtin_head
from risorius.project import Project, read_project, write_project
from risorius.spatial.closest import closest_points
from tests.studio.server import pages, studio
from tests.studio.visitor import Visitor

SIZE = (1280, 800)
STEPS = 20
# Across the cheek bone, the cheek, and beside the mouth corner, left on the built-in head.
ROWS = np.array(
    [
        [[50.0, -26.0, 78.0], [42.0, -22.0, 82.0]],
        [[40.0, -46.0, 82.0], [34.0, -40.0, 86.0]],
        [[33.0, -62.0, 85.0], [29.0, -56.0, 88.0]],
    ]
)


def _row(visitor: Visitor, places: np.ndarray) -> None:
    for place in places:
        visitor.click_at(place)
        visitor.page.wait_for_timeout(200)
    visitor.page.keyboard.press("Enter")
    visitor.page.wait_for_timeout(200)


def _drawn(visitor: Visitor) -> None:
    """Draw a muscle of three rows, contract it on the way, and keep it."""
    head = builtin_head()
    flat = head.frame.to_canonical(ROWS.reshape(-1, 3))
    rows = closest_points(head.skin.mesh, flat).positions.reshape(ROWS.shape)
    visitor.mark("new-name").locator("visible=true").first.fill("smiler")
    visitor.click("draw-a-grid")
    visitor.until(lambda: "first row" in visitor.page.inner_text(".st-hint"), "it says how")
    _row(visitor, rows[0])
    assert not visitor.has("smiler_l"), "one row is no muscle"
    _row(visitor, rows[1])
    visitor.until(lambda: visitor.has("smiler_r"), "from the second row on it is fitted, mirrored")
    visitor.settle()
    corner = head.skin_vertex("8.3")
    rest = visitor.positions("skin")[corner]
    visitor.slide("contract-new", 0.98)
    visitor.until(
        lambda: visitor.positions("skin")[corner][1] > rest[1] + 0.3, "and moves while it is drawn"
    )
    visitor.picture("10_grid_drawn")
    visitor.slide("contract-new", 0.0)
    visitor.until(
        lambda: np.allclose(visitor.positions("skin")[corner], rest, atol=0.02), "and goes back"
    )
    _row(visitor, rows[2])
    facts = visitor.mark("feedback-facts")
    visitor.until(lambda: "zygomaticus major" in facts.inner_text(), "its end merges with others")
    visitor.page.keyboard.press("Enter")
    visitor.until(lambda: visitor.mark("editor").is_visible(), "it is kept and chosen")
    visitor.settle()


def test_a_grid_moves_as_it_is_drawn_and_after_a_crash_all_is_undone_and_done_again(
    tmp_path: Path,
) -> None:
    project = tmp_path / "work.json"
    write_project(Project(method="springs"), project)
    with pages(SIZE) as new_page:
        with studio(project) as (port, process):
            visitor = Visitor(new_page(), port)
            visitor.panel("Muscles")
            visitor.until(lambda: visitor.has("risorius_l"), "the recipe's muscles are there")
            _drawn(visitor)
            assert "Everything fits." in visitor.mark("feedback-findings").inner_text()
            visitor.click("feedback-influenced")
            visitor.until(
                lambda: visitor.page.evaluate("risoriusViewport.meshes.byName.get('skin').painted"),
                "the skin that it moves is painted",
            )
            visitor.picture("11_grid_kept")
            visitor.panel("Face")
            for step in range(STEPS - 1):
                visitor.click("emotion-anger" if step % 2 else "emotion-joy")
                visitor.page.wait_for_timeout(60)
            visitor.settle()
            kept = project.read_bytes()
            assert visitor.complaints == [] and visitor.foreign == []
            process.kill()
            process.wait()
        assert project.read_bytes() == kept
        with studio(project) as (port, _):
            visitor = Visitor(new_page(), port)
            visitor.until(lambda: visitor.has("smiler_l"), "the muscle is there again")
            assert project.read_bytes() == kept, "opening changes nothing"
            visitor.panel("Project")
            assert not visitor.mark("history-notice").is_visible()
            visitor.picture("12_reopened")
            for _ in range(STEPS):
                visitor.page.keyboard.press("Control+z")
                visitor.page.wait_for_timeout(60)
            visitor.until(
                lambda: (
                    not read_project(project).poses and "recipe" not in read_project(project).inline
                ),
                "twenty steps back is the start",
            )
            visitor.until(lambda: not visitor.has("smiler_l"), "where there was no such muscle")
            for _ in range(STEPS):
                visitor.page.keyboard.press("Control+Shift+z")
                visitor.page.wait_for_timeout(60)
            visitor.until(lambda: project.read_bytes() == kept, "twenty steps ahead is the end")
            visitor.until(lambda: visitor.has("smiler_l"), "with the muscle")
            assert visitor.complaints == []
