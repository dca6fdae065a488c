"""`risorius rig --skull`: skulls and muscle maps of one's own, from file to rig."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from risorius import Rig
from risorius.anatomy.outwards import outwards
from risorius.anatomy.skull import load_skull
from risorius.anatomy.template import builtin_head
from risorius.head import Head
from risorius.layered import LayeredFace
from risorius.layered.faithful import FaithfulFace
from risorius.layered.muscle_map import default_muscle_map
from risorius.spatial.raycast import Scene
from tests.cli.running import asset, run

Change = Callable[[np.ndarray], np.ndarray]

HEADS = (
    "ict_facekit/ict_neutral.obj",
    "makehuman_head/african_female_young.obj",
    "makehuman_head/asian_male_old.obj",
    "makehuman_head/caucasian_male_young.obj",
)
LANDMARKS = "skull.landmarks.json"


def _changed(name: str, folder: Path, change: Change) -> Path:
    """Write an asset with its vertices moved."""
    lines = asset(name).read_text("utf-8").splitlines()
    rows = [number for number, line in enumerate(lines) if line.startswith("v ")]
    places = np.array([[float(word) for word in lines[row].split()[1:4]] for row in rows])
    for row, (x, y, z) in zip(rows, change(places).tolist()):
        lines[row] = f"v {x!r} {y!r} {z!r}"
    path = folder / name
    path.write_text("\n".join(lines) + "\n", "utf-8")
    return path


def _in_metres_elsewhere(places: np.ndarray) -> np.ndarray:
    return 0.001 * places + [2.0, -1.0, 0.3]


def _muzzled(places: np.ndarray) -> np.ndarray:
    """Draw out the lower face as in an animal, narrow the brain case and lengthen it."""
    x, y, z = places.T
    below = 1.0 / (1.0 + np.exp((y + 15.0) / 12.0))
    ahead = np.maximum(z - 30.0, 0.0)
    return np.stack([0.9 * x, 1.1 * y, z + 0.5 * below * ahead - 0.15 * np.maximum(-z, 0.0)], 1)


def _rig(folder: Path, head: object, *options: object) -> Rig:
    out = folder / "face.npz"
    result = run("rig", head, "-o", out, "--shapes", "emotions", *options)
    assert result.exit_code == 0, result.stderr
    return Rig.load(out)


def _depth(head: Head, points: np.ndarray) -> np.ndarray:
    """Return how deep points lie behind the skin, seen from outside; NaN over openings [mm]."""
    way = outwards(points)
    hits = Scene([head.skin.mesh]).cast(points + 80.0 * way, -way, max_distance=200.0)
    depth = 80.0 - hits.distance
    # Through the slits of mouth and eyes rays meet the far side.
    return np.where(hits.hit & (depth > -20.0), depth, np.nan)


def _require_plausible_bones(face: LayeredFace | FaithfulFace, skull_points: np.ndarray) -> None:
    depth = _depth(face.head, skull_points)
    front = (skull_points[:, 2] > face.mechanics.jaw.hinge[2]) & np.isfinite(depth)
    assert (depth[front] < 0.0).mean() < 0.01
    assert depth[front].min() > -4.0
    assert 4.0 < np.median(depth[front]) < 25.0


@pytest.mark.parametrize("profile", ["improved", "faithful"])
def test_a_scaled_and_shifted_copy_of_the_builtin_skull_gives_its_rig(
    tmp_path: Path, profile: str
) -> None:
    skull = _changed("skull.obj", tmp_path, _in_metres_elsewhere)
    chart = tmp_path / "map.json"
    chart.write_text(json.dumps(default_muscle_map().to_json()), "utf-8")
    own = _rig(
        tmp_path, "builtin", "--profile", profile, "--skull", skull,
        "--skull-landmarks", asset(LANDMARKS), "--muscle-map", chart,
    )  # fmt: skip
    usual = _rig(tmp_path, "builtin", "--profile", profile)
    for target in usual.targets:
        wanted = target.dense(usual.mesh.vertex_count)
        found = own.target(target.name).dense(usual.mesh.vertex_count)
        off = np.linalg.norm(found - wanted) / np.linalg.norm(wanted)
        # A foreign skull keeps 3 mm under the skin everywhere, the built-in one its own depth.
        assert off < (0.05 if profile == "improved" else 0.25), target.name


@pytest.mark.parametrize("profile", ["improved", "faithful"])
def test_an_animal_head_with_its_skull_gets_a_face(tmp_path: Path, profile: str) -> None:
    skull = _changed("skull.obj", tmp_path, _muzzled)
    head = _changed("head.obj", tmp_path, _muzzled)
    rig = _rig(
        tmp_path, head, "-l", asset("head.landmarks.json"), "--profile", profile,
        "--skull", skull, "--skull-landmarks", asset(LANDMARKS),
    )  # fmt: skip
    for target in rig.targets:
        assert np.isfinite(target.deltas).all()
        largest = np.linalg.norm(target.deltas, axis=1).max()
        assert 1.0 < largest < 60.0, target.name
    opened = rig.target("surprise").dense(rig.mesh.vertex_count)
    chin = Head.load(head, asset("head.landmarks.json")).landmarks.vertex("2.1")
    assert opened[chin, 1] < -3.0


def test_bones_of_a_muzzled_skull_lie_inside_its_head(tmp_path: Path) -> None:
    skull = _changed("skull.obj", tmp_path, _muzzled)
    head = Head.load(_changed("head.obj", tmp_path, _muzzled), asset("head.landmarks.json"))
    marks = default_muscle_map().landmarks
    bones = load_skull((skull,), asset(LANDMARKS), marks=marks)
    face = LayeredFace.build(head, skull=bones)
    _require_plausible_bones(face, face.skull.cranium.positions)
    _require_plausible_bones(face, face.skull.mandible.positions)


def _swapped(folder: Path) -> Path:
    document = json.loads(asset(LANDMARKS).read_text("utf-8"))
    document["landmarks"] = {
        name[:-2] + {"_l": "_r", "_r": "_l"}.get(name[-2:], name[-2:]): place
        for name, place in document["landmarks"].items()
    }
    path = folder / "swapped.json"
    path.write_text(json.dumps(document), "utf-8")
    return path


def _of_another_unit(folder: Path) -> Path:
    """Landmarks in millimetres, for a skull in metres."""
    marks = {
        name: {"position": place.tolist()} for name, place in default_muscle_map().landmarks.items()
    }
    path = folder / "millimetres.json"
    document = {"schema": "risorius/landmarks", "version": 1, "landmarks": marks}
    path.write_text(json.dumps(document), "utf-8")
    return path


def _of_other_bones(folder: Path) -> Path:
    document = json.loads(asset(LANDMARKS).read_text("utf-8"))
    names = sorted(document["landmarks"])
    places = [document["landmarks"][name] for name in names]
    document["landmarks"] = dict(zip(names, places[7:] + places[:7]))
    path = folder / "shuffled.json"
    path.write_text(json.dumps(document), "utf-8")
    return path


@pytest.mark.parametrize(
    ("marks", "said"),
    [
        (None, "needs bone landmarks that place it; give a file of them with --skull-landmarks"),
        (_swapped, "left and right bone landmarks are exchanged"),
        (_of_another_unit, "positions must be in the mesh's own unit and axes"),
        (_of_other_bones, "of the skull's size from where those of a skull lie"),
    ],
)
def test_landmarks_that_do_not_fit_the_skull_are_refused_in_one_sentence(
    tmp_path: Path, marks: Callable[[Path], Path] | None, said: str
) -> None:
    skull = _changed("skull.obj", tmp_path, _in_metres_elsewhere)
    options = () if marks is None else ("--skull-landmarks", marks(tmp_path))
    out = tmp_path / "face.npz"
    result = run("rig", "builtin", "-o", out, "--shapes", "emotions", "--skull", skull, *options)
    assert result.exit_code == 1
    assert said in " ".join(result.stderr.split())
    assert len(result.stderr.strip().splitlines()) <= 3
    assert not out.exists()


def test_a_skull_without_a_mandible_is_refused(tmp_path: Path) -> None:
    lines = asset("skull.obj").read_text("utf-8").splitlines()
    end = next(row for row, line in enumerate(lines) if line.startswith("o mandible"))
    skull = tmp_path / "cranium.obj"
    skull.write_text("\n".join(lines[:end]) + "\n", "utf-8")
    document = json.loads(asset(LANDMARKS).read_text("utf-8"))
    face_count = sum(line.startswith("f ") for line in lines[:end])
    document["landmarks"] = {
        name: place for name, place in document["landmarks"].items() if place["face"] < face_count
    }
    marks = tmp_path / "cranium.json"
    marks.write_text(json.dumps(document), "utf-8")
    result = run(
        "rig", "builtin", "-o", tmp_path / "face.npz", "--skull", skull,
        "--skull-landmarks", marks,
    )  # fmt: skip
    assert result.exit_code == 1
    assert "no objects or groups named like 'cranium' and 'mandible'" in result.stderr


def test_skull_landmarks_without_a_skull_are_refused(tmp_path: Path) -> None:
    result = run(
        "rig", "builtin", "-o", tmp_path / "face.npz", "--skull-landmarks", asset(LANDMARKS)
    )
    assert result.exit_code == 1
    assert "without a skull" in result.stderr


@pytest.mark.real
@pytest.mark.slow
@pytest.mark.parametrize("profile", ["improved", "faithful"])
@pytest.mark.parametrize("name", ["builtin", *HEADS], ids=lambda name: Path(name).stem)
def test_the_real_skull_fits_into_every_head(
    tmp_path: Path, real_data: Path, name: str, profile: str
) -> None:
    folder = real_data / "myosim_skull"
    bones = (folder / "skull_yup_zfwd.obj", folder / "mandible_yup_zfwd.obj")
    head = name if name == "builtin" else real_data / name
    marks = () if name == "builtin" else ("-l", (real_data / name).with_name("landmarks.json"))
    rig = _rig(
        tmp_path, head, *marks, "--profile", profile, "--skull", bones[0], "--mandible", bones[1],
        "--skull-landmarks", folder / "landmarks.json",
    )  # fmt: skip
    for target in rig.targets:
        assert np.isfinite(target.deltas).all()
        assert len(target.vertices) > 50, target.name


@pytest.mark.real
@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::risorius.errors.RisoriusWarning")
@pytest.mark.parametrize("name", ["builtin", *HEADS], ids=lambda name: Path(name).stem)
def test_the_real_skull_lies_inside_the_skin(real_data: Path, name: str) -> None:
    folder = real_data / "myosim_skull"
    bones = load_skull(
        (folder / "skull_yup_zfwd.obj", folder / "mandible_yup_zfwd.obj"),
        folder / "landmarks.json", marks=default_muscle_map().landmarks,
    )  # fmt: skip
    path = real_data / name
    head = (
        builtin_head() if name == "builtin" else Head.load(path, path.with_name("landmarks.json"))
    )
    face = LayeredFace.build(head, skull=bones)
    for bone in (face.skull.cranium, face.skull.mandible):
        _require_plausible_bones(face, bone.positions)
    published = FaithfulFace.build(head, skull=bones)
    anatomy = published.muscles.anatomy
    _require_plausible_bones(published, anatomy.positions[: published.muscles.bone_count])
