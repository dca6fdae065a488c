"""Read the landmarks of an Xface FDP file: ``.fdp``, XML.

``<fdp affects="head.wrl_3" index="2395" name="2.1">`` says that feature point 2.1 is vertex 2395 of
the mesh ``head.wrl_3``. A head of several meshes has points on several of them. Only those on the
mesh with most points, the skin, are landmarks here: a vertex number says nothing of a mesh that
lies elsewhere in a file. What the file knows beside that (influence zones, meshes of expressions)
belongs to Xface's own way of deforming a face and is not read.

References
----------
Balci, K. (2004), Xface: MPEG-4 based open source toolkit for 3D facial animation, AVI'04.
"""

from __future__ import annotations

import warnings
from collections import Counter
from pathlib import Path
from typing import NoReturn
from xml.parsers import expat

from risorius._formats import Format, register
from risorius.errors import FormatError, RisoriusWarning
from risorius.io.bounded import MEGABYTE, read_bytes_limited
from risorius.landmarks.feature_points import feature_points
from risorius.landmarks.landmark_set import LandmarkSpec

__all__ = ["read_fdp"]

_ROOT = "xfdp"
_POINT = "fdp"
_LIMIT = 16 * MEGABYTE
_DEEPEST = 32
_MOST_VERTICES = 2**31
_SHOWN = 6


def read_fdp(path: str | Path) -> dict[str, LandmarkSpec]:
    """Read landmarks by name.

    Raises
    ------
    FormatError
        If the file is no FDP file of Xface, malformed, or names no feature point.

    Warns
    -----
    RisoriusWarning
        Which mesh the vertices count in, and which points lie on others and are left out.
    """
    where = str(path)
    points = _Points(where)
    points.read(read_bytes_limited(path, limit=_LIMIT))
    known = [point for point in points.found if point[1] in feature_points()]
    if not known:
        raise FormatError(f"{where}: there are no feature points (<{_POINT} name=...>) in it")
    counts = Counter(mesh for mesh, _, _ in known)
    # The first of those with most points; Counter keeps their order.
    skin = counts.most_common(1)[0][0]
    specs: dict[str, LandmarkSpec] = {}
    for mesh, name, vertex in known:
        if mesh == skin:
            specs.setdefault(name, LandmarkSpec(vertex=vertex))
    _tell(where, skin, [(mesh, name) for mesh, name, _ in known if mesh != skin])
    return specs


def _tell(where: str, skin: str, others: list[tuple[str, str]]) -> None:
    text = f"{where}: vertices count from 0 in the mesh {skin[:60]!r}, which must come first"
    if others:
        listed = ", ".join(f"{name} on {mesh[:40]}" for mesh, name in others[:_SHOWN])
        more = f" and {len(others) - _SHOWN} more" if len(others) > _SHOWN else ""
        text += f"; left out: {listed}{more}"
    warnings.warn(text, RisoriusWarning, stacklevel=3)


class _Points:
    """Collects the feature points of a document while it is parsed."""

    def __init__(self, where: str) -> None:
        self.found: list[tuple[str, str, int]] = []
        self._where = where
        self._depth = 0
        self._parser = expat.ParserCreate()
        self._parser.StartElementHandler = self._start
        self._parser.EndElementHandler = self._end
        self._parser.StartDoctypeDeclHandler = self._refuse_doctype

    def read(self, data: bytes) -> None:
        """Parse the whole document."""
        try:
            self._parser.Parse(data, True)
        except expat.ExpatError as error:
            reason = expat.ErrorString(error.code)
            raise FormatError(
                f"{self._where}: line {error.lineno}, column {error.offset + 1}: {reason}"
            ) from None
        except (LookupError, ValueError):
            raise FormatError(f"{self._where}: unknown encoding; save it as UTF-8") from None

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        if self._depth == 0 and tag != _ROOT:
            self._fail(f"expected <{_ROOT}> of Xface, found <{tag[:40]}>")
        self._depth += 1
        if self._depth > _DEEPEST:
            self._fail(f"nested deeper than {_DEEPEST} elements")
        if tag == _POINT:
            self._add(attributes)

    def _end(self, _: str) -> None:
        self._depth -= 1

    def _add(self, attributes: dict[str, str]) -> None:
        missing = [key for key in ("name", "index", "affects") if key not in attributes]
        if missing:
            self._fail(f"<{_POINT}> has no {', '.join(missing)}")
        index = attributes["index"].strip()
        if not (index.isascii() and index.isdigit() and len(index) <= 10):
            self._fail(f"index {index[:40]!r} of {attributes['name'][:40]!r} is no vertex number")
        if int(index) >= _MOST_VERTICES:
            self._fail(f"index {index} of {attributes['name'][:40]!r} is beyond any mesh")
        self.found.append((attributes["affects"], attributes["name"].strip(), int(index)))

    def _refuse_doctype(self, *_: object) -> None:
        self._fail("has a document type with entities, which no FDP file needs; remove it")

    def _fail(self, text: str) -> NoReturn:
        raise FormatError(f"{self._where}: line {self._parser.CurrentLineNumber}: {text}")


register(Format("Xface FDP", (".fdp",), read_landmarks=read_fdp))
