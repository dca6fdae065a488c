"""Over-relaxation: a guess of where the skin will come to rest, before any step is taken."""

from __future__ import annotations

import numpy as np

from risorius._check import FloatArray
from risorius.springmuscle.driving import Drive
from risorius.springmuscle.skin import SkinSprings

__all__ = ["start_of"]


def start_of(springs: SkinSprings, drive: Drive, *, passes: int) -> FloatArray:
    """Return positions (n, 3) [mm] to start from (Kaehler et al. 2001, section 5).

    Each vertex moves with the mean of its feet, weighted by stiffness against what draws it home;
    skin that hangs on nothing takes the mean of its neighbours in `passes` passes (ours; the paper
    leaves it open). Where it is known what every muscle does alone, their sum is nearer.

    Parameters
    ----------
    springs : SkinSprings
    drive : Drive
        What the pose asks for.
    passes : int
        0 starts from the reference.
    """
    if passes == 0:
        return drive.reference
    if drive.guess is not drive.reference:
        return drive.guess
    skin, n = springs.skin, len(drive.reference)
    stiffness = springs.stiffness * drive.activity
    total = np.bincount(springs.vertices, stiffness, n)
    moved = 0.5 * (drive.feet + drive.partners)
    motion = np.stack(
        [np.bincount(springs.vertices, stiffness * moved[:, axis], n) for axis in range(3)], axis=1
    )
    held = total + springs.tissue
    known = held > 0.0
    motion[known] /= held[known, None]
    for _ in range(passes):
        motion = skin.average @ motion
    motion[springs.network.fixed] = 0.0
    return drive.reference + motion
