"""Rigs as NumPy archives."""

import io
import json
import tracemalloc
import zipfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from risorius import _formats
from risorius.errors import FormatError
from risorius.io.npz import read_npz_head, read_npz_rig, write_npz
from tests.io.rigs import assert_same_rig, make_rig, make_seam_rig


@pytest.fixture(scope="module")
def archive(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("npz") / "a.npz"
    write_npz(make_rig(), path)
    return path


@pytest.mark.parametrize("rig", [make_rig(), make_seam_rig(apart=False)])
def test_a_rig_comes_back_bit_by_bit(tmp_path: Path, rig):
    rig.save(tmp_path / "a.npz")
    assert_same_rig(_formats.read_rig(tmp_path / "a.npz"), rig, rounding=0.0)


def test_the_arrays_are_plain_and_documented(archive: Path):
    rig = make_rig()
    with np.load(archive, allow_pickle=False) as arrays:
        assert arrays["names"].tolist() == list(rig.names)
        for name, deltas in zip(arrays["names"], arrays["deltas"]):
            np.testing.assert_array_equal(deltas, rig.by_name[name].dense(rig.mesh.vertex_count))
        np.testing.assert_array_equal(arrays["neutral"], rig.mesh.positions)
        np.testing.assert_array_equal(arrays["faces"], rig.mesh.triangles)
        meta = json.loads(str(arrays["meta"]))
    assert meta["landmarks"]["2.1"] == {"vertex": 3, "confidence": "documented"}


def test_the_head_comes_back_with_its_landmarks(archive: Path):
    mesh, landmarks = read_npz_head(archive)
    np.testing.assert_array_equal(mesh.positions, make_rig().mesh.positions)
    assert landmarks == make_rig().landmarks


def test_the_same_rig_gives_the_same_bytes(archive: Path, tmp_path: Path):
    write_npz(make_rig(), tmp_path / "b.npz")
    assert (tmp_path / "b.npz").read_bytes() == archive.read_bytes()


def test_a_failed_write_keeps_the_old_file(tmp_path: Path):
    rig = make_rig()
    rig.frame.origin[0] = np.nan
    (tmp_path / "a.npz").write_bytes(b"old")
    with pytest.raises(FormatError, match="hold a number that is not finite"):
        write_npz(rig, tmp_path / "a.npz")
    assert (tmp_path / "a.npz").read_bytes() == b"old"
    assert len(list(tmp_path.iterdir())) == 1


def npy(array: np.ndarray) -> bytes:
    buffer = io.BytesIO()
    np.save(buffer, array, allow_pickle=True)
    return buffer.getvalue()


def header(descr: str, shape: str) -> bytes:
    text = f"{{'descr': {descr}, 'fortran_order': False, 'shape': {shape}, }}".encode()
    text += b" " * (117 - len(text)) + b"\n"
    return b"\x93NUMPY\x01\x00" + len(text).to_bytes(2, "little") + text


Entries = dict[str, bytes]


def with_entry(name: str, data: bytes) -> Callable[[Entries], object]:
    return lambda entries: entries.__setitem__(f"{name}.npy", data)


def meta(**changes: object) -> Callable[[Entries], object]:
    def change(entries: Entries) -> None:
        text = str(np.load(io.BytesIO(entries["meta.npy"])))
        entries["meta.npy"] = npy(np.array(json.dumps({**json.loads(text), **changes})))

    return change


N = make_rig().mesh.vertex_count


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda entries: entries.pop("neutral.npy"), "has no array 'neutral'"),
        (with_entry("neutral", b""), "neutral: has no plain array header"),
        (with_entry("neutral", b"\x93NUMPY\x02\x00" + bytes(200)), "no plain array header"),
        (with_entry("neutral", npy(np.array([{}], object))), "no plain array header"),
        (with_entry("neutral", npy(np.asfortranarray(np.ones((4, 3))))), "no plain array header"),
        (with_entry("neutral", npy(np.ones((N, 3), ">f8"))), "no plain array header"),
        (with_entry("neutral", header("'<f8'", "(4000000000000, 3)")), "do not hold an array"),
        (with_entry("neutral", header("'<f999999999'", "(0, 3)")), "no plain array header"),
        (with_entry("neutral", header("'<f8'", "(" + "9" * 70 + ",)")), "no plain array header"),
        (with_entry("neutral", npy(np.ones((N, 2)))), "neutral: expected 3 columns"),
        (with_entry("neutral", npy(np.ones(N))), "which is not expected"),
        (with_entry("neutral", npy(np.ones((N, 3), int))), "which is not expected"),
        (with_entry("neutral", npy(np.full((N, 3), np.nan))), "neutral: row 0 is .*finite"),
        (with_entry("corners", npy(np.array([N]))), f"numbers must lie in -1..{N - 1}"),
        (with_entry("corners", npy(np.array([-1]))), "must lie in|must start at 0"),
        (with_entry("offsets", npy(np.array([0, 4, 3]))), "must start at 0 and rise"),
        (with_entry("offsets", npy(np.zeros(0, int))), "must start at 0 and rise"),
        (with_entry("offsets", npy(np.array([1, 4]))), "expected 1 values|must start at 0"),
        (with_entry("uv_corners", npy(np.array([0]))), "uv_corners: expected"),
        (with_entry("part_of_vertex", npy(np.array([0]))), f"expected {N} numbers"),
        (with_entry("names", npy(np.array(["a", "b"]))), r"deltas: expected numbers of shape \(2"),
        (with_entry("names", npy(np.array(["a", "a", "b"]))), "two targets have the same name"),
        (with_entry("names", header("'<U1'", "(3,)") + b"\xff" * 12), "broken archive"),
        (with_entry("deltas", npy(np.full((3, N, 3), np.inf))), r"deltas\[0\]: row 0"),
        (with_entry("meta", npy(np.array("{"))), "meta: line 1, column 2"),
        (meta(schema="x"), 'expected "schema"'),
        (meta(version=2), "update risorius"),
        (meta(groups={"names": ["a"], "runs": [[0, 2]]}), "expected 45 values"),
    ],
)
def test_malformed_archives_are_refused(
    archive: Path, tmp_path: Path, change: Callable[[Entries], object], message: str
):
    with zipfile.ZipFile(archive) as file:
        entries = {name: file.read(name) for name in file.namelist()}
    change(entries)
    path = tmp_path / "b.npz"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as file:
        for name, data in entries.items():
            file.writestr(name, data)
    with pytest.raises(FormatError, match=message) as caught:
        read_npz_rig(path)
    assert str(path) in str(caught.value)


