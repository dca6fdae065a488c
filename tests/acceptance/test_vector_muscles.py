"""Vector muscles, section 7, items 7 to 14: export, regions, tuning."""

from __future__ import annotations

import numpy as np
import pytest

from risorius.anatomy.template import builtin_head
from risorius.controls.presets import EMOTIONS, default_presets
from risorius.tuning import Genome, Parameter, Session
from risorius.tuning.objective import MadeUpUser
from risorius.vectormuscle import VectorFace
from risorius.vectormuscle.export import EXPORT_ORDER, Export, ExportParameters
from risorius.vectormuscle.export_lips import detected_lips, opened_lips, opened_vertices
from risorius.vectormuscle.export_points import find_features
from risorius.vectormuscle.export_regions import nearest_corners, split_lips, transfer_regions
from risorius.vectormuscle.kinds import LinearMuscle
from risorius.vectormuscle.vector_set import VectorSet
from risorius.warp import NetworkWarp
from tests.face_fixtures import builtin_face
from tests.synthetic import slit_sheet
from tests.tuning.heads import broad_export, broad_face, broad_head, similar_head


# 7. RBF
def test_without_regularisation_the_network_meets_the_features() -> None:
    here, there = (feature.positions for feature in broad_export().features)
    warp = NetworkWarp.fit(here, there, regularisation=0.0)
    assert np.abs(warp(here) - there).max() < 1e-9 * np.ptp(there)


@pytest.mark.parametrize("origin", [0.0, 1500.0])
def test_an_affine_target_is_met_exactly_from_any_origin(origin: float) -> None:
    here = broad_export().features[0].positions + origin
    linear = np.array([[1.2, 0.1, 0.0], [0.0, 0.9, 0.2], [-0.1, 0.0, 1.1]])
    probes = here + np.random.default_rng(3).normal(0.0, 40.0, here.shape)
    warp = NetworkWarp.fit(here, here @ linear.T - 7.0)
    assert np.abs(warp(probes) - (probes @ linear.T - 7.0)).max() < 1e-9 * (1.0 + origin)


# 8. Chromosomes
def test_a_chromosome_keeps_values_to_half_a_quantum_ends_included() -> None:
    names = tuple(f"gene{number}" for number in range(7))
    genome = Genome(tuple(Parameter(name, -2.0, 6.0, 1.0) for name in names))
    values = np.array([-2.0, -1.99, 0.0, 1.0, 3.3, 5.99, 6.0])
    bits = genome.encode(values, low=genome.low, high=genome.high)
    assert bits.shape == (7, 8)
    back = genome.decode(bits, low=genome.low, high=genome.high)
    assert np.abs(back - values).max() <= 0.5 * 8.0 / 256 + 1e-12


# 9. The genetic algorithm with a scripted user
def _tuned(seed: int) -> tuple[float, float]:
    genome = Genome(tuple(Parameter(f"gene{i}", 0.0, 1.0, 0.5) for i in range(10)))
    wish = np.random.default_rng([seed, 5]).uniform(size=10)
    session = Session(genome, seed=seed)
    user = MadeUpUser(lambda values: float(np.linalg.norm(values - wish)))
    errors = [np.median(np.abs(session.generation.candidates - wish))]
    for _ in range(10):
        picks = user(session.generation)
        kept = session.generation.candidates[list(picks)]
        shown = session.pick(picks).candidates
        assert (shown[:3] == kept).all()
        errors.append(np.median(np.abs(shown - wish)))
    return float(errors[0]), float(errors[-1])


def test_ten_generations_halve_the_median_error_and_picked_parents_survive() -> None:
    errors = np.array([_tuned(seed) for seed in range(10)])
    before, after = np.median(errors, axis=0)
    assert after <= 0.5 * before


