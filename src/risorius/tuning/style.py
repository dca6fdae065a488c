"""A style: what was tuned, as changes that fit the next head as well."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, cast

from risorius._check import as_number
from risorius.controls.presets import PresetBook
from risorius.errors import FormatError, ParameterError
from risorius.io.atomic import write_json
from risorius.io.bounded import check_schema, read_json
from risorius.layered.muscle_map import MuscleMap
from risorius.springmuscle.fit_parameters import FitParameters
from risorius.springmuscle.recipe import OutlineRecipe
from risorius.tuning.genome import Genome
from risorius.tuning.intensities import apply_intensities
from risorius.tuning.map_genes import apply_map_genes
from risorius.tuning.muscle_genes import apply_genes
from risorius.tuning.outline_genes import apply_outline_genes
from risorius.vectormuscle.muscle import VectorMuscle

__all__ = ["Style", "parse_style", "read_style", "write_style"]

SCHEMA = "risorius/style"
VERSION = 1
_DIGITS = 6
_METHODS = {"layered": "layered muscles", "springs": "spring muscles", "vector": "vector muscles"}


@dataclass(frozen=True)
class Style:
    """Tuned parameters.

    Parameters
    ----------
    parameters : mapping of str to float
        By name: of muscles, see `muscle_parameters`, `map_parameters` and `outline_parameters`;
        and how far controls go in an expression, see `intensity_parameters`.
    method : str
        The method whose parameters they are.
    """

    parameters: Mapping[str, float] = field(default_factory=dict[str, float])
    method: str = "vector"

    def with_parameters(self, values: Mapping[str, float]) -> Style:
        """Return the style with more parameters, as its file keeps them; new replace old ones."""
        rounded = {name: round(value, _DIGITS) for name, value in values.items()}
        return Style({**self.parameters, **rounded}, self.method)

    def without_muscles(self, names: Iterable[str]) -> Style:
        """Return the style without what it says of muscles (without side)."""
        gone = set(names)
        kept = {
            name: value
            for name, value in self.parameters.items()
            if gone.isdisjoint((name.partition(".")[0], _stem(name.partition(".")[0])))
        }
        return Style(kept, self.method)

    def start_of(self, genome: Genome) -> dict[str, float]:
        """Return what the style says about a genome, inside its bounds."""
        return {
            each.name: min(max(self.parameters[each.name], each.low), each.high)
            for each in genome.parameters
            if each.name in self.parameters
        }

    def require_method(self, method: str, *, source: str) -> None:
        """Refuse a style of another method.

        Raises
        ------
        ParameterError
            If its muscles are not those of `method`.
        """
        if self.method != method:
            raise ParameterError(
                f"{source}: this style was tuned on {_METHODS.get(self.method, self.method)}, not "
                f"on {_METHODS.get(method, method)}; use it with --method {self.method}, or tune "
                "one for this method"
            )

    def on_vectors(
        self, muscles: Iterable[VectorMuscle], *, width: float
    ) -> tuple[VectorMuscle, ...]:
        """Return vector muscles of another head in this style.

        Parameters
        ----------
        muscles : iterable of VectorMuscle
            As proposed for the head.
        width : float
            Width of the head [mm].
        """
        return tuple(apply_genes(muscle, self.parameters, width=width) for muscle in muscles)

    def on_map(self, muscle_map: MuscleMap) -> MuscleMap:
        """Return a muscle map in this style; it fits every head."""
        return apply_map_genes(muscle_map, self.parameters)

    def on_recipe(
        self, recipe: OutlineRecipe, *, fit: FitParameters | None = None
    ) -> OutlineRecipe:
        """Return an outline recipe in this style; it fits every head."""
        return apply_outline_genes(recipe, self.parameters, fit=fit)

    def on_presets(self, presets: PresetBook) -> PresetBook:
        """Return presets in this style."""
        return apply_intensities(presets, self.parameters)

    def unknown(self, known: Iterable[str]) -> tuple[str, ...]:
        """Return the parameters that are not among `known`, with or without their side."""
        names = set(known)
        return tuple(
            name for name in self.parameters if name not in names and _sideless(name) not in names
        )

    def to_json(self) -> dict[str, Any]:
        """Return the file's content."""
        rounded = {name: round(value, _DIGITS) for name, value in self.parameters.items()}
        return {
            "schema": SCHEMA,
            "version": VERSION,
            "method": self.method,
            "parameters": rounded,
        }


def _stem(name: str) -> str:
    return name[:-2] if name.endswith(("_l", "_r")) else name


def _sideless(name: str) -> str:
    """Return the name of a parameter whose muscle or control has lost its side."""
    muscle, dot, gene = name.partition(".")
    return f"{_stem(muscle)}{dot}{_stem(gene)}"


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
    write_json(path, style.to_json())
