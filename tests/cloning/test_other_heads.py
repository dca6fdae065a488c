"""Clones on heads of another shape, another mesh, another density."""

from __future__ import annotations

import warnings
from dataclasses import replace
from functools import cache

import numpy as np
import numpy.typing as npt
import pytest

from risorius import Head, Rig
from risorius.anatomy.template import builtin_head
from risorius.cloning import clone_with_report, motion_error
from risorius.errors import LandmarkError, MeshError, ParameterError, RisoriusWarning, ShapeError
from risorius.head.mouth import find_head_lips
from risorius.landmarks import LandmarkSpec, mirror_name
from risorius.mesh.connectivity import edge_faces, edges
from risorius.mesh.polygon_mesh import PolygonMesh
from risorius.rig import MorphTarget
from risorius.rig.bake import empty_rig
from risorius.rig.quality import inspect_rig
from tests.cloning.rigs import (
    copy_of,
    dense,
    other_cloning,
    other_head,
    self_cloning,
    source_rig,
    specs_of,
)

FloatArray = npt.NDArray[np.float64]


@cache
def clones() -> FloatArray:
    return other_cloning().carry(dense(source_rig()))


def as_rig(head: Head, deltas: FloatArray) -> Rig:
    targets = [MorphTarget.from_dense(n, d) for n, d in zip(source_rig().names, deltas)]
    return empty_rig(head).with_targets(targets)


def test_vertices_of_one_topology_get_nearly_the_motion_of_their_twins() -> None:
    for truth, made in zip(dense(source_rig()), clones()):
        assert motion_error(truth, made) < 3.0


def test_lips_keep_their_sides_and_open_as_far() -> None:
    report = inspect_rig(as_rig(other_head(), clones()))
    true = inspect_rig(source_rig())
    for name in source_rig().names:
        seam = report.shape(name).seam
        assert seam is not None
        assert (seam.lost, seam.invented) == ((), ())
    opened, wanted = report.shape("jawOpen").seam, true.shape("jawOpen").seam
    assert opened is not None
    assert wanted is not None
    assert wanted.gap > 5.0
    assert abs(opened.gap / wanted.gap - 1.0) < 0.05


def test_the_upper_lip_does_not_go_with_the_jaw() -> None:
    jaw = source_rig().names.index("jawOpen")
    lips = find_head_lips(other_head())
    skin = clones()[jaw][other_head().skin.first_source()]
    upper, lower = (
        np.linalg.norm(skin[line[3:-3]], axis=1).mean()
        for line in (lips.slit.upper, lips.slit.lower)
    )
    assert upper < 0.05 * lower


def test_a_blink_closes_as_far_as_on_the_source() -> None:
    made = inspect_rig(as_rig(other_head(), clones())).shape("blink").lids
    true = inspect_rig(source_rig()).shape("blink").lids
    assert set(made) == {"l", "r"}
    for side in made:
        assert abs(made[side].left - true[side].left) < 5.0


def test_an_eye_turns_about_the_centre_of_the_target_s_own() -> None:
    look = source_rig().names.index("look")
    for kind in ("eye_left", "eye_right"):
        part = other_head().parts[kind]
        moved = clones()[look][part.first_source()]
        assert np.abs(moved).max() > 1.0
        start = part.mesh.positions
        centre = start.mean(axis=0)
        before = np.linalg.norm(start - centre, axis=1)
        after = np.linalg.norm(start + moved - (centre + moved.mean(axis=0)), axis=1)
        assert np.abs(after - before).max() < 1e-2 * before.max()


def finer(head: Head) -> tuple[PolygonMesh, npt.NDArray[np.int32]]:
    """Split every edge of a head; also return the pair of vertices behind each new vertex."""
    faces = head.source.triangles
    table, pairs = edge_faces(faces), edges(faces)
    n = head.vertex_count
    middle = n + table.face_edges
    parts = [np.stack([faces[:, k], middle[:, k], middle[:, k - 1]], axis=1) for k in range(3)]
    points = np.concatenate([head.source.positions, head.source.positions[pairs].mean(axis=1)])
    polygons = np.concatenate([*parts, middle]).tolist()
    return PolygonMesh.from_polygons(points, polygons), pairs


