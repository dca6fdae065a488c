"""Landmark files."""

import json
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from risorius import _formats
from risorius.errors import FormatError, RisoriusWarning
from risorius.io.landmarks import read_landmarks, write_landmarks
from risorius.landmarks.feature_points import feature_points
from risorius.landmarks.landmark_set import LandmarkSpec


def written(tmp_path: Path, document: object) -> Path:
    path = tmp_path / "x.json"
    path.write_text(document if isinstance(document, str) else json.dumps(document))
    return path


def test_what_is_written_comes_back(tmp_path: Path):
    specs = {
        "2.1": LandmarkSpec(vertex=7, confidence="documented"),
        "2.2": LandmarkSpec(face=3, bary=(0.25, 0.5, 0.25)),
        "8.3": LandmarkSpec(position=(0.1, -2.5, 1e-9)),
    }
    path = tmp_path / "a.landmarks.json"
    write_landmarks(specs, path)
    assert read_landmarks(path) == specs
    assert list(read_landmarks(path)) == list(specs)
    first = path.read_bytes()
    write_landmarks(specs, path)
    assert path.read_bytes() == first


def test_a_vertex_is_preferred_to_a_position_and_the_index_base_is_obeyed(tmp_path: Path):
    place = {"vertex": 5, "pos": [1, 2, 3], "confidence": "guess", "source": "a table"}
    path = written(tmp_path, {"fdp": {"2.1": place}, "index_base": 1})
    assert read_landmarks(path) == {"2.1": LandmarkSpec(vertex=4, confidence="guess")}


def test_a_missing_vertex_falls_back_to_the_position(tmp_path: Path):
    path = written(tmp_path, {"fdp": {"2.1": {"vertex": None, "pos": [1, 2, 3]}}})
    assert read_landmarks(path) == {"2.1": LandmarkSpec(position=(1.0, 2.0, 3.0))}


def test_unknown_names_are_kept_with_a_warning(tmp_path: Path):
    path = written(tmp_path, {"fdp": {"2.1": {"vertex": 0}, "gnathion": {"vertex": 1}}})
    with pytest.warns(RisoriusWarning, match="'gnathion' are not MPEG-4"):
        assert set(read_landmarks(path)) == {"2.1", "gnathion"}


OURS = '{"schema": "risorius/landmarks", "version": 1, "landmarks": '


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("{}", 'expected "landmarks"'),
        ('{"fdp": []}', 'expected "landmarks"'),
        ('{"fdp": {}}', "no landmarks in it"),
        ('{"fdp": {"2.1": {"vertex": 1}}, "index_base": 2}', '"index_base" must be 0 or 1'),
        ('{"fdp": {"2.1": {"vertex": 1}}, "index_base": true}', '"index_base" must be 0 or 1'),
        ('{"fdp": {"2.1": {"vertex": 0}}, "index_base": 1}', r"must lie in 1\.\."),
        ('{"fdp": {"2.1": 5}}', "landmark '2.1': expected a JSON object"),
        ('{"fdp": {"2.1": {}}}', "landmark '2.1': has no \"vertex\""),
        ('{"fdp": {"2.1": {"vertex": true}}}', "landmark '2.1'.vertex: expected a whole number"),
        ('{"fdp": {"2.1": {"vertex": 1.5}}}', "whole number"),
        ('{"fdp": {"2.1": {"vertex": -1}}}', r"must lie in 0\.\."),
        ('{"fdp": {"2.1": {"vertex": 99999999999999999999}}}', r"must lie in 0\.\."),
        ('{"fdp": {"2.1": {"vertex": 1}, "2.1": {"vertex": 2}}}', "given twice"),
        ('{"fdp": {"2.1": {"pos": [1, 2]}}}', "list of 3 numbers"),
        ('{"fdp": {"2.1": {"pos": [1, 2, false]}}}', "expected a number"),
        ('{"fdp": {"2.1": {"pos": [1, 2, NaN]}}}', "NaN is not JSON"),
        ('{"fdp": {"2.1": {"face": 1}}}', "bary: expected a list"),
        ('{"fdp": {"2.1": {"face": 1, "bary": [1, 1, 0]}}}', "sum to 1"),
        ('{"fdp": {"2.1": {"face": 1, "bary": [2, -1, 0]}}}', "sum to 1"),
        ('{"fdp": {"2.1": {"vertex": 1, "confidence": 1}}}', "confidence: expected a text"),
        ('{"schema": "x", "fdp": {}}', 'expected "schema"'),
        (OURS.replace("1,", "2,") + '{"2.1": {"vertex": 1}}}', "update risorius"),
    ],
)
def test_malformed_files_are_refused_with_the_landmark(tmp_path: Path, text: str, message: str):
    with pytest.raises(FormatError, match=message):
        read_landmarks(written(tmp_path, text))


JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=5), inner),
)
PLACE = JSON | st.fixed_dictionaries(
    {}, optional={"vertex": JSON, "face": JSON, "bary": JSON, "position": JSON, "confidence": JSON}
)


@given(
    st.fixed_dictionaries(
        {"fdp": st.dictionaries(st.sampled_from(list(feature_points())), PLACE) | JSON},
        optional={"index_base": JSON, "schema": JSON, "version": JSON},
    )
)
def test_any_json_is_read_or_refused(tmp_path_factory: pytest.TempPathFactory, document: object):
    path = tmp_path_factory.getbasetemp() / "any.json"
    path.write_text(json.dumps(document))
    try:
        specs = read_landmarks(path)
    except FormatError as error:
        assert str(path) in str(error)
    else:
        assert specs


@pytest.mark.real
@pytest.mark.parametrize(
    ("folder", "count"),
    [("ict_facekit", 74), ("makehuman_head", 75), ("mediapipe_canonical", 58)],
)
def test_the_reference_files_are_read_as_they_are(real_data: Path, folder: str, count: int):
    specs = _formats.read_landmarks(real_data / folder / "landmarks.json")
    assert len(specs) == count
    assert all(spec.vertex is not None for spec in specs.values())
    assert all(spec.confidence for spec in specs.values())


@pytest.mark.real
def test_the_landmarks_of_the_skull_are_read(real_data: Path):
    with pytest.warns(RisoriusWarning, match="not MPEG-4"):
        specs = read_landmarks(real_data / "myosim_skull" / "landmarks.json")
    assert len(specs) == 20
