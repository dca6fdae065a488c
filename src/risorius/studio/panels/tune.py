"""The panel of tuning: nine faces from the same camera; click those that you like."""

from __future__ import annotations

import asyncio
from typing import Any

from nicegui import ui

from risorius.controls.presets import EMOTIONS
from risorius.errors import ParameterError
from risorius.io.json_fields import Fields
from risorius.studio import frames
from risorius.studio.jobs import Job
from risorius.studio.panel import Panel, group, heading
from risorius.studio.panels.progress import Progress
from risorius.studio.stated import Message
from risorius.studio.tuner import Tuner, muscle_of

__all__ = ["TunePanel"]

_MOST = 3


class TunePanel(Panel):
    """Choose among nine, again and again."""

    name = "Tune"
    icon = "grid_view"
    hint = "Choose an expression and <b>Begin</b>: nine faces appear."

    def build(self) -> None:
        """Make the elements."""
        self.tuner: Tuner | None = None
        self.picks: list[int] = []
        self._settled: dict[str, str] = {}
        heading("Tune by choosing", "Nine faces; click up to three you like, the best first.")
        with group("What"):
            self._expression = ui.select(list(EMOTIONS), value="joy").props("dense")
            self._expression.style("width:100%").props("data-mark=tune-expression")
            self._what = ui.toggle(
                {"pose": "strength of muscles", "muscles": "muscles themselves"}, value="pose"
            ).props("dense no-caps flat size=sm data-mark=tune-what")
            with ui.row().style("gap:6px"):
                self._button("Begin", "play_arrow", self._begin)
                self._button("Stop", "close", self._end)
        self.progress = Progress(self.page)
        with group("Generation") as self._group:
            self._state = ui.label().props("data-mark=generation")
            with ui.row().style("gap:6px"):
                self._button("Next faces", "navigate_next", self._next)
                self._button("Others", "casino", self._others)
                self._button("Back", "navigate_before", self._back)
                self._button("Accept", "check", self._accept)
            ui.label(
                "Others: nine more from the same choice. Back: the nine before. Keys 1 to 9 choose."
            ).classes("st-help")
        with group("Locked: stays as it is") as self._locks:
            self._list = ui.column().style("gap:0;width:100%")
        self._group.set_visibility(False)
        self._locks.set_visibility(False)

    def _button(self, text: str, icon: str, act: Any) -> None:
        button = ui.button(text, icon=icon, on_click=self.page.safely(act))
        button.props("flat dense no-caps").classes("st-chip")
        button.props(f"data-mark=tune-{_slug(text)}")

    def refresh(self, what: str) -> None:
        """Follow a change."""
        if what == "document":
            names = [*EMOTIONS, *self.shop.document.work.poses]
            self._expression.set_options(names)

    def leave(self) -> None:
        """Show one face again."""
        self._end()

    # -- actions ----------------------------------------------------------------------------

    async def _begin(self) -> None:
        expression, what, subject = str(self._expression.value), str(self._what.value), self.subject
        locked = [name for name, by in self._settled.items() if by != expression]

        def work(job: Job) -> Tuner:
            return Tuner.begin(subject, expression, job, what=what, locked=locked)

        self._end()
        tuner = await self.progress.run("nine faces", work)
        if tuner is not None and self.page.active is self:
            self.tuner = tuner
            await self._show()

    async def _show(self) -> None:
        tuner, stage = self.tuner, self.shop.stage
        if tuner is None or stage is None:
            return
        self.page.busy.set_text("making nine faces …")
        self.page.busy.set_visibility(True)
        try:
            shown = await asyncio.to_thread(tuner.faces, stage)
        finally:
            self.page.busy.set_visibility(False)
        if self.tuner is not tuner:
            return
        rest = {each.name: each.mesh.positions for each in stage.meshes}
        self.picks = []
        message = frames.candidates(
            rest, shown, epoch=self.shop.epoch, labels=[str(k + 1) for k in range(9)]
        )
        stream = self.shop.hub.of(self.page.client.id)
        if stream is not None:
            stream.put(message)
        self.page.view.set(layout="nine")
        self.page.view.choose([])
        self._group.set_visibility(True)
        self._locks.set_visibility(True)
        self._fill_locks()
        self._tell()

    def _tell(self) -> None:
        tuner = self.tuner
        if tuner is None:
            return
        number = tuner.session.generation.number + 1
        chosen = ", ".join(str(pick + 1) for pick in self.picks) or "none"
        self._state.set_text(f"{tuner.expression}, generation {number}; chosen: {chosen}")
        self.page.say(
            "Click up to three faces, the best first, then <b>Next faces</b>. "
            "<b>Accept</b> takes the best; <b>drag</b> turns all nine."
        )

    def _fill_locks(self) -> None:
        tuner = self.tuner
        self._list.clear()
        if tuner is None:
            return
        locked, stems = set(tuner.session.locked), dict[str, list[str]]()
        for name in tuner.session.genome.names:
            stems.setdefault(name.split(".")[0], []).append(name)
        with self._list:
            for stem, names in stems.items():
                if len(names) == 1:
                    self._box(names[0].replace("_", " "), names, locked)
                    continue
                by = self._settled.get(muscle_of(stem), tuner.expression)
                words = stem.replace("_", " ")
                self._box(words if by == tuner.expression else f"{words} ({by})", names, locked)
            if len(stems) < len(tuner.session.genome):
                self._fill_numbers(stems, locked)

    def _fill_numbers(self, stems: dict[str, list[str]], locked: set[str]) -> None:
        with ui.expansion("number by number").props("dense").classes("st-help"):
            for stem, names in stems.items():
                ui.label(stem.replace("_", " ")).classes("st-head")
                for name in names:
                    self._box(name.split(".")[-1].replace("_", " "), [name], locked)

    def _box(self, words: str, names: list[str], locked: set[str]) -> None:
        box = ui.checkbox(words, value=locked.issuperset(names))
        box.props("dense size=xs").on_value_change(
            self.page.safely(lambda e: self._lock(names, bool(e.value)))
        )

    def _lock(self, names: list[str], locked: bool) -> None:
        session = self._require().session
        (session.lock if locked else session.unlock)(names)
        if len(names) > 1:
            self._fill_locks()

    def _require(self) -> Tuner:
        if self.tuner is None:
            raise ParameterError("tuning: press Begin first")
        return self.tuner

    async def _next(self) -> None:
        tuner = self._require()
        await asyncio.to_thread(tuner.next, tuple(self.picks))
        await self._show()

    async def _others(self) -> None:
        tuner = self._require()
        await asyncio.to_thread(tuner.next, ())
        await self._show()

    async def _back(self) -> None:
        self._require().session.undo()
        await self._show()

    def _accept(self) -> None:
        tuner = self._require()
        changed = tuner.accepted(self.shop.document.work, self.picks[0] if self.picks else None)
        if tuner.what == "muscles":
            free = set(tuner.session.genome.names).difference(tuner.session.locked)
            self._settled |= {muscle_of(name): tuner.expression for name in free}
        self._end()
        self.shop.change(f"Tune {tuner.expression}", changed)
        what = "its muscles are" if tuner.what == "muscles" else "it is"
        self.page.tell(f"{tuner.expression}: {what} kept")

    def _end(self) -> None:
        self.tuner = None
        self.picks = []
        self._group.set_visibility(False)
        self._locks.set_visibility(False)
        self.page.view.set(layout=self.page.bar.layout)
        self.page.view.choose([])
        self.page.say(self.hint)

    # -- choosing ---------------------------------------------------------------------------

    def _toggle(self, index: int) -> None:
        if self.tuner is None or not 0 <= index < 9:
            return
        if index in self.picks:
            self.picks.remove(index)
        elif len(self.picks) < _MOST:
            self.picks.append(index)
        self.page.view.choose(self.picks)
        self._tell()

    def take(self, event: str, message: Message) -> None:
        """Take a click on a face."""
        if event == "choose":
            self._toggle(Fields(message, "page").integer("index"))

    def key(self, key: str) -> bool:
        """Take a key."""
        if self.tuner is None:
            return False
        if key.isdigit() and key != "0" and len(key) == 1:
            self._toggle(int(key) - 1)
            return True
        return False


def _slug(text: str) -> str:
    return text.lower().replace(" ", "-")
