"""Rigs that other tools wrote are sources: GLB of every make, folders of OBJ, arrays."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from risorius import Head, Rig
from risorius.anatomy.template import builtin_head
from risorius.cloning import Cloning, clone_with_report, motion_error
from risorius.errors import FormatError, RisoriusError
from risorius.io.obj_folder import write_obj_folder
from risorius.rig.bake import empty_rig
from tests.cloning.rigs import dense, other_head, source_rig, specs_of
from tests.io.glb import Maker

FloatArray = npt.NDArray[np.float64]
NAMES = ("jawOpen", "smile")
# Bits that a quantised position has over the head's size.
STEPS = 32767


@cache
def skin_only() -> tuple[FloatArray, npt.NDArray[np.int32], FloatArray]:
    """Return vertices [m], triangles and two shapes (2, n, 3) [m] of the built-in head's skin."""
    head, rig = builtin_head(), source_rig()
    used = np.unique(head.skin.source)
    place = np.full(head.vertex_count, -1)
    place[used] = np.arange(len(used))
    faces = place[head.source.triangles]
    metres = 0.001 * head.frame.scale
    moved = np.stack([rig.target(name).dense(head.vertex_count) for name in NAMES])
    faces = faces[(faces >= 0).all(axis=1)].astype(np.int32)
    return metres * head.source.positions[used], faces, metres * moved[:, used]


def sparse(maker: Maker, moved: FloatArray) -> int:
    """Add displacements (n, 3) as a sparse accessor without a base."""
    rows = np.flatnonzero(moved.any(axis=1))
    maker.document["accessors"].append(
        {
            "componentType": 5126,
            "count": len(moved),
            "type": "VEC3",
            "sparse": {
                "count": len(rows),
                "indices": {"bufferView": maker.view(rows.astype("<u4").tobytes()),
                            "byteOffset": 0, "componentType": 5125},
                "values": {"bufferView": maker.view(moved[rows].astype("<f4").tobytes()),
                           "byteOffset": 0},
            },
        }
    )  # fmt: skip
    return len(maker.document["accessors"]) - 1


def plain(maker: Maker, moved: FloatArray) -> int:
    return maker.accessor(moved.astype("<f4"))


def interleaved(maker: Maker, moved: FloatArray) -> int:
    """Add displacements in rows of 24 bytes, as exporters write them beside normals."""
    rows = np.concatenate([moved, np.ones_like(moved)], axis=1).astype("<f4")
    view = maker.view(rows.tobytes(), byteStride=24)
    maker.document["accessors"].append(
        {"bufferView": view, "componentType": 5126, "count": len(moved), "type": "VEC3"}
    )
    return len(maker.document["accessors"]) - 1


WRITERS = {"sparse": sparse, "plain": plain, "interleaved": interleaved}


def quantised(maker: Maker, positions: FloatArray) -> tuple[int, float]:
    """Add positions as normalised 16 bit integers; return the accessor and the node's scale."""
    size = float(np.abs(positions).max())
    whole = np.round(positions / size * STEPS).astype("<i2")
    padded = np.concatenate([whole, np.zeros((len(whole), 1), "<i2")], axis=1)
    view = maker.view(padded.tobytes(), byteStride=8)
    maker.document["accessors"].append(
        {
            "bufferView": view,
            "componentType": 5122,
            "normalized": True,
            "count": len(whole),
            "type": "VEC3",
        }
    )
    return len(maker.document["accessors"]) - 1, size


def foreign(
    path: Path, writer: str, *, pieces: int = 1, normalised: bool = False, named: bool = True
) -> Rig:
    """Write a GLB by hand, turned and shifted by its node, and read it."""
    positions, faces, moved = skin_only()
    maker = Maker()
    # The node turns what was written back to where it belongs.
    back = np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]])
    written = (positions - [0.1, 0.2, -0.3]) @ back
    scale = 1.0
    maker.document["meshes"] = []
    # Halves above and below share no vertex number; seams are welded by the reader's heads.
    bounds = np.linspace(0, len(faces), pieces + 1).astype(int)
    maker.document["nodes"], maker.document["scenes"] = [], [{"nodes": list(range(pieces))}]
    for start, end in pairwise(bounds):
        used, local = np.unique(faces[start:end], return_inverse=True)
        if normalised:
            place, scale = quantised(maker, written[used])
        else:
            place = maker.accessor(written[used].astype("<f4"))
        targets = [
            {"POSITION": WRITERS[writer](maker, (shape @ back)[used] / scale)} for shape in moved
        ]
        primitive = {
            "attributes": {"POSITION": place},
            "indices": maker.accessor(local.reshape(-1).astype("<u4")),
            "targets": targets,
        }
        mesh: dict[str, Any] = {"primitives": [primitive]}
        if named:
            mesh["extras"] = {"targetNames": list(NAMES)}
        quaternion = [0.0, float(np.sin(np.pi / 4)), 0.0, float(np.cos(np.pi / 4))]
        maker.document["nodes"].append(
            {
                "mesh": len(maker.document["meshes"]),
                "rotation": quaternion,
                "translation": [0.1, 0.2, -0.3],
                "scale": [scale] * 3,
            }
        )
        maker.document["meshes"].append(mesh)
    path.write_bytes(maker.glb())
    return Rig.load(path)


