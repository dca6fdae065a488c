"""The panel of the landmarks: shown, placed, dragged, mirrored; what is missing."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from nicegui import ui

from risorius.errors import FormatError, LandmarkError
from risorius.landmarks import feature_points
from risorius.landmarks.editing import mirrored, placed, without
from risorius.landmarks.landmark_set import LandmarkSpec
from risorius.mesh.normals import vertex_normals
from risorius.studio.panel import Panel, heading
from risorius.studio.places import place_of, text_of
from risorius.studio.stated import Message

__all__ = ["LandmarkPanel"]

_COLOURS = {"left": "#7fb4ff", "right": "#ff9d7f", "centre": "#ffd166"}
_MISSING = "#6b7178"
_GROUPS = ("skin", "parts")


class LandmarkPanel(Panel):
    """Named points of the head."""

    name = "Landmarks"
    icon = "my_location"
    hint = "Drag a point on the skin; hold the pointer over it to read its name."

    def build(self) -> None:
        """Make the elements."""
        self.chosen = ""
        self._shown: object = None
        heading("Landmarks", "Points that the face is fitted by. Left is the character's left.")
        self._count = ui.label().classes("st-help").props("data-mark=landmark-count")
        self._card = ui.column().classes("st-group")
        self._list = ui.column().classes("st-group").style("gap:1px")

    def enter(self) -> None:
        """Show the points."""
        self._before = dict(self.page.opacity)
        self.page.show(skin=1.0, parts=1.0, skull=0.0, muscles=0.0)
        self.shop.replace_pose({}, "Rest") if self.shop.pose else None
        self._handles()

    def leave(self) -> None:
        """Put the layers back."""
        self.page.show(**self._before)

    def refresh(self, what: str) -> None:
        """Follow a change."""
        if what in ("document", "face"):
            self._fill()
            if getattr(self.page, "active", None) is self:
                self._handles()

    # -- elements ---------------------------------------------------------------------------

    def _fill(self) -> None:
        marks = self.shop.document.work.landmarks
        if self._shown == (marks, self.chosen):
            return
        self._shown = (marks, self.chosen)
        known = feature_points()
        self._count.set_text(f"{len(marks)} of {len(known)} placed")
        self._list.clear()
        with self._list:
            for point in known.values():
                here = point.name in marks
                classes = f"st-item {'on' if point.name == self.chosen else ''}"
                with ui.element("div").classes(classes) as row:
                    row.on("click", self.page.safely(lambda _, n=point.name: self._choose(n)))
                    ui.icon("circle", size="10px").style(
                        f"color:{_COLOURS[point.side] if here else _MISSING};margin-right:6px"
                    )
                    ui.label(point.name).style("width:44px")
                    ui.label(point.description).classes("st-name st-help").props(
                        f'title="{point.description}"'
                    )
        self._fill_card(marks)

    def _fill_card(self, marks: Mapping[str, LandmarkSpec]) -> None:
        self._card.clear()
        self._card.set_visibility(bool(self.chosen))
        point = feature_points().get(self.chosen)
        if point is None:
            return
        with self._card:
            ui.label(f"{point.name}  {point.description}")
            here = point.name in marks
            ui.label("placed" if here else "click on the head to place it").classes("st-help")
            with ui.row().style("gap:6px"):
                self._button("Place", "add_location", self._aim)
                if here and point.mirror != point.name:
                    self._button("Mirror", "flip", self._mirror)
                if here:
                    self._button("Take away", "delete", self._remove)

    def _button(self, text: str, icon: str, act: Any) -> None:
        button = ui.button(text, icon=icon, on_click=self.page.safely(act))
        button.props("flat dense no-caps").classes("st-chip").props(
            f"data-mark=landmark-{text.lower()}"
        )

    def _handles(self) -> None:
        subject = self.shop.subject
        if subject is None:
            return
        head = subject.head
        normals = vertex_normals(head.skin.mesh.positions, head.skin.mesh.faces)
        handles: list[dict[str, Any]] = []
        for name in head.landmarks:
            point = feature_points().get(name)
            normal = normals[head.skin_vertex(name)]
            at = head.landmarks.position(name) + 0.8 * normal
            handles.append(
                {
                    "id": name, "at": at.tolist(), "normal": normal.tolist(), "on": _GROUPS,
                    "colour": "#ffffff" if name == self.chosen
                    else _COLOURS[point.side if point else "centre"],
                    "label": f"{name}  {point.description if point else ''}",
                }
            )  # fmt: skip
        self.page.view.overlay(handles=handles)

    # -- changes ----------------------------------------------------------------------------

    def _choose(self, name: str) -> None:
        self.chosen = name
        self._fill()
        self._handles()
        if name not in self.shop.document.work.landmarks:
            self._aim()

    def _aim(self) -> None:
        self.page.view.set(tool="draw", drawOn=list(_GROUPS))
        self.page.say(f"Click where <b>{self.chosen}</b> lies on the head. <b>Escape</b> stops.")

    def _change(self, label: str, marks: dict[str, LandmarkSpec]) -> None:
        self.shop.change(label, replace(self.shop.document.work, landmarks=marks))

    def _mirror(self) -> None:
        head, marks = self.subject.head, self.shop.document.work.landmarks
        self._change(
            f"Mirror {self.chosen}", mirrored(marks, self.chosen, head.positions, head.source)
        )

    def _remove(self) -> None:
        self._change(
            f"Take {self.chosen} away", without(self.shop.document.work.landmarks, self.chosen)
        )

    def take(self, event: str, message: Message) -> None:
        """Take a message of the viewport."""
        stage = self.shop.stage
        if stage is None:
            return
        if event == "handle":
            self._choose(text_of(message, "id"))
        elif event in ("dropped", "place"):
            name = text_of(message, "id") if event == "dropped" else self.chosen
            if not name:
                raise LandmarkError("landmarks: choose in the list which one to place")
            place = place_of(message, stage)
            if place.group not in _GROUPS:
                raise FormatError("landmarks: they lie on the head, not on bone or muscle")
            head = self.subject.head
            there = head.frame.to_input(place.position[None])[0]
            marks = placed(self.shop.document.work.landmarks, name, there, head.source)
            self.chosen = name
            self.page.view.set(tool="look")
            self.page.say(self.hint)
            self._change(f"Move landmark {name}", marks)

    def key(self, key: str) -> bool:
        """Take a key."""
        if key != "Escape":
            return False
        self.page.view.set(tool="look")
        self.page.say(self.hint)
        return True
