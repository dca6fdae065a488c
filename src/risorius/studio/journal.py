"""The file beside a project that remembers the steps which led to it, so that undo survives.

One record stands on each line: eight hexadecimal digits of its CRC-32, a blank, its JSON. A *part*
holds a recipe by its digest, once however many steps share it; a *step* names its label, the
project's document without these recipes, the digest of the project file in that state, and how
many of the steps before it stay; a *place* says that undo or redo went to another step. The
journal is written before the project: whichever of the two a crash leaves behind, the digests
tell which step the project is at.
"""

from __future__ import annotations

import hashlib
import json
import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from risorius.errors import FormatError
from risorius.io.atomic import write_bytes
from risorius.io.bounded import MEGABYTE, check_schema, parse_json, read_bytes_limited
from risorius.io.json_fields import Fields
from risorius.project.project import INLINE
from risorius.studio.history import History, Record, Step

__all__ = ["Journal"]

SCHEMA = "risorius/history"
VERSION = 1
# A journal larger than the first is shortened to the second; one beyond the third is not ours.
_FULL, _HALF, _LIMIT = 16 * MEGABYTE, 8 * MEGABYTE, 64 * MEGABYTE
_LONGEST_STEP = 4 * MEGABYTE
_DIGEST = 64  # hexadecimal digits of a SHA-256


