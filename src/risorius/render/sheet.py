"""Many pictures on one page."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
from PIL import Image, ImageDraw, ImageFont

from risorius._check import as_number
from risorius.errors import ParameterError, ShapeError
from risorius.render.png import Uint8Array, as_image

__all__ = ["contact_sheet"]

_PAGE, _INK, _FAINT = (28, 30, 34), (226, 228, 232), (160, 166, 176)


def contact_sheet(
    images: Sequence[npt.ArrayLike],
    labels: Sequence[str],
    *,
    columns: int,
    title: str | None = None,
    gap: int = 6,
    text_size: int = 13,
) -> Uint8Array:
    """Lay out `images` row by row with a label beneath each.

    Parameters
    ----------
    images : sequence of (h, w, 3) uint8
        Pictures; smaller ones are centred in the cell of the largest.
    labels : sequence of str
        One line for each picture; what is too long for its cell is cut with an ellipsis.
    columns : int
        Pictures per row.
    title : str, optional
        Line above all.
    gap : int
        Space between the cells and around the page [pixels].
    text_size : int
        Height of the label's font [pixels]; the title's is larger by half.

    Returns
    -------
    (h, w, 3) uint8
        Width is ``columns * (cell + gap) + gap``.
    """
    pictures = [as_image(f"images[{index}]", image) for index, image in enumerate(images)]
    if not pictures:
        raise ParameterError("images: a contact sheet needs at least one picture")
    if len(labels) != len(pictures):
        raise ShapeError(f"labels: expected {len(pictures)}, got {len(labels)}")
    columns = int(as_number("columns", columns, low=1, high=1000))
    gap = int(as_number("gap", gap, low=0, high=1000))
    text_size = int(as_number("text_size", text_size, low=4, high=400))
    cell_w = max(picture.shape[1] for picture in pictures)
    cell_h = max(picture.shape[0] for picture in pictures)
    line = round(1.5 * text_size)
    head = gap if title is None else gap + round(1.5 * line)
    rows = -(-len(pictures) // columns)
    page = Image.new(
        "RGB", (columns * (cell_w + gap) + gap, head + rows * (cell_h + line + gap)), _PAGE
    )
    pen = ImageDraw.Draw(page)
    if title is not None:
        large = ImageFont.load_default(1.5 * text_size)
        fitted = _fitted(title, large, page.width - 2 * gap)
        pen.text((gap, head / 2 + gap / 4), fitted, _INK, large, anchor="lm")
    font = ImageFont.load_default(text_size)
    for index, (picture, label) in enumerate(zip(pictures, labels, strict=True)):
        row, column = divmod(index, columns)
        left, top = gap + column * (cell_w + gap), head + row * (cell_h + line + gap)
        height, width = picture.shape[:2]
        place = (left + (cell_w - width) // 2, top + (cell_h - height) // 2)
        page.paste(Image.fromarray(np.ascontiguousarray(picture)), place)
        middle = (left + cell_w / 2, top + cell_h + line / 2)
        pen.text(middle, _fitted(label, font, cell_w), _FAINT, font, anchor="mm")
    return np.asarray(page, dtype=np.uint8)


def _fitted(text: str, font: ImageFont.FreeTypeFont | ImageFont.ImageFont, width: int) -> str:
    """Return `text` as one line that is at most `width` pixels wide."""
    text = " ".join(text.split())
    if font.getlength(text) <= width:
        return text
    while text and font.getlength(text + "…") > width:
        text = text[:-1]
    return text + "…" if text else ""