# 10. The incremental loop
def _apart() -> VectorSet:
    """Return the default muscles, their ends spread so that no two share a place."""
    rng = np.random.default_rng(1)
    vectors = builtin_face().vectors
    muscles = [
        LinearMuscle(
            muscle.name, *(muscle.ends() + rng.uniform(-9.0, 9.0, (2, 3))), 30.0, 50.0, 30.0
        )
        for muscle in vectors.muscles
    ]
    return VectorSet(tuple(muscles), vectors.landmarks)


def test_the_loop_follows_the_order_and_adds_each_point_once() -> None:
    parameters = ExportParameters("features", near=1e-6)
    export = Export.begin(builtin_head(), broad_head(), _apart(), parameters=parameters)
    assert [group.expression for group in export.groups] == [*EXPORT_ORDER]
    assert EXPORT_ORDER == ("joy", "surprise", "sadness", "anger", "fear", "disgust")
    assert len(export.pairs) == 10
    while export.group is not None:
        export = export.accept()
        assert len(export.pairs) == 10 + 2 * len(export.fixed)
        assert len(set(export.pairs.names)) == len(export.pairs)
        assert export.condition() < 1e8
    grouped = [name for group in export.groups for name in group.muscles]
    assert len(grouped) == len(set(grouped)) == len(export.fixed)


def test_ends_that_lie_on_one_place_are_added_once() -> None:
    export = broad_export()
    while export.group is not None:
        export = export.accept()
    gaps = np.linalg.norm(export.pairs.source[:, None] - export.pairs.source[None], axis=2)
    near = export.parameters.near * export.features[0].width
    assert (gaps + 1e9 * np.eye(len(gaps))).min() > near
    assert "risorius_l.tail" in export.pairs.merged
    assert export.condition() < 1e8


# 11. Target = source, and a similar copy
@pytest.mark.parametrize("profile", ["improved", "faithful"])
def test_muscles_map_to_themselves_on_their_own_head(profile: str) -> None:
    head = builtin_head()
    export = Export.begin(head, head, parameters=ExportParameters.of_profile(profile))
    for before, after in zip(export.vectors.muscles, export.proposal(), strict=True):
        gap = np.linalg.norm(before.ends() - after.ends(), axis=1).max()
        assert gap < 0.01 * export.features[0].width


@pytest.mark.parametrize(("scale", "turn"), [(1.15, 0.0), (0.9, 0.25)])
def test_muscles_follow_a_similar_head(scale: float, turn: float) -> None:
    head = similar_head(scale, turn)
    export = Export.begin(builtin_head(), head)
    names = [name for name in builtin_head().landmarks if name in head.landmarks]
    here = builtin_head().landmarks.positions(names)
    there = head.landmarks.positions(names)
    rows = np.column_stack([here, np.ones(len(here))])
    similar = np.linalg.lstsq(rows, there, rcond=None)[0]
    for before, after in zip(export.vectors.muscles, export.proposal(), strict=True):
        wanted = np.column_stack([before.ends(), np.ones(2)]) @ similar
        gap = np.linalg.norm(after.ends() - wanted, axis=1).max()
        assert gap < 0.01 * export.features[1].width


@pytest.mark.parametrize("emotion", EMOTIONS)
def test_expressions_on_a_similar_head_are_equal_within_1_percent(emotion: str) -> None:
    head = similar_head(1.15, 0.0)
    carried = Export.begin(builtin_head(), head).vector_set()
    face = VectorFace.build(head, carried)
    pose = default_presets().fit(default_presets().emotions[emotion], face.controls).pose
    here = builtin_face().displace(pose)
    assert np.abs(face.displace(pose) / 1.15 - here).max() < 0.01 * np.abs(here).max()


# 12. Regions
def test_regions_carried_to_the_same_head_are_the_same() -> None:
    head = builtin_head()
    regions = builtin_face().context.regions
    carried = transfer_regions(Export.begin(head, head)).carry(regions)
    assert (carried.labels == regions.labels).all()


