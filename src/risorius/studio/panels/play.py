"""The panel that plays: a timeline for streams of any standard and for emotions."""

from __future__ import annotations

import asyncio
import time
from pathlib import Path
from typing import Any

from nicegui import ui
from nicegui.events import UploadEventArguments, ValueChangeEventArguments

from risorius.controls.presets import EMOTIONS
from risorius.controls.shape_sets import SHAPE_SETS
from risorius.controls.stream import Stream
from risorius.errors import FormatError, ParameterError
from risorius.io.motion import stream_endings
from risorius.playback.emotion_timing import emotion_stream
from risorius.studio.guard import inside
from risorius.studio.jobs import Job
from risorius.studio.panel import Panel, group, heading
from risorius.studio.panels.progress import Progress
from risorius.studio.take import Take, open_take
from risorius.studio.uploads import keep_upload

__all__ = ["PlayPanel"]

_TICK = 1.0 / 25.0
_SPEEDS = {0.25: "¼", 0.5: "½", 1.0: "1", 2.0: "2"}


class PlayPanel(Panel):
    """Streams on a timeline."""

    name = "Play"
    icon = "play_circle"
    hint = "Drop a <b>.fap</b>, Live Link <b>.csv</b> or <b>.json</b>, or play an emotion."

    def build(self) -> None:
        """Make the elements."""
        self.take_: Take | None = None
        self.now = 0.0
        self.is_playing = False
        self._task: asyncio.Task[None] | None = None
        heading("Play", "Motion of any standard moves the face; drag along the timeline.")
        with group("Motion"):
            upload = ui.upload(
                label="drop a take here, or click +", auto_upload=True, max_file_size=64 << 20,
                on_upload=self.page.safely(self._upload),
            )  # fmt: skip
            upload.props("flat bordered dense accept='.fap,.csv,.json'").style("width:100%")
            upload.props("data-mark=take-upload")
            self._files = ui.select([], label="in the project's folder").props("dense")
            self._files.style("width:100%").props("data-mark=take-file")
            self._files.on_value_change(self.page.safely(self._choose))
            with ui.row().style("gap:6px"):
                for name in EMOTIONS:
                    ui.button(
                        name, on_click=self.page.safely(lambda n=name: self._emotion(n))
                    ).props("flat dense no-caps").classes("st-chip").props(f"data-mark=play-{name}")
        with group("Timeline") as self._line:
            self._title = ui.label().classes("st-name").props("data-mark=take-title")
            self._curve = ui.html("", sanitize=False).style("width:100%;height:54px")
            self._slider = ui.slider(min=0.0, max=1.0, step=0.01, value=0.0).props("dense")
            self._slider.props("data-mark=timeline")
            self._slider.on(
                "update:model-value", self.page.safely(lambda e: self._scrub(e.args)), throttle=0.03
            )
            with ui.row().style("gap:6px;align-items:center"):
                self._button = ui.button(icon="play_arrow", on_click=self._toggle)
                self._button.props("flat round dense").props("data-mark=play")
                self._clock = ui.label("0.00 s").classes("st-number").props("data-mark=clock")
                self._speed = ui.toggle(_SPEEDS, value=1.0).props("dense flat size=sm")
                self._loop = ui.switch("loop", value=True).props("dense")
            with ui.row().style("gap:6px"):
                for text, ending in (("Record GLB", ".glb"), ("Record film", ".mp4")):
                    ui.button(
                        text, icon="fiber_manual_record",
                        on_click=self.page.safely(lambda e=ending: self._record(e)),
                    ).props("flat dense no-caps").classes("st-chip")  # fmt: skip
        self._line.set_visibility(False)
        self.progress = Progress(self.page)

    def enter(self) -> None:
        """Look for takes in the folder."""
        folder, own = self.shop.document.keeper.folder, self.shop.document.keeper.path.name
        names = sorted(
            file.name
            for file in folder.iterdir()
            if file.suffix.lower() in stream_endings()
            and file.is_file()
            and file.name != own
            and not file.name.startswith(".")
        )
        self._files.set_options(names)

    def leave(self) -> None:
        """Stop, and show the pose again."""
        self._pause()
        if self.shop.show.played is not None:
            self.shop.present(played=None)

    # -- takes ------------------------------------------------------------------------------

    async def _upload(self, event: UploadEventArguments) -> None:
        folder, data = self.shop.document.keeper.folder, await event.file.read()
        path = keep_upload(folder, event.file.name, data, endings=stream_endings())
        self.enter()
        await self._open(path)

    async def _choose(self, event: ValueChangeEventArguments[Any]) -> None:
        if event.value:
            folder = self.shop.document.keeper.folder
            await self._open(inside(folder, str(event.value), endings=stream_endings()))

    async def _emotion(self, name: str) -> None:
        await self._open(emotion_stream({name: 1.0}))

    async def _open(self, source: Path | Stream) -> None:
        self._pause()

        def work(job: Job) -> Take:
            rig = self.shop.rig(SHAPE_SETS, job)
            return open_take(source, rig, self.subject.presets, job)

        take = await self.progress.run("opening the take", work)
        if take is None:
            return
        self.take_ = take
        name = source.name if isinstance(source, Path) else source.source
        self._title.set_text(f"{name}: {take.duration:.2f} s at {take.rate:g} frames per second")
        self._slider._props["max"] = max(take.duration, 0.01)
        self._slider.update()
        self._curve.set_content(_svg(take))
        self._line.set_visibility(True)
        self._show(0.0)
        missing = take.player.unmatched
        if missing:
            self.page.tell(f"not played: {', '.join(list(missing)[:6])}")

    # -- time -------------------------------------------------------------------------------

    def _require(self) -> Take:
        if self.take_ is None:
            raise ParameterError("play: open a take first")
        return self.take_

    def _show(self, now: float, *, slider: bool = True) -> None:
        take = self._require()
        self.now = min(max(now, 0.0), take.duration)
        self.shop.present(played=take.positions(self.now))
        self._clock.set_text(f"{self.now:.2f} s")
        if slider:
            self._slider.set_value(self.now)

    def _scrub(self, value: object) -> None:
        if not isinstance(value, int | float):
            raise FormatError("timeline: expected a number")
        self._pause()
        self._show(float(value), slider=False)

    def _toggle(self) -> None:
        if self.is_playing:
            self._pause()
        elif self.take_ is not None:
            self.is_playing = True
            self._button.props("icon=pause")
            self._task = asyncio.create_task(self._run())

    def _pause(self) -> None:
        self.is_playing = False
        self._button.props("icon=play_arrow")
        if self._task is not None:
            self._task.cancel()
            self._task = None

    async def _run(self) -> None:
        take, last = self._require(), time.monotonic()
        while self.is_playing:
            await asyncio.sleep(_TICK)
            moment = time.monotonic()
            now = self.now + (moment - last) * float(self._speed.value or 1.0)
            last = moment
            if now > take.duration:
                if not self._loop.value:
                    self._show(take.duration)
                    self._pause()
                    return
                now = 0.0
            self._show(now)

    async def _record(self, ending: str) -> None:
        take = self._require()
        stem = self.shop.document.keeper.path.stem
        path = inside(self.shop.document.keeper.folder, f"{stem} take{ending}")

        def work(job: Job) -> Path:
            take.record(path, job)
            return path

        written = await self.progress.run("recording", work)
        if written is not None:
            ui.download.file(written)
            self.page.tell(f"wrote {written.name}")

    def key(self, key: str) -> bool:
        """Take a key."""
        if key != " " or self.take_ is None:
            return False
        self._toggle()
        return True


def _svg(take: Take) -> str:
    curve = take.curve()
    count = max(len(curve) - 1, 1)
    points = " ".join(f"{300 * k / count:.1f},{50 - 44 * v:.1f}" for k, v in enumerate(curve))
    return (
        '<svg viewBox="0 0 300 54" preserveAspectRatio="none" style="width:100%;height:54px">'
        '<rect width="300" height="54" fill="#191c1f"/>'
        f'<polyline points="{points}" fill="none" stroke="#e08a63" stroke-width="1.4" '
        'vector-effect="non-scaling-stroke"/></svg>'
    )
