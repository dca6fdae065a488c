"""The order in which muscles lie on one another: deep before superficial."""

from __future__ import annotations

from collections.abc import Sequence
from graphlib import CycleError, TopologicalSorter

from risorius.errors import ParameterError
from risorius.layered.muscle import BONES, Muscle

__all__ = ["layer_order"]


def layer_order(muscles: Sequence[Muscle]) -> tuple[Muscle, ...]:
    """Return the muscles so that each comes after everything it lies on.

    Among muscles that do not depend on one another the layer decides, then their given order.

    Raises
    ------
    ParameterError
        If a name is listed twice, a muscle lies on something unknown, on one of its own or a
        higher layer, or if muscles lie on one another in a circle.
    """
    by_name = {muscle.name: muscle for muscle in muscles}
    if len(by_name) < len(muscles):
        names = [muscle.name for muscle in muscles]
        twice = next(name for name in names if names.count(name) > 1)
        raise ParameterError(f"muscle map: {twice} is listed twice; give each muscle once")
    for muscle in muscles:
        _require_known(muscle, by_name)
    sorter = TopologicalSorter(
        {muscle.name: [name for name in muscle.on if name in by_name] for muscle in muscles}
    )
    try:
        sorter.prepare()
    except CycleError as error:
        circle = " on ".join(reversed(error.args[1]))
        raise ParameterError(
            f"muscle map: muscles lie on one another in a circle ({circle}); remove one of them "
            "from an 'on' list"
        ) from None
    for muscle in muscles:
        _require_deeper(muscle, by_name)
    place = {muscle.name: number for number, muscle in enumerate(muscles)}
    return tuple(sorted(muscles, key=lambda muscle: (muscle.layer, place[muscle.name])))


def _require_known(muscle: Muscle, by_name: dict[str, Muscle]) -> None:
    for name in muscle.on:
        if name not in by_name and name not in BONES:
            raise ParameterError(
                f"muscle {muscle.name}: lies on {name!r}, which is neither a muscle of the map nor "
                f"one of {', '.join(BONES)}"
            )


def _require_deeper(muscle: Muscle, by_name: dict[str, Muscle]) -> None:
    for name in muscle.on:
        if name in by_name and by_name[name].layer >= muscle.layer:
            raise ParameterError(
                f"muscle {muscle.name}: layer {muscle.layer} lies on {name} of layer "
                f"{by_name[name].layer}; it must lie on deeper layers"
            )
