"""One page: top bar, panels, viewport, hints, keys."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from functools import wraps
from inspect import isawaitable
from typing import Any

from nicegui import background_tasks, ui
from nicegui.events import GenericEventArguments, KeyEventArguments, ValueChangeEventArguments

from risorius.errors import FormatError, RisoriusError
from risorius.io.json_fields import Fields
from risorius.studio.bakery import Bakery
from risorius.studio.looks import ACCENT, CSS
from risorius.studio.panel import Panel
from risorius.studio.panels.catalogue import PANELS
from risorius.studio.scene import GROUPS
from risorius.studio.shortcuts import show_shortcuts
from risorius.studio.topbar import TopBar
from risorius.studio.viewport import Viewport
from risorius.studio.workshop import Workshop

__all__ = ["Page"]

_EVENTS = ("select", "place", "finish", "dragging", "dropped", "handle", "choose", "seek")
Handler = Callable[..., Awaitable[None] | None]


class Page:
    """The page of one browser tab.

    Parameters
    ----------
    shop : Workshop
    bakery : Bakery
    """

    def __init__(self, shop: Workshop, bakery: Bakery) -> None:
        self.shop = shop
        self.bakery = bakery
        self.client = ui.context.client
        self.opacity = {"skin": 1.0, "parts": 1.0, "skull": 0.0, "muscles": 0.0}
        self.hidden: set[str] = set()
        ui.colors(primary=ACCENT, dark="#1f2226", negative="#b9503f", positive="#5b8f68")
        ui.add_css(CSS)
        self.bar = TopBar(self)
        self.bar.build()
        self.panels = [panel(self) for panel in PANELS]
        self.active = self.panels[0]
        with ui.element("div").classes("st-body"):
            self._build_panels()
            with ui.element("div").classes("st-view"):
                self.view = Viewport(self.client.id)
                self.hint = ui.html("", sanitize=False).classes("st-hint")
                self.busy = ui.label("building the face …").classes("st-busy")
        for name in _EVENTS:
            self.view.on(name, self._event_handler(name))
        self.view.on("strange", self.safely(self._strange))
        ui.keyboard(on_key=self.on_key, ignore=["input", "select", "textarea"])
        shop.listeners.add(self.hear)
        self.client.on_delete(self._leave)
        self.say(self.active.hint)
        self.show()
        self._set_drops()
        for what in ("document", "face", "pose", "show"):
            self.hear(what)
        self.active.enter()
        if shop.document.notice:
            self.refuse(shop.document.notice)

    def _build_panels(self) -> None:
        with ui.element("div").classes("st-tabs"):
            self.tabs = ui.tabs(on_change=self._turn).props("vertical dense")
            with self.tabs:
                for panel in self.panels:
                    ui.tab(panel.name, icon=panel.icon).props(f"data-mark=tab-{panel.name.lower()}")
        with (
            ui.element("div").classes("st-panel"),
            ui.tab_panels(self.tabs, value=self.active.name, animated=False).props("keep-alive"),
        ):
            for panel in self.panels:
                with ui.tab_panel(panel.name), ui.column().classes("st-stack"):
                    panel.build()

    # -- what the panels use ----------------------------------------------------------------

    def safely(self, handler: Handler) -> Callable[..., Awaitable[None]]:
        """Return a handler that shows what is refused instead of failing."""

        @wraps(handler)  # whether it wants the event is told by its signature
        async def run(*arguments: Any) -> None:
            try:
                result = handler(*arguments)
                if isawaitable(result):
                    await result
            except (RisoriusError, ImportError) as error:
                self.refuse(str(error))

        return run

    def start(self, work: Callable[[], Awaitable[None]]) -> None:
        """Do something that takes time; what is refused is shown."""
        background_tasks.create(self.safely(work)())

    def refuse(self, sentence: str) -> None:
        """Show why something is not possible."""
        with self.client:
            ui.notify(sentence, type="negative", position="top", multi_line=True, timeout=7000)

    def tell(self, sentence: str) -> None:
        """Show what was done."""
        with self.client:
            ui.notify(sentence, position="bottom-right", timeout=2500, color="dark")

    def say(self, hint: str) -> None:
        """Show a hint at the foot of the viewport."""
        self.hint.set_content(hint)
        self.hint.set_visibility(bool(hint))

    def show(self, **opacity: float) -> None:
        """Set the opacity of groups and hand it to the viewport."""
        self.opacity.update(opacity)
        self.view.set(opacity=self.opacity, hidden=sorted(self.hidden))
        self.want()
        self.bar.follow()

    def want(self) -> None:
        """Tell the workshop which groups this page shows."""
        shown = {name for name, solid in self.opacity.items() if solid > 0.0}
        self.shop.want(self, GROUPS if self.bar.layout == "two" else shown | {"skin"})

    # -- events -----------------------------------------------------------------------------

    def hear(self, what: str) -> None:
        """Follow a change of the workshop."""
        with self.client:
            if what == "problem":
                self.refuse(self.shop.problem)
            if what in ("building", "face", "problem", "draft"):
                self.busy.set_visibility(what == "building")
            if what == "show":
                show = self.shop.show
                self.view.set(selected=show.selected, painted=show.heat != "none")
            self.bar.refresh(what)
            for panel in self.panels:
                panel.refresh(what)

    def _leave(self) -> None:
        self.shop.listeners.discard(self.hear)
        self.shop.want(self, ())

    def _turn(self, event: ValueChangeEventArguments[Any]) -> None:
        panel = next((each for each in self.panels if each.name == event.value), self.active)
        if panel is self.active:
            return
        self.active.leave()
        self.active = panel
        self.view.set(tool="look", layout=self.bar.layout)
        self.view.overlay()
        self.say(panel.hint)
        self._set_drops()
        panel.enter()

    def turn_to(self, panel: Panel) -> None:
        """Bring a panel to the front."""
        self.tabs.set_value(panel.name)

    def _set_drops(self) -> None:
        """Tell the viewport where dropped files go: what several take, to the one in front."""
        places: dict[str, str] = {}
        for panel in (*self.panels, self.active):
            if panel.box is not None:
                places |= dict.fromkeys(panel.drops, str(panel.box.props["url"]))
        self.view.set(drops=places)

    def _strange(self, event: GenericEventArguments) -> None:
        fields = Fields(event.args, "page")
        name = fields.text("name")[:60]
        if fields.integer("big"):
            raise FormatError(f"{name}: is larger than 256 MB; open it by the command line")
        raise FormatError(
            f"{name}: the studio takes heads (.obj .ply .stl .glb .gltf), landmarks (.json) and "
            "takes (.fap .csv .json)"
        )

    def _event_handler(self, name: str) -> Callable[..., Awaitable[None]]:
        def handle(event: GenericEventArguments) -> None:
            if not isinstance(event.args, dict):
                raise FormatError(f"page: {name}: expected an object")
            self.active.take(name, event.args)

        return self.safely(handle)

    async def on_key(self, event: KeyEventArguments) -> None:
        """Take a key."""
        if not event.action.keydown:
            return
        key = str(event.key.name)
        control = event.modifiers.ctrl or event.modifiers.meta
        if control:
            key = f"ctrl+{'shift+' if event.modifiers.shift else ''}{key.lower()}"
        actions: dict[str, Handler] = {
            "ctrl+z": self.undo,
            "ctrl+shift+z": self.redo,
            "ctrl+y": self.redo,
            "?": show_shortcuts,
            "f": lambda: self.view.look("front"),
            "t": lambda: self.view.look("three_quarter"),
            "l": lambda: self.view.look("left"),
            "r": lambda: self.view.look("right"),
            "2": self.bar.toggle_layout,
        }
        if self.active.key(key):
            return
        if key in actions:
            await self.safely(actions[key])()

    def undo(self) -> None:
        """Undo one step."""
        self.tell(f"undone: {self.shop.undo()}")

    def redo(self) -> None:
        """Do a step again."""
        self.tell(f"done again: {self.shop.redo()}")
