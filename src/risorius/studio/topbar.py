"""The bar at the top: file, history, layers, camera."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from nicegui import ui
from nicegui.events import ValueChangeEventArguments

from risorius.io.json_fields import finite_number
from risorius.studio.scene import GROUPS
from risorius.studio.shortcuts import show_shortcuts

if TYPE_CHECKING:
    from risorius.studio.page import Page

__all__ = ["TopBar"]

_VIEWS = (
    ("front", "face", "Front (F)"),
    ("three_quarter", "3d_rotation", "Three-quarter (T)"),
    ("left", "switch_left", "From the character's left (L)"),
    ("right", "switch_right", "From the character's right (R)"),
    ("eyes", "visibility", "Eyes"),
    ("mouth", "sentiment_satisfied", "Mouth"),
)


class TopBar:
    """The bar of one page.

    Parameters
    ----------
    page : Page
    """

    def __init__(self, page: Page) -> None:
        self.page = page
        self.layout = "one"
        self._sliders: dict[str, ui.slider] = {}

    def build(self) -> None:
        """Make the elements."""
        page = self.page
        with ui.element("div").classes("st-top"):
            ui.label("risorius").classes("st-brand")
            self._file = ui.label().classes("st-file").props("data-mark=file")
            self._kept = ui.label().classes("st-kept").props("data-mark=kept")
            ui.element("div").classes("st-sep")
            self._undo = self._button("undo", "Undo", page.safely(page.undo), "undo")
            self._redo = self._button("redo", "Do again", page.safely(page.redo), "redo")
            ui.space()
            for group in GROUPS:
                self._layer(group)
            ui.element("div").classes("st-sep")
            for preset, icon, tip in _VIEWS:
                self._button(icon, tip, lambda p=preset: page.view.look(p), f"view-{preset}")
            self._two = self._button(
                "vertical_split",
                "Two views: outside and inside (2)",
                self.toggle_layout,
                "two-views",
            )
            self._button("photo_camera", "Save a picture of this view", self._picture, "picture")
            self._button("help_outline", "Keys and gestures (?)", show_shortcuts, "help")

    def _button(self, icon: str, tip: str, action: object, mark: str) -> ui.button:
        button = ui.button(icon=icon, on_click=action)  # pyright: ignore[reportArgumentType]
        button.props(f"flat round dense size=sm color=grey-4 data-mark={mark}").tooltip(tip)
        return button

    def _layer(self, group: str) -> None:
        with ui.element("div").style("width:92px;padding:0 6px"):
            ui.label(group.capitalize()).style("font-size:11px;line-height:12px;color:var(--dim)")
            slider = ui.slider(min=0.0, max=1.0, step=0.05, value=self.page.opacity[group])
            slider.props("dense").style("height:14px").props(f"data-mark=layer-{group}")
            slider.tooltip(f"How solid: {group}")

            def changed(event: ValueChangeEventArguments[Any], group: str = group) -> None:
                if self.page.opacity[group] != event.value:
                    solid = finite_number(event.value, f"slider {group}")
                    self.page.show(**{group: min(max(solid, 0.0), 1.0)})

            slider.on_value_change(self.page.safely(changed))
            self._sliders[group] = slider

    def _picture(self) -> None:
        self.page.view.picture(f"{self.page.shop.document.keeper.path.stem}.png")

    def toggle_layout(self) -> None:
        """Change between one view and two."""
        self.layout = "one" if self.layout == "two" else "two"
        self._two.props(f"color={'primary' if self.layout == 'two' else 'grey-4'}")
        self.page.view.set(layout=self.layout)
        self.page.want()

    def follow(self) -> None:
        """Show the opacities that are set."""
        for group, slider in self._sliders.items():
            slider.set_value(self.page.opacity[group])

    def refresh(self, what: str) -> None:
        """Follow a change."""
        if what != "document":
            return
        document = self.page.shop.document
        self._file.set_text(document.keeper.path.name)
        self._file.props(f'title="{document.keeper.path}"')
        kept = document.keeper.path.is_file()
        self._kept.set_text("kept" if kept else "not changed yet")
        self._undo.set_enabled(bool(document.undo_label))
        self._redo.set_enabled(bool(document.redo_label))
