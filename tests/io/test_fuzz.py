"""Every reader, fed with cut, flipped and random bytes, reads or refuses; nothing else happens."""

from __future__ import annotations

import tracemalloc
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st

from risorius import _formats
from risorius.errors import FormatError
from risorius.io.gltf.write import glb_bytes
from risorius.io.landmarks import write_landmarks
from risorius.io.npz import write_npz
from risorius.io.obj_text import ObjText
from tests.io.glb import Maker
from tests.io.rigs import make_mesh, make_rig
from tests.io.test_fdp import GOOD as FDP
from tests.io.test_gltf_read import CORNERS
from tests.io.test_ply import ascii_ply, binary_ply

pytestmark = pytest.mark.filterwarnings("ignore::risorius.errors.RisoriusWarning")


def _npz(folder: Path) -> bytes:
    write_npz(make_rig(), folder / "x.npz")
    return (folder / "x.npz").read_bytes()


def _landmarks(folder: Path) -> bytes:
    write_landmarks(make_rig().landmarks, folder / "x.json")
    return (folder / "x.json").read_bytes()


def _gltf(folder: Path) -> bytes:
    maker = Maker()
    maker.primitive(CORNERS, np.array([0, 1, 2, 0, 2, 3], "<u2"), targets=[{"POSITION": 0}])
    return maker.gltf()


def _stl(kind: str) -> Callable[[Path], bytes]:
    mesh = make_mesh()
    other = trimesh.Trimesh(mesh.positions, mesh.triangles[-12:], process=False)
    if kind == "binary":
        return lambda _: trimesh.exchange.stl.export_stl(other)
    return lambda _: trimesh.exchange.stl.export_stl_ascii(other).encode()


SEEDS: dict[str, tuple[str, Callable[[Path], bytes]]] = {
    "obj": (".obj", lambda _: ObjText(make_mesh()).neutral()),
    "glb": (".glb", lambda _: glb_bytes(make_rig(), "x")),
    "gltf": (".gltf", _gltf),
    "npz": (".npz", _npz),
    "ply ascii": (".ply", lambda _: ascii_ply()),
    "ply binary": (".ply", lambda _: binary_ply()),
    "stl ascii": (".stl", _stl("ascii")),
    "stl binary": (".stl", _stl("binary")),
    "landmarks": (".json", _landmarks),
    "fdp": (".fdp", lambda _: FDP.encode()),
}
READERS = (_formats.read_head, _formats.read_rig, _formats.read_landmarks)


@pytest.fixture(scope="module", params=SEEDS)
def seed(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory):
    ending, make = SEEDS[request.param]
    folder = tmp_path_factory.mktemp("fuzz")
    return folder / f"mutant{ending}", make(folder)


def read_all(path: Path, data: bytes) -> int:
    """Let every reader of this ending try; return how many could."""
    path.write_bytes(data)
    able = 0
    for reader in READERS:
        try:
            reader(path)
            able += 1
        except FormatError as error:
            assert path.name in str(error)
    return able


def test_the_seed_itself_is_read(seed):
    assert read_all(*seed) >= 1


@given(st.data())
def test_cut_off_files_are_refused_or_read(seed, data):
    path, content = seed
    read_all(path, content[: data.draw(st.integers(0, len(content) - 1))])


@given(st.data())
def test_flipped_bytes_are_refused_or_read(seed, data):
    path, content = seed
    mutant = bytearray(content)
    places = st.tuples(st.integers(0, len(content) - 1), st.integers(0, 255))
    for place, value in data.draw(st.lists(places, min_size=1, max_size=8)):
        mutant[place] = value
    read_all(path, bytes(mutant))


@given(st.data())
def test_pieces_in_the_wrong_place_are_refused_or_read(seed, data):
    path, content = seed
    a, b, c = sorted(data.draw(st.tuples(*[st.integers(0, len(content))] * 3)))
    read_all(path, content[:a] + content[b:c] + content[a:b] + content[c:])


@given(st.binary(max_size=300))
def test_random_bytes_are_refused(seed, content):
    path, whole = seed
    read_all(path, content)
    read_all(path, whole[:20] + content)


def test_a_cut_file_needs_no_more_memory_than_the_whole(seed):
    path, content = seed
    path.write_bytes(content)
    tracemalloc.start()
    read_all(path, content)
    whole = tracemalloc.get_traced_memory()[1]
    for share in np.linspace(0.1, 0.9, 9):
        tracemalloc.reset_peak()
        read_all(path, content[: int(share * len(content))])
        assert tracemalloc.get_traced_memory()[1] < 2 * whole + 1e6
    tracemalloc.stop()


@pytest.mark.parametrize("ending", [".obj", ".glb", ".gltf", ".npz", ".ply", ".stl", ".json"])
@pytest.mark.parametrize("content", [b"", b"\0", b"\n", b"\xff" * 100, b" " * 1000, b"0" * 1000])
def test_empty_and_dull_files_are_refused(tmp_path: Path, ending: str, content: bytes):
    assert read_all(tmp_path / f"mutant{ending}", content) == 0