def with_landmarks(rig: Rig) -> Rig:
    """Give a rig the built-in head's landmarks by place, as a landmark file for it would."""
    head = builtin_head()
    metres = 0.001 * head.frame.scale
    specs = {
        name: replace(
            spec, vertex=None, position=tuple(metres * head.source.positions[spec.vertex])
        )
        for name, spec in specs_of(head).items()
        if spec.vertex in set(head.skin.source.tolist())
    }
    return empty_rig(Head.from_mesh(rig.mesh, specs)).with_targets(rig.targets)


@cache
def wanted() -> FloatArray:
    """Return what the rig itself gives on the other head, on its skin."""
    rig = source_rig().subset(list(NAMES))
    skin = other_head().skin.first_source()
    return Cloning.build(builtin_head(), other_head()).carry(dense(rig))[:, skin]


@pytest.mark.filterwarnings("ignore::risorius.errors.RisoriusWarning")
@pytest.mark.parametrize(
    ("writer", "options"),
    [
        ("sparse", {}),
        ("plain", {"pieces": 2}),
        ("interleaved", {"named": False}),
        ("plain", {"normalised": True}),
    ],
)
def test_a_glb_of_another_tool_gives_what_our_own_rig_gives(tmp_path, writer, options) -> None:
    rig = foreign(tmp_path / "foreign.glb", writer, **options)
    expected = NAMES if options.get("named", True) else ("target_0", "target_1")
    assert rig.names == expected
    made = clone_with_report(with_landmarks(rig), other_head())
    assert made.report.scale == pytest.approx(1.0, abs=0.05)
    skin = other_head().skin.first_source()
    for truth, moved in zip(wanted(), dense(made.rig)):
        # 16 bits and welding at seams move places by hundredths of a millimetre.
        assert motion_error(truth, moved[skin]) < 5.0


@pytest.mark.filterwarnings("ignore:.*rig.json")
def test_a_folder_of_obj_with_any_names_is_a_source(tmp_path: Path) -> None:
    folder = tmp_path / "shapes"
    write_obj_folder(source_rig().subset(list(NAMES)), folder)
    (folder / "rig.json").unlink()
    (folder / "jawOpen.obj").rename(folder / "Actor 01 - jaw open (v2).obj")
    rig = Rig.load(folder)
    assert set(rig.names) == {"Actor 01 - jaw open (v2)", "smile"}
    made = clone_with_report(replace(rig, landmarks=specs_of(builtin_head())), other_head())
    skin = other_head().skin.first_source()
    jaw = dense(made.rig.subset(["Actor 01 - jaw open (v2)"]))[0][skin]
    assert motion_error(wanted()[0], jaw) < 0.5


def test_an_archive_of_arrays_is_a_source(tmp_path: Path) -> None:
    path = tmp_path / "shapes.npz"
    source_rig().subset(list(NAMES)).save(path)
    made = clone_with_report(Rig.load(path), other_head())
    skin = other_head().skin.first_source()
    for truth, moved in zip(wanted(), dense(made.rig)):
        assert motion_error(truth, moved[skin]) < 0.5


@pytest.mark.parametrize("content", [b"", b"glTF", b"PK\x03\x04 no archive"])
@pytest.mark.parametrize("ending", [".glb", ".npz"])
def test_what_is_no_rig_is_refused_in_one_sentence(tmp_path, ending, content) -> None:
    path = tmp_path / f"broken{ending}"
    path.write_bytes(content)
    with pytest.raises(FormatError) as told:
        Rig.load(path)
    assert path.name in str(told.value)
    assert "\n" not in str(told.value)


@pytest.mark.filterwarnings("ignore:.*rig.json")
def test_a_shape_of_another_mesh_in_a_folder_is_refused_by_its_name(tmp_path: Path) -> None:
    folder = tmp_path / "shapes"
    write_obj_folder(source_rig().subset(list(NAMES)), folder)
    (folder / "rig.json").unlink()
    (folder / "smile.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    with pytest.raises(RisoriusError, match="smile"):
        Rig.load(folder)
