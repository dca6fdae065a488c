"""The chosen muscle: its slider, its numbers and words, and handles on its points."""

from __future__ import annotations

from collections.abc import Callable, Generator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from nicegui import ui
from nicegui.events import GenericEventArguments, ValueChangeEventArguments

from risorius.errors import ParameterError, RisoriusError
from risorius.io.json_fields import Fields, finite_number
from risorius.studio.drawing.craft import Choice, Number, Traits
from risorius.studio.panels.contraction import ContractionSlider
from risorius.studio.places import place_of
from risorius.studio.regions import title_of
from risorius.studio.stated import Message
from risorius.studio.work import Work

if TYPE_CHECKING:
    from risorius.studio.panels.muscles import MusclePanel

__all__ = ["MuscleEditor"]


class MuscleEditor:
    """What can be changed of one muscle, as its craft says.

    Parameters
    ----------
    panel : MusclePanel
    """

    def __init__(self, panel: MusclePanel) -> None:
        self.panel = panel
        self.shop, self.page = panel.shop, panel.page
        self._shown: object = None
        self._slider: ContractionSlider | None = None

    def build(self) -> None:
        """Make the elements."""
        self._frame = ui.column().classes("st-group").props("data-mark=editor")
        self._frame.set_visibility(False)

    @property
    def _name(self) -> str:
        return self.shop.show.selected

    # -- elements ---------------------------------------------------------------------------

    def fill(self) -> None:
        """Show the chosen muscle, if it has changed."""
        name, craft = self._name, self.panel.kept
        own = bool(name) and bool(craft.own_name(name))
        traits = craft.traits(name) if own else Traits(name)
        known = frozenset(each.name for each in self.shop.controls)
        state = (name, own, traits, craft.controls(name), known)
        if state == self._shown:
            return
        self._shown = state
        self._frame.clear()
        self._slider = None
        self._frame.set_visibility(bool(name))
        if not name:
            return
        with self._frame:
            ui.label(title_of(traits.name)).classes("st-title")
            self._contraction(craft.controls(name))
            self._of_traits(traits)
            if own:
                self.panel.action("Delete it", "delete", lambda: self.panel.delete(name))

    def _contraction(self, controls: tuple[str, ...]) -> None:
        keep = f"Contract {title_of(self._name)}"
        slider = ContractionSlider(self.panel, "contract", keep=keep)
        slider.take(controls)
        self._slider = slider
        if not slider.controls:
            ui.label("Passive: it carries others and does not contract.").classes("st-help")

    def _of_traits(self, traits: Traits) -> None:
        safely = self.page.safely
        if traits.can_rename:
            entry = ui.input("name", value=traits.name).props("dense").style("width:100%")
            entry.props("data-mark=muscle-name")
            for event in ("blur", "keydown.enter"):
                entry.on(event, safely(lambda _: self._rename(traits, str(entry.value or ""))))
        with ui.row().style("gap:4px;align-items:center"):
            if traits.layer is not None:
                ui.label(f"layer {traits.layer}").classes("st-name").style("width:70px")
                for icon, step, tip in (
                    ("remove", -1, "deeper"),
                    ("add", 1, "nearer to the skin"),
                ):
                    layer = traits.layer + step
                    button = ui.button(icon=icon, on_click=safely(lambda n=layer: self._layer(n)))
                    button.props(f'flat round dense size=sm title="{tip}"')
            if traits.mirror is not None:
                switch = ui.switch("mirrored", value=traits.mirror).props("dense")
                switch.props("data-mark=mirrored")
                switch.on_value_change(safely(lambda e: self._set_mirror(traits, bool(e.value))))
        for choice in traits.choices:
            self._choice(choice)
        for number in traits.numbers:
            self._number(number)
        if traits.words:
            ui.label(traits.words).classes("st-help")

    def _choice(self, choice: Choice) -> None:
        with ui.element("div").classes("st-row two"):
            ui.label(title_of(choice.key)).classes("st-name")
            toggle = ui.toggle(list(choice.options), value=choice.value).props("dense no-caps")
            toggle.props(f"data-mark=choice-{_slug(choice.key)}").style("grid-column:span 2")

            def chosen(event: ValueChangeEventArguments[Any]) -> None:
                self._change(
                    choice.key,
                    lambda: self.panel.kept.with_choice(self._name, choice.key, str(event.value)),
                )

            toggle.on_value_change(self.page.safely(chosen))

    def _number(self, number: Number) -> None:
        key, value = number.key, number.value
        with ui.element("div").classes("st-row"):
            ui.label(title_of(key)).classes("st-name")
            step = number.step or (number.high - number.low) / 200.0
            slider = ui.slider(min=number.low, max=max(number.high, value), step=step, value=value)
            shown = ui.label(f"{value:.3g}").classes("st-number")
            slider.props("dense").props(f"data-mark=number-{_slug(key)}")

            def changed(event: ValueChangeEventArguments[Any]) -> None:
                shown.set_text(f"{finite_number(event.value, 'slider'):.3g}")

            def kept(event: GenericEventArguments) -> None:
                there = finite_number(event.args, "slider")
                self._change(key, lambda: self.panel.kept.with_number(self._name, key, there))

            slider.on_value_change(self.page.safely(changed))
            slider.on("change", self.page.safely(kept))

    def follow(self) -> None:
        """Show the contraction of the pose."""
        if self._slider is not None:
            self._slider.follow()

    # -- changes ----------------------------------------------------------------------------

    @contextmanager
    def _or_as_before(self) -> Generator[None]:
        """Show what is still there, where a change is refused."""
        try:
            self.panel.require_unlocked(self._name)
            yield
        except RisoriusError:
            self._shown = None
            self.panel.drawing.forget_draft()
            self.fill()
            self.panel.feedback.fill()
            self.panel.show_overlay()
            raise

    def _change(self, what: str, make: Callable[[], Work]) -> None:
        with self._or_as_before():
            self.shop.change(f"{title_of(self._name)}: {title_of(what)}", make())

    def _set_mirror(self, traits: Traits, mirror: bool) -> None:
        if mirror != traits.mirror:
            self._exchange("mirrored", lambda: self.panel.kept.mirrored(self._name, mirror=mirror))

    def _rename(self, traits: Traits, name: str) -> None:
        if name != traits.name:
            self._exchange("rename", lambda: self.panel.kept.renamed(self._name, name))

    def _exchange(self, what: str, make: Callable[[], tuple[Work, str]]) -> None:
        """Make a change after which the muscle's body is called otherwise."""
        with self._or_as_before():
            work, name = make()
        label = f"{title_of(self._name)}: {what}"
        self.shop.present(selected="")
        self.shop.change(label, work)
        self.panel.select(name)

    def _layer(self, layer: int) -> None:
        self._change("layer", lambda: self.panel.kept.in_layer(self._name, layer))

    # -- handles ----------------------------------------------------------------------------

    def handles(self) -> list[dict[str, Any]]:
        """Return the points of the chosen muscle as the viewport shows them."""
        craft = self.panel.craft
        if not self._name or not craft.is_ready or not craft.own_name(self._name):
            return []
        return [handle.to_page() for handle in craft.handles(self._name)]

    def take(self, event: str, message: Message) -> None:
        """Move, insert or delete a point."""
        name, stage = self._name, self.shop.stage
        key = Fields(message, "page").text("id")
        if not name or stage is None:
            return
        craft = self.panel.kept
        if event == "handle":
            if message.get("shift") is True:
                self._change("delete point", lambda: craft.without_point(name, key))
            elif message.get("alt") is True:
                self._change("insert point", lambda: craft.with_point(name, key))
            return
        place = place_of(message, stage)
        if event == "dragging":
            self._try(name, lambda: craft.moved(name, key, place))
        else:
            self._change("move point", lambda: craft.moved(name, key, place))

    def _try(self, name: str, make: Callable[[], Work]) -> None:
        """Show a change while it is dragged; what is refused is said and waits for the drop."""
        self.panel.require_unlocked(name)
        try:
            self.shop.try_out(make())
        except ParameterError as error:
            self.shop.draft_problem = str(error)
            self.shop.tell("draft")


def _slug(text: str) -> str:
    return text.lower().replace(" ", "-")
