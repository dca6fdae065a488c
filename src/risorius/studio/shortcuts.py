"""Keys and gestures, and the page that lists them."""

from __future__ import annotations

from nicegui import ui

__all__ = ["SHORTCUTS", "show_shortcuts"]

SHORTCUTS = {
    "Look around": (
        ("drag", "turn"),
        ("right drag", "shift"),
        ("wheel", "nearer, farther"),
        ("F T L R", "front, three-quarter, left, right"),
        ("2", "two views: outside and inside"),
    ),
    "Draw muscles": (
        ("click", "place a point on bone, muscle or skin"),
        ("Enter, double click", "finish the line or the row"),
        ("Enter once more", "keep the muscle"),
        ("Backspace", "take the last point back"),
        ("Escape", "stop drawing"),
        ("drag a point", "move it on the surface"),
        ("Shift + click a point", "delete it"),
        ("Alt + click a point", "insert one behind it"),
    ),
    "Everywhere": (
        ("Ctrl Z, Ctrl Shift Z", "undo, do again"),
        ("Space", "play, pause (Play)"),
        ("1 - 9", "choose a face (Tune)"),
        ("?", "this page"),
    ),
}
"""What can be done by key and pointer, by chapter."""


def show_shortcuts() -> None:
    """Open the page that lists them."""
    with ui.dialog() as dialog, ui.card().style("min-width:430px;gap:1px"):
        for chapter, rows in SHORTCUTS.items():
            ui.label(chapter).classes("st-head")
            for keys, meaning in rows:
                with ui.element("div").classes("st-row").style("grid-template-columns:170px 1fr"):
                    ui.label(keys).style("color:var(--accent)")
                    ui.label(meaning)
        ui.button("Close", on_click=dialog.close).props("flat dense").classes("st-act")
    dialog.open()
