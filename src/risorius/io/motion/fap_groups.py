"""The two groups among MPEG-4 parameters: visemes (1) and expressions (2)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from risorius.controls.visemes import MPEG4_EXPRESSIONS, mpeg4_visemes

__all__ = [
    "EXPRESSION_FIELDS",
    "GROUP_NAMES",
    "VISEME_FIELDS",
    "expression_fields",
    "expression_weights",
    "viseme_fields",
    "viseme_weights",
]

VISEME_FIELDS = 4
"""Select 1, select 2, blend (0..63, all of the first at 63), definition bit."""
EXPRESSION_FIELDS = 6
"""Select 1, intensity 1 (0..63), select 2, intensity 2, two bits for init and definition."""

_FULL = 63
_VISEMES = {viseme.number: f"viseme_mpeg4_{viseme.name}" for viseme in mpeg4_visemes()}
_EXPRESSIONS = dict(enumerate(MPEG4_EXPRESSIONS, start=1))
GROUP_NAMES = (*_VISEMES.values(), *_EXPRESSIONS.values())
"""Names of the weights that the groups become."""


def viseme_weights(fields: Sequence[int]) -> dict[str, float]:
    """Return the weights that a viseme group stands for; unknown visemes and 0 rest."""
    first, second, blend = fields[:3]
    share = min(max(blend, 0), _FULL) / _FULL
    result: dict[str, float] = {}
    for number, weight in ((first, share), (second, 1.0 - share)):
        if number in _VISEMES and weight:
            result[_VISEMES[number]] = result.get(_VISEMES[number], 0.0) + weight
    return result


def expression_weights(fields: Sequence[int]) -> dict[str, float]:
    """Return the weights that an expression group stands for."""
    result: dict[str, float] = {}
    for number, intensity in ((fields[0], fields[1]), (fields[2], fields[3])):
        weight = min(max(intensity, 0), _FULL) / _FULL
        if number in _EXPRESSIONS and weight:
            name = _EXPRESSIONS[number]
            result[name] = max(result.get(name, 0.0), weight)
    return result


def viseme_fields(values: Mapping[str, float]) -> tuple[int, ...] | None:
    """Return the group of the two strongest visemes in `values`, or None without any."""
    strongest = _strongest(values, _VISEMES)
    if not strongest:
        return None
    (first, weight), (second, other) = (*strongest, (0, 0.0))[:2]
    # The second viseme gets what the first leaves; a lone one blends with the neutral face.
    share = weight / (weight + other) if other else min(weight, 1.0)
    return first, second, round(_FULL * share), 0


def expression_fields(values: Mapping[str, float]) -> tuple[int, ...] | None:
    """Return the group of the two strongest expressions in `values`, or None without any."""
    strongest = _strongest(values, _EXPRESSIONS)
    if not strongest:
        return None
    (first, weight), (second, other) = (*strongest, (0, 0.0))[:2]
    return first, _intensity(weight), second, _intensity(other), 0, 0


def _strongest(values: Mapping[str, float], names: Mapping[int, str]) -> list[tuple[int, float]]:
    present = [(number, values[name]) for number, name in names.items() if values.get(name, 0) > 0]
    return sorted(present, key=lambda pair: -pair[1])[:2]


def _intensity(weight: float) -> int:
    return round(_FULL * min(max(weight, 0.0), 1.0))
