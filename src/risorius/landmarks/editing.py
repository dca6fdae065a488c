"""Changes of a landmark set as a person makes them; every function returns a new one."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from scipy.spatial import cKDTree

from risorius._check import FloatArray
from risorius.errors import LandmarkError
from risorius.landmarks.feature_points import feature_points, mirror_name
from risorius.landmarks.landmark_set import LandmarkSpec
from risorius.mesh.polygon_mesh import PolygonMesh

__all__ = ["mirrored", "placed", "without"]


def placed(
    specs: Mapping[str, LandmarkSpec], name: str, place: FloatArray, mesh: PolygonMesh
) -> dict[str, LandmarkSpec]:
    """Return the set with a landmark on the vertex nearest to `place` (3,) [file frame].

    Raises
    ------
    LandmarkError
        If there is no landmark of such a name.
    """
    _require_name(name)
    used = np.unique(mesh.triangles)
    row = int(cKDTree(mesh.positions[used]).query(place)[1])
    return {**specs, name: LandmarkSpec(vertex=int(used[row]))}


def mirrored(
    specs: Mapping[str, LandmarkSpec],
    name: str,
    places: FloatArray,
    mesh: PolygonMesh,
) -> dict[str, LandmarkSpec]:
    """Return the set with the partner of a landmark at its mirror image.

    Parameters
    ----------
    specs : mapping of str to LandmarkSpec
    name : str
        Its partner is moved.
    places : (n, 3) float64
        Vertices of `mesh` in the canonical frame, where x = 0 is the mirror plane [mm].
    mesh : PolygonMesh

    Raises
    ------
    LandmarkError
        If the landmark is missing, stands on no vertex, or has no other side.
    """
    _require_name(name)
    other, spec = mirror_name(name), specs.get(name)
    if other == name:
        raise LandmarkError(f"landmarks: {name!r} lies on the midline and has no other side")
    if spec is None or spec.vertex is None:
        raise LandmarkError(f"landmarks: place {name!r} on the head first")
    used = np.unique(mesh.triangles)
    image = places[spec.vertex] * [-1.0, 1.0, 1.0]
    row = int(cKDTree(places[used]).query(image)[1])
    return {**specs, other: LandmarkSpec(vertex=int(used[row]))}


def without(specs: Mapping[str, LandmarkSpec], name: str) -> dict[str, LandmarkSpec]:
    """Return the set without a landmark.

    Raises
    ------
    LandmarkError
        If it is not there.
    """
    if name not in specs:
        raise LandmarkError(f"landmarks: there is no {name!r} to take away")
    return {key: spec for key, spec in specs.items() if key != name}


def _require_name(name: str) -> None:
    if name not in feature_points():
        raise LandmarkError(
            f"landmarks: {name[:40]!r} is no feature point; `risorius landmarks` lists them"
        )
