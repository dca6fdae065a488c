"""The group in which a new muscle is drawn, line by line, and moves as soon as it is one."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from nicegui import ui

from risorius.errors import ParameterError
from risorius.studio.drawing.craft import Tool
from risorius.studio.drawing.sketch import Drawn, Sketch
from risorius.studio.panel import group
from risorius.studio.panels.contraction import ContractionSlider
from risorius.studio.places import place_of
from risorius.studio.stated import Message

if TYPE_CHECKING:
    from risorius.studio.panels.muscles import MusclePanel

__all__ = ["MuscleDrawing"]


class MuscleDrawing:
    """A sketch of the method's own kind, and what the pointer and the keys add to it.

    Parameters
    ----------
    panel : MusclePanel
    """

    def __init__(self, panel: MusclePanel) -> None:
        self.panel = panel
        self.shop, self.page = panel.shop, panel.page
        self.sketch: Sketch | None = None
        self.drawn: Drawn | None = None
        self._offered: tuple[Tool, ...] = ()

    def build(self) -> None:
        """Make the elements."""
        panel = self.panel
        with group("New muscle"):
            self._name = ui.input("name", value="new_muscle").props("dense").style("width:100%")
            self._name.props("data-mark=new-name")
            self._tools = ui.row().style("gap:6px")
            self._mirror = ui.switch("mirror to the other side", value=True).props("dense")
            self._mirror.props("data-mark=mirror")
            self._skin = ui.switch("draw on the skin, too", on_change=self._aim).props("dense")
            with ui.row().style("gap:6px") as self._ends:
                panel.action("Keep it", "check", self.finish).props("data-mark=finish")
                panel.action("Stop", "close", self.cancel).props("data-mark=cancel")
            self._ends.set_visibility(False)
            self._slider = ContractionSlider(panel, "contract-new")
        self.offer()

    def offer(self) -> None:
        """Show the tools of the method."""
        tools = self.panel.craft.tools
        if tools == self._offered:
            return
        self._offered = tools
        self._tools.clear()
        with self._tools:
            for tool in tools:
                self.panel.action(tool.text, tool.icon, lambda t=tool: self.begin(t.key))
        self._skin.set_visibility(self.panel.craft.on_bone)

    def begin(self, tool: str) -> None:
        """Begin to draw."""
        self.cancel()
        name = str(self._name.value or "").strip().lower().replace(" ", "_")
        sketch = self.panel.craft.sketch(tool, name, mirror=bool(self._mirror.value))
        self.shop.present(selected="")
        self.sketch = sketch
        self._ends.set_visibility(True)
        self._aim()
        self.show()

    def _aim(self, *_: object) -> None:
        if self.sketch is not None:
            grounds = self.sketch.grounds(skin=bool(self._skin.value))
            self.page.view.set(tool="draw", drawOn=grounds)

    def show(self) -> None:
        """Show the lines and say what can be done next."""
        if self.sketch is not None:
            self.panel.show_overlay()
            self.page.say(self.sketch.hint)

    def _preview(self) -> None:
        """Let the muscle appear as it is drawn."""
        sketch, work = self.sketch, self.shop.document.work
        if sketch is None:
            return
        before = self.drawn
        try:
            self.drawn = sketch.drawn(work, self.panel.subject)
        except ParameterError:  # not yet: more points may make it one
            self.drawn = None
        if self.drawn is not None:
            self.shop.try_out(self.drawn.work)
        elif before is not None:
            self.forget_draft()

    def forget_draft(self) -> None:
        """Go back to what is kept."""
        self.shop.draft_problem = ""
        if self.shop.draft is not None:
            self.shop.try_out(self.shop.document.work)
            self.shop.draft = None

    def follow(self) -> None:
        """Follow the face: contract what is drawn as soon as it moves."""
        controls = self.panel.craft.controls(self.drawn.name) if self.drawn is not None else ()
        self._slider.take(controls)

    def follow_pose(self) -> None:
        """Follow the pose."""
        self._slider.follow()

    def finish(self) -> None:
        """Finish the line, or the muscle if the line was finished."""
        sketch = self.sketch
        if sketch is None:
            return
        sketch.mirror = bool(self._mirror.value)
        if sketch.close():
            self._keep()
        else:
            self._preview()
            self.show()

    def _keep(self) -> None:
        sketch, subject = self.sketch, self.panel.subject
        assert sketch is not None
        drawn = sketch.drawn(self.shop.document.work, subject)
        if drawn is None:
            raise ParameterError("drawing: too few points for a muscle")
        if self.shop.draft_problem:
            raise ParameterError(self.shop.draft_problem)
        self.cancel()
        self.shop.change(f"Draw {sketch.name}", drawn.work)
        self.panel.select(drawn.name)
        self.page.tell(f"{sketch.name} is there: move its slider")

    def cancel(self) -> None:
        """Stop drawing."""
        self.forget_draft()
        self.sketch = self.drawn = None
        self._slider.take(())
        self._ends.set_visibility(False)
        self.page.view.set(tool="look")
        self.panel.show_overlay()
        self.panel.say()

    def take(self, message: Message) -> None:
        """Take a place that the pointer gave."""
        sketch, stage = self.sketch, self.shop.stage
        if sketch is None or stage is None:
            return
        sketch.put(place_of(message, stage))
        if sketch.is_complete:
            self._keep()
            return
        self._aim()
        self._preview()
        self.show()

    def key(self, key: str) -> bool:
        """Take a key while something is drawn."""
        if self.sketch is None:
            return False
        if key == "Enter":
            self._guarded(self.finish)
        elif key == "Escape":
            self.cancel()
        elif key == "Backspace" and self.sketch.back():
            self._aim()
            self._guarded(self._preview)
            self.show()
        else:
            return False
        return True

    def _guarded(self, act: Any) -> None:
        try:
            act()
        except ParameterError as error:
            self.page.refuse(str(error))
