"""Pictures of candidates: nine faces on one page, and the six emotions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from risorius._check import FloatArray, one_of
from risorius.cli.talk import Talk
from risorius.controls.presets import EMOTIONS, PresetBook
from risorius.head.head import Head
from risorius.render.heads import Portrait
from risorius.render.png import write_png
from risorius.render.series import Series
from risorius.render.sheet import contact_sheet
from risorius.render.views import VIEWS
from risorius.vectormuscle.face import VectorFace
from risorius.vectormuscle.vector_set import VectorSet

__all__ = ["FacePage", "write_emotions"]

# Nine of these fit on a screen, and a generation is there before one has blinked.
_CELL = (256, 256)


@dataclass(frozen=True, eq=False)
class FacePage:
    """Draws faces of one head three in a row.

    Parameters
    ----------
    head : Head
    view : str
        One of the named views.
    size : (width, height)
        Of each face in pixels.
    """

    head: Head
    view: str = "face"
    size: tuple[int, int] = _CELL

    def __post_init__(self) -> None:
        one_of("view", self.view, tuple(VIEWS))

    @cached_property
    def series(self) -> Series:
        """The head that sits for the pictures."""
        return Series.of(Portrait.of(self.head), self.view, size=self.size)

    def write(
        self, path: Path, posed: Sequence[FloatArray], labels: Sequence[str], *, title: str
    ) -> None:
        """Write the page.

        Parameters
        ----------
        path : Path
        posed : sequence of (n, 3) float64
            Vertices of each face [mm].
        labels : sequence of str
        title : str
        """
        images = self.series.pictures(posed)
        sheet = contact_sheet(images, labels, columns=3, title=title)
        write_png(path, sheet, effort=1)


def write_emotions(
    head: Head, vectors: VectorSet, presets: PresetBook, path: Path, talk: Talk
) -> None:
    """Write the six emotions that muscles make on a head."""
    with talk.stage("sheet"):
        face = VectorFace.build(head, vectors)
        names = [name for name in EMOTIONS if name in presets.emotions]
        poses = [presets.fit(presets.emotions[name], face.controls).pose for name in names]
        FacePage(head).write(path, [face.pose(pose) for pose in poses], names, title="emotions")
    talk.put(sheet=path)
    talk.say(f"wrote {path}: the six emotions")
