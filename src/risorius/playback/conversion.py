"""Streams of one standard as streams of another, through a rig that has both.

The rig is posed as the stream says; the weights of the wanted set are those that bring its
vertices nearest to that pose (bounded least squares over all vertices), and MPEG-4 parameters are
read at the feature points. How far the two poses are apart is part of the answer.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from risorius._check import FloatArray, one_of
from risorius.controls.fap import fap_name, fap_number
from risorius.controls.head_turn import (
    HEAD_TURN_FAPS,
    HEAD_TURNS,
    head_turn_of,
    parameters_of_turn,
)
from risorius.controls.stream import Stream, StreamFrame
from risorius.errors import ParameterError
from risorius.playback.bounded_fit import fit_bounded
from risorius.playback.inner_products import inner_products
from risorius.playback.shape_names import TARGET_SETS, set_of
from risorius.playback.weights import RigWeights
from risorius.rig.rig import Rig

__all__ = ["ConversionError", "converted"]

_EFFORT = 1e-6  # of a full weight, as a share of the mean energy of a target


@dataclass
class ConversionError:
    """How far the converted stream is from the one it was made of; filled while it is read.

    Parameters
    ----------
    frame_count : int
    mean, largest : float
        Distance of the vertices that move, root mean square over them, over all frames and in
        the worst one [mm].
    parameters : mapping of str to (mean, largest)
        Root mean square and largest difference of each asked ``fap_*`` [FAPU].
    """

    frame_count: int = 0
    mean: float = 0.0
    largest: float = 0.0
    parameters: dict[str, tuple[float, float]] = field(
        default_factory=dict[str, tuple[float, float]]
    )
    _squares: float = 0.0

    def add(self, square: float, differences: Mapping[str, float]) -> None:
        """Count a frame: mean square distance [mm^2] and differences of parameters [FAPU]."""
        before = self.frame_count
        self.frame_count += 1
        self._squares += square
        self.mean = float(np.sqrt(self._squares / self.frame_count))
        self.largest = max(self.largest, float(np.sqrt(square)))
        for name, difference in differences.items():
            mean, largest = self.parameters.get(name, (0.0, 0.0))
            total = mean * mean * before + difference * difference
            self.parameters[name] = (
                float(np.sqrt(total / self.frame_count)),
                max(largest, abs(difference)),
            )


def converted(stream: Stream, weights: RigWeights, *, to: str) -> tuple[Stream, ConversionError]:
    """Return the stream in the shapes of another set, and its error.

    Parameters
    ----------
    stream : Stream
    weights : RigWeights
        Of the rig that both sets are compared on.
    to : str
        One of `TARGET_SETS`. Turns of the head are passed on: to ``fap`` as ``fap_48`` ..
        ``fap_50``, to every other set as ``head_pitch``, ``head_yaw`` and ``head_roll`` [deg].

    Returns
    -------
    Stream, ConversionError
        The error is that of the latest passage through the stream.

    Raises
    ------
    ParameterError
        If the set is unknown, or the rig has none of its shapes.
    LandmarkError
        If parameters are wanted and the rig carries too few landmarks.
    """
    one_of("to", to, TARGET_SETS)
    error = ConversionError()
    change = _ToFap(weights) if to == "fap" else _ToTargets(weights.rig, to)
    parameters = tuple(parameter for parameter, _ in HEAD_TURN_FAPS.values())
    turning = set(stream.names) & {*HEAD_TURNS, *parameters}
    turns = (parameters if to == "fap" else HEAD_TURNS) if turning else ()

    def frames() -> Iterator[StreamFrame]:
        error.__init__()
        for frame in stream:
            row = weights.of(frame.values)
            values, square = change.of(row)
            if turns:
                values |= _turn(frame.values, to)
            asked = {name: value for name, value in frame.values.items() if fap_number(name)}
            differences: dict[str, float] = {}
            if asked:
                made = weights.fit.values(row)
                differences = {n: made[n] - value for n, value in asked.items() if n in made}
            error.add(square, differences)
            yield StreamFrame(frame.time, values)

    return replace(stream, names=(*change.names, *turns), open=frames), error


def _turn(values: Mapping[str, float], to: str) -> dict[str, float]:
    turn = head_turn_of(values)
    return parameters_of_turn(turn) if to == "fap" else dict(zip(HEAD_TURNS, turn, strict=True))


class _ToFap:
    """Reads parameters off weights."""

    def __init__(self, weights: RigWeights) -> None:
        self._fit = weights.fit
        self.names = tuple(fap_name(n) for n in self._fit.reading.numbers)

    def of(self, row: FloatArray) -> tuple[dict[str, float], float]:
        return self._fit.values(row), 0.0


class _ToTargets:
    """Fits the targets of a set to a pose of all targets."""

    def __init__(self, rig: Rig, to: str) -> None:
        chosen = [i for i, target in enumerate(rig.targets) if set_of(target.name) == to]
        if not chosen:
            raise ParameterError(
                f"to: the rig has no shapes of the set {to!r}; make it with --shapes ...,{to}"
            )
        self.names = tuple(rig.names[index] for index in chosen)
        self._chosen = np.array(chosen, np.intp)
        self._others = np.setdiff1d(np.arange(len(rig.targets)), self._chosen)
        self._gram, moving = inner_products(rig)
        self._moving = max(moving, 1)
        own = self._gram[np.ix_(self._chosen, self._chosen)]
        self._own = own + (_EFFORT * np.trace(own) / len(own) + 1e-12) * np.eye(len(own))
        self._still = own.diagonal() <= 0.0

    def of(self, row: FloatArray) -> tuple[dict[str, float], float]:
        if not row[self._others].any():
            return dict(zip(self.names, row[self._chosen].tolist())), 0.0
        count = len(self._chosen)
        high = np.where(self._still, 0.0, 1.0)
        linear = self._gram[self._chosen] @ row
        found = fit_bounded(self._own, linear, low=np.zeros(count), high=high)
        apart = row.copy()
        apart[self._chosen] -= found
        square = max(float(apart @ self._gram @ apart), 0.0) / self._moving
        return dict(zip(self.names, found.tolist())), square
