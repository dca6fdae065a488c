"""Write wrinkle maps: pictures, and a text file that says which weights drive them."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np

from risorius.io.atomic import write_bytes
from risorius.render.png import write_png
from risorius.wrinkles import WrinkleSet

__all__ = ["write_wrinkles"]

SCHEMA = "risorius/wrinkles"
VERSION = 1
_SIDE = "side.png"


def write_wrinkles(wrinkles: WrinkleSet, folder: str | Path) -> tuple[Path, ...]:
    """Write ``wrinkles.json``, ``side.png`` and one ``wrinkle_NAME.png`` for each map.

    Parameters
    ----------
    wrinkles : WrinkleSet
    folder : path
        That exists.

    Returns
    -------
    tuple of Path
        The files, ``wrinkles.json`` last.

    Raises
    ------
    FormatError
        If a file cannot be written.
    """
    folder = Path(folder)
    written: list[Path] = []
    maps: list[dict[str, Any]] = []
    for made in wrinkles.maps:
        name = f"wrinkle_{made.group.name}.png"
        write_png(folder / name, made.normals)
        written.append(folder / name)
        maps.append(
            {
                "name": made.group.name,
                "file": name,
                "left": list(made.group.left),
                "right": list(made.group.right),
                "deepest_mm": round(made.relief.deepest, 3),
            }
        )
    write_png(folder / _SIDE, np.repeat(wrinkles.side[:, :, None], 3, axis=2))
    content = {
        "schema": SCHEMA,
        "version": VERSION,
        "size": wrinkles.size,
        "tile": list(wrinkles.tile),
        "green": "up",
        "side": _SIDE,
        "maps": maps,
    }
    told = folder / "wrinkles.json"
    write_bytes(told, f"{json.dumps(content, indent=1, ensure_ascii=False)}\n".encode())
    return (*written, folder / _SIDE, told)
