"""The panel of tuning: nine faces from the same camera; click those that you like."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from nicegui import ui

from risorius.controls.presets import EMOTIONS
from risorius.errors import ParameterError
from risorius.io.json_fields import Fields
from risorius.studio import frames
from risorius.studio.panel import Panel, group, heading
from risorius.studio.stated import Message
from risorius.studio.tuner import Tuner

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
        heading("Tune by choosing", "Nine faces; click up to three you like, the best first.")
        with group("What"):
            self._expression = ui.select(list(EMOTIONS), value="joy").props("dense")
            self._expression.style("width:100%").props("data-mark=tune-expression")
            self._what = ui.toggle(
                {"pose": "strength of muscles", "muscles": "muscles themselves"}, value="pose"
            ).props("dense no-caps flat size=sm")
            with ui.row().style("gap:6px"):
                self._button("Begin", "play_arrow", self._begin)
                self._button("Stop", "close", self._end)
        with group("Generation") as self._group:
            self._state = ui.label().props("data-mark=generation")
            with ui.row().style("gap:6px"):
                self._button("Next faces", "navigate_next", self._next)
                self._button("Back", "navigate_before", self._back)
                self._button("Accept", "check", self._accept)
            ui.label("With none chosen, other faces are shown. Keys 1 to 9 choose.").classes(
                "st-help"
            )
        with group("Locked parameters") as self._locks:
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
        expression = str(self._expression.value)
        self.page.busy.set_text("making nine faces …")
        self.page.busy.set_visibility(True)
        try:
            self.tuner = await self.shop.work(
                lambda: Tuner.begin(self.subject, expression, what=str(self._what.value))
            )
        finally:
            self.page.busy.set_visibility(False)
        await self._show()

    async def _show(self) -> None:
        tuner, stage = self.tuner, self.shop.stage
        if tuner is None or stage is None:
            return
        shown = await self.shop.work(tuner.faces, stage)
        rest = {each.name: each.mesh.positions for each in stage.meshes}
        self.picks = []
        self.shop.hub.put(
            frames.candidates(
                rest, shown, epoch=self.shop.epoch, labels=[str(k + 1) for k in range(9)]
            )
        )
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
            "<b>Accept</b> takes the best."
        )

    def _fill_locks(self) -> None:
        tuner = self.tuner
        self._list.clear()
        if tuner is None:
            return
        locked = tuner.session.locked
        with self._list:
            for name in tuner.session.genome.names:
                box = ui.checkbox(name.replace("_", " "), value=name in locked)
                box.props("dense size=xs").on_value_change(
                    self.page.safely(lambda e, n=name: self._lock(n, bool(e.value)))
                )

    def _lock(self, name: str, locked: bool) -> None:
        session = self._require().session
        (session.lock if locked else session.unlock)([name])

    def _require(self) -> Tuner:
        if self.tuner is None:
            raise ParameterError("tuning: press Begin first")
        return self.tuner

    async def _next(self) -> None:
        tuner = self._require()
        await self.shop.work(tuner.next, tuple(self.picks))
        await self._show()

    async def _back(self) -> None:
        self._require().session.undo()
        await self._show()

    def _accept(self) -> None:
        tuner, work = self._require(), self.shop.document.work
        values = tuner.session.accept(self.picks[0] if self.picks else None)
        pose = {name: float(value) for name, value in tuner.pose(values).items()}
        vectors = tuner.vectors(values)
        self._end()
        if vectors is not None:
            changed = replace(work, vectors=vectors, pose=pose)
        else:
            name = tuner.expression if tuner.expression in work.poses else f"my {tuner.expression}"
            project = replace(work.project, poses={**work.project.poses, name: pose})
            changed = replace(work, project=project, pose=pose)
        self.shop.change(f"Tune {tuner.expression}", changed)
        self.page.tell(f"{tuner.expression} is kept")

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
