"""The chosen muscle: its slider, its numbers, and handles on its points."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from nicegui import ui
from nicegui.events import GenericEventArguments, ValueChangeEventArguments

from risorius._check import FloatArray
from risorius.anatomy.outwards import outwards
from risorius.errors import FormatError, ParameterError
from risorius.io.json_fields import Fields, finite_number
from risorius.layered.editing import (
    in_layer,
    moved_point,
    renamed,
    with_muscle,
    with_point,
    without_point,
)
from risorius.layered.muscle import Muscle, Sheet
from risorius.studio.places import place_of
from risorius.studio.regions import title_of
from risorius.studio.stated import Message
from risorius.studio.work import Work
from risorius.vectormuscle.editing import moved_end, with_numbers

if TYPE_CHECKING:
    from risorius.studio.panels.muscles import MusclePanel

__all__ = ["MuscleEditor"]

_HANDLE = "#ffd166"
Get = Callable[[Muscle], float]
Put = Callable[[Muscle, float], Muscle]


def _action(field: str) -> tuple[Get, Put]:
    def get(muscle: Muscle) -> float:
        return float(getattr(muscle.action, field))

    def put(muscle: Muscle, value: float) -> Muscle:
        assert muscle.action is not None
        return replace(muscle, action=replace(muscle.action, **{field: value}))  # pyright: ignore

    return get, put


def _widen(muscle: Muscle, value: float) -> Muscle:
    assert isinstance(muscle.shape, Sheet)
    factor = value / max(float(muscle.shape.half_width.mean()), 1e-6)
    return replace(muscle, shape=replace(muscle.shape, half_width=muscle.shape.half_width * factor))


_NUMBERS: dict[str, tuple[float, float, Get, Put]] = {
    "thickness": (
        0.5, 10.0, lambda m: m.thickness, lambda m, v: replace(m, thickness=v),
    ),
    "fibres": (
        2, 15, lambda m: m.sections[0],
        lambda m, v: replace(m, sections=(round(v), m.sections[1])),
    ),
    "half width": (
        0.5, 25.0, lambda m: float(getattr(m.shape, "half_width", np.zeros(1)).mean()), _widen,
    ),
    "shortening": (
        0.05, 0.6, lambda m: m.shortening, lambda m, v: replace(m, shortening=v),
    ),
    "stiffness": (0.2, 8.0, *_action("stiffness")),
    "reach": (6.0, 40.0, *_action("reach")),
    "slide": (0.0, 1.0, *_action("tangential")),
}  # fmt: skip
_VECTOR = {
    "strength": (0.1, 1.2), "half_angle": (5.0, 85.0), "start_radius": (5.0, 80.0),
    "finish_radius": (10.0, 140.0), "pull": (0.5, 25.0), "half_width": (3.0, 60.0),
}  # fmt: skip


class MuscleEditor:
    """What can be changed of one muscle.

    Parameters
    ----------
    panel : MusclePanel
    """

    def __init__(self, panel: MusclePanel) -> None:
        self.panel = panel
        self.shop = panel.shop
        self._shown: object = None
        self._slider: ui.slider | None = None

    def build(self) -> None:
        """Make the elements."""
        self._frame = ui.column().classes("st-group").props("data-mark=editor")
        self._frame.set_visibility(False)

    # -- which ------------------------------------------------------------------------------

    @property
    def muscle(self) -> Muscle | None:
        """The chosen muscle of the map, if it is one."""
        work, name = self.shop.document.work, self.shop.show.selected
        if not name or work.project.method != "layered":
            return None
        return work.muscle_map.by_name.get(self.panel.stem(work, name))

    def _controls(self) -> list[str]:
        muscle, known = self.muscle, {control.name for control in self.shop.controls}
        name = self.shop.show.selected
        wanted = muscle.control_names if muscle else (name, name[:-2] + "_r")
        return [each for each in dict.fromkeys(wanted) if each in known]

    # -- elements ---------------------------------------------------------------------------

    def fill(self) -> None:
        """Show the chosen muscle, if it has changed."""
        name, muscle = self.shop.show.selected, self.muscle
        state = (name, muscle, self.shop.document.work.vectors, tuple(self._controls()))
        if state == self._shown:
            return
        self._shown = state
        self._frame.clear()
        self._slider = None
        self._frame.set_visibility(bool(name))
        if not name:
            return
        with self._frame:
            ui.label(title_of(muscle.name if muscle else name)).classes("st-title")
            self._contraction()
            if muscle is not None:
                self._of_map(muscle)
            else:
                self._of_vectors(name)
            if self.shop.document.work.project.method != "springs":
                self.panel.action("Delete it", "delete", lambda: self.panel.delete(name))

    def _contraction(self) -> None:
        controls = self._controls()
        if not controls:
            ui.label("Passive: it carries others and does not contract.").classes("st-help")
            return
        with ui.element("div").classes("st-row"):
            ui.label("contract").style("color:var(--accent)")
            slider = ui.slider(min=0.0, max=1.0, step=0.01, value=0.0).props("dense")
            slider.props("data-mark=contract")
            slider.on("update:model-value", self.panel.page.safely(self._move), throttle=0.03)
            slider.on("change", self.panel.page.safely(self._keep_pose))
            self._slider = slider
        self.follow()

    def _of_map(self, muscle: Muscle) -> None:
        page = self.panel.page
        entry = ui.input("name", value=muscle.name).props("dense").style("width:100%")
        entry.props("data-mark=muscle-name")
        entry.on("blur", page.safely(lambda _: self._rename(str(entry.value or ""))))
        entry.on("keydown.enter", page.safely(lambda _: self._rename(str(entry.value or ""))))
        with ui.row().style("gap:4px;align-items:center"):
            ui.label(f"layer {muscle.layer}").classes("st-name").style("width:70px")
            for icon, step, tip in (("remove", -1, "deeper"), ("add", 1, "nearer to the skin")):
                button = ui.button(icon=icon, on_click=page.safely(lambda s=step: self._layer(s)))
                button.props(f'flat round dense size=sm title="{tip}"')
            switch = ui.switch("mirrored", value=muscle.mirror).props("dense")
            switch.on_value_change(page.safely(self._set_mirror))
        sheet = isinstance(muscle.shape, Sheet)
        for label, (low, high, get, put) in _NUMBERS.items():
            if label in ("stiffness", "reach", "slide", "shortening") and muscle.action is None:
                continue
            if label in ("half width", "reach", "slide") and not sheet:
                continue
            self._number(
                label, low, high, get(muscle), lambda v, p=put, n=label: self._set(n, p, v)
            )
        if sheet:
            ui.label(
                "Drag a point to move it. Shift + click deletes it, Alt + click inserts one."
            ).classes("st-help")

    def _of_vectors(self, name: str) -> None:
        work = self.shop.document.work
        known = work.vectors.muscles if work.project.method == "vector" else ()
        muscle = next((each for each in known if each.name == name), None)
        for key, (low, high) in _VECTOR.items():
            value = getattr(muscle, key, None)
            if isinstance(value, float | int):
                self._number(
                    title_of(key), low, high, float(value), lambda v, k=key: self._set_vector(k, v)
                )
        words = "Spring muscles are edited in their recipe file."
        if muscle is not None:
            words = "Drag head and tail; 'influence' below paints the zone."
        ui.label(words).classes("st-help")

    def _number(
        self, label: str, low: float, high: float, value: float, keep: Callable[[float], None]
    ) -> None:
        with ui.element("div").classes("st-row"):
            ui.label(label).classes("st-name")
            step = 1.0 if label == "fibres" else (high - low) / 200.0
            slider = ui.slider(min=low, max=max(high, value), step=step, value=value)
            shown = ui.label(f"{value:.3g}").classes("st-number")
            slider.props("dense").props(f"data-mark=number-{_slug(label)}")

            def changed(event: ValueChangeEventArguments[Any]) -> None:
                shown.set_text(f"{float(event.value):.3g}")

            def kept(event: GenericEventArguments) -> None:
                keep(finite_number(event.args, "slider"))

            slider.on_value_change(changed)
            slider.on("change", self.panel.page.safely(kept))

    # -- changes ----------------------------------------------------------------------------

    def _move(self, event: GenericEventArguments) -> None:
        value = finite_number(event.args, "slider")
        self.shop.set_pose(dict.fromkeys(self._controls(), value))

    def _keep_pose(self, event: GenericEventArguments) -> None:
        self._move(event)
        self.shop.keep_pose(f"Contract {title_of(self.shop.show.selected)}", gesture="contract")

    def follow(self) -> None:
        """Show the contraction of the pose."""
        controls = self._controls()
        if self._slider is not None and controls:
            self._slider.set_value(self.shop.pose.get(controls[0], 0.0))

    def _require(self) -> Muscle:
        muscle = self.muscle
        if muscle is None:
            raise ParameterError("muscles: choose one first")
        if muscle.name in self.panel.locked:
            raise ParameterError(f"muscle {muscle.name}: is locked; unlock it in the list first")
        return muscle

    def _with(self, muscle: Muscle) -> Work:
        work = self.shop.document.work
        return replace(work, muscle_map=with_muscle(work.muscle_map, muscle))

    def _set(self, label: str, put: Put, value: float) -> None:
        muscle = put(self._require(), value)
        self.shop.change(f"{title_of(muscle.name)}: {label}", self._with(muscle))

    def _set_vector(self, key: str, value: float) -> None:
        name, work = self.shop.show.selected, self.shop.document.work
        vectors = with_numbers(work.vectors, name, {key: value})
        self.shop.change(f"{title_of(name)}: {title_of(key)}", replace(work, vectors=vectors))

    def _set_mirror(self, event: ValueChangeEventArguments[Any]) -> None:
        muscle = self._require()
        if bool(event.value) != muscle.mirror:
            self._switch(muscle.name, bool(event.value))

    def _switch(self, name: str, mirror: bool) -> None:
        muscle = replace(self._require(), mirror=mirror)
        self.shop.change(f"{title_of(name)}: mirrored", self._with(muscle))
        self.panel.select(muscle.control_names[0])

    def _layer(self, step: int) -> None:
        muscle, work = self._require(), self.shop.document.work
        changed = in_layer(work.muscle_map, muscle.name, muscle.layer + step)
        self.shop.change(f"{title_of(muscle.name)}: layer", replace(work, muscle_map=changed))

    def _rename(self, name: str) -> None:
        muscle, work = self._require(), self.shop.document.work
        if name == muscle.name:
            return
        changed = renamed(work.muscle_map, muscle.name, name)
        self.shop.present(selected="")
        self.shop.change(f"Rename {muscle.name}", replace(work, muscle_map=changed))
        self.panel.select(changed.by_name[name].control_names[0])

    # -- handles ----------------------------------------------------------------------------

    def show_handles(self) -> None:
        """Show the points of the chosen muscle."""
        subject, name, muscle = self.shop.subject, self.shop.show.selected, self.muscle
        ends: dict[str, FloatArray] = {}
        on = {"origin": ["skull"], "insertion": ["skin"]}
        if subject is not None and muscle is not None and isinstance(muscle.shape, Sheet):
            places = subject.space.to_head(muscle.shape.line)
            ends = {str(k): place for k, place in enumerate(places)}
        elif subject is not None and subject.vector_face is not None:
            drawn = next((m for m in subject.vector_face.vectors.muscles if m.name == name), None)
            for key in on:
                if drawn is not None and hasattr(drawn, key):
                    ends[key] = getattr(drawn, key)
        handles: list[dict[str, Any]] = []
        for key, place in ends.items():
            out = outwards(place[None])[0]
            handles.append(
                {
                    "id": key, "at": (place + out).tolist(), "normal": out.tolist(),
                    "colour": _HANDLE, "label": key if key in on else f"point {int(key) + 1}",
                    "on": on.get(key, ["skull", "muscles"]),
                }
            )  # fmt: skip
        self.panel.page.view.overlay(handles=handles)

    def take(self, event: str, message: Message) -> None:
        """Move, insert or delete a point."""
        key = Fields(message, "page").text("id")
        if self.shop.document.work.project.method == "vector":
            self._take_vector(event, key, message)
            return
        muscle, subject = self._require(), self.panel.subject
        if not key.isdigit() or len(key) > 4:
            raise FormatError("page: this handle has gone")
        index = int(key)
        if event == "handle":
            self._edit_point(muscle, index, message)
            return
        stage = self.shop.stage
        assert stage is not None
        position = place_of(message, stage).position
        place = subject.space.from_head(position[None])[0]
        work = self._with(moved_point(muscle, index, place))
        if event == "dragging":
            self.shop.try_out(work)
        else:
            self.shop.change(f"{title_of(muscle.name)}: move point {index + 1}", work)

    def _edit_point(self, muscle: Muscle, index: int, message: Message) -> None:
        assert isinstance(muscle.shape, Sheet)
        line = muscle.shape.line
        if message.get("shift") is True:
            work = self._with(without_point(muscle, index))
            self.shop.change(f"{title_of(muscle.name)}: delete point", work)
        elif message.get("alt") is True:
            other = min(index + 1, len(line) - 1) if index + 1 < len(line) else index - 1
            middle = 0.5 * (line[index] + line[other])
            work = self._with(with_point(muscle, max(index, other), middle))
            self.shop.change(f"{title_of(muscle.name)}: insert point", work)

    def _take_vector(self, event: str, key: str, message: Message) -> None:
        face, stage = self.panel.subject.vector_face, self.shop.stage
        if event == "handle" or face is None or stage is None:
            return
        position = place_of(message, stage).position
        name = self.shop.show.selected
        vectors = moved_end(face.vectors, name, key, position)
        work = replace(self.shop.document.work, vectors=vectors)
        if event == "dragging":
            self.shop.try_out(work)
        else:
            self.shop.change(f"{title_of(name)}: move {key}", work)


def _slug(text: str) -> str:
    return text.lower().replace(" ", "-")
