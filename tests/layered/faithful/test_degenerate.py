"""Degenerate input of the published face and of its solver: the rows of spec section 6.

Rows that are decided before a face is built have their tests elsewhere: landmarks that coincide or
lie in a plane in tests/warp, exchanged sides in tests/landmarks, frame and unit in tests/head,
contours on the same or a higher layer in tests/layered/test_muscle_map.py.
"""

from __future__ import annotations

import numpy as np
import pytest

from risorius.anatomy.template import builtin_head
from risorius.errors import LandmarkError, MeshError, ParameterError, RisoriusWarning, ShapeError
from risorius.head import Head
from risorius.layered.faithful import FaithfulFace, FaithfulParameters
from risorius.layered.faithful.anatomy import rebuilt
from risorius.layered.faithful.binding import bind_skin
from risorius.layered.faithful.muscle_mesh import box_mesh
from risorius.mesh.core import TriMesh
from risorius.solvers.model import Model, State
from risorius.solvers.parameters import Parameters
from risorius.solvers.pbd import Solver
from risorius.solvers.surface import surface_constraints
from tests.face_fixtures import made_up_head
from tests.layered.faithful.ground import PUBLISHED, flat_ground, grid, lay, sheet
from tests.synthetic import assemble, head_pieces, head_specs

HEAD = builtin_head()


def _quick(head: Head) -> FaithfulFace:
    return FaithfulFace.build(head, parameters=FaithfulParameters(lift=False, even=False))


def test_a_line_of_one_place_is_refused_with_muscle_and_line() -> None:
    with pytest.raises(ShapeError, match="muscle dot: first side: 1 distinct surface points"):
        lay(flat_ground(), sheet("dot", [(0, 0), (0, 0)]))


def test_points_drawn_twice_change_nothing() -> None:
    once, twice = (
        lay(flat_ground(), sheet("a", line)).lines
        for line in ([(0, 0), (0, 20), (0, 40)], [(0, 0), (0, 20), (0, 20), (0, 40)])
    )
    ground = flat_ground()
    np.testing.assert_allclose(
        once.bottom(ground.positions, ground.faces), twice.bottom(ground.positions, ground.faces),
        atol=1e-9,
    )  # fmt: skip


def test_sides_that_cross_are_refused_with_their_segments() -> None:
    bent = sheet("bent", [(0, 0), (0, 30), (4, 0)], half_width=12.0)
    with pytest.raises(
        ShapeError,
        match=r"muscle bent: contour: segment \d+ of line 1 crosses segment \d+ of line 3",
    ):
        lay(flat_ground(), bent)


def test_edges_without_length_and_faces_without_area_are_counted_and_left_out() -> None:
    positions, faces = grid(5, 5, 10.0)
    positions = positions + np.random.default_rng(0).normal(size=positions.shape)
    positions[6] = positions[7]
    mesh = TriMesh(positions, faces)
    with pytest.warns(RisoriusWarning, match="edges and faces of the mesh have no length or no a"):
        constraints = surface_constraints(mesh, with_volume=False)
    model = Model(positions, constraints)
    found = Solver().settle(model, State.at_rest(model))
    np.testing.assert_allclose(found.positions, positions, atol=1e-4)


def test_an_edge_of_three_faces_keeps_two_with_a_warning_and_the_face_is_built() -> None:
    positions, faces = grid(5, 5, 10.0)
    fin = np.array([[6, 7, len(positions)]], np.int32)
    mesh = TriMesh(np.vstack([positions, [[0.0, 0.0, 9.0]]]), np.vstack([faces, fin]))
    with pytest.warns(RisoriusWarning, match="1 edges have more than two faces"):
        constraints = surface_constraints(mesh, with_volume=False)
    assert np.isfinite(constraints.bends.rest).all()


def test_welded_lips_are_refused_in_words() -> None:
    head = Head.from_mesh(assemble(head_pieces("welded")), head_specs("welded"))
    with pytest.raises(LandmarkError, match="middle of the upper and of the lower lip"):
        FaithfulFace.build(head)


