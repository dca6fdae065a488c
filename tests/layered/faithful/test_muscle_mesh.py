from __future__ import annotations

import numpy as np
import pytest

from risorius.errors import MeshError
from risorius.layered.faithful.muscle_mesh import box_mesh, ring_mesh
from risorius.layered.faithful.parameters import RingStiffness, SheetStiffness
from risorius.mesh.core import TriMesh
from risorius.mesh.topology import report
from risorius.solvers.gradients import volume_value


def _box(rows: int, columns: int) -> np.ndarray:
    r, c = np.divmod(np.arange(rows * columns), columns)
    bottom = np.stack([c, r, 0.0 * r], axis=1)
    return np.concatenate([bottom, bottom + [0.0, 0.0, 0.5]])


def _ring(columns: int) -> np.ndarray:
    angle = 2.0 * np.pi * np.arange(columns) / columns
    row = np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], axis=1)
    bottom = np.concatenate([row, 2.0 * row])
    return np.concatenate([bottom, bottom + [0.0, 0.0, 0.5]])


@pytest.mark.parametrize(("rows", "columns"), [(2, 2), (5, 3), (4, 6)])
def test_a_box_is_closed_and_encloses_its_volume(rows: int, columns: int) -> None:
    mesh = box_mesh(rows, columns, SheetStiffness())
    positions = _box(rows, columns)
    assert report(TriMesh(positions, mesh.faces)).is_closed
    assert volume_value(positions, mesh.faces) == pytest.approx((rows - 1) * (columns - 1) * 0.5)


def test_a_ring_is_closed_and_encloses_its_volume() -> None:
    mesh = ring_mesh(2, 19, RingStiffness())
    positions = _ring(19)
    assert report(TriMesh(positions, mesh.faces)).is_closed
    base = 0.5 * 19 * np.sin(2.0 * np.pi / 19) * (4.0 - 1.0)
    volume = mesh.outwards(positions, name="ring")
    assert abs(volume_value(positions, volume.faces)) == pytest.approx(base * 0.5)


def test_faces_are_turned_outwards() -> None:
    mesh = box_mesh(3, 3, SheetStiffness())
    mirrored = _box(3, 3) * [-1.0, 1.0, 1.0]
    assert volume_value(mirrored, mesh.faces) < 0.0
    turned = mesh.outwards(mirrored, name="m")
    assert volume_value(mirrored, turned.faces) > 0.0


def test_a_mesh_without_volume_is_refused() -> None:
    mesh = box_mesh(3, 3, SheetStiffness())
    with pytest.raises(MeshError, match="muscle m: its mesh encloses nothing"):
        mesh.outwards(np.zeros((18, 3)), name="m")


def test_only_side_walls_connect_bottom_and_top() -> None:
    mesh = box_mesh(4, 5, SheetStiffness())
    apart = mesh.pairs[:, 1] - mesh.pairs[:, 0] == mesh.bottom_count
    assert apart.sum() == 2 * (4 + 5) - 4
    assert set(mesh.pair_stiffness[apart]) == {1.0}


def test_constraints_are_at_rest_where_they_are_made() -> None:
    mesh = box_mesh(4, 3, SheetStiffness())
    distances, bends, volume = mesh.constraints(_box(4, 3))
    lengths = np.linalg.norm(np.diff(_box(4, 3)[distances.particles], axis=1)[:, 0], axis=1)
    np.testing.assert_allclose(distances.rest, lengths)
    assert len(bends.particles) == 3 * len(mesh.faces) // 2
    assert volume.rest == pytest.approx(3.0)
