# pyright: basic
# ruff: noqa: PLR0912, PLR0913, PLR0915, PLR0917
"""Sort constraints into groups that share no particle."""

import numpy as np
from numba import njit

__all__ = ["group_disjoint"]

# Groups that are filled at the same time; one bit each.
_OPEN = 24


@njit(cache=True, error_model="numpy")
def _close(group, filled, age, inside, member, particles, count, rows):
    """Write an open group to the result and forget its particles."""
    for slot in range(member[group]):
        rows[count, slot] = inside[group, slot]
        for corner in range(particles.shape[1]):
            filled[particles[inside[group, slot], corner]] &= ~(np.uint64(1) << np.uint64(group))
    member[group] = 0
    age[group] = 0


@njit(cache=True, error_model="numpy")
def group_disjoint(particles, partners, particle_count, lanes):
    """Return groups (g, lanes) of row numbers of `particles` (k, c), -1 where empty.

    Every row goes, in order, into the oldest open group that has room and none of its particles;
    with it goes its partner (k,), the row that must be projected at the same time, -1 if none.
    """
    row_count = particles.shape[0]
    rows = np.full((row_count + _OPEN, lanes), -1, np.int32)
    inside = np.zeros((_OPEN, lanes), np.int32)
    member = np.zeros(_OPEN, np.int64)
    age = np.zeros(_OPEN, np.int64)
    filled = np.zeros(particle_count, np.uint64)
    placed = np.zeros(row_count, np.bool_)
    count = 0
    clock = 0
    for row in range(row_count):
        if placed[row]:
            continue
        partner = partners[row]
        need = 1 if partner < 0 else 2
        taken = np.uint64(0)
        for corner in range(particles.shape[1]):
            taken |= filled[particles[row, corner]]
            if need == 2:
                taken |= filled[particles[partner, corner]]
        best = -1
        vacant = -1
        oldest = -1
        for group in range(_OPEN):
            if member[group] == 0:
                if vacant < 0:
                    vacant = group
                continue
            if oldest < 0 or age[group] < age[oldest]:
                oldest = group
            free = (taken >> np.uint64(group)) & np.uint64(1) == 0
            if free and member[group] + need <= lanes and (best < 0 or age[group] < age[best]):
                best = group
        if best < 0:
            if vacant < 0:
                _close(oldest, filled, age, inside, member, particles, count, rows)
                count += 1
                vacant = oldest
            best = vacant
            clock += 1
            age[best] = clock
        for turn in range(need):
            chosen = row if turn == 0 else partner
            inside[best, member[best]] = chosen
            member[best] += 1
            placed[chosen] = True
            for corner in range(particles.shape[1]):
                filled[particles[chosen, corner]] |= np.uint64(1) << np.uint64(best)
        if member[best] == lanes:
            _close(best, filled, age, inside, member, particles, count, rows)
            count += 1
    while True:
        oldest = -1
        for group in range(_OPEN):
            if member[group] > 0 and (oldest < 0 or age[group] < age[oldest]):
                oldest = group
        if oldest < 0:
            break
        _close(oldest, filled, age, inside, member, particles, count, rows)
        count += 1
    return rows[:count].copy()
