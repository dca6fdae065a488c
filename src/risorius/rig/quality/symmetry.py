"""Left-right symmetry of shapes."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from risorius._check import FloatArray, IntArray
from risorius.controls.control import Control
from risorius.mesh.core import TriMesh
from risorius.mesh.normals import vertex_normals

__all__ = ["Asymmetry", "MirrorMap", "asymmetries", "mirror_map", "mirror_shape"]

_MIRROR = np.array([-1.0, 1.0, 1.0])
# A vertex has a partner if one lies this near to its mirror image [mm].
_NEAR = 0.2
_ENOUGH = 0.7
# Normals tell touching lips apart: opposite ones count like this distance [mm].
_NORMAL_LENGTH = 2.0
_LEAST_MOTION = 0.01
_SIDES = (("left", "right"), ("Left", "Right"), ("LEFT", "RIGHT"), ("l", "r"), ("L", "R"))
_SWAP = dict(_SIDES) | {right: left for left, right in _SIDES}
_SIDE = re.compile(
    r"(?<![A-Za-z])(?:left|right|[lrLR])(?![A-Za-z])|(?:Left|Right)(?![a-z])"
    r"|(?<![A-Za-z])(?:LEFT|RIGHT)(?![A-Za-z])|(?<![A-Za-z])(?:left|right)(?=[A-Z])"
)


@dataclass(frozen=True)
class Asymmetry:
    """Symmetry of one shape.

    Parameters
    ----------
    partner : str
        The shape it should mirror; its own name for a shape of the midline.
    largest : float
        Largest difference between the shape and its partner's mirror image, in percent of the
        largest motion of both [%].
    """

    partner: str
    largest: float


@dataclass(frozen=True, eq=False)
class MirrorMap:
    """Partners across the sagittal plane.

    Parameters
    ----------
    vertices : (k,) int32
        Vertices that have a partner.
    partners : (k,) int32
        The vertex at their mirror image.
    share : float
        Share of all vertices that have one.
    """

    vertices: IntArray
    partners: IntArray
    share: float


def mirror_map(mesh: TriMesh) -> MirrorMap | None:
    """Pair the vertices of a skin (canonical frame) with those nearest to their mirror images.

    Returns
    -------
    MirrorMap or None
        None if less than 70 % of the vertices have a partner within 0.2 mm.
    """
    normals = vertex_normals(mesh.positions, mesh.faces)
    features = np.concatenate([mesh.positions, 0.5 * _NORMAL_LENGTH * normals], axis=1)
    mirrored = features * np.tile(_MIRROR, 2)
    partner = np.asarray(cKDTree(features).query(mirrored)[1])
    gap = np.linalg.norm(mesh.positions[partner] - mesh.positions * _MIRROR, axis=1)
    vertices = np.flatnonzero(gap <= _NEAR).astype(np.int32)
    share = len(vertices) / max(mesh.vertex_count, 1)
    if share < _ENOUGH:
        return None
    return MirrorMap(vertices, partner[vertices].astype(np.int32), share)


def mirror_shape(name: str, controls: Sequence[Control] = ()) -> str:
    """Return the name of the shape that mirrors `name`; itself on the midline.

    Singles of known controls follow the registry (``gaze_yaw_l`` mirrors ``gaze_yaw_r_neg``);
    otherwise left and right are exchanged where the name says them: Left, left, l or L as a word.
    """
    known = {control.name: control for control in controls}
    base = name.removesuffix("_neg")
    control = known.get(base)
    if control is not None and (name == base or control.low < control.default):
        negative = (name != base) != (control.mirror_sign < 0.0)
        return control.mirror + "_neg" * negative
    return _SIDE.sub(lambda found: _SWAP[found.group()], name)


def asymmetries(
    names: Sequence[str],
    deltas: FloatArray,
    pairing: MirrorMap,
    *,
    partner_of: Mapping[str, str],
) -> list[Asymmetry | None]:
    """Compare every shape with the mirror image of its partner.

    Parameters
    ----------
    names : sequence of str
    deltas : (s, w, 3) float64
        Displacements of the skin [mm].
    pairing : MirrorMap
    partner_of : mapping of str to str
        From `mirror_shape`.

    Returns
    -------
    list of Asymmetry or None
        None where the partner is not in the rig or the skin does not move.
    """
    place = {name: index for index, name in enumerate(names)}
    result: list[Asymmetry | None] = []
    for index, name in enumerate(names):
        partner = partner_of[name]
        other = place.get(partner)
        if other is None:
            result.append(None)
            continue
        own = deltas[index][pairing.vertices]
        image = deltas[other][pairing.partners] * _MIRROR
        largest = np.linalg.norm(np.stack([own, image]), axis=2).max(initial=0.0)
        if largest < _LEAST_MOTION:
            result.append(None)
            continue
        difference = float(np.linalg.norm(own - image, axis=1).max())
        result.append(Asymmetry(partner, 100.0 * difference / float(largest)))
    return result
