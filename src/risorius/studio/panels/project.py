"""The panel of the project: head, profile, history, file."""

from __future__ import annotations

import asyncio
from dataclasses import replace
from pathlib import Path
from typing import Any

from nicegui import ui
from nicegui.events import UploadEventArguments, ValueChangeEventArguments

from risorius import _formats
from risorius._check import one_of
from risorius.anatomy.mechanics import Mechanics
from risorius.errors import FormatError, RisoriusError
from risorius.head.head import Head
from risorius.project import PROFILES, Project
from risorius.studio.panel import Panel, group, heading
from risorius.studio.panels.method import MethodToggle
from risorius.studio.uploads import trying_upload
from risorius.studio.work import Work, work_of

__all__ = ["ProjectPanel"]

_HEADS = (".obj", ".ply", ".stl", ".glb", ".gltf")
_ALL = (*_HEADS, ".json")


class ProjectPanel(Panel):
    """What the work belongs to."""

    name = "Project"
    icon = "folder_open"
    hint = "Everything is kept at once in one text file; every step can be undone."

    drops = _ALL

    def build(self) -> None:
        """Make the elements."""
        heading("Project")
        with group("Head"):
            self._head = ui.label().props("data-mark=head-name")
            ui.label(
                "Drop a head (OBJ, PLY, STL, GLB) and its landmarks, named like it: head.obj and "
                "head.landmarks.json."
            ).classes("st-help")
            self.box = ui.upload(
                label="drop a head here, or click +", auto_upload=True, multiple=True,
                max_file_size=256 << 20, on_upload=self.page.safely(self._upload),
            )  # fmt: skip
            self.box.props(f"flat bordered dense accept='{','.join(_ALL)}'").style("width:100%")
            self.box.props("data-mark=head-upload")
            self._builtin = ui.button(
                "Built-in head", icon="face", on_click=self.page.safely(self._take_builtin)
            )
            self._builtin.props("flat dense no-caps").classes("st-chip")
        with group("Method"):
            self._method = MethodToggle(self, "project-method")
            self._profile = ui.toggle(list(PROFILES), value="improved").props("dense no-caps")
            self._profile.on_value_change(self.page.safely(self._set_profile))
        with group("History"):
            self._notice = ui.label().classes("st-warn").props("data-mark=history-notice")
            self._steps = ui.column().style("gap:0;width:100%")
        with group("File"):
            self._path = ui.label().classes("st-help").style("word-break:break-all")
            ui.button("Download the project", icon="download", on_click=self._download).props(
                "flat dense no-caps"
            ).classes("st-chip")

    def refresh(self, what: str) -> None:
        """Follow a change."""
        if what != "document":
            return
        document = self.shop.document
        project = document.work.project
        self._head.set_text("built-in head" if project.head is None else project.head.name)
        self._method.follow()
        self._profile.set_value(project.profile)
        self._path.set_text(str(document.keeper.path))
        self._notice.set_text(document.notice)
        self._notice.set_visibility(bool(document.notice))
        labels, place = document.history
        self._steps.clear()
        with self._steps:
            for number, label in reversed(list(enumerate(labels))[-30:]):
                mark = "▸ " if number == place else ""
                style = "color:var(--accent)" if number == place else ""
                ui.label(f"{mark}{label}").classes("st-help").style(style)

    def _download(self) -> None:
        path = self.shop.document.keeper.path
        if not path.is_file():
            self.shop.document.keep()
        ui.download.file(path)

    def _set_profile(self, event: ValueChangeEventArguments[Any]) -> None:
        work = self.shop.document.work
        if event.value != work.project.profile:
            one_of("profile", event.value, PROFILES)
            project = replace(work.project, profile=str(event.value))
            self.shop.change(f"Profile {event.value}", replace(work, project=project))

    async def _take_builtin(self) -> None:
        await self._take_head(None, None)

    async def _upload(self, event: UploadEventArguments) -> None:
        folder, data = self.shop.document.keeper.folder, await event.file.read()
        self.clear_box()
        self.page.turn_to(self)
        with trying_upload(folder, event.file.name, data, endings=_ALL) as path:
            if path.suffix.lower() == ".json":
                await self._take_landmarks(path)
            else:
                await self._try_head(path)

    async def _take_landmarks(self, path: Path) -> None:
        work = self.shop.document.work
        name = path.name.removesuffix(".json").removesuffix(".landmarks")
        heads = [path.with_name(f"{name}{ending}") for ending in _HEADS]
        head = next((each for each in heads if each.is_file()), None)
        if head is not None and head != work.project.head:
            await self._try_head(head, path)
            return
        own = "builtin" if work.project.head is None else work.project.head.stem
        if path.name.endswith(".landmarks.json") and name != own:
            self.page.say(f"<b>{path.name}</b> is here. Now drop its head, <b>{name}.obj</b>.")
            return
        specs = _formats.read_landmarks(path)
        self.shop.change("Landmarks from a file", replace(work, landmarks=dict(specs)))

    async def _try_head(self, path: Path, landmarks: Path | None = None) -> None:
        beside = path.with_suffix(".landmarks.json")
        marks = landmarks or (beside if beside.is_file() else None)
        if marks is None and not _formats.read_head(path)[1]:
            self.page.say(
                f"<b>{path.name}</b> is here. Now drop its landmarks, <b>{beside.name}</b>."
            )
            return
        await self._take_head(path, marks)

    async def _take_head(self, path: Path | None, landmarks: Path | None) -> None:
        """Take another head after the same checks as on the command line."""

        def of(project: Project) -> Project:
            return replace(project, head=path, landmarks=landmarks, unit=None, axes=None, parts={})

        wanted = of(self.shop.document.work.project)

        def checked() -> Work:
            work = work_of(wanted)
            if path is not None:
                mesh, _ = _formats.read_head(path)
                Mechanics.build(Head.from_mesh(mesh, work.landmarks, options=wanted.options))
            return work

        try:
            fresh = await asyncio.to_thread(checked)
        except RisoriusError as error:
            raise FormatError(f"{error}; the head before stays") from error
        now = self.shop.document.work
        work = replace(now, project=of(now.project), landmarks=fresh.landmarks, pose={})
        self.page.say(self.hint)
        self.page.view.look("three_quarter")
        self.shop.change("Another head", work)
