"""Pictures of a rig in motion: numbered PNG files or a film."""

from __future__ import annotations

import shutil
import subprocess
import tempfile
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from risorius._check import FloatArray
from risorius.errors import FormatError, ParameterError
from risorius.io.atomic import atomic_folder, atomic_write
from risorius.playback.poser import Poser
from risorius.render.camera import Camera
from risorius.render.heads import Portrait
from risorius.render.picture import render
from risorius.render.png import write_png
from risorius.rig.rig import Rig

__all__ = ["Film", "has_ffmpeg", "write_film", "write_pictures"]

_FFMPEG = "ffmpeg"


@dataclass(frozen=True)
class Film:
    """How a rig is filmed.

    Parameters
    ----------
    view : str
        One of `risorius.render.views.VIEWS`.
    size : (width, height)
        In pixels; even numbers for a film.
    rate : float
        Frames per second.
    """

    view: str = "front"
    size: tuple[int, int] = (640, 640)
    rate: float = 25.0


def has_ffmpeg() -> bool:
    """Return whether films can be written."""
    return shutil.which(_FFMPEG) is not None


def write_pictures(
    rig: Rig, weights: Iterable[FloatArray], folder: str | Path, *, film: Film
) -> int:
    """Write ``frame_00000.png`` ... into a folder of their own; return how many.

    Parameters
    ----------
    rig : Rig
    weights : iterable of (t,) float64
        One row per frame, in the order of the rig's targets.
    folder : path
        Replaced as a whole when all pictures are there.
    film : Film

    Raises
    ------
    FormatError
        If the folder cannot be written, or holds other files than pictures of an earlier run.
    """
    folder = Path(folder)
    _require_own_folder(folder)
    studio = _Studio(rig, film)
    count = 0
    with atomic_folder(folder) as temporary:
        for count, positions in enumerate(studio.poser.frames(weights), start=1):
            write_png(temporary / f"frame_{count - 1:05d}.png", studio.picture(positions))
    return count


def write_film(rig: Rig, weights: Iterable[FloatArray], path: str | Path, *, film: Film) -> int:
    """Write an MP4 with the program ffmpeg; return the number of frames.

    Raises
    ------
    FormatError
        If ffmpeg is missing or fails.
    ParameterError
        If a side of the picture is odd.
    """
    if not has_ffmpeg():
        raise FormatError(
            f"{path}: a film needs the program ffmpeg, which is not installed; install it, or give "
            "a folder for PNG frames"
        )
    width, height = film.size
    if width % 2 or height % 2:
        raise ParameterError(f"size: {width}x{height}: both sides of a film must be even")
    studio = _Studio(rig, film)
    count = 0
    with atomic_write(path) as temporary, tempfile.TemporaryFile() as log:
        command = [_FFMPEG, "-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24"]
        command += ["-s", f"{width}x{height}", "-r", f"{film.rate:g}", "-i", "-"]
        command += ["-pix_fmt", "yuv420p", "-f", "mp4", str(temporary)]
        with subprocess.Popen(command, stdin=subprocess.PIPE, stderr=log) as encoder:
            stream = encoder.stdin
            assert stream is not None
            try:
                for positions in studio.poser.frames(weights):
                    stream.write(studio.picture(positions).tobytes())
                    count += 1
                stream.close()
            except BrokenPipeError:
                pass  # the encoder's own words follow
        if encoder.returncode:
            log.seek(0)
            words = log.read(400).decode(errors="replace").strip()
            raise FormatError(f"{path}: ffmpeg failed: {words}")
    return count


class _Studio:
    """A portrait, its camera and the poser of one rig."""

    def __init__(self, rig: Rig, film: Film) -> None:
        self.poser = Poser(rig)
        self._portrait = Portrait.of(rig)
        self._frame = rig.frame
        self._size = film.size
        width, height = film.size
        self._camera: Camera = self._portrait.camera(film.view, aspect=width / height)

    def picture(self, positions: FloatArray | np.ndarray) -> np.ndarray:
        placed = self._frame.to_canonical(positions)
        return render(self._portrait.surfaces(placed), self._camera, size=self._size)


def _require_own_folder(folder: Path) -> None:
    if not folder.is_dir():
        return
    strangers = [f.name for f in folder.iterdir() if not (f.suffix == ".png" and f.is_file())]
    if strangers:
        raise FormatError(
            f"{folder}: holds {strangers[0]!r}, which is no picture; give a folder of its own"
        )
