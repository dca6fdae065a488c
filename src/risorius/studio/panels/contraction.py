"""A slider that contracts one muscle on all its sides."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from nicegui import ui
from nicegui.events import GenericEventArguments

from risorius.io.json_fields import finite_number

if TYPE_CHECKING:
    from risorius.studio.panels.muscles import MusclePanel

__all__ = ["ContractionSlider"]


class ContractionSlider:
    """The slider; hidden while there is nothing to contract.

    Parameters
    ----------
    panel : MusclePanel
    mark : str
        By which tests find it.
    keep : str
        What a finished move is called in the history; empty where it is not kept.
    """

    def __init__(self, panel: MusclePanel, mark: str, *, keep: str = "") -> None:
        self.panel = panel
        self.controls: tuple[str, ...] = ()
        self._keep_as = keep
        safely = panel.page.safely
        with ui.element("div").classes("st-row") as self._row:
            ui.label("contract").style("color:var(--accent)")
            self._slider = ui.slider(min=0.0, max=1.0, step=0.01, value=0.0).props("dense")
            self._slider.props(f"data-mark={mark}")
            self._slider.on("update:model-value", safely(self._move), throttle=0.03)
            self._slider.on("change", safely(self._keep))
        self._row.set_visibility(False)

    def take(self, controls: Sequence[str]) -> None:
        """Move these controls from now on, those of them that the face has."""
        known = {each.name for each in self.panel.shop.controls}
        self.controls = tuple(name for name in dict.fromkeys(controls) if name in known)
        self._row.set_visibility(bool(self.controls))
        self.follow()

    def follow(self) -> None:
        """Show the contraction of the pose."""
        if self.controls:
            self._slider.set_value(self.panel.shop.pose.get(self.controls[0], 0.0))

    def _move(self, event: GenericEventArguments) -> None:
        value = finite_number(event.args, "slider")
        self.panel.shop.set_pose(dict.fromkeys(self.controls, value))

    def _keep(self, event: GenericEventArguments) -> None:
        self._move(event)
        if self._keep_as:
            self.panel.shop.keep_pose(self._keep_as, gesture="contract")
