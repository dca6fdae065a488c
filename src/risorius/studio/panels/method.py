"""The choice of the method that poses the face."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from nicegui import ui
from nicegui.events import ValueChangeEventArguments

from risorius.studio.drawing.catalogue import CRAFTS
from risorius.studio.panel import Panel

__all__ = ["MethodToggle"]


class MethodToggle:
    """Layers, springs or vectors.

    Parameters
    ----------
    panel : Panel
    mark : str
        By which tests find it.
    """

    def __init__(self, panel: Panel, mark: str) -> None:
        self._shop = panel.shop
        self._seen = self._shop.document.work.project.method
        words = {method: craft.title for method, craft in CRAFTS.items()}
        self._toggle = ui.toggle(words, value=self._seen)
        self._toggle.props("dense no-caps").props(f"data-mark={mark}")
        self._toggle.on_value_change(panel.page.safely(self._set))

    def follow(self) -> bool:
        """Show the method of the work; tell whether it is another one."""
        method = self._shop.document.work.project.method
        changed = self._toggle.value != method or self._seen != method
        self._seen = method
        self._toggle.set_value(method)
        return changed

    def _set(self, event: ValueChangeEventArguments[Any]) -> None:
        shop, method = self._shop, str(event.value)
        work = shop.document.work
        if method == work.project.method:
            return
        shop.present(selected="")
        project = replace(work.project, method=method, parameters={})
        shop.change(f"Method {CRAFTS[method].title}", replace(work, project=project))