def test_a_head_without_eye_holes_has_no_lids_and_says_why() -> None:
    face = _quick(made_up_head())
    names = {control.name for control in face.controls}
    assert "lid_upper_l" not in names
    assert "frontalis_l" in names
    assert any("lid" in note or "eye" in note for note in face.notes)


def test_a_head_of_skin_alone_moves() -> None:
    bare = Head(HEAD.source, HEAD.frame, {"skin": HEAD.skin}, HEAD.landmarks)
    face = _quick(bare)
    assert face.teeth.arches == ()
    moved = face.displace({"jaw_pitch": 10.0, "zygomaticus_major_l": 1.0})
    assert np.isfinite(moved).all()
    assert np.abs(moved).max() > 5.0


def test_controls_beyond_their_range_are_clamped_and_what_is_no_number_is_refused() -> None:
    face = _quick(made_up_head())
    np.testing.assert_array_equal(
        face.displace({"frontalis_l": 7.0}), face.displace({"frontalis_l": 1.0})
    )
    np.testing.assert_array_equal(face.displace({"frontalis_l": -3.0}), face.displace({}))
    for value in (float("nan"), float("inf")):
        with pytest.raises(ParameterError, match="frontalis_l"):
            face.displace({"frontalis_l": value})


def test_a_skull_beside_the_head_is_refused_and_one_that_fits_leaves_gaps_to_neighbours() -> None:
    face = _quick(HEAD)
    free = np.setdiff1d(np.arange(HEAD.skin.mesh.vertex_count), face.anchors.vertices)
    moved = face.displace({"zygomaticus_major_l": 1.0})[HEAD.skin.first_source()]
    assert len(free) > 100
    assert np.abs(moved[free]).max() > 0.5, "what hangs on nothing follows its neighbours"
    anatomy = face.muscles.anatomy
    aside = {
        name: anatomy.positions[s.first : s.last] + [400.0, 0.0, 0.0]
        for name, s in anatomy.surfaces.items()
        if name in ("cranium", "mandible")
    }
    with pytest.raises(MeshError, match="hang on muscle or bone, 30% are needed"):
        bind_skin(rebuilt(anatomy, aside, scale=1.0), face.mechanics, 1.0, face.parameters)


def test_a_muscle_inside_out_is_turned_and_one_without_volume_is_refused() -> None:
    anatomy = flat_ground()
    laid = lay(anatomy, sheet("a", [(0, 0), (0, 40)]))
    places = anatomy.positions[laid.surface.first : laid.surface.last]
    mesh = box_mesh(laid.mesh.rows, laid.mesh.columns, PUBLISHED.sheet)
    down = places * [1.0, 1.0, -1.0]
    kept, turned = mesh.outwards(places, name="a"), mesh.outwards(down, name="a")
    np.testing.assert_array_equal(kept.faces, turned.faces[:, ::-1])
    with pytest.raises(MeshError, match="muscle a: its mesh encloses nothing"):
        mesh.outwards(places * [1.0, 1.0, 0.0], name="a")


@pytest.mark.parametrize("path", ["simd", "scalar"])
def test_slivers_with_a_stiff_area_are_warned_of_and_stay_finite(path: str) -> None:
    positions, faces = grid(6, 6, 10.0)
    positions[:, 1] *= 0.02
    positions[:, 2] = 0.3 * np.sin(positions[:, 0])
    mesh = TriMesh(positions, faces)
    with pytest.warns(RisoriusWarning, match="sliver triangles"):
        model = Model(positions, surface_constraints(mesh, with_volume=False))
    start = State(positions + np.random.default_rng(1).normal(size=positions.shape), 0 * positions)
    found = Solver(path=path).settle(  # pyright: ignore[reportArgumentType]
        model, start, parameters=Parameters(iteration_limit=100)
    )
    assert np.isfinite(found.positions).all()
    assert np.abs(found.positions).max() < 100.0
