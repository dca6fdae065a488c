"""Sheet muscles: the skin near a fibre goes where the fibre goes."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from risorius._check import FloatArray
from risorius.anatomy.mouth import lip_body
from risorius.anatomy.outwards import unit
from risorius.anatomy.skin import Skin
from risorius.anatomy.smooth_step import smooth_step
from risorius.layered.fibres import contract, refine
from risorius.layered.muscle import Muscle, SheetAction
from risorius.layered.pulls.pull import Pull

__all__ = ["near_skin", "sheet_pull"]

_FINE = 4
_NEAREST = 6
# Depth below the skin that costs nothing, what more of it counts, and where it ends [mm].
_SHALLOW, _DEPTH_COST, _TOO_DEEP = 4.0, 0.35, 35.0
# Fibres stay below the skin, and come near it towards their insertion [mm].
_LEAST_DEPTH, _INSERTION_DEPTH, _ORIGIN_DEPTH = 1.5, 5.0, 25.0
# Distance from the lip line where tissue slides along the dental arch fully, and not at all [mm].
_ARCH = (8.0, 33.0)


def near_skin(fibres: FloatArray, skin: Skin) -> FloatArray:
    """Return fibres (h, w, 3) kept below the skin, and brought near it at their insertion [mm].

    A foreign skull never fits to the millimetre; mimic muscles end in the skin on every head.
    """
    points = fibres.reshape(-1, 3)
    seen = np.flatnonzero(~skin.hidden)
    _, nearest = cKDTree(skin.positions[seen]).query(points, k=4)
    nearest = seen[nearest]
    normal = unit(skin.normals[nearest].mean(axis=1))
    depth = np.einsum("qd,qd->q", skin.positions[nearest].mean(axis=1) - points, normal)
    along = np.repeat(np.linspace(0.0, 1.0, len(fibres)), fibres.shape[1])
    most = _INSERTION_DEPTH + (_ORIGIN_DEPTH - _INSERTION_DEPTH) * (1.0 - along)
    wanted = np.clip(depth, _LEAST_DEPTH * skin.scale, most * skin.scale)
    return (points - (wanted - depth)[:, None] * normal).reshape(fibres.shape)


def sheet_pull(muscle: Muscle, action: SheetAction, fibres: FloatArray, skin: Skin) -> Pull:
    """Return the pull of the left (or only) half of a sheet muscle.

    Parameters
    ----------
    muscle : Muscle
    action : SheetAction
        Of the muscle.
    fibres : (h, w, 3) float64
        In the head, from `near_skin` [mm].
    skin : Skin
    """
    moved = contract(fibres, muscle.shortening, fixed_point=action.fixed_point) - fibres
    places = refine(fibres, _FINE).reshape(-1, 3)
    motion = refine(moved, _FINE).reshape(-1, 3)
    distance, nearest = cKDTree(places).query(skin.positions, k=min(_NEAREST, len(places)))
    share = 1.0 / (distance + 0.5)
    goal = np.einsum("nk,nkd->nd", share, motion[nearest]) / share.sum(axis=1)[:, None]
    weight = _reach(skin, skin.positions - places[nearest[:, 0]], action.reach)
    if action.lip is not None:
        weight = weight * (skin.mouth.side * (1.0 if action.lip == "upper" else -1.0) >= 0.0)
    if action.corner:
        weight = weight * (1.0 - action.corner * lip_body(skin.mouth))
    normal = np.einsum("nd,nd->n", goal, skin.broad_normals)[:, None] * skin.broad_normals
    goal = goal - action.tangential * normal
    if action.arch:
        goal = _along_arch(goal, skin, action.arch)
    rows = len(fibres) * _FINE - _FINE + 1
    along = (nearest[:, 0] // (len(places) // rows)) / (rows - 1.0)
    out = action.push + action.bulge * (1.0 - along)
    goal = goal + (out * skin.scale)[:, None] * skin.broad_normals
    goal[:, 0] += action.sideways * skin.scale * (1.0 - along) * np.sign(fibres[..., 0].mean())
    weight = weight * (1.0 - action.slide * (1.0 - along**2))
    return Pull(action.stiffness * weight, goal, action.seal)


def _reach(skin: Skin, offset: FloatArray, reach: float) -> FloatArray:
    """Return the fall-off (n,): distance along the skin counts, shallow depth does not."""
    scale = skin.scale
    depth = np.einsum("nd,nd->n", offset, skin.normals)
    across = np.linalg.norm(offset - depth[:, None] * skin.normals, axis=1)
    deep = _DEPTH_COST * np.maximum(np.abs(depth) - _SHALLOW * scale, 0.0)
    effective = np.hypot(across, deep)
    inside = np.abs(depth) < _TOO_DEEP * scale
    return smooth_step(1.0 - effective / (reach * scale)) * inside * ~skin.hidden


def _along_arch(goal: FloatArray, skin: Skin, share: float) -> FloatArray:
    """Let tissue near the mouth that slides sideways follow the dental arch backwards."""
    mouth = skin.mouth
    near = 1.0 - (mouth.distance - _ARCH[0]) / (_ARCH[1] - _ARCH[0])
    weight = share * smooth_step(near)
    arrived = mouth.place + goal[:, 0] / mouth.half_width
    drop = mouth.arch_drop(arrived) - mouth.arch_drop(mouth.place)
    result = goal.copy()
    result[:, 2] = (1.0 - weight) * goal[:, 2] + weight * drop
    return result
