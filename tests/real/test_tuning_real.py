"""Tuned on one real head, carried to another: the expression changes in the same direction."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from risorius._check import FloatArray
from risorius.controls.presets import default_presets
from risorius.layered.workbench import Workbench
from risorius.rig.face import Face
from risorius.springmuscle.face import SpringFace
from risorius.springmuscle.recipe_file import default_recipe
from risorius.springmuscle.redrawing import redrawn
from risorius.tuning import MuscleCandidates, Session
from risorius.tuning.candidates import FaceCandidates
from risorius.tuning.fit import fit_shape
from risorius.tuning.intensities import IntensityCandidates
from risorius.tuning.map_genes import MapCandidates, map_muscles
from risorius.tuning.outline_genes import OutlineCandidates, outline_muscles
from risorius.tuning.style import Style
from risorius.vectormuscle import VectorFace
from risorius.vectormuscle.export_points import find_features
from tests.real.heads import real_head
from tests.tools import real_data_folder
from tests.tuning.faces import expression

pytestmark = pytest.mark.real

METHODS = ("layered", "springs", "vector")
NEXT = "caucasian_male_young"
# Mouth corners, lips, cheeks beside the nose, brows.
_MARKS = ("8.1", "8.2", "8.3", "8.4", "9.1", "9.2", "4.1", "4.2", "4.3", "4.4")


@cache
def _bench(head: str) -> Workbench:
    return Workbench.build(real_head(head))


@cache
def _face(method: str, head: str) -> Face:
    if method == "layered":
        return _bench(head).face
    return (SpringFace if method == "springs" else VectorFace).build(real_head(head))


def _candidates(method: str, emotion: str) -> FaceCandidates:
    face = _face(method, "ict")
    pose = expression(face, emotion)
    if method == "layered":
        bench = _bench("ict")
        return MapCandidates.of_bench(bench, map_muscles(bench.face.muscle_map, pose), pose)
    if isinstance(face, SpringFace):
        recipe = default_recipe()
        return OutlineCandidates(face, recipe, outline_muscles(recipe, pose), pose)
    assert isinstance(face, VectorFace)
    names = tuple(name for name in pose if name in face.bound)
    return MuscleCandidates(face, names, pose, find_features(face.head).width)


def _worn(method: str, style: Style) -> Face:
    """Return the next head in a style."""
    face = _face(method, NEXT)
    if method == "layered":
        return _bench(NEXT).redrawn(style.on_map(_bench(NEXT).face.muscle_map)).face
    if isinstance(face, SpringFace):
        return redrawn(face, default_recipe(), style.on_recipe(default_recipe()))
    assert isinstance(face, VectorFace)
    width = find_features(face.head).width
    return face.with_muscles(style.on_vectors(face.vectors.muscles, width=width))


def _at_marks(face: Face, positions: FloatArray) -> FloatArray:
    rows = face.head.skin.first_source()
    return np.array([positions[rows[face.head.skin_vertex(name)]] for name in _MARKS])


@pytest.mark.parametrize("emotion", ["joy", "anger"])
@pytest.mark.parametrize("method", METHODS)
def test_a_style_changes_the_next_head_in_the_same_direction(method: str, emotion: str) -> None:
    candidates = _candidates(method, emotion)
    genome = candidates.genome
    session = Session(genome, strategy="genetic", seed=4)
    shown = [candidates.positions(genome.named(v)) for v in session.generation.candidates[:5]]
    here = [_at_marks(_face(method, "ict"), each - shown[0]) for each in shown]
    # The person likes the face that differs most from the one proposed.
    pick = int(np.argmax([np.linalg.norm(change) for change in here]))
    style = Style(session.accept(pick), method)
    before, worn = _face(method, NEXT), _worn(method, style)
    pose = expression(before, emotion)
    there = _at_marks(before, worn.pose(pose) - before.pose(pose))
    assert np.linalg.norm(here[pick], axis=1).max() > 1.0
    assert np.linalg.norm(there, axis=1).max() > 0.5
    cosine = (here[pick] * there).sum() / np.linalg.norm(here[pick]) / np.linalg.norm(there)
    assert cosine > 0.7


@pytest.mark.parametrize("method", METHODS)
def test_a_true_smile_is_approached_by_intensities_alone(method: str) -> None:
    face = _face(method, "ict")
    found = fit_shape(
        IntensityCandidates(face, default_presets(), "joy"), _smile(face), iterations=4
    )
    assert found.after < 0.995 * found.before


def _smile(face: Face) -> FloatArray:
    """Return the true smile of ICT-FaceKit on its own head (n, 3) [mm]."""
    data = np.load(real_data_folder() / "ict_facekit/ict_facekit.npz")
    names = [str(name) for name in data["expression_names"]]
    deltas = sum(data["expression_deltas"][names.index(f"mouthSmile_{side}")] for side in "LR")
    # The file of the head lacks some vertices of the archive; the order is the same.
    source, everything = face.head.source.positions, data["vertices"]
    rows: list[int] = []
    for place in source:
        row = rows[-1] + 1 if rows else 0
        while np.abs(everything[row] - place).max() > 1e-4:
            row += 1
        rows.append(row)
    return face.head.positions + face.head.frame.scale * np.asarray(deltas)[rows]
