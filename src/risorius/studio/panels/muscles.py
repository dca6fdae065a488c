"""The panel of the muscle designer: draw, choose, change, order."""

from __future__ import annotations

from typing import Any

from nicegui import ui
from nicegui.events import ValueChangeEventArguments

from risorius.errors import ParameterError
from risorius.studio.drawing.catalogue import CRAFTS
from risorius.studio.drawing.craft import Craft
from risorius.studio.panel import Panel, heading
from risorius.studio.panels.heat import HeatGroup
from risorius.studio.panels.method import MethodToggle
from risorius.studio.panels.muscle_drawing import MuscleDrawing
from risorius.studio.panels.muscle_editor import MuscleEditor
from risorius.studio.panels.muscle_feedback import MuscleFeedback
from risorius.studio.panels.muscle_list import MuscleList
from risorius.studio.stated import Message

__all__ = ["MusclePanel"]

_OUTSIDE = {"skin": 1.0, "parts": 1.0, "skull": 0.0, "muscles": 0.0}


class MusclePanel(Panel):
    """Muscles of the face; how they are drawn and changed depends on its method, see `craft`."""

    name = "Muscles"
    icon = "gesture"

    def build(self) -> None:
        """Make the elements."""
        self.locked: set[str] = set()
        heading("Muscles", "Draw them on the skull or the skin; the face moves at once.")
        self._method = MethodToggle(self, "method")
        ui.toggle({"in": "inside", "out": "outside"}, value="in").props(
            "dense no-caps"
        ).on_value_change(self._look)
        self.drawing = MuscleDrawing(self)
        self.drawing.build()
        self.feedback = MuscleFeedback(self)
        self.feedback.build()
        self.editor = MuscleEditor(self)
        self.editor.build()
        self.list = MuscleList(self)
        self.list.build()
        HeatGroup(self.page).build()

    def action(self, text: str, icon: str, act: Any) -> ui.button:
        """Place a button."""
        button = ui.button(text, icon=icon, on_click=self.page.safely(act))
        button.props("flat dense no-caps").classes("st-chip").props(f"data-mark={_slug(text)}")
        return button

    # -- what the parts of the panel share --------------------------------------------------

    @property
    def craft(self) -> Craft:
        """The muscles at hand, also of a change that is only tried out."""
        return self._craft(draft=True)

    @property
    def kept(self) -> Craft:
        """The muscles that are kept, for changing them."""
        return self._craft(draft=False)

    def _craft(self, *, draft: bool) -> Craft:
        work, subject = self.shop.document.work, self.shop.subject
        if draft and self.shop.draft is not None:
            work = self.shop.draft
        method = work.project.method
        if subject is not None and subject.work.project.method != method:
            subject = None
        return CRAFTS[method](work, subject)

    @property
    def focus(self) -> str:
        """The muscle that is drawn, or the chosen one."""
        drawn = self.drawing.drawn
        return drawn.name if drawn is not None else self.shop.show.selected

    @property
    def is_in_front(self) -> bool:
        """Whether this panel is in front."""
        return getattr(self.page, "active", None) is self

    def show_overlay(self) -> None:
        """Show the lines that are drawn, or the handles of the chosen muscle, and the feedback."""
        if not self.is_in_front:
            return
        sketch, seen = self.drawing.sketch, self.feedback.shown
        content = sketch.overlay() if sketch is not None else {"handles": self.editor.handles()}
        lines = [*content.get("lines", []), *seen.lines]
        self.page.view.overlay(
            handles=content["handles"], lines=lines, segments=seen.segments, dots=seen.dots
        )

    def say(self) -> None:
        """Say what can be done next."""
        self.page.say(self.craft.hint)

    def require_unlocked(self, name: str) -> None:
        """Refuse to change a locked muscle.

        Raises
        ------
        ParameterError
            If it is locked.
        """
        own = self.kept.own_name(name)
        if own in self.locked:
            raise ParameterError(f"muscle {own}: is locked; unlock it in the list first")

    # -- coming and going -------------------------------------------------------------------

    def enter(self) -> None:
        """Show what muscles are drawn on."""
        self._before = dict(self.page.opacity)
        self.page.show(**self.craft.looks)
        self.drawing.offer()
        self.say()
        self.feedback.fill()
        self.show_overlay()

    def leave(self) -> None:
        """Show the face again."""
        self.drawing.cancel()
        self.feedback.leave()
        self.page.show(**getattr(self, "_before", _OUTSIDE))

    def _look(self, event: ValueChangeEventArguments[Any]) -> None:
        self.page.show(**(self.craft.looks if event.value == "in" else _OUTSIDE))

    def refresh(self, what: str) -> None:
        """Follow a change."""
        if what == "document":
            if self._method.follow():
                self.drawing.cancel()
                if self.is_in_front:
                    self.page.show(**self.craft.looks)
            self.drawing.offer()
            if self.is_in_front and self.drawing.sketch is None:
                self.say()
        if what == "pose":
            self.editor.follow()
            self.drawing.follow_pose()
        if what in ("document", "face", "show"):
            self.list.fill()
            self.editor.fill()
            self.drawing.follow()
        if what in ("document", "face", "show", "pose", "draft") and self.is_in_front:
            self.feedback.fill()
            self.show_overlay()

    # -- what the pointer and the keys say --------------------------------------------------

    def take(self, event: str, message: Message) -> None:
        """Take a message of the viewport."""
        sketching = self.drawing.sketch is not None
        if event == "place":
            self.drawing.take(message)
        elif event == "finish":
            self.drawing.finish()
        elif event == "select" and not sketching:
            self.select(str(message.get("mesh", "")))
        elif event in ("dragging", "dropped", "handle") and not sketching:
            self.editor.take(event, message)

    def key(self, key: str) -> bool:
        """Take a key."""
        if key == "Delete" and self.shop.show.selected and self.drawing.sketch is None:
            self.delete(self.shop.show.selected)
            return True
        return self.drawing.key(key)

    def select(self, name: str) -> None:
        """Choose a muscle by the name of its body; anything else chooses none."""
        stage = self.shop.stage
        mesh = stage.mesh(name) if stage is not None else None
        own = bool(self.kept.own_name(name))
        chosen = name if (mesh is not None and mesh.group == "muscles") or own else ""
        self.shop.present(selected=chosen)

    def delete(self, name: str) -> None:
        """Delete a muscle."""
        try:
            self.require_unlocked(name)
            changed = self.kept.without(name)
        except ParameterError as error:
            self.page.refuse(str(error))
            return
        self.shop.present(selected="")
        self.shop.change(f"Delete {name}", changed)


def _slug(text: str) -> str:
    return text.lower().replace(" ", "-")
