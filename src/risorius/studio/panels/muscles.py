"""The panel of the muscle designer: draw, choose, change, order."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, cast

from nicegui import ui
from nicegui.events import ValueChangeEventArguments

from risorius.errors import ParameterError
from risorius.layered.editing import free_name, with_muscle, without_muscle
from risorius.studio.panel import Panel, group, heading
from risorius.studio.panels.heat import HeatGroup
from risorius.studio.panels.muscle_editor import MuscleEditor
from risorius.studio.panels.muscle_list import MuscleList
from risorius.studio.places import place_of
from risorius.studio.sketch import Sketch, SketchKind
from risorius.studio.stated import Message
from risorius.studio.work import Work
from risorius.vectormuscle.editing import added, removed

__all__ = ["MusclePanel"]

_METHODS = {"layered": "layers", "vector": "vectors", "springs": "springs"}
_INSIDE = {"skin": 0.25, "parts": 0.0, "skull": 1.0, "muscles": 1.0}
_OUTSIDE = {"skin": 1.0, "parts": 1.0, "skull": 0.0, "muscles": 0.0}


class MusclePanel(Panel):
    """Muscles drawn on the skull, or vector muscles by head and tail."""

    name = "Muscles"
    icon = "gesture"
    hint = "Click a muscle to change it, or <b>Draw a sheet</b> to make a new one."
    _vector_hint = "Click a muscle to change it, or <b>Head and tail</b> to make a new one."

    def build(self) -> None:
        """Make the elements."""
        self.sketch: Sketch | None = None
        self.locked: set[str] = set()
        heading("Muscles", "Draw them on the skull; the face moves at once.")
        self._method = ui.toggle(_METHODS, value=self.shop.document.work.project.method)
        self._method.props("dense no-caps").on_value_change(self.page.safely(self._set_method))
        self._method.props("data-mark=method")
        ui.toggle({"in": "inside", "out": "outside"}, value="in").props(
            "dense no-caps"
        ).on_value_change(lambda e: self.page.show(**(_INSIDE if e.value == "in" else _OUTSIDE)))
        with group("New muscle") as self._new:
            self._name = ui.input("name", value="new_muscle").props("dense").style("width:100%")
            self._name.props("data-mark=new-name")
            with ui.row().style("gap:6px"):
                self._buttons: dict[str, ui.button] = {
                    kind: self.action(text, icon, lambda k=kind: self.begin(cast(SketchKind, k)))
                    for kind, text, icon in (
                        ("sheet", "Draw a sheet", "draw"),
                        ("sphincter", "Draw a ring", "circle"),
                        ("vector", "Head and tail", "trending_up"),
                    )
                }
            self._mirror = ui.switch("mirror to the other side", value=True).props("dense")
            self._mirror.props("data-mark=mirror")
            self._skin = ui.switch("draw on the skin, too", on_change=self._aim).props("dense")
            with ui.row().style("gap:6px") as self._drawing:
                self.action("Keep it", "check", self.finish).props("data-mark=finish")
                self.action("Stop", "close", self.cancel).props("data-mark=cancel")
            self._drawing.set_visibility(False)
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

    # -- coming and going -------------------------------------------------------------------

    def enter(self) -> None:
        """Show the inside of the head."""
        self._before = dict(self.page.opacity)
        self.page.show(**_INSIDE)
        self._offer_kinds()
        self._say()
        self.editor.show_handles()

    def leave(self) -> None:
        """Show the face again."""
        self.cancel()
        self.page.show(**getattr(self, "_before", _OUTSIDE))

    def _offer_kinds(self) -> None:
        method = self.shop.document.work.project.method
        self._new.set_visibility(method != "springs")
        for kind, button in self._buttons.items():
            button.set_visibility((kind == "vector") == (method == "vector"))

    def refresh(self, what: str) -> None:
        """Follow a change."""
        if what == "document":
            self._method.set_value(self.shop.document.work.project.method)
            self._offer_kinds()
            if self.page_is_here and self.sketch is None:
                self._say()
        if what in ("document", "face", "show"):
            self.list.fill()
            self.editor.fill()
            if self.page_is_here and self.sketch is None:
                self.editor.show_handles()
        if what == "pose":
            self.editor.follow()

    @property
    def page_is_here(self) -> bool:
        """Whether this panel is in front."""
        return getattr(self.page, "active", None) is self

    # -- method -----------------------------------------------------------------------------

    def _set_method(self, event: ValueChangeEventArguments[Any]) -> None:
        work = self.shop.document.work
        if event.value == work.project.method:
            return
        self.cancel()
        self.shop.present(selected="")
        project = replace(work.project, method=str(event.value), parameters={})
        self.shop.change(f"Method {_METHODS[project.method]}", replace(work, project=project))

    # -- drawing ----------------------------------------------------------------------------

    def begin(self, kind: SketchKind) -> None:
        """Begin to draw."""
        subject = self.subject
        name = str(self._name.value or "").strip().lower().replace(" ", "_")
        if kind != "vector":
            if subject.bench is None:
                raise ParameterError(
                    "drawing: this profile shows no muscles while they are drawn; choose improved"
                )
            free_name(subject.work.muscle_map, name)
        self.shop.present(selected="")
        self.sketch = Sketch(kind, name, mirror=bool(self._mirror.value))
        self._drawing.set_visibility(kind != "vector")
        self._aim()
        self._show_sketch()

    def _aim(self, *_: object) -> None:
        if self.sketch is None:
            return
        targets = ["skull", "muscles"]
        tail = self.sketch.kind == "vector" and len(self.sketch.lines[-1]) == 1
        if tail:
            targets = ["skin"]
        elif self._skin.value:
            targets.append("skin")
        self.page.view.set(tool="draw", drawOn=targets)

    def _show_sketch(self) -> None:
        sketch = self.sketch
        if sketch is None:
            return
        self.page.view.overlay(**sketch.overlay())
        self.page.say(sketch.hint)

    def _preview(self) -> None:
        """Let the muscle appear as it is drawn."""
        sketch, work = self.sketch, self.shop.document.work
        if sketch is None:
            return
        try:
            muscle = sketch.muscle(self.subject.space, work.muscle_map)
        except ParameterError:  # not yet: more points may make it one
            muscle = None
        if muscle is not None:
            self.shop.try_out(replace(work, muscle_map=with_muscle(work.muscle_map, muscle)))
        elif self.shop.draft is not None:
            self.shop.try_out(work)

    def finish(self) -> None:
        """Finish the line, or the muscle if the line was finished."""
        sketch = self.sketch
        if sketch is None:
            return
        sketch.mirror = bool(self._mirror.value)
        if len(sketch.lines) == 1 and sketch.kind == "sphincter":
            sketch.close()
            self._show_sketch()
            return
        if sketch.close():
            self._keep()
        else:
            self._preview()
            self._show_sketch()

    def _keep(self) -> None:
        sketch, work = self.sketch, self.shop.document.work
        assert sketch is not None
        muscle = sketch.muscle(self.subject.space, work.muscle_map)
        if muscle is None:
            raise ParameterError("drawing: too few points for a muscle")
        self.cancel()
        changed = replace(work, muscle_map=with_muscle(work.muscle_map, muscle))
        self.shop.change(f"Draw {muscle.name}", changed)
        self.select(muscle.control_names[0])
        self.page.tell(f"{muscle.name} is there: move its slider")

    def cancel(self) -> None:
        """Stop drawing."""
        if self.shop.draft is not None:
            self.shop.try_out(self.shop.document.work)
            self.shop.draft = None
        self.sketch = None
        self._drawing.set_visibility(False)
        self.page.view.set(tool="look")
        self.page.view.overlay()
        self._say()

    def _say(self) -> None:
        method = self.shop.document.work.project.method
        self.page.say(
            {"layered": self.hint, "vector": self._vector_hint}.get(
                method, "Click a spring muscle and contract it."
            )
        )

    def _draw_vector(self) -> None:
        sketch, work = self.sketch, self.shop.document.work
        assert sketch is not None
        head, tail = (place.position for place in sketch.lines[-1][:2])
        vectors = added(self._fitted(), sketch.name, head, tail)
        self.cancel()
        self.shop.change(f"Draw {sketch.name}", replace(work, vectors=vectors))
        self.select(vectors.muscles[-2].name)

    def _fitted(self) -> Any:
        face = self.subject.vector_face
        if face is None:
            raise ParameterError("muscles: this face has no vector muscles")
        return face.vectors

    # -- what the pointer and the keys say --------------------------------------------------

    def take(self, event: str, message: Message) -> None:
        """Take a message of the viewport."""
        if event == "place" and self.sketch is not None:
            stage = self.shop.stage
            if stage is None:
                return
            self.sketch.put(place_of(message, stage))
            if self.sketch.kind == "vector" and len(self.sketch.lines[-1]) == 2:
                self._draw_vector()
                return
            self._aim()
            self._preview()
            self._show_sketch()
        elif event == "finish":
            self.finish()
        elif event == "select" and self.sketch is None:
            self.select(str(message.get("mesh", "")))
        elif event in ("dragging", "dropped", "handle"):
            self.editor.take(event, message)

    def key(self, key: str) -> bool:
        """Take a key."""
        if self.sketch is None:
            if key == "Delete" and self.shop.show.selected:
                self._guarded(lambda: self.delete(self.shop.show.selected))
                return True
            return False
        if key == "Enter":
            self._guarded(self.finish)
        elif key == "Escape":
            self.cancel()
        elif key == "Backspace" and self.sketch.back():
            self._aim()
            self._guarded(self._preview)
            self._show_sketch()
        else:
            return False
        return True

    def _guarded(self, act: Any) -> None:
        try:
            act()
        except ParameterError as error:
            self.page.refuse(str(error))

    def select(self, name: str) -> None:
        """Choose a muscle by the name of its body; anything else chooses none."""
        stage = self.shop.stage
        mesh = stage.mesh(name) if stage is not None else None
        known = {each.name for each in self.shop.controls}
        chosen = name if (mesh is not None and mesh.group == "muscles") or name in known else ""
        self.shop.present(selected=chosen)

    def delete(self, name: str) -> None:
        """Delete a muscle."""
        work = self.shop.document.work
        if work.project.method == "vector":
            changed = replace(work, vectors=removed(self._fitted(), name))
        else:
            stem = self.stem(work, name)
            if stem in self.locked:
                raise ParameterError(f"muscle {stem}: is locked; unlock it in the list first")
            changed = replace(work, muscle_map=without_muscle(work.muscle_map, stem))
        self.shop.present(selected="")
        self.shop.change(f"Delete {name}", changed)

    def stem(self, work: Work, name: str) -> str:
        """Return the name of a muscle of the map from that of its body or control."""
        names = work.muscle_map.by_name
        return name if name in names else name.removesuffix("_l").removesuffix("_r")


def _slug(text: str) -> str:
    return text.lower().replace(" ", "-")
