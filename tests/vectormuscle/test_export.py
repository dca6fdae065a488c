"""Feature points, correspondences and what an export refuses."""

from __future__ import annotations

import json

import numpy as np
import pytest

from risorius.anatomy.template import builtin_head
from risorius.errors import LandmarkError, ParameterError
from risorius.vectormuscle import VectorFace, parse_vector_set
from risorius.vectormuscle.export import Export, ExportParameters, export_muscles
from risorius.vectormuscle.export_lips import compare_lips, opened_lips
from risorius.vectormuscle.export_pairs import Pairs
from risorius.vectormuscle.export_points import FEATURE_NAMES, find_features
from risorius.vectormuscle.export_regions import nearest_corners
from tests.face_fixtures import builtin_face
from tests.mesh.shapes import sphere
from tests.tuning.heads import broad_export, broad_face, broad_head, similar_head


def test_ten_feature_points_are_found_where_they_belong() -> None:
    found = find_features(builtin_head())
    assert tuple(found.points) == FEATURE_NAMES
    assert len(FEATURE_NAMES) == 10
    place = found.points
    assert place["head_top"][1] > place["nose_root"][1] > place["nose_tip"][1]
    assert place["nose_base"][1] < place["nose_tip"][1]
    assert place["nose_tip"][2] == max(point[2] for point in place.values())
    for stem in ("head", "socket", "nose"):
        left, right = place[f"{stem}_left"], place[f"{stem}_right"]
        assert np.abs(left * [-1.0, 1.0, 1.0] - right).max() < 0.02 * found.width


@pytest.mark.parametrize(("scale", "turn"), [(1.15, 0.0), (0.9, 0.25)])
def test_feature_points_follow_a_head_that_is_scaled_and_tilted(scale: float, turn: float) -> None:
    here, there = find_features(builtin_head()), find_features(similar_head(scale, turn))
    gaps = [
        np.linalg.norm(points[:, None] - points[None], axis=2)
        for points in (here.positions, there.positions)
    ]
    assert np.abs(gaps[1] / scale - gaps[0]).max() < 1e-3 * here.width


def test_a_person_knows_better() -> None:
    found = find_features(builtin_head(), given={"nose_tip": [0.0, -40.0, 34.0]})
    assert found.points["nose_tip"].tolist() == [0.0, -40.0, 34.0]
    assert found.sources["nose_tip"] == "given"
    assert found.sources["nose_base"] == "9.15"
    with pytest.raises(LandmarkError, match="chin is none of nose_tip"):
        found.edited({"chin": [0.0, 0.0, 0.0]})
    with pytest.raises(LandmarkError, match="'head_left' and 'head_right' are swapped"):
        found.edited({"head_left": found.points["head_right"] - [5.0, 0.0, 0.0]})


def test_a_pair_is_added_once() -> None:
    pairs = Pairs.empty().with_pair("a", np.zeros(3), np.ones(3), near=1.0)
    pairs = pairs.with_pair("b", np.array([0.5, 0.0, 0.0]), np.ones(3), near=1.0, exact=True)
    pairs = pairs.with_pair("c", np.array([2.0, 0.0, 0.0]), np.ones(3), near=1.0, exact=True)
    pairs = pairs.with_pair("d", np.array([2.0, 0.0, 0.0]), np.ones(3), near=1.0, exact=True)
    # The end of a fixed muscle takes the place of a landmark; the first muscle stays.
    assert pairs.names == ("b", "c")
    assert pairs.merged == ("a", "d")
    assert pairs.exact.tolist() == [0, 1]
    assert pairs.source[0].tolist() == [0.5, 0.0, 0.0]


def test_a_tuned_muscle_is_kept_and_draws_its_neighbours() -> None:
    export = broad_export()
    group = export.group
    assert group is not None
    before = {muscle.name: muscle for muscle in export.proposal()}
    major = before["zygomaticus_major_l"]
    moved = type(major)(**{**vars(major), "insertion": major.insertion + [0.0, 6.0, 0.0]})
    after = export.accept([moved])
    now = {muscle.name: muscle for muscle in after.proposal()}
    assert now["zygomaticus_major_l"] is moved
    # Buccinator ends at the same mouth corner and is in no group: it follows through the warp.
    shift = now["buccinator_l"].insertion - before["buccinator_l"].insertion
    assert np.allclose(shift, [0.0, 6.0, 0.0], atol=0.5)
    far = now["frontalis_inner_r"].ends() - before["frontalis_inner_r"].ends()
    assert np.abs(far).max() < 3.0


def test_accepting_everything_as_proposed_is_the_export_without_tuning() -> None:
    plain = export_muscles(broad_export())
    tuned = export_muscles(broad_export(), tune=lambda export: ())
    for a, b in zip(plain.muscles, tuned.muscles, strict=True):
        assert np.abs(a.ends() - b.ends()).max() < 0.02 * broad_export().features[1].width


def test_the_exported_set_survives_its_file_and_runs_on_the_head() -> None:
    carried = broad_export().vector_set()
    again = parse_vector_set(json.loads(json.dumps(carried.to_json())), source="x.json")
    face = VectorFace.build(broad_head(), again)
    pose = {"zygomaticus_major_l": 1.0, "frontalis_inner_r": 0.5, "jaw_pitch": 6.0}
    assert np.abs(face.pose(pose) - broad_face().pose(pose)).max() < 0.05


def test_radii_follow_the_stretch_and_other_numbers_are_copied() -> None:
    export = broad_export()
    for before, after in zip(export.vectors.muscles, export.proposal(), strict=True):
        if not hasattr(before, "start_radius"):
            continue
        length = [np.linalg.norm(np.diff(muscle.ends(), axis=0)) for muscle in (before, after)]
        stretch = length[1] / length[0]
        assert after.start_radius == pytest.approx(stretch * before.start_radius)
        assert after.half_angle == before.half_angle
        assert after.strength == before.strength


def test_senseless_exports_are_refused() -> None:
    export = broad_export()
    with pytest.raises(ParameterError, match="mentalis_l is not in the group of joy"):
        export.accept([muscle for muscle in export.proposal() if muscle.name == "mentalis_l"])
    while export.group is not None:
        export = export.accept()
    with pytest.raises(ParameterError, match="every group is fixed already"):
        export.accept()
    with pytest.raises(ParameterError, match="'all' is not one of features, landmarks"):
        ExportParameters("all")  # pyright: ignore[reportArgumentType]


def test_the_published_export_uses_ten_points() -> None:
    parameters = ExportParameters.of_profile("faithful")
    assert len(Export.begin(builtin_head(), broad_head(), parameters=parameters).pairs) == 10


def test_a_sphere_projected_on_a_larger_one_finds_the_same_directions() -> None:
    inner = sphere(3)
    points = 1.5 * inner.positions
    level = np.abs(inner.positions[:, 1]) < 0.3
    found = nearest_corners(inner, points[level] * [1.0, 1.0 / 1.5, 1.0], axis=(0.0, 0.0))
    assert not found.missed.any()
    near = inner.positions[found.vertices]
    assert np.linalg.norm(near - inner.positions[level], axis=1).max() < 0.15
    above = nearest_corners(inner, [[0.2, 3.0, 0.0]], axis=(0.0, 0.0))
    assert above.missed.all()
    assert inner.positions[above.vertices[0], 1] == pytest.approx(1.0, abs=0.1)


def test_opened_vertices_agree_with_the_detector_on_the_built_in_head() -> None:
    found = opened_lips(builtin_head())
    compared = compare_lips(builtin_head(), found, builtin_face().mechanics.lips)
    assert compared.vertex_count > 300
    assert compared.agreement > 0.99
