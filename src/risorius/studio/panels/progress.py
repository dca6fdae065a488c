"""Long work on the page: a bar, words, and a way to stop it."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import TYPE_CHECKING, TypeVar

from nicegui import ui

from risorius.errors import Cancelled
from risorius.studio.jobs import Job

if TYPE_CHECKING:
    from risorius.studio.page import Page

__all__ = ["Progress"]

Result = TypeVar("Result")
_PACE = 0.15


class Progress:
    """A progress bar that runs one job at a time.

    Parameters
    ----------
    page : Page
    """

    def __init__(self, page: Page) -> None:
        self.page = page
        self._job: Job | None = None
        with ui.column().style("width:100%;gap:4px") as self._frame:
            self._bar = ui.linear_progress(0.0, show_value=False).props("rounded size=6px")
            with ui.row().style("width:100%;align-items:center"):
                self._words = ui.label().classes("st-help").style("flex:1")
                ui.button("Cancel", icon="close", on_click=self.cancel).props(
                    "flat dense no-caps size=sm"
                ).props("data-mark=cancel-job")
        self._frame.set_visibility(False)

    def cancel(self) -> None:
        """Stop the job."""
        if self._job is not None:
            self._job.cancel()

    async def quietly(self, work: Callable[[Job], Result]) -> Result:
        """Run short `work` in a thread beside everything else.

        Raises
        ------
        RisoriusError
            What the work raises.
        """
        return await asyncio.to_thread(work, Job(""))

    async def run(self, title: str, work: Callable[[Job], Result]) -> Result | None:
        """Run `work` in a thread; return what it gives, None if it was stopped.

        Raises
        ------
        RisoriusError
            What the work raises.
        """
        if self._job is not None:
            self.page.tell(f"{self._job.title} is still under way")
            return None
        job = self._job = Job(title)
        self._frame.set_visibility(True)
        task = asyncio.create_task(asyncio.to_thread(work, job))
        try:
            while not task.done():
                self._bar.set_value(job.share)
                self._words.set_text(f"{title}: {job.stage}")
                await asyncio.wait({task}, timeout=_PACE)
            return task.result()
        except Cancelled:
            self.page.tell(f"{title}: cancelled")
            return None
        finally:
            self._job = None
            self._frame.set_visibility(False)