def test_regions_survive_a_remeshing_away_from_their_borders() -> None:
    skin = builtin_head().skin.mesh
    labels = builtin_face().context.regions.labels
    shares = np.random.default_rng(2).dirichlet([2.0, 2.0, 2.0], skin.face_count)
    corners = skin.positions[skin.faces]
    points = np.einsum("fc,fcd->fd", shares, corners)
    found = labels[nearest_corners(skin, points, axis=(0.0, -40.0)).vertices]
    of_corners = labels[skin.faces]
    inner = (of_corners == of_corners[:, :1]).all(axis=1)
    assert inner.sum() > 5000
    assert (found[inner] == of_corners[inner, 0]).mean() >= 0.95


def test_lips_that_touch_are_told_apart_by_opened_vertices() -> None:
    sheet = slit_sheet("slit", opening=0.0)
    up, down = opened_vertices(sheet.mesh.positions, sheet.mesh.faces)
    inner = slice(1, -1)
    upper, lower = sheet.upper[inner], sheet.lower[inner]
    assert (sheet.mesh.positions[upper][:, :2] == sheet.mesh.positions[lower][:, :2]).all()
    assert down[upper].all() and not up[upper].any()
    assert up[lower].all() and not down[lower].any()


@pytest.mark.parametrize("way", ["opened", "detected"])
def test_contact_vertices_get_different_labels(way: str) -> None:
    head, lips = broad_head(), broad_face().mechanics.lips
    carried = transfer_regions(broad_export()).carry(builtin_face().context.regions)
    if way == "opened":
        found = opened_lips(head)
        upper, lower = found.upper, found.lower
    else:
        upper, lower = detected_lips(lips)
    labels = split_lips(carried, upper=upper, lower=lower).labels
    pairs = labels[lips.pairs(head.skin.mesh.positions)]
    assert len(pairs) > 15
    assert (pairs == ["middle", "lower"]).all()


# 13. The jaw side leaves the upper lip alone
def test_jaw_side_muscles_do_not_move_the_upper_lip_after_export() -> None:
    faces = [broad_face()]
    lips = faces[0].mechanics.lips
    carried = transfer_regions(broad_export()).carry(builtin_face().context.regions)
    upper, lower = detected_lips(lips)
    regions = split_lips(carried, upper=upper, lower=lower)
    faces.append(VectorFace.build(broad_head(), broad_export().vector_set(), regions=regions))
    line = lips.slit.upper[~lips.corner[lips.slit.upper]]
    names = [
        muscle.name
        for muscle in faces[0].vectors.muscles
        if isinstance(muscle, LinearMuscle) and muscle.regions == ("lower",)
    ]
    assert names
    for face in faces:
        for name in names:
            moved = face.displace_skin({name: 1.0})
            assert np.abs(moved).max() > 0.5
            assert not moved[line].any()


# 14. Expressions read right: which way landmarks go
_WAYS = {
    "joy": {"8.3": "up", "8.4": "up"},
    "sadness": {"8.3": "down", "8.4": "down", "4.1": "up", "4.2": "up"},
    "surprise": {"4.1": "up", "4.3": "up", "2.1": "down"},
    "anger": {"4.1": "down", "4.2": "down"},
    "fear": {"4.1": "up", "4.2": "up", "2.1": "down"},
    "disgust": {"8.1": "up", "9.1": "up"},
}


@pytest.mark.parametrize("emotion", EMOTIONS)
def test_landmarks_go_where_the_expression_takes_them(emotion: str) -> None:
    face = broad_face()
    pose = default_presets().fit(default_presets().emotions[emotion], face.controls).pose
    moved = face.displace(pose)[face.head.skin.first_source()]
    for landmark, way in _WAYS[emotion].items():
        rise = moved[face.head.skin_vertex(landmark), 1]
        assert rise * (1.0 if way == "up" else -1.0) > 0.005 * find_features(face.head).width
