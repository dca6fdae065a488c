"""All shapes of a rig on one page, and one head from several sides."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from risorius.controls.arkit import arkit_shapes
from risorius.controls.presets import EMOTIONS
from risorius.errors import ParameterError
from risorius.render.heads import Portrait
from risorius.render.sheet import contact_sheet
from risorius.rig.rig import Rig

__all__ = ["rig_sheet", "view_sheet"]

Picture = npt.NDArray[np.uint8]
Progress = Callable[[int, int, str], None]

_GAP = 6
_PAGE = (28, 30, 34)  # the background of contact sheets
_TALL = 1.16  # height over width of a picture of the face


@dataclass(frozen=True)
class _Section:
    title: str
    shapes: tuple[str, ...]
    columns: int


def rig_sheet(
    rig: Rig, *, columns: int = 10, cell: int = 156, progress: Progress | None = None
) -> Picture:
    """Return a page with every shape of a rig at weight 1, all seen by the same camera.

    The neutral and the emotions come first and larger, then the ARKit shapes, then all others.

    Parameters
    ----------
    rig : Rig
    columns : int
        Pictures per row; emotions take seven per row.
    cell : int
        Width of a picture [pixels].
    progress : callable, optional
        Called with (done, all, name) before each picture.

    Returns
    -------
    (h, w, 3) uint8
    """
    if columns < 1 or cell < 16:
        raise ParameterError("sheet: needs at least 1 column and pictures of 16 pixels")
    portrait = Portrait.of(rig)
    camera = portrait.camera("face", aspect=1.0 / _TALL)
    width = columns * (cell + _GAP) + _GAP
    done, count = 0, len(rig.targets) + 1
    pages: list[Picture] = []
    for section in _sections(rig, columns):
        side = (width - _GAP) // section.columns - _GAP
        images: list[Picture] = []
        for name in section.shapes:
            if progress is not None:
                progress(done, count, name or "neutral")
            weights = {name: 1.0} if name else None
            images.append(
                portrait.picture(camera, size=(side, round(_TALL * side)), weights=weights)
            )
            done += 1
        labels = [name or "neutral" for name in section.shapes]
        pages.append(
            contact_sheet(
                images, labels, columns=section.columns, title=section.title, gap=_GAP, text_size=12
            )
        )
    return _stacked(pages)


def _sections(rig: Rig, columns: int) -> list[_Section]:
    apple = {shape.name for shape in arkit_shapes()}
    first = tuple(name for name in EMOTIONS if name in rig.by_name)
    second = tuple(name for name in rig.names if name in apple)
    third = tuple(name for name in rig.names if name not in apple and name not in first)
    sections = [_Section("neutral and emotions", ("", *first), max(2, min(7, columns)))]
    if second:
        sections.append(_Section(f"ARKit ({len(second)})", second, columns))
    if third:
        sections.append(_Section(f"shapes ({len(third)})", third, columns))
    return sections


def view_sheet(
    rig: Rig,
    poses: Mapping[str, Mapping[str, float]],
    views: Sequence[str],
    *,
    cell: int = 300,
    progress: Progress | None = None,
) -> Picture:
    """Return a page with one row per pose and one column per view.

    Parameters
    ----------
    rig : Rig
    poses : mapping of str to mapping of str to float
        Label -> weights of targets; no weights are the neutral.
    views : sequence of str
        See `risorius.render.views.VIEWS`.
    cell : int
        Side of a picture [pixels].
    progress : callable, optional
        Called with (done, all, label) before each picture.

    Returns
    -------
    (h, w, 3) uint8
    """
    portrait = Portrait.of(rig)
    cameras = {view: portrait.camera(view) for view in views}
    images: list[Picture] = []
    labels: list[str] = []
    for label, weights in poses.items():
        for view, camera in cameras.items():
            if progress is not None:
                progress(len(images), len(poses) * len(cameras), f"{label}, {view}")
            images.append(portrait.picture(camera, size=(cell, cell), weights=weights))
            labels.append(f"{label}, {view}")
    return contact_sheet(images, labels, columns=len(views), gap=_GAP)


def _stacked(pages: Sequence[Picture]) -> Picture:
    """Return the pages one below the other; the narrower ones are filled up."""
    width = max(page.shape[1] for page in pages)
    height = sum(page.shape[0] for page in pages)
    whole = np.empty((height, width, 3), np.uint8)
    whole[:] = _PAGE
    top = 0
    for page in pages:
        whole[top : top + page.shape[0], : page.shape[1]] = page
        top += page.shape[0]
    return whole
