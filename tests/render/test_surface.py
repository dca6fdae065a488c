"""Surfaces and their tables."""

import numpy as np
import pytest

from risorius.errors import ParameterError, ShapeError
from risorius.mesh.core import TriMesh
from risorius.mesh.normals import vertex_normals
from risorius.render import Surface
from risorius.render.kernels.raster import area_normals
from tests.render.scenes import ball, square

CORNERS = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]])
FACES = np.array([[0, 1, 2], [0, 2, 3]])


@pytest.mark.parametrize(
    ("look", "error", "message"),
    [
        ({"positions": CORNERS * [1.0, np.nan, 1.0]}, ShapeError, "positions: row 0"),
        ({"positions": CORNERS[:, :2]}, ShapeError, r"positions: expected shape \(n, 3\)"),
        ({"faces": FACES + 2}, ShapeError, "faces: row 0"),
        ({"colour": (1.0, 0.5)}, ShapeError, r"colour: expected shape \(3,\) or \(4, 3\)"),
        ({"colour": (200.0, 10.0, 0.0)}, ParameterError, "colour: entry 0.*divide 8-bit"),
        ({"colour": np.full((2, 3), np.nan)}, ParameterError, "colour: entry 0"),
        ({"ramp": np.eye(3)}, ShapeError, r"colour: expected shape \(4,\) or \(4, 3\)"),
        ({"ramp": np.zeros((0, 3)), "colour": np.zeros(4)}, ShapeError, "at least one colour"),
        ({"opacity": 1.5}, ParameterError, "opacity: 1.5 is above 1"),
        ({"gloss": -0.1}, ParameterError, "gloss: -0.1 is below 0"),
        ({"normals": CORNERS[:2]}, ShapeError, "normals: expected 4 rows, got 2"),
    ],
)
def test_a_bad_surface_is_refused(look: dict, error: type, message: str) -> None:
    with pytest.raises(error, match=message):
        Surface(**({"positions": CORNERS, "faces": FACES} | look))


def test_a_mesh_becomes_a_surface() -> None:
    surface = Surface.of(TriMesh(CORNERS, FACES), colour=(0.1, 0.2, 0.3), opacity=0.5)
    np.testing.assert_array_equal(surface.positions, CORNERS)
    np.testing.assert_array_equal(surface.faces, FACES)
    assert surface.opacity == 0.5


def test_computed_normals_are_those_of_the_mesh_weighted_by_area() -> None:
    shape = ball(8)
    found = np.zeros_like(shape.positions)
    area_normals(shape.positions, shape.faces, found)
    expected = vertex_normals(shape.positions, shape.faces, weighting="area")
    np.testing.assert_allclose(found, expected, atol=1e-12)
    outwards = shape.positions / 10.0
    assert np.einsum("ij,ij->i", found, outwards).min() > 0.9


def test_a_square_faces_forward() -> None:
    found = np.zeros((4, 3))
    area_normals(square().positions, square().faces, found)
    np.testing.assert_array_equal(found, [[0.0, 0.0, 1.0]] * 4)