def test_a_bomb_is_refused_before_it_unpacks(tmp_path: Path):
    path = tmp_path / "b.npz"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as file:
        file.writestr("neutral.npy", bytes(1 << 20))
    data = bytearray(path.read_bytes())
    size = (1 << 20).to_bytes(4, "little")
    place = data.rindex(size)
    data[place : place + 4] = (0xF0000000).to_bytes(4, "little")
    path.write_bytes(data)
    tracemalloc.start()
    with pytest.raises(FormatError, match="unpacks to more than 2048 MB"):
        read_npz_rig(path)
    assert tracemalloc.get_traced_memory()[1] < 10e6
    tracemalloc.stop()


def test_what_is_no_archive_is_refused(tmp_path: Path):
    (tmp_path / "a.npz").write_bytes(b"PK\x03\x04")
    with pytest.raises(FormatError, match="broken archive"):
        read_npz_rig(tmp_path / "a.npz")


def test_unusual_compression_and_encryption_are_refused(archive: Path, tmp_path: Path):
    with zipfile.ZipFile(archive) as file:
        entries = {name: file.read(name) for name in file.namelist()}
    path = tmp_path / "b.npz"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_LZMA) as file:
        for name, data in entries.items():
            file.writestr(name, data)
    with pytest.raises(FormatError, match="compressed in a way that is not read"):
        read_npz_rig(path)
    data = bytearray(archive.read_bytes())
    place = data.index(b"PK\x01\x02")  # the first entry of the directory
    data[place + 8] |= 1  # says that it is encrypted
    path.write_bytes(data)
    with pytest.raises(FormatError, match="broken archive"):
        read_npz_rig(path)
