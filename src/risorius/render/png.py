"""PNG files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt
from PIL import Image, UnidentifiedImageError

from risorius._check import as_number
from risorius.errors import FormatError, ShapeError
from risorius.io.atomic import atomic_write

__all__ = ["as_image", "read_png", "write_png"]

Uint8Array = npt.NDArray[np.uint8]


def as_image(name: str, value: npt.ArrayLike) -> Uint8Array:
    """Return `value` as an (h, w, 3) uint8 array.

    Raises
    ------
    ShapeError
        If it has another shape or type, or no pixels.
    """
    image = np.asarray(value)
    if image.ndim != 3 or image.shape[2] != 3 or not image.size:
        raise ShapeError(f"{name}: expected shape (height, width, 3), got {image.shape}")
    if image.dtype != np.uint8:
        raise ShapeError(f"{name}: expected uint8, got {image.dtype}; scale it to 0..255")
    return image


def write_png(path: str | Path, image: npt.ArrayLike, *, effort: int = 6) -> None:
    """Write `image` (h, w, 3) uint8 to `path`; the file appears complete or not at all.

    Parameters
    ----------
    path : str or Path
    image : (h, w, 3) array_like
    effort : int
        1 writes three times as fast as 6, for a fifth more bytes; 9 is the most.

    Raises
    ------
    FormatError
        If the folder is missing or the system refuses to write.
    """
    picture = Image.fromarray(np.ascontiguousarray(as_image("image", image)))
    effort = int(as_number("effort", effort, low=1, high=9))
    with atomic_write(path) as temporary:
        picture.save(temporary, format="PNG", compress_level=effort)


def read_png(path: str | Path) -> Uint8Array:
    """Read `path` as an (h, w, 3) uint8 array; an alpha channel is dropped.

    Raises
    ------
    FormatError
        If the file is missing, no PNG, or broken.
    """
    try:
        with Image.open(path, formats=["PNG"]) as picture:
            return np.asarray(picture.convert("RGB"), dtype=np.uint8)
    except FileNotFoundError:
        raise FormatError(f"{path}: no such file; check its name and its folder") from None
    except (UnidentifiedImageError, OSError, ValueError, SyntaxError) as error:
        raise FormatError(f"{path}: not a readable PNG file ({error}); export it again") from None
    except Image.DecompressionBombError as error:
        raise FormatError(f"{path}: the picture is too large ({error})") from None
