"""Poses of the skin that have come to rest: one by itself, or many side by side in lanes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from risorius._check import FloatArray, IntArray
from risorius.layered.faithful.lips import joined_contacts
from risorius.solvers.constraints import Contacts
from risorius.solvers.kernels.simd import LANES
from risorius.solvers.model import State

if TYPE_CHECKING:
    from risorius.layered.faithful.face import FaithfulFace

__all__ = ["settled_skins", "side_by_side"]

# Below so many poses lanes would mostly be empty, and each pose is solved by itself.
_FEWEST = 4


def settled_skins(face: FaithfulFace, poses: Sequence[Mapping[str, float]]) -> FloatArray:
    """Return the skin (s, n, 3) [mm] of every pose, entered in stages and brought to rest.

    Every pose comes to rest as if it were alone. Solved in lanes it differs from the pose solved by
    itself by rounding, and where skin trembles instead of resting (slivers) by as much as that.

    Parameters
    ----------
    face : FaithfulFace
    poses : sequence of mapping of str to float
        Resolved controls of s poses.
    """
    faces = face.muscles.anatomy.faces
    ends = [face.anchors.places(face.anatomy_at(values), faces) for values in poses]
    lids = [face.lids(values) for values in poses]
    step = LANES if len(poses) >= _FEWEST else 1
    found: list[FloatArray] = []
    for first in range(0, len(poses), step):
        part = slice(first, first + step)
        found.append(_settled(face, poses[part], np.stack(ends[part]), np.stack(lids[part])))
    return np.concatenate(found)


def _settled(
    face: FaithfulFace, poses: Sequence[Mapping[str, float]], ends: FloatArray, lids: FloatArray
) -> FloatArray:
    p, skin = face.parameters, face.skin
    rest = face.head.skin.mesh.positions
    start = face.anchors.places(face.muscles.anatomy.positions, face.muscles.anatomy.faces)
    quick = replace(p.skin_solver, iteration_limit=p.ramp_sweeps)
    places = np.repeat(skin.model.rest_positions[None], len(poses), axis=0)
    for stage in range(1, p.ramp_steps):
        share = stage / p.ramp_steps
        control = start + share * (ends - start), rest + share * (lids - rest)
        places = _at_rest(face, places, *control, [None] * len(poses), limit=quick.iteration_limit)
    teeth = [face.teeth.moved(face.mechanics.jaw, face.jaw_of(values)) for values in poses]
    contacts: list[Contacts | None] = [None] * len(poses)
    open_ = np.arange(len(poses))
    for _ in range(p.contact_rounds):
        touched = [contacts[pose] for pose in open_]
        places[open_] = _at_rest(face, places[open_], ends[open_], lids[open_], touched)
        found = {
            int(pose): face.contacts(teeth[pose], places[pose, : skin.vertex_count])
            for pose in open_
        }
        open_ = np.array([pose for pose in open_ if found[int(pose)] is not None], np.int64)
        if not len(open_):
            break
        for pose in open_:
            contacts[pose] = joined_contacts([contacts[pose], found[int(pose)]])
    return places[:, : skin.vertex_count]


def _at_rest(
    face: FaithfulFace, places: FloatArray, ends: FloatArray, lids: FloatArray,
    contacts: Sequence[Contacts | None], *, limit: int | None = None,
) -> FloatArray:  # fmt: skip
    """Return the particles (s, m, 3) at rest, in lanes if there are several poses."""
    skin, p = face.skin, face.parameters.skin_solver
    parameters = p if limit is None else replace(p, iteration_limit=limit)
    if len(places) == 1:
        control = skin.control(ends[0], lids[0], contacts[0])
        state = State(places[0], np.zeros_like(places[0]))
        found = skin.solver.settle(skin.model, state, control, parameters=parameters)
        return found.positions[None]
    control = skin.control(ends, lids, side_by_side(contacts))
    state = State(places, np.zeros_like(places))
    return skin.solver.settle(skin.model, state, control, parameters=parameters).positions


def side_by_side(contacts: Sequence[Contacts | None]) -> Contacts | None:
    """Return the contacts of s poses as one table, in which those of the others are switched off.

    Parameters
    ----------
    contacts : sequence of Contacts or None
        Of every pose.
    """
    found = [(pose, one) for pose, one in enumerate(contacts) if one is not None]
    if not found:
        return None
    particles: IntArray = np.concatenate([one.particles for _, one in found])
    points = np.zeros((len(contacts), len(particles), 3))
    normals = np.zeros_like(points)
    row = 0
    for pose, one in found:
        part = slice(row, row + len(one.particles))
        points[pose, part], normals[pose, part] = one.points, one.normals
        row = part.stop
    return Contacts(particles, points, normals)
