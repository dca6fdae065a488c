"""What the page shows of a spring muscle: grid, influence, jaw, merges, errors."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nicegui import ui

from risorius.studio.drawing.spring_feedback import SWITCHES, Feedback, feedback_of
from risorius.studio.panel import group

if TYPE_CHECKING:
    from risorius.studio.panels.muscles import MusclePanel

__all__ = ["MuscleFeedback"]

_ON = ("grid", "merged", "errors")


class MuscleFeedback:
    """Switches, and sentences about the muscle that is drawn or chosen.

    Parameters
    ----------
    panel : MusclePanel
    """

    def __init__(self, panel: MusclePanel) -> None:
        self.panel = panel
        self.shown = Feedback()
        self._switches: dict[str, ui.checkbox] = {}

    def build(self) -> None:
        """Make the elements."""
        with group("What is shown of it") as self._group:
            with ui.row().style("gap:4px 14px"):
                for key, (text, tip) in SWITCHES.items():
                    switch = ui.checkbox(text, value=key in _ON).props("dense size=xs")
                    switch.props(f"data-mark=feedback-{key}").tooltip(tip)
                    switch.on_value_change(self.panel.page.safely(lambda _: self._changed()))
                    self._switches[key] = switch
            self._facts = ui.label().classes("st-help").props("data-mark=feedback-facts")
            self._findings = ui.column().style("gap:2px").props("data-mark=feedback-findings")
        self._group.set_visibility(False)

    @property
    def _on(self) -> set[str]:
        return {key for key, switch in self._switches.items() if switch.value}

    def _changed(self) -> None:
        self.fill()
        self.panel.show_overlay()

    def fill(self) -> None:
        """Look at the muscle that is drawn or chosen."""
        panel, shop = self.panel, self.panel.shop
        name, subject = panel.focus, shop.subject
        face = subject.spring_face if subject is not None else None
        on = self._on
        here = panel.is_in_front and face is not None and bool(name)
        self.shown = feedback_of(face, name, shop.pose, on) if here and face else Feedback()
        self._group.set_visibility(shop.document.work.project.method == "springs" and bool(name))
        self._facts.set_text(self.shown.facts)
        sentences = [shop.draft_problem] if shop.draft_problem else self.shown.findings
        self._findings.clear()
        with self._findings:
            for sentence in sentences:
                ui.label(sentence).classes("st-warn")
            if here and "errors" in on and self.shown.facts and not sentences:
                ui.label("Everything fits.").classes("st-help")
        painted = name if here and "influenced" in on and self.shown.facts else ""
        if panel.is_in_front and painted != shop.show.influenced:
            shop.present(influenced=painted)

    def leave(self) -> None:
        """Give the skin its colours back."""
        self.shown = Feedback()
        if self.panel.shop.show.influenced:
            self.panel.shop.present(influenced="")