def test_a_finer_head_gets_smooth_motion_and_keeps_its_own_shape() -> None:
    head = builtin_head()
    mesh, pairs = finer(head)
    target = Head.from_mesh(mesh, specs_of(head))
    made = clone_with_report(source_rig(), target, source=head)
    assert made.rig.mesh is mesh
    skin = target.skin.first_source()
    for name, truth, moved in zip(source_rig().names, dense(source_rig()), dense(made.rig)):
        wanted = np.concatenate([truth, truth[pairs].mean(axis=1)])
        # A lid's margin is traced along other edges on the finer mesh, so that it closes a little
        # differently.
        limit = 8.0 if name == "blink" else 3.0
        if name == "look":
            # Only the sockets move, by fractions of a millimetre.
            assert np.abs(wanted[skin] - moved[skin]).max() < 2e-4 * head.height
        else:
            assert motion_error(wanted[skin], moved[skin]) < limit


def test_a_shape_without_motion_stays_without() -> None:
    none = np.zeros((1, builtin_head().vertex_count, 3))
    assert (other_cloning().carry(none) == 0.0).all()


def test_shapes_add_up_where_nothing_touches() -> None:
    """Apart from contact, cloning is linear in the shape."""
    smile = dense(source_rig())[source_rig().names.index("smile")]
    both = other_cloning().carry(np.stack([smile, 0.5 * smile]))
    size = np.abs(both[0]).max()
    assert np.abs(0.5 * both[0] - both[1]).max() < 5e-3 * size


def test_missing_landmarks_are_said_and_filled_in() -> None:
    head = builtin_head()
    specs = {name: spec for name, spec in specs_of(head).items() if name not in ("3.3", "2.3")}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RisoriusWarning)
        target = copy_of(head, head.source.positions, specs=specs)
    with pytest.warns(RisoriusWarning, match=r"2\.3, 3\.3 are not in both files"):
        made = clone_with_report(source_rig(), target, source=head)
    jaw = source_rig().names.index("smile")
    assert motion_error(dense(source_rig())[jaw], dense(made.rig)[jaw]) < 20.0


def test_too_few_common_landmarks_are_refused_with_their_number() -> None:
    head = builtin_head()
    kept = ("3.7", "3.8", "3.11", "3.12", "2.1", "9.3")
    specs = {name: spec for name, spec in specs_of(head).items() if name in kept}
    target = copy_of(head, head.source.positions, specs=specs)
    with pytest.raises(LandmarkError, match="share 6 names on the skin, cloning needs at least 8"):
        clone_with_report(source_rig(), target, source=head)


def head_x(head: Head, name: str) -> float:
    return float(head.landmarks.position(name)[0])


def test_mixed_up_landmarks_are_refused() -> None:
    head = builtin_head()
    specs = specs_of(head)
    kept = ("3.7", "3.8", "3.11", "3.12", "2.1", "9.3")
    left = [n for n in specs if mirror_name(n) != n and n not in kept and head_x(head, n) > 0.0]
    mixed = dict(specs)
    # Both sides alike, so that left stays left.
    for name, other in zip(left, left[5:] + left[:5]):
        mixed[name] = specs[other]
        mixed[mirror_name(name)] = specs[mirror_name(other)]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RisoriusWarning)
        target = copy_of(head, head.source.positions, specs=mixed)
        with pytest.raises((LandmarkError, MeshError), match="landmarks"):
            clone_with_report(source_rig(), target, source=head)


def test_a_rig_without_shapes_or_landmarks_is_refused() -> None:
    with pytest.raises(ParameterError, match="the source has no shapes"):
        clone_with_report(source_rig().subset([]), builtin_head())
    bare = replace(source_rig(), landmarks={})
    with pytest.raises(LandmarkError, match="the source rig carries none"):
        clone_with_report(bare, builtin_head())


def test_shapes_of_another_mesh_are_refused() -> None:
    with pytest.raises(ShapeError, match=r"expected shape \(s, 10840, 3\)"):
        self_cloning().carry(np.zeros((1, 7, 3)))


def test_landmarks_off_by_millimetres_hardly_matter() -> None:
    head = other_head()
    random = np.random.default_rng(4)
    points = head.source.positions
    specs = {}
    for name, spec in specs_of(head).items():
        skin = head.landmarks.vertex(name)
        near = np.linalg.norm(points - points[skin], axis=1)
        lip = name.startswith(("2.", "8."))
        ring = np.flatnonzero((near < 2.5 / head.frame.scale) & (near > 0.5 / head.frame.scale))
        ring = ring[np.isin(ring, head.skin.source)]
        use = int(random.choice(ring)) if len(ring) and not lip else spec.vertex
        specs[name] = LandmarkSpec(vertex=use)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RisoriusWarning)
        target = copy_of(head, points, specs=specs)
        made = dense(clone_with_report(source_rig(), target, source=builtin_head()).rig)
    for truth, moved in zip(dense(source_rig())[:3], made):
        assert motion_error(truth, moved) < 5.0
