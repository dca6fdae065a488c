"""The panel that moves the face: emotions, sliders by region, jaw and gaze pads."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from nicegui import ui
from nicegui.events import GenericEventArguments, ValueChangeEventArguments

from risorius.controls.control import Control
from risorius.controls.presets import EMOTIONS
from risorius.errors import ParameterError
from risorius.io.json_fields import Fields, finite_number
from risorius.studio.panel import Panel, group, heading
from risorius.studio.panels.heat import HeatGroup
from risorius.studio.regions import Row, rows_of, title_of
from risorius.studio.viewport import Pad

__all__ = ["FacePanel"]

_PACE = 0.03


class FacePanel(Panel):
    """Sliders for every control of the face."""

    name = "Face"
    icon = "face"
    hint = (
        "Move a slider: the face follows. <b>Drag</b> turns the view, <b>wheel</b> zooms. "
        "<b>Muscles</b> draws new ones, <b>Export</b> writes the rig."
    )

    def build(self) -> None:
        """Make the elements."""
        self._together = True
        self._intensity = 1.0
        self._sliders: dict[str, list[tuple[Control, ui.slider, ui.label | None]]] = {}
        heading("Face")
        with group("Expressions"):
            with ui.row().style("gap:6px"):
                for name in EMOTIONS:
                    ui.button(
                        name, on_click=self.page.safely(lambda n=name: self._emotion(n))
                    ).props("flat dense no-caps").classes("st-chip").props(
                        f"data-mark=emotion-{name}"
                    )
            with ui.element("div").classes("st-row"):
                ui.label("intensity").classes("st-name")
                slider = ui.slider(min=0.0, max=1.0, step=0.01, value=1.0).props("dense")
                slider.on_value_change(self.page.safely(self._intense))
                slider.props("data-mark=intensity")
                self._shown = ui.label("100 %").classes("st-number")
            with ui.row().style("gap:6px"):
                ui.button("Rest", icon="restart_alt", on_click=self._rest).props(
                    "flat dense no-caps"
                ).classes("st-chip").props("data-mark=rest")
                ui.switch("both sides", value=True, on_change=self._join).props("dense").props(
                    "data-mark=both-sides"
                )
        self._own = ui.column().classes("st-group")
        self._pads()
        self._rows = ui.column().style("width:100%;gap:10px")
        HeatGroup(self.page).build()

    # -- elements ---------------------------------------------------------------------------

    def _pads(self) -> None:
        with ui.element("div").style(
            "display:grid;grid-template-columns:1fr 1fr;gap:10px;width:100%"
        ):
            with group("Jaw"):
                self._jaw = Pad(low=(-5.0, -18.0), high=(5.0, 4.0))
                self._jaw.tooltip("Down opens, sideways moves the chin; double click rests")
            with group("Gaze"):
                self._gaze = Pad(low=(-40.0, -35.0), high=(40.0, 30.0))
                self._gaze.tooltip("Where the eyes look; double click rests")
        for pad, move in ((self._jaw, self._move_jaw), (self._gaze, self._move_gaze)):
            pad.on("moved", self.page.safely(move))
            pad.on("kept", self.page.safely(move))
            pad.on("kept", self.page.safely(lambda _: self.shop.keep_pose("Jaw or gaze")))

    def _fill(self) -> None:
        self._sliders.clear()
        self._rows.clear()
        with self._rows:
            for region, rows in rows_of(self.shop.controls).items():
                if region == "Jaw":
                    rows = [row for row in rows if row.name == "jaw_protrusion"] or rows
                shown = [row for row in rows if not row.name.startswith("gaze_")]
                if not shown:
                    continue
                with group(region):
                    for row in shown:
                        self._slider_row(row)

    def _slider_row(self, row: Row) -> None:
        joined = self._together or len(row.controls) == 1
        with ui.element("div").classes("st-row" if joined else "st-row two"):
            ui.label(title_of(row.name)).classes("st-name").props(f'title="{title_of(row.name)}"')
            for controls in [row.controls] if joined else [[each] for each in row.controls]:
                first = controls[0]
                slider = ui.slider(
                    min=first.low, max=first.high, step=(first.high - first.low) / 200, value=0.0
                ).props("dense")
                slider.props(f"data-mark=control-{row.name if joined else first.name}")
                label = ui.label("0").classes("st-number") if joined else None
                for control in controls:
                    self._sliders.setdefault(control.name, []).append((control, slider, label))
                slider.on(
                    "update:model-value",
                    self.page.safely(lambda e, c=controls: self._move(e, c)),
                    throttle=_PACE,
                )
                slider.on(
                    "change",
                    self.page.safely(lambda e, c=controls, r=row: self._keep(e, c, r)),
                )

    # -- actions ----------------------------------------------------------------------------

    def _move(self, event: GenericEventArguments, controls: list[Control]) -> None:
        first = controls[0]
        value = min(max(finite_number(event.args, "slider"), first.low), first.high)
        sign = first.mirror_sign if len(controls) > 1 else 1.0
        values = {control.name: value for control in controls}
        if sign < 0.0:
            values[controls[1].name] = -value
        self.shop.set_pose(values)
        self._numbers()

    def _keep(self, event: GenericEventArguments, controls: list[Control], row: Row) -> None:
        self._move(event, controls)
        self.shop.keep_pose(title_of(row.name), gesture=f"slider {row.name}")

    def _move_jaw(self, event: GenericEventArguments) -> None:
        x, y = _two(event)
        self._offer({"jaw_yaw": x, "jaw_pitch": -y})

    def _move_gaze(self, event: GenericEventArguments) -> None:
        x, y = _two(event)
        self._offer({"gaze_yaw_l": x, "gaze_yaw_r": x, "gaze_pitch_l": y, "gaze_pitch_r": y})

    def _offer(self, values: dict[str, float]) -> None:
        known = {control.name: control for control in self.shop.controls}
        self.shop.set_pose(
            {
                name: min(max(value, known[name].low), known[name].high)
                for name, value in values.items()
                if name in known
            }
        )

    def _intense(self, event: ValueChangeEventArguments[Any]) -> None:
        self._intensity = min(max(finite_number(event.value, "intensity"), 0.0), 1.0)
        self._shown.set_text(f"{100 * self._intensity:.0f} %")

    def _emotion(self, name: str) -> None:
        pose = self.subject.presets.emotions.get(name)
        if pose is None:
            raise ParameterError(f"presets: this book has no {name}")
        fitted = self.subject.presets.fit(pose, self.shop.controls).pose
        scaled = {control: self._intensity * value for control, value in fitted.items()}
        self.shop.replace_pose(scaled, name.capitalize())

    def _rest(self) -> None:
        self.shop.replace_pose({}, "Rest")

    def _join(self, event: ValueChangeEventArguments[Any]) -> None:
        self._together = bool(event.value)
        self._fill()
        self._follow()

    # -- follow -----------------------------------------------------------------------------

    def refresh(self, what: str) -> None:
        """Follow the face and the pose."""
        if what == "face":
            names = [control.name for control in self.shop.controls]
            if names != list(self._sliders):
                self._fill()
        if what in ("face", "pose"):
            self._follow()
        if what == "document":
            self._fill_own()

    def _follow(self) -> None:
        pose = self.shop.pose
        for name, entries in self._sliders.items():
            for control, slider, _ in entries:
                if control.name == name:
                    slider.set_value(pose.get(name, 0.0))
        self._jaw.put(pose.get("jaw_yaw", 0.0), -pose.get("jaw_pitch", 0.0))
        self._gaze.put(pose.get("gaze_yaw_l", 0.0), pose.get("gaze_pitch_l", 0.0))
        self._numbers()

    def _numbers(self) -> None:
        for name, entries in self._sliders.items():
            for control, _, label in entries:
                if label is not None:
                    value = self.shop.pose.get(name, 0.0)
                    text = f"{value:.2f}" if control.unit == "1" else f"{value:.1f}"
                    label.set_text(text if value else "0")

    def _fill_own(self) -> None:
        self._own.clear()
        poses = self.shop.document.work.poses
        with self._own:
            ui.label("My poses").classes("st-head")
            with ui.row().style("gap:6px"):
                for name in poses:
                    ui.button(
                        name, on_click=self.page.safely(lambda n=name: self._recall(n))
                    ).props("flat dense no-caps").classes("st-chip")
                ui.button("keep this one", icon="add", on_click=self._ask_name).props(
                    "flat dense no-caps"
                ).classes("st-chip").props("data-mark=keep-pose")

    def _recall(self, name: str) -> None:
        self.shop.replace_pose(dict(self.shop.document.work.poses[name]), f"Pose {name}")

    def _ask_name(self) -> None:
        with ui.dialog() as dialog, ui.card():
            entry = ui.input("Name of the pose").props("data-mark=pose-name")

            def keep() -> None:
                self._keep_pose(str(entry.value or "").strip())
                dialog.close()

            ui.button("Keep", on_click=self.page.safely(keep)).classes("st-act").props(
                "data-mark=pose-ok"
            )
        dialog.open()

    def _keep_pose(self, name: str) -> None:
        if not name or len(name) > 60 or name == "current":
            raise ParameterError("pose: give a name of 1 to 60 letters, not 'current'")
        work = self.shop.document.work
        pose = {key: value for key, value in self.shop.pose.items() if value}
        project = replace(work.project, poses={**work.project.poses, name: pose})
        self.shop.change(f"Keep pose {name}", replace(work, project=project, pose=pose))


def _two(event: GenericEventArguments) -> tuple[float, float]:
    fields = Fields(event.args, "pad")
    return fields.number("x"), fields.number("y")
