"""How one number of a muscle may change, so that the change means the same on every head."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import dataclass
from typing import Literal

import numpy as np

from risorius.tuning.genome import Parameter

__all__ = ["Change", "Gene", "Genes", "parameters_of"]

Genes = Literal["published", "all"]
"""Numbers of a muscle that are tuned: those of its publication, or also those that are ours."""

Way = Literal["shift", "factor", "add", "share"]


@dataclass(frozen=True)
class Change:
    """A rule for one number.

    Parameters
    ----------
    way : {"shift", "factor", "add", "share"}
        ``shift`` adds a share of a size of the head, ``factor`` multiplies, ``add`` adds, and
        ``share`` adds to a number that stays between `low` and `high`.
    low, high : float
        Bounds of the change; of the number itself for ``share``.
    least, most : float
        What the number never leaves.
    """

    way: Way
    low: float
    high: float
    least: float = -np.inf
    most: float = np.inf

    @property
    def neutral(self) -> float:
        """The change that changes nothing."""
        return 1.0 if self.way == "factor" else 0.0

    def parameter(self, name: str, value: float) -> Parameter | None:
        """Return what can be tuned of a number; None of 0, which no factor changes."""
        low, high = self.low, self.high
        if self.way == "share":
            low, high = min(low - value, 0.0), max(high - value, 0.0)
        elif self.way == "factor" and value == 0.0:
            return None
        return Parameter(name, low, high, self.neutral)

    def applied(self, value: float, change: float, *, size: float = 1.0) -> float:
        """Return the changed number; `size` is what shifts are shares of."""
        if change == self.neutral:
            return value
        if self.way == "factor":
            value = value * change
        else:
            value = value + change * (size if self.way == "shift" else 1.0)
        low, high = (self.low, self.high) if self.way == "share" else (self.least, self.most)
        return float(np.clip(value, low, high))


@dataclass(frozen=True)
class Gene:
    """One number of one muscle.

    Parameters
    ----------
    muscle : str
        Without side where both sides share it.
    name : str
    change : Change
    value : float
        Before tuning.
    """

    muscle: str
    name: str
    change: Change
    value: float


def parameters_of(
    genes: Iterable[Gene], further: Collection[str], *, which: Genes
) -> tuple[Parameter, ...]:
    """Return the parameters of genes, named muscle, dot, gene.

    Parameters
    ----------
    genes : iterable of Gene
    further : collection of str
        Names of genes that only ``"all"`` tunes.
    which : {"published", "all"}
    """
    result: dict[str, Parameter] = {}
    for gene in genes:
        if which == "published" and gene.name in further:
            continue
        full = f"{gene.muscle}.{gene.name}"
        parameter = gene.change.parameter(full, gene.value)
        if parameter is not None:
            result[full] = parameter
    return tuple(result.values())
