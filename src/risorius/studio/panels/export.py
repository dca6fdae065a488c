"""The panel that exports rigs and judges them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from nicegui import ui

from risorius.controls.shape_sets import ALL_SHAPE_SETS
from risorius.errors import ParameterError
from risorius.rig.quality import QualityReport, inspect_rig, shortcomings
from risorius.rig.rig import Rig
from risorius.studio.exports import KINDS, export_rig
from risorius.studio.jobs import Job
from risorius.studio.moment import Moment
from risorius.studio.offenders import offenders_of
from risorius.studio.panel import Panel, group, heading
from risorius.studio.panels.progress import Progress
from risorius.studio.scene import Stage

__all__ = ["ExportPanel"]

_WORDS = {
    ".glb": "GLB: Blender, Unity, Unreal, three.js",
    ".usdc": "USD, binary",
    ".usda": "USD, text",
    ".npz": "NPZ: NumPy",
    ".zip": "OBJ files in a zip",
}
_SETS = {
    "singles": "muscles one by one",
    "emotions": "six emotions",
    "arkit": "ARKit 52",
    "visemes_mpeg4": "visemes, MPEG-4",
    "visemes_oculus": "visemes, Oculus",
    "facs": "FACS action units",
    "fap": "MPEG-4 parameters",
    "mpeg4_84": "MPEG-4, the 84 of the thesis",
}
_BAD = "#ff5a4d"


class ExportPanel(Panel):
    """Rig files and the quality report."""

    name = "Export"
    icon = "ios_share"
    hint = "<b>Export</b> writes the rig beside the project and hands it to the browser."

    def build(self) -> None:
        """Make the elements."""
        heading("Export", "A neutral head with named shapes, in the frame of your file.")
        with group("Rig"):
            self._kind = ui.select({kind: _WORDS[kind] for kind in KINDS}, value=".glb")
            self._kind.props("dense").style("width:100%").props("data-mark=export-kind")
            chosen = list(self.shop.document.work.project.shapes)
            self._sets = ui.select(
                {name: _SETS.get(name, name) for name in ALL_SHAPE_SETS}, value=chosen,
                multiple=True, label="shapes",
            )  # fmt: skip
            self._sets.props("dense use-chips").style("width:100%")
            self._animation = ui.switch("animation that shows every shape").props("dense")
            self._metres = ui.switch("appear in metres (GLB)").props("dense")
            ui.button("Export", icon="download", on_click=self.page.safely(self._export)).props(
                "unelevated no-caps"
            ).classes("st-act").props("data-mark=export")
            self._written = ui.label().classes("st-help").props("data-mark=written")
        self.progress = Progress(self.page)
        with group("Quality"):
            ui.label("Measures every shape: lips, lids, teeth, creases, symmetry.").classes(
                "st-help"
            )
            ui.button("Inspect", icon="fact_check", on_click=self.page.safely(self._inspect)).props(
                "flat dense no-caps"
            ).classes("st-chip").props("data-mark=inspect")
            self._verdict = ui.label().props("data-mark=verdict")
            self._rows = ui.column().style("width:100%;gap:1px")

    def leave(self) -> None:
        """Take the marks away."""
        self.page.view.overlay()
        if self.shop.show.played is not None:
            self.shop.present(played=None)

    def _chosen(self) -> tuple[str, ...]:
        sets = tuple(str(name) for name in self._sets.value or ())
        if not sets:
            raise ParameterError("export: choose at least one set of shapes")
        return sets

    async def _export(self) -> None:
        sets, kind = self._chosen(), str(self._kind.value)
        keeper = self.shop.document.keeper
        name = f"{keeper.path.stem}{kind}"
        animation, metres = bool(self._animation.value), bool(self._metres.value)

        def work(job: Job) -> tuple[Path, Rig]:
            rig = self.shop.rig(sets, job)
            path = export_rig(rig, keeper.folder, name, job, animation=animation, metres=metres)
            return path, rig

        done = await self.progress.run("export", work)
        if done is None:
            return
        path, rig = done
        size = path.stat().st_size / 1e6
        self._written.set_text(
            f"{path.name}: {len(rig.targets)} shapes, {size:.1f} MB; in {path.parent}"
        )
        ui.download.file(path)

    async def _inspect(self) -> None:
        sets = self._chosen()

        def work(job: Job) -> tuple[Rig, QualityReport]:
            rig = self.shop.rig(sets, job)
            job.step("inspect")
            return rig, inspect_rig(rig, progress=job.tick)

        done = await self.progress.run("quality", work)
        if done is not None:
            self._show_report(*done)

    def _show_report(self, rig: Rig, report: QualityReport) -> None:
        found = shortcomings(report)
        self.page.say("Click a line: the head takes that shape and shows its vertices.")
        self._verdict.set_text(
            f"{len(report.shapes)} shapes; "
            + (f"{len(found)} below the bar" if found else "all good")
        )
        self._rows.clear()
        with self._rows:
            for sentence in found[:30]:
                self._row(rig, report, sentence.split(":")[0], sentence, bad=True)
            worst = sorted(report.rows(), key=lambda row: -float(row["added"] or 0.0))[:12]
            for row in worst:
                words = f"{row['shape']}: moves {row['largest']:.1f} mm"
                if row["into"]:
                    words += f", {row['added']:.2f} mm into {row['into']}"
                self._row(rig, report, str(row["shape"]), words, bad=False)

    def _row(self, rig: Rig, report: QualityReport, shape: str, words: str, *, bad: bool) -> None:
        with ui.element("div").classes("st-item") as row:
            row.on("click", self.page.safely(lambda _: self._point_at(rig, report, shape)))
            ui.icon("error" if bad else "info", size="14px").style(
                f"color:{_BAD if bad else 'var(--dim)'};margin-right:6px"
            )
            ui.label(words).classes("st-name").props(f'title="{words}"')

    def _point_at(self, rig: Rig, report: QualityReport, name: str) -> None:
        """Show a shape and the vertices that a finding is about."""
        positions = rig.frame.to_canonical(rig.posed({name: 1.0}))

        def moment(stage: Stage, groups: set[str]) -> Moment:
            return Moment(stage.posed(rig.target(name).pose, positions, groups))

        self.shop.present(played=moment)
        handles: list[dict[str, Any]] = []
        for what, vertices in offenders_of(report.shape(name)).items():
            for vertex in vertices[:200]:
                handles.append(
                    {
                        "id": "", "at": positions[vertex].tolist(), "normal": None, "on": None,
                        "colour": _BAD, "label": f"{what} (vertex {vertex})",
                    }
                )  # fmt: skip
        self.page.view.overlay(handles=handles)
        self.page.say(f"<b>{name}</b>: {len(handles)} marked; hold the pointer over one.")
