"""What every panel of the page is."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nicegui import ui

from risorius.errors import ParameterError
from risorius.studio.stated import Message
from risorius.studio.subject import Subject
from risorius.studio.workshop import Workshop

if TYPE_CHECKING:
    from risorius.studio.page import Page

__all__ = ["Panel", "group", "heading"]


class Panel:
    """A panel: builds its elements once, follows what changes, takes the pointer's messages.

    Parameters
    ----------
    page : Page
    """

    name = ""
    icon = ""
    hint = ""
    drops: tuple[str, ...] = ()
    """Endings of files that `box` takes wherever they are dropped."""
    box: ui.upload | None = None

    def __init__(self, page: Page) -> None:
        self.page = page
        self.shop: Workshop = page.shop

    @property
    def subject(self) -> Subject:
        """The face at hand.

        Raises
        ------
        ParameterError
            If it is still being built.
        """
        if self.shop.subject is None:
            raise ParameterError("face: still being built; a moment")
        return self.shop.subject

    def build(self) -> None:
        """Make the elements."""

    def refresh(self, what: str) -> None:
        """Follow a change; see `Workshop.tell`."""

    def enter(self) -> None:
        """Become the panel in front."""

    def leave(self) -> None:
        """Give way to another panel."""

    def take(self, event: str, message: Message) -> None:
        """Take a message of the viewport while in front."""

    def clear_box(self) -> None:
        """Take what has arrived from the list of the box; what is under way goes on."""
        if self.box is not None:
            self.box.run_method("removeUploadedFiles")

    def key(self, key: str) -> bool:
        """Take a key while in front; tell whether it meant something."""
        return False


def heading(text: str, help_text: str = "") -> None:
    """Place the title of a panel and a sentence about it."""
    ui.label(text).classes("st-title")
    if help_text:
        ui.label(help_text).classes("st-help")


def group(title: str) -> ui.column:
    """Place a framed group with a small title; use it as a context."""
    frame = ui.column().classes("st-group")
    with frame:
        ui.label(title).classes("st-head")
    return frame
