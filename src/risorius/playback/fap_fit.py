"""From MPEG-4 parameters to weights of a rig's targets, and back.

Each target is read at the feature points once (`FapReading`): column j of M holds the parameters
[FAPU] that target j makes at weight 1. A rig in the weights w then makes M w, and the weights for
wanted parameters b are a bounded least-squares fit of M w = b. Neighbouring points move together
on a real face (2.2 and 8.1 lie on one lip), so parameters are fitted together and never added up.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray
from risorius.controls.fap import fap_name, fap_number, faps
from risorius.errors import ParameterError
from risorius.playback.bounded_fit import fit_bounded
from risorius.playback.reading import FapReading
from risorius.playback.shape_names import set_of
from risorius.rig.rig import Rig

__all__ = ["FapFit"]

_ENOUGH = 20  # targets of one set that can stand for a whole face
_PREFERENCE = ("singles", "fap", "arkit", "facs")
_ABSENT = 3e-3  # weight of parameters that a frame says nothing of
_EFFORT = 4e-5  # cost of a full weight [mm^2]; so small that what can be made is made
_EYE_RADIUS = 12.0  # length at which a turn counts [mm]
_MOST_MASKS = 64


@dataclass(frozen=True, eq=False)
class FapFit:
    """A rig as MPEG-4 parameters see it.

    Parameters
    ----------
    reading : FapReading
    matrix : (k, t) float64
        M: parameters of each target, rows as in `reading.numbers`.
    basis : (b,) int
        Targets that the fit uses.
    low, high : (b,) float64
        Bounds of their weights.
    contraries : (c, 2) int
        Places in the basis of the two ends of a control.
    """

    reading: FapReading
    matrix: FloatArray
    basis: npt.NDArray[np.intp]
    low: FloatArray
    high: FloatArray
    contraries: npt.NDArray[np.intp]
    _systems: dict[tuple[int, ...], tuple[FloatArray, FloatArray]] = field(
        default_factory=dict[tuple[int, ...], tuple[FloatArray, FloatArray]], repr=False
    )

    @staticmethod
    def of_rig(rig: Rig) -> FapFit:
        """Read all targets of a rig.

        Raises
        ------
        LandmarkError
            If the rig carries too few landmarks.
        ParameterError
            If it has no target that moves.
        """
        reading = FapReading.of_rig(rig)
        matrix = np.zeros((len(reading.numbers), len(rig.targets)))
        for column, target in enumerate(rig.targets):
            dense = target.dense(rig.mesh.vertex_count)
            matrix[:, column] = reading.values(rig.frame.vectors_to_canonical(dense))
        basis = _basis(rig)
        if not len(basis):
            raise ParameterError("rig: no target moves anything, there is nothing to play with")
        low, high = np.zeros(len(basis)), np.ones(len(basis))
        for place, column in enumerate(basis):
            name = rig.names[column]
            number = fap_number(name.removesuffix("_neg"))
            if number is not None and number in reading.numbers:
                gain = matrix[reading.numbers.index(number), column]
                low[place], high[place] = _fap_bounds(number, float(gain), name, rig)
        place = {rig.names[column]: row for row, column in enumerate(basis)}
        ends = [(place[n], place[f"{n}_neg"]) for n in place if f"{n}_neg" in place]
        contraries = np.array(ends, np.intp).reshape(-1, 2)
        return FapFit(reading, matrix, basis, low, high, contraries)

    def values(self, weights: FloatArray) -> dict[str, float]:
        """Return the parameters [FAPU] that the weights (t,) of all targets make."""
        made = self.matrix @ weights
        return {fap_name(n): float(value) for n, value in zip(self.reading.numbers, made)}

    def weights(self, values: Mapping[str, float]) -> FloatArray:
        """Return the weights (t,) of all targets that come nearest to the ``fap_*`` in `values`."""
        numbers = self.reading.numbers
        present = tuple(row for row, n in enumerate(numbers) if fap_name(n) in values)
        result = np.zeros(self.matrix.shape[1])
        if not present:
            return result
        gram, scaled = self._system(present)
        wanted = np.array([values[fap_name(numbers[row])] for row in present])
        linear = scaled.T @ (wanted * self._scale[list(present)])
        result[self.basis] = self._without_contraries(gram, linear)
        return result

    def _without_contraries(self, gram: FloatArray, linear: FloatArray) -> FloatArray:
        """Return the best weights (b,) in which no control goes both of its ways at once.

        Where the free answer has both ends of a control, the one that does less is let go and the
        rest is fitted again. What an end does is its weight times the size of its motion: ends may
        reach differently far, and by weight alone a jaw would jump where its net motion passes
        zero. Every round lets go of more, so that there is an end.
        """
        high, size = self.high.copy(), np.sqrt(gram.diagonal())
        while True:
            found = fit_bounded(gram, linear, low=self.low, high=high)
            up, down = self.contraries[:, 0], self.contraries[:, 1]
            both = (found[up] > 0.0) & (found[down] > 0.0)
            if not both.any():
                return found
            does = found * size
            smaller = np.where(does[up] < does[down], up, down)[both]
            high[smaller] = 0.0

    @property
    def _scale(self) -> FloatArray:
        turns = ~self.reading.direction.any(axis=1)
        return self.reading.unit * np.where(turns, _EYE_RADIUS, 1.0)

    def _system(self, present: tuple[int, ...]) -> tuple[FloatArray, FloatArray]:
        """Return normal matrix (b, b) and scaled rows (p, b) of the parameters in a frame."""
        if present not in self._systems:
            if len(self._systems) >= _MOST_MASKS:
                self._systems.clear()
            rows = self.matrix[:, self.basis] * self._scale[:, None]
            share = np.full(len(rows), _ABSENT)
            share[list(present)] = 1.0
            gram = (rows * share[:, None]).T @ rows + _EFFORT * np.eye(len(self.basis))
            self._systems[present] = (gram, rows[list(present)])
        return self._systems[present]


def _basis(rig: Rig) -> npt.NDArray[np.intp]:
    """Return the targets of the first set that is rich enough, else all that move."""
    kinds = [set_of(target.name) if len(target.vertices) else "" for target in rig.targets]
    kinds = ["" if kind == "pairs" else kind for kind in kinds]
    if rig.controls:
        # What a person named freely is no single, where the rig knows its controls.
        singles = {control.name for control in rig.controls}
        singles |= {f"{name}_neg" for name in singles}
        kinds = [
            "own" if kind == "singles" and name not in singles else kind
            for kind, name in zip(kinds, rig.names)
        ]
    for wanted in _PREFERENCE:
        found = np.flatnonzero([kind == wanted for kind in kinds])
        if len(found) >= _ENOUGH:
            return found
    return np.flatnonzero([kind != "" for kind in kinds])


def _fap_bounds(number: int, gain: float, name: str, rig: Rig) -> tuple[float, float]:
    """Return the weights at which a target makes the sane bounds of its own parameter."""
    fap = faps()[number]
    if name.endswith("_neg"):
        return 0.0, max(fap.low / gain, 0.0) if gain < 0.0 else 1.0
    if gain <= 0.0:
        return 0.0, 1.0
    two_way = f"{name}_neg" not in rig.by_name
    return (fap.low / gain if two_way else 0.0), fap.high / gain
