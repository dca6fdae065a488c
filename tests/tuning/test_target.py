"""Sculpted shapes: which files are read, and what is no target."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest

from risorius._check import FloatArray
from risorius.anatomy.template import builtin_head
from risorius.errors import FormatError, ParameterError, ShapeError
from risorius.rig.bake import bake
from risorius.rig.rig import Rig
from risorius.tuning.target import read_target, require_target
from tests.face_fixtures import builtin_face
from tests.tuning.faces import expression

HEAD = builtin_head()


def _smile(size: float = 1.0) -> FloatArray:
    """Return the smiling head in its file's frame."""
    posed = builtin_face().pose(expression(builtin_face(), "joy"))
    return HEAD.frame.to_input(HEAD.positions + size * (posed - HEAD.positions))


def _refused(positions: npt.ArrayLike) -> str:
    with pytest.raises((ParameterError, ShapeError)) as caught:
        require_target(HEAD, positions, source="smile.obj")
    assert str(caught.value).startswith("smile.obj: ")
    return str(caught.value)


def test_a_sculpted_head_comes_into_the_canonical_frame() -> None:
    posed = builtin_face().pose(expression(builtin_face(), "joy"))
    assert np.allclose(require_target(HEAD, _smile(), source="x"), posed)


def test_wide_open_jaws_are_expressions_too() -> None:
    posed = builtin_face().pose({"jaw_pitch": 18.0, "jaw_yaw": 5.0, "jaw_protrusion": 8.0})
    require_target(HEAD, HEAD.frame.to_input(posed), source="x")


def test_another_number_of_vertices_is_refused() -> None:
    assert "without splitting, merging or adding vertices" in _refused(_smile()[:-1])


def test_numbers_that_are_none_are_refused_with_their_vertex() -> None:
    broken = _smile()
    broken[17, 1] = np.nan
    assert "vertex 17 is" in _refused(broken)


@pytest.mark.parametrize("factor", [0.001, 0.1, 10.0, 100.0])
def test_another_unit_is_refused(factor: float) -> None:
    assert f"is {factor:.4g} times as large" in _refused(factor * _smile()).replace(
        "0.09999", "0.1"
    )


def test_a_turned_or_shifted_head_is_refused() -> None:
    c, s = np.cos(0.2), np.sin(0.2)
    turned = _smile() @ np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
    assert "turned by 11.5 deg" in _refused(turned)
    assert "in the pose of the head" in _refused(_smile() + [0.0, 50.0, 0.0])


def test_another_axis_up_is_refused() -> None:
    x, y, z = _smile().T
    assert "turned by 90.0 deg" in _refused(np.stack([x, -z, y], axis=1))


def test_another_order_of_vertices_is_refused() -> None:
    shuffled = np.random.default_rng(0).permutation(_smile())
    assert "exported in another order" in _refused(shuffled)


def test_the_neutral_head_is_no_expression() -> None:
    assert "is the neutral head itself" in _refused(HEAD.frame.to_input(HEAD.positions))


def test_nothing_at_all_is_refused() -> None:
    assert "0 vertices" in _refused(np.zeros((0, 3)))
    assert _refused(np.zeros_like(HEAD.positions))


def _rig() -> Rig:
    face = builtin_face()
    return bake(face, {name: expression(face, name) for name in ("joy", "anger")})


@pytest.mark.parametrize("name", ["face.glb", "face.npz"])
def test_a_rig_gives_the_shape_of_the_expression_or_the_one_named(
    tmp_path: Path, name: str
) -> None:
    path = tmp_path / name
    _rig().save(path)
    face = builtin_face()
    for shapes, wanted in ((None, "joy"), ({"anger": 1.0}, "anger")):
        found = read_target(path, HEAD, expression="joy", shapes=shapes)
        assert np.abs(found - face.pose(expression(face, wanted))).max() < 1e-3
    with pytest.raises(ParameterError, match="has no shape 'fear'; name one of its 2 with"):
        read_target(path, HEAD, expression="joy", shapes={"fear": 1.0})


def test_shapes_of_a_rig_add_up_to_a_target(tmp_path: Path) -> None:
    rig = _rig()
    rig.save(tmp_path / "face.npz")
    weights = {"joy": 0.5, "anger": 0.8}
    found = read_target(tmp_path / "face.npz", HEAD, expression="joy", shapes=weights)
    assert np.allclose(found, HEAD.frame.to_canonical(rig.posed(weights)))


def test_positions_in_an_archive_are_a_target(tmp_path: Path) -> None:
    np.savez(tmp_path / "smile.npz", positions=_smile())
    found = read_target(tmp_path / "smile.npz", HEAD, expression="joy")
    assert np.allclose(found, require_target(HEAD, _smile(), source="x"))


@pytest.mark.parametrize("name", ["smile.glb", "smile.npz"])
def test_a_rig_without_shapes_is_the_head_itself(tmp_path: Path, name: str) -> None:
    rig = _rig().subset(())
    mesh = replace(rig.mesh, positions=_smile())
    replace(rig, mesh=mesh).save(tmp_path / name)
    found = read_target(tmp_path / name, HEAD, expression="joy")
    assert np.abs(found - require_target(HEAD, _smile(), source="x")).max() < 1e-3


def test_ply_files_are_read_and_have_no_shapes(tmp_path: Path) -> None:
    mesh = HEAD.source
    lines = [
        "ply", "format ascii 1.0", f"element vertex {mesh.vertex_count}",
        *(f"property float {axis}" for axis in "xyz"),
        f"element face {len(mesh.triangles)}", "property list uchar int vertex_indices",
        "end_header", *(" ".join(f"{value:.6f}" for value in place) for place in _smile()),
        *("3 " + " ".join(map(str, face)) for face in mesh.triangles),
    ]  # fmt: skip
    path = tmp_path / "smile.ply"
    path.write_text("\n".join(lines) + "\n")
    found = read_target(path, HEAD, expression="joy")
    assert np.abs(found - require_target(HEAD, _smile(), source="x")).max() < 1e-3
    with pytest.raises(ParameterError, match="is no rig, it has no shape 'joy'"):
        read_target(path, HEAD, expression="joy", shapes={"joy": 1.0})


@pytest.mark.parametrize("name", ["gone.obj", "gone.glb", "gone.npz", "gone.ply"])
def test_a_missing_file_is_refused(tmp_path: Path, name: str) -> None:
    with pytest.raises(FormatError, match="no such file"):
        read_target(tmp_path / name, HEAD, expression="joy")
