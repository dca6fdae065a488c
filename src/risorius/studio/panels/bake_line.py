"""A line that tells how far the face is baked, with a way to stop it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nicegui import ui

from risorius.studio.stage_rig import LARGEST

if TYPE_CHECKING:
    from risorius.studio.page import Page

__all__ = ["BakeLine"]


class BakeLine:
    """What the bakery does.

    Parameters
    ----------
    page : Page
    """

    def __init__(self, page: Page) -> None:
        self.page = page
        with ui.column().style("width:100%;gap:2px").props("data-mark=bake-line") as self._frame:
            self._bar = ui.linear_progress(0.0, show_value=False).props("rounded size=4px")
            with ui.row().style("width:100%;align-items:center"):
                self._words = ui.label().classes("st-help").style("flex:1")
                self._stop = ui.button("Stop", on_click=page.bakery.cancel)
                self._stop.props("flat dense no-caps size=sm")
        self.follow()

    def follow(self) -> None:
        """Show how things are."""
        bakery = self.page.bakery
        job, ready = bakery.job, bakery.ready
        sentence = bakery.problem
        if job is not None:
            sentence = f"baking for smooth play: {job.stage}"
            self._bar.set_value(job.share)
        elif ready is not None and ready.entry_count > LARGEST:
            sentence = "This head is too big for the browser to play alone; frames come one by one."
        self._words.set_text(sentence)
        self._bar.set_visibility(job is not None)
        self._stop.set_visibility(job is not None)
        self._frame.set_visibility(bool(sentence))
