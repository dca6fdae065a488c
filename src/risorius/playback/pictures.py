"""Pictures of a rig in motion: numbered PNG files or a film."""

from __future__ import annotations

import shutil
import subprocess
import tempfile
from collections.abc import Iterable
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path

import numpy as np
import numpy.typing as npt

from risorius.errors import FormatError, ParameterError
from risorius.io.atomic import atomic_folder, atomic_write
from risorius.render.camera import Camera
from risorius.render.heads import Portrait
from risorius.render.picture import render
from risorius.render.png import write_png
from risorius.rig.rig import Rig

__all__ = ["NO_FFMPEG", "Film", "has_ffmpeg", "write_film", "write_pictures"]

_FFMPEG = "ffmpeg"
_BUNDLE = "imageio_ffmpeg"
NO_FFMPEG = (
    "a film needs the program ffmpeg, which is not installed; install it or the extra "
    "(pip install risorius[video])"
)
"""Why there is no film, and the way out."""


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
    return _ffmpeg() is not None


def _ffmpeg() -> str | None:
    """Return the program ffmpeg: the one on the path, else that of the extra ``video``."""
    found = shutil.which(_FFMPEG)
    if found is not None:
        return found
    try:
        return str(import_module(_BUNDLE).get_ffmpeg_exe())
    except (ImportError, RuntimeError):  # not installed, or without a program for this machine
        return None


Frames = Iterable[npt.NDArray[np.floating]]


def write_pictures(rig: Rig, frames: Frames, folder: str | Path, *, film: Film) -> int:
    """Write ``frame_00000.png`` ... into a folder of their own; return how many.

    Parameters
    ----------
    rig : Rig
        Whose parts and materials are drawn.
    frames : iterable of (n, 3) float
        Positions of all vertices [file frame], as `Player.positions` gives them.
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
        for count, positions in enumerate(frames, start=1):
            write_png(temporary / f"frame_{count - 1:05d}.png", studio.picture(positions))
    return count


def write_film(rig: Rig, frames: Frames, path: str | Path, *, film: Film) -> int:
    """Write an MP4 with the program ffmpeg; return the number of frames.

    Parameters are those of `write_pictures`. The program is the one on the path, else the one that
    the extra ``video`` installs.

    Raises
    ------
    FormatError
        If ffmpeg is missing or fails.
    ParameterError
        If a side of the picture is odd.
    """
    program = _ffmpeg()
    if program is None:
        raise FormatError(f"{path}: {NO_FFMPEG}, or give a folder for PNG frames")
    width, height = film.size
    if width % 2 or height % 2:
        raise ParameterError(f"size: {width}x{height}: both sides of a film must be even")
    studio = _Studio(rig, film)
    count = 0
    with atomic_write(path) as temporary, tempfile.TemporaryFile() as log:
        command = [program, "-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24"]
        command += ["-s", f"{width}x{height}", "-r", f"{film.rate:g}", "-i", "-"]
        command += ["-pix_fmt", "yuv420p", "-movflags", "+faststart", "-f", "mp4", str(temporary)]
        with subprocess.Popen(command, stdin=subprocess.PIPE, stderr=log) as encoder:
            stream = encoder.stdin
            assert stream is not None
            try:
                for positions in frames:
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
    """A portrait of one rig and its camera."""

    def __init__(self, rig: Rig, film: Film) -> None:
        self._portrait = Portrait.of(rig)
        self._frame = rig.frame
        self._size = film.size
        width, height = film.size
        self._camera: Camera = self._portrait.camera(film.view, aspect=width / height)

    def picture(self, positions: npt.NDArray[np.floating]) -> npt.NDArray[np.uint8]:
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
