"""The group that paints numbers on the skin."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from nicegui import ui
from nicegui.events import ValueChangeEventArguments

from risorius.studio.heat import HEATS
from risorius.studio.panel import group

if TYPE_CHECKING:
    from risorius.studio.page import Page

__all__ = ["HeatGroup"]

_WORDS = {
    "none": "",
    "displacement": "0 to 12 mm",
    "strain": "area unchanged to changed by 65 %",
    "influence": "of the selected muscle: none to largest",
}


class HeatGroup:
    """A choice of heat maps.

    Parameters
    ----------
    page : Page
    """

    def __init__(self, page: Page) -> None:
        self.page = page

    def build(self) -> None:
        """Make the elements."""
        with group("Paint on the skin"):
            choice = ui.toggle(list(HEATS), value="none", on_change=self._change)
            choice.props("dense no-caps flat size=sm").props("data-mark=heat")
            self._scale = ui.element("div").classes("st-scale")
            self._words = ui.label().classes("st-help")
            self._scale.set_visibility(False)

    def _change(self, event: ValueChangeEventArguments[Any]) -> None:
        kind = str(event.value)
        self._scale.set_visibility(kind != "none")
        self._words.set_text(_WORDS.get(kind, ""))
        self.page.shop.present(heat=kind if kind in HEATS else "none")
