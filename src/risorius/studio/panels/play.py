"""The panel that plays: a timeline for streams of any standard and for emotions."""

from __future__ import annotations

import itertools
from pathlib import Path
from typing import Any

from nicegui import ui
from nicegui.events import UploadEventArguments, ValueChangeEventArguments

from risorius.controls.presets import EMOTIONS
from risorius.controls.stream import Stream
from risorius.errors import ParameterError
from risorius.io.json_fields import Fields
from risorius.io.motion import read_stream, stream_endings
from risorius.playback.emotion_timing import emotion_stream
from risorius.studio import frames
from risorius.studio.guard import inside
from risorius.studio.hub import Connection
from risorius.studio.jobs import Job
from risorius.studio.panel import Panel, group, heading
from risorius.studio.panels.bake_line import BakeLine
from risorius.studio.panels.progress import Progress
from risorius.studio.stage_rig import LARGEST
from risorius.studio.stated import Message
from risorius.studio.take import Take, Timed, open_take, rehearse
from risorius.studio.uploads import trying_upload
from risorius.studio.viewport import Timeline

__all__ = ["PlayPanel"]

_NUMBERS = itertools.count(1)
_HINT = "Drag along the curve, or <b>Space</b> plays and pauses. <b>Record</b> writes a file."


class PlayPanel(Panel):
    """Streams on a timeline.

    A take is shown by the page alone, from baked targets that it is sent once; until these are
    there, or where they are too many, every picture is a frame of the studio.
    """

    name = "Play"
    icon = "play_circle"
    hint = "Drop a <b>.fap</b>, Live Link <b>.csv</b> or <b>.json</b>, or play an emotion."

    drops = stream_endings()

    def build(self) -> None:
        """Make the elements."""
        self.timed: Timed | None = None
        self.stream: Stream | None = None
        self.number = 0
        self._sent: tuple[Connection, int] | None = None
        heading("Play", "Motion of any standard moves the face; drag along the timeline.")
        with group("Motion"):
            self.box = ui.upload(
                label="drop a take here, or click +", auto_upload=True, max_file_size=64 << 20,
                on_upload=self.page.safely(self._upload),
            )  # fmt: skip
            self.box.props(f"flat bordered dense accept='{','.join(self.drops)}'")
            self.box.style("width:100%").props("data-mark=take-upload")
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
            self._timeline = Timeline()
            with ui.row().style("gap:6px"):
                for text, ending in (("Record GLB", ".glb"), ("Record film", ".mp4")):
                    ui.button(
                        text, icon="fiber_manual_record",
                        on_click=self.page.safely(lambda e=ending: self._record(e)),
                    ).props("flat dense no-caps").classes("st-chip").props(
                        f"data-mark=record-{ending[1:]}"
                    )  # fmt: skip
        self._line.set_visibility(False)
        self.progress = Progress(self.page)
        self.bake_line = BakeLine(self.page)

    def enter(self) -> None:
        """Look for takes in the folder, and bake."""
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
        self.page.bakery.want(self)
        if self.timed is not None:
            self._present()

    def leave(self) -> None:
        """Stop, and show the pose again."""
        self.page.bakery.leave(self)
        self.page.view.rest()
        self._still()

    def refresh(self, what: str) -> None:
        """Follow the face, its bake and the stream."""
        if what == "bake":
            self.bake_line.follow()
            if isinstance(self.timed, Take):
                self._send(self.timed)
            elif self.page.bakery.ready is not None:
                self._again()
        elif what == "stream" and isinstance(self.timed, Take):
            self._send(self.timed)
        elif what == "face" and self.stream is not None:
            self._again()

    # -- takes ------------------------------------------------------------------------------

    async def _upload(self, event: UploadEventArguments) -> None:
        folder, data = self.shop.document.keeper.folder, await event.file.read()
        self.clear_box()
        self.page.turn_to(self)
        try:
            with trying_upload(folder, event.file.name, data, endings=self.drops) as path:
                await self._open(path)
        finally:
            self.enter()

    async def _choose(self, event: ValueChangeEventArguments[Any]) -> None:
        if event.value:
            folder = self.shop.document.keeper.folder
            await self._open(inside(folder, str(event.value), endings=stream_endings()))

    async def _emotion(self, name: str) -> None:
        await self._open(emotion_stream({name: 1.0}))

    async def _open(self, source: Path | Stream) -> None:
        name = source.name if isinstance(source, Path) else source.source
        face = self.subject

        def read(job: Job) -> tuple[Stream, Timed | None]:
            stream = source if isinstance(source, Stream) else read_stream(source)
            return stream, rehearse(stream, face.face, face.presets, job)

        found = await self.progress.run("opening the take", read)
        if found is None:
            return
        stream, timed = found
        if timed is None or self.page.bakery.ready is not None:
            timed = await self._baked(stream)
        if timed is None:
            return
        self.stream, self.timed, self.number = stream, timed, next(_NUMBERS)
        seconds = (timed.frame_count - 1) / timed.rate
        self._title.set_text(f"{name}: {seconds:.2f} s at {timed.rate:g} frames per second")
        self._line.set_visibility(True)
        self._present()
        missing = timed.player.unmatched
        if missing:
            some, more = list(missing)[:6], len(missing) - 6
            rest = f" and {more} more" if more > 0 else ""
            self.page.tell(f"not played: {', '.join(some)}{rest}")

    async def _baked(self, stream: Stream) -> Take | None:
        """Bind a stream to the baked face, which is waited for."""
        self.page.bakery.want(self)
        rig, presets = await self.page.bakery.rig(), self.subject.presets
        return await self.progress.run(
            "opening the take", lambda job: open_take(stream, rig, presets, job)
        )

    def _again(self) -> None:
        """Bind the open take to the face as it is now, without a word and at its place."""
        stream, face = self.stream, self.shop.subject
        if stream is None or face is None:
            return

        async def bind() -> None:
            rig = self.page.bakery.ready
            if rig is not None:
                take = await self.progress.quietly(
                    lambda job: open_take(stream, rig, face.presets, job)
                )
            else:
                take = await self.progress.quietly(
                    lambda job: rehearse(stream, face.face, face.presets, job)
                )
            if take is not None and self.stream is stream and self.shop.subject is face:
                self.timed = take
                self._present()

        self.page.start(bind)

    # -- showing ----------------------------------------------------------------------------

    def _present(self) -> None:
        """Hand the take to the page."""
        timed = self.timed
        if timed is None or self.page.active is not self:
            return
        if isinstance(timed, Take):
            self._send(timed)
        self._timeline.load(
            {
                "number": self.number,
                "rate": timed.rate,
                "duration": (timed.frame_count - 1) / timed.rate,
                "curve": timed.curve().round(3).tolist(),
            }
        )
        self.page.say(_HINT)

    def _send(self, take: Take) -> None:
        """Send targets, once for each stream and bake, and the weights of the take."""
        connection = self.shop.hub.of(self.page.client.id)
        bakery = self.page.bakery
        if connection is None or bakery.ready is not take.rig or self.page.active is not self:
            return
        if take.rig.entry_count > LARGEST:
            return
        mark = (connection, bakery.number)
        epoch = self.shop.epoch
        if self._sent != mark:
            connection.put(frames.targets(take.rig, epoch=epoch, number=bakery.number))
            self._sent = mark
        facts = {"number": self.number, "targets": bakery.number, "rate": take.rate}
        if take.turns is not None:
            facts["pivot"] = take.turns.pivot.tolist()
        rotations = None if take.turns is None else take.turns.rotations
        connection.put(frames.take(take.weights, rotations, epoch=epoch, facts=facts))
        self._still()

    def _still(self) -> None:
        if self.shop.show.played is not None:
            self.shop.present(played=None)

    def take(self, event: str, message: Message) -> None:
        """Take a wish of the page for a frame, while it cannot show the take alone."""
        if event == "seek" and self.timed is not None:
            time = Fields(message, "timeline").number("time")
            self.shop.present(played=self.timed.shown(time))

    async def _record(self, ending: str) -> None:
        if self.stream is None:
            raise ParameterError("play: open a take first")
        take = self.timed if isinstance(self.timed, Take) else await self._baked(self.stream)
        if take is None:
            return
        stem = self.shop.document.keeper.path.stem
        path = inside(self.shop.document.keeper.folder, f"{stem} take{ending}")
        count = await self.progress.run("recording", lambda job: take.record(path, job))
        if count is not None:
            ui.download.file(path)
            self.page.tell(f"wrote {path.name}: {count} frames")

    def key(self, key: str) -> bool:
        """Take a key."""
        if key != " " or self.timed is None:
            return False
        self._timeline.toggle()
        return True
