"""The list of muscles by layer: choose, hide, solo, lock, delete."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nicegui import ui

from risorius.studio.regions import title_of

if TYPE_CHECKING:
    from risorius.studio.panels.muscles import MusclePanel

__all__ = ["MuscleList"]


class MuscleList:
    """Muscles of the face, deep before superficial.

    Parameters
    ----------
    panel : MusclePanel
    """

    def __init__(self, panel: MusclePanel) -> None:
        self.panel = panel
        self._shown: object = None

    def build(self) -> None:
        """Make the elements."""
        self._frame = ui.column().classes("st-group").style("gap:2px")
        self._frame.props("data-mark=muscle-list")

    def fill(self) -> None:
        """Show the muscles there are, if they have changed."""
        page = self.panel.page
        entries = self.panel.kept.entries()
        state = (
            tuple(entries), self.panel.shop.show.selected, frozenset(page.hidden),
            frozenset(self.panel.locked),
        )  # fmt: skip
        if state == self._shown:
            return
        self._shown = state
        self._frame.clear()
        with self._frame:
            title = ""
            for entry in entries:
                if entry.group != title:
                    title = entry.group
                    ui.label(title).classes("st-head")
                self._row(entry.name, entry.bodies)
            if not entries:
                ui.label("No muscles to show.").classes("st-help")

    def _row(self, name: str, bodies: tuple[str, ...]) -> None:
        panel, page = self.panel, self.panel.page
        hidden = bodies[0] in page.hidden
        chosen = panel.shop.show.selected in (*bodies, name)
        classes = f"st-item {'on' if chosen else ''} {'off' if hidden else ''}"
        with ui.element("div").classes(classes).props(f"data-mark=muscle-{name}") as row:
            row.on("click", page.safely(lambda _: panel.select(bodies[0])))
            ui.label(title_of(name)).classes("st-name")
            locked = name in panel.locked
            for icon, tip, act in (
                ("visibility_off" if hidden else "visibility", "Hide or show", self._hide),
                ("filter_center_focus", "Only this one", self._solo),
                ("lock" if locked else "lock_open", "Lock", self._lock),
            ):
                button = ui.button(icon=icon).props(
                    f'flat round dense size=xs color=grey-6 title="{tip}"'
                )
                button.on("click.stop", page.safely(lambda _, a=act: a(name, bodies)))

    def _hide(self, _: str, bodies: tuple[str, ...]) -> None:
        hidden = self.panel.page.hidden
        if bodies[0] in hidden:
            hidden.difference_update(bodies)
        else:
            hidden.update(bodies)
        self._apply()

    def _solo(self, _: str, bodies: tuple[str, ...]) -> None:
        stage = self.panel.shop.stage
        names = {each.name for each in stage.meshes if each.group == "muscles"} if stage else set()
        others = names - set(bodies)
        page = self.panel.page
        page.hidden = set() if page.hidden == others else others
        self._apply()

    def _lock(self, name: str, _: tuple[str, ...]) -> None:
        self.panel.locked ^= {name}
        self.fill()

    def _apply(self) -> None:
        self.panel.page.show()
        self.fill()