class Journal:
    """The journal of one project.

    Parameters
    ----------
    project : Path
        Of the project file; the journal is a hidden file beside it.
    """

    def __init__(self, project: Path) -> None:
        self.path = project.with_name(f".{project.name}.history")
        self._parts: dict[str, bytes] = {}
        self._written: set[str] = set()
        self._size = 0

    def move(self, project: Path) -> None:
        """Belong to another project file; what was written of the one before stays."""
        self.path = Journal(project).path
        self._size = 0

    def record(self, document: Mapping[str, Any], content: bytes) -> Record:
        """Return the record of a state.

        Parameters
        ----------
        document : mapping
            JSON of the project.
        content : bytes
            Of the project file, as it is or is going to be.
        """
        bare, parts = dict(document), dict[str, str]()
        for name in INLINE:
            if isinstance(bare.get(name), dict):
                data = _json(bare.pop(name))
                parts[name] = hashlib.sha256(data).hexdigest()
                self._parts[parts[name]] = data
        return Record(bare, parts, hashlib.sha256(content).hexdigest())

    def document(self, record: Record) -> dict[str, Any]:
        """Return the JSON of the project in a state.

        Raises
        ------
        FormatError
            If a recipe in it is malformed.
        """
        where = f"{self.path}: step"
        parts = {n: parse_json(self._parts[key], where) for n, key in record.parts.items()}
        return {**record.document, **parts}

    # -- writing ----------------------------------------------------------------------------

    def add(self, history: History, kept: int) -> None:
        """Write down the present step, which follows the first `kept` steps.

        Raises
        ------
        FormatError
            If the journal cannot be written.
        """
        whole = not self._size or not self._appended(self._lines(history.present, kept))
        if whole or self._size > _FULL:
            self.rewrite(history)

    def go(self, history: History) -> None:
        """Write down that another step is the present one.

        Raises
        ------
        FormatError
            If the journal cannot be written.
        """
        if not self._size or not self._appended(_place_line(history)):
            self.rewrite(history)

    def rewrite(self, history: History) -> None:
        """Write the whole history, as many of its last steps as there is room for.

        Steps that do not fit are forgotten, the oldest first; the present one stays.

        Raises
        ------
        FormatError
            If the journal cannot be written.
        """
        self._size = 0
        self._written.clear()
        sizes = self._sizes(history)
        total, first = 0, len(sizes)
        while first and (total + sizes[first - 1] <= _HALF or first > history.place):
            first -= 1
            total += sizes[first]
        del history.steps[:first]
        history.place -= first
        lines = [_line({"schema": SCHEMA, "version": VERSION})]
        lines += [self._lines(step, kept) for kept, step in enumerate(history.steps)]
        lines.append(_place_line(history))
        data = b"".join(lines)
        write_bytes(self.path, data)
        self._size = len(data)
        used = self._written
        self._parts = {key: part for key, part in self._parts.items() if key in used}

    def _sizes(self, history: History) -> list[int]:
        """Return about how much room each step takes, counting parts where they are last used."""
        seen, result = set[str](), list[int]()
        for step in reversed(history.steps):
            assert step.record is not None
            fresh = set(step.record.parts.values()) - seen
            seen |= fresh
            own = len(_json(step.record.document))
            result.append(own + sum(len(self._parts[key]) for key in fresh))
        return result[::-1]

    def _lines(self, step: Step, kept: int) -> bytes:
        record = step.record
        assert record is not None
        lines: list[bytes] = []
        for key in record.parts.values():
            if key not in self._written:
                self._written.add(key)
                lines.append(_framed(b'{"part": "%s", "content": ' % key.encode()
                                     + self._parts[key] + b"}"))  # fmt: skip
        entry = {
            "step": step.label, "gesture": step.gesture, "kept": kept, "digest": record.digest,
            "parts": dict(record.parts), "document": dict(record.document),
        }  # fmt: skip
        return b"".join([*lines, _line(entry)])

    def _appended(self, data: bytes) -> bool:
        """Write behind what is there; tell whether the file is as it was left."""
        try:
            with self.path.open("ab") as file:
                if file.tell() != self._size:
                    return False
                file.write(data)
        except OSError as error:
            raise FormatError(f"{self.path}: cannot be written ({error.strerror})") from error
        self._size += len(data)
        return True

    # -- reading ----------------------------------------------------------------------------

    def read(self, content: bytes) -> History | None:
        """Return the history that led to a project, or None if there is no journal.

        Parameters
        ----------
        content : bytes
            Of the project file as it is now.

        Raises
        ------
        FormatError
            If the journal is malformed, or belongs to another state of the project. A last record
            that a crash has cut off is left out.
        """
        if not self.path.exists():
            return None
        data = read_bytes_limited(self.path, limit=_LIMIT)
        *lines, rest = data.split(b"\n")
        history = self._replayed(lines)
        digest = hashlib.sha256(content).hexdigest()
        matches = [
            number
            for number, step in enumerate(history.steps)
            if step.record is not None and step.record.digest == digest
        ]
        if not matches:
            raise FormatError(f"{self.path}: belongs to another state of the project")
        history.place = min(matches, key=lambda number: abs(number - history.place))
        # What a crash cut off is not written behind: the next step writes the whole anew.
        self._size = 0 if rest else len(data)
        return history

    def _replayed(self, lines: list[bytes]) -> History:
        header, *others = lines or [b""]
        fields = self._parsed(header, 1)
        check_schema(fields.value, str(self.path), schema=SCHEMA, version=VERSION)
        history = History([])
        for number, line in enumerate(others, 2):
            if line[9:17] == b'{"part":':
                self._take_part(line, number)
                continue
            if len(line) > _LONGEST_STEP:
                raise FormatError(f"{self.path}: line {number}: is longer than any step")
            fields = self._parsed(line, number)
            if "place" in fields:
                self._take_place(history, fields)
            else:
                self._take_step(history, fields)
        if not history.steps:
            raise FormatError(f"{self.path}: holds no step")
        return history

    def _parsed(self, line: bytes, number: int) -> Fields:
        where = f"{self.path}: line {number}"
        return Fields(parse_json(self._checked(line, number), where), where)

    def _checked(self, line: bytes, number: int) -> bytes:
        body = line[9:]
        if line[:9] != b"%08x " % zlib.crc32(body):
            raise FormatError(f"{self.path}: line {number}: is damaged")
        return body

    def _take_part(self, line: bytes, number: int) -> None:
        body = self._checked(line, number)
        key, content = body[10 : 10 + _DIGEST], body[10 + _DIGEST + 14 : -1]
        if body != b'{"part": "%s", "content": %s}' % (key, content):
            raise FormatError(f"{self.path}: line {number}: is no part")
        if hashlib.sha256(content).hexdigest().encode() != key:
            raise FormatError(f"{self.path}: line {number}: does not hold what it says")
        self._parts[key.decode()] = content
        self._written.add(key.decode())

    def _take_place(self, history: History, fields: Fields) -> None:
        place = fields.integer("place")
        if place >= len(history.steps):
            raise FormatError(f"{fields.place('place')}: there is no step {place}")
        step = history.steps[place]
        assert step.record is not None
        record = Record(step.record.document, step.record.parts, _digest(fields, "digest"))
        history.place = place
        history.steps[place] = Step(step.label, step.gesture, None, record)

    def _take_step(self, history: History, fields: Fields) -> None:
        kept = fields.integer("kept")
        if kept > len(history.steps):
            raise FormatError(f"{fields.place('kept')}: there are not {kept} steps before it")
        named = fields.fields("parts")
        parts = {name: _digest(named, name) for name in named}
        unknown = [
            name for name, key in parts.items() if name not in INLINE or key not in self._parts
        ]
        if unknown:
            raise FormatError(f"{fields.place('parts')}: {unknown[0][:40]!r} is missing")
        document = fields.fields("document").value
        record = Record(document, parts, _digest(fields, "digest"))
        history.put(kept, Step(fields.text("step"), fields.text("gesture"), None, record))


def _digest(fields: Fields, key: str) -> str:
    text = fields.text(key)
    if len(text) != _DIGEST:
        raise FormatError(f"{fields.place(key)}: is no digest")
    return text


def _json(value: object) -> bytes:
    return json.dumps(value, ensure_ascii=True, allow_nan=False, separators=(",", ":")).encode()


def _place_line(history: History) -> bytes:
    record = history.present.record
    assert record is not None
    return _line({"place": history.place, "digest": record.digest})


def _line(value: object) -> bytes:
    return _framed(_json(value))


def _framed(body: bytes) -> bytes:
    return b"%08x %s\n" % (zlib.crc32(body), body)
