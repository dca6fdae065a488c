"""A style: what was tuned, as changes that fit the next head as well."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, cast

from risorius._check import as_number
from risorius.errors import FormatError
from risorius.io.atomic import write_bytes
from risorius.io.bounded import check_schema, read_json
from risorius.tuning.muscle_genes import apply_genes, muscle_parameters
from risorius.vectormuscle.muscle import VectorMuscle

__all__ = ["Style", "parse_style", "read_style", "write_style"]

SCHEMA = "risorius/style"
VERSION = 1


@dataclass(frozen=True)
class Style:
    """Tuned parameters.

    Parameters
    ----------
    parameters : mapping of str to float
        By name; see `muscle_parameters` for what they mean.
    method : str
        The method whose parameters they are.
    """

    parameters: Mapping[str, float] = field(default_factory=dict[str, float])
    method: str = "vector"

    def with_parameters(self, values: Mapping[str, float]) -> Style:
        """Return the style with more parameters; new values replace old ones."""
        return Style({**self.parameters, **values}, self.method)

    def applied(self, muscles: Iterable[VectorMuscle], *, width: float) -> tuple[VectorMuscle, ...]:
        """Return muscles of another head in this style.

        Parameters
        ----------
        muscles : iterable of VectorMuscle
            As proposed for the head.
        width : float
            Width of the head [mm].
        """
        return tuple(apply_genes(muscle, self.parameters, width=width) for muscle in muscles)

    def unknown(self, muscles: Iterable[VectorMuscle]) -> tuple[str, ...]:
        """Return the parameters that none of `muscles` has."""
        listed = list(muscles)
        known = {
            parameter.name
            for mirror in (True, False)
            for parameter in muscle_parameters(listed, mirror=mirror, genes="all")
        }
        return tuple(name for name in self.parameters if name not in known)

    def to_json(self) -> dict[str, Any]:
        """Return the file's content."""
        rounded = {name: round(value, 6) for name, value in self.parameters.items()}
        return {
            "schema": SCHEMA,
            "version": VERSION,
            "method": self.method,
            "parameters": rounded,
        }


def parse_style(data: Mapping[str, Any], *, source: str) -> Style:
    """Build a style from the parsed JSON of its file.

    Raises
    ------
    FormatError
        If schema, version or an entry is wrong.
    ParameterError
        If a value is not a finite number.
    """
    check_schema(data, source, schema=SCHEMA, version=VERSION)
    parameters = data.get("parameters")
    if not isinstance(parameters, dict):
        raise FormatError(f"{source}: 'parameters' must be an object of name: number")
    method = data.get("method", "vector")
    if not isinstance(method, str):
        raise FormatError(f"{source}: 'method' must be a word")
    values = {
        name: as_number(f"{source}: {name}", value)
        for name, value in cast(dict[str, Any], parameters).items()
    }
    return Style(values, method)


def read_style(path: str | Path) -> Style:
    """Read a style.

    Raises
    ------
    FormatError
        If the file is missing or malformed.
    """
    return parse_style(read_json(path, schema=SCHEMA), source=str(path))


def write_style(style: Style, path: str | Path) -> None:
    """Write a style.

    Raises
    ------
    FormatError
        If the file cannot be written.
    """
    text = json.dumps(style.to_json(), indent=1, ensure_ascii=False, allow_nan=False)
    write_bytes(path, f"{text}\n".encode())
