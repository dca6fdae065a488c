"""Landmarks out of FDP files of Xface."""

from __future__ import annotations

import tracemalloc
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from risorius import _formats
from risorius.errors import FormatError, RisoriusWarning
from risorius.io.fdp import read_fdp
from risorius.landmarks.landmark_set import LandmarkSpec

GOOD = """<?xml version="1.0" encoding="UTF-8" standalone="no" ?>
<xfdp>
  <head><file version="0.2"/></head>
  <fdp affects="head.wrl_3" index="2395" name="2.1"><indices>0 1 2 </indices>
    <influence fap="2" type="RaisedCosInfluenceSph" weight="0.3"/></fdp>
  <fdp affects="head.wrl_3" index="35" name="8.3"/>
  <fdp affects="head.wrl_1" index="19" name="3.5"/>
  <fdp affects="head.wrl_1" index="3" name="2.1"/>
  <fdp affects="head.wrl_3" index="7" name="Hair"/>
</xfdp>
"""


def written(folder: Path, text: str) -> Path:
    path = folder / "a.fdp"
    path.write_text(text)
    return path


def test_points_of_the_skin_become_landmarks_and_others_are_named(tmp_path: Path) -> None:
    with pytest.warns(RisoriusWarning, match=r"count from 0 in the mesh 'head\.wrl_3'") as told:
        specs = _formats.read_landmarks(written(tmp_path, GOOD))
    assert specs == {"2.1": LandmarkSpec(vertex=2395), "8.3": LandmarkSpec(vertex=35)}
    assert "left out: 3.5 on head.wrl_1, 2.1 on head.wrl_1" in str(told[0].message)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("<xfdp>", "<fdp>", "expected <xfdp> of Xface, found <fdp>"),
        ('index="35" ', "", "line 6: <fdp> has no index"),
        ('index="35"', 'index="-1"', "index '-1' of '8.3' is no vertex number"),
        ('index="35"', 'index="٣"', "is no vertex number"),
        ('index="35"', 'index="9999999999"', "beyond any mesh"),
        ("</xfdp>", "", "line 11, column 1: no element found"),
        ("<xfdp>", '<!DOCTYPE x [<!ENTITY a "b">]><xfdp>', "has a document type"),
        ('name="', 'name="x', "there are no feature points"),
        ("UTF-8", "klingon", "unknown encoding"),
        ("<head>", "<head>" + "<a>" * 40, "nested deeper than 32"),
    ],
)
def test_what_is_wrong_is_named(tmp_path: Path, old: str, new: str, message: str) -> None:
    path = written(tmp_path, GOOD.replace(old, new))
    with pytest.raises(FormatError, match=message) as refused:
        read_fdp(path)
    assert str(path) in str(refused.value)


@given(junk=st.binary(max_size=200), place=st.integers(0, len(GOOD)))
@pytest.mark.filterwarnings("ignore::risorius.errors.RisoriusWarning")
def test_broken_files_are_read_or_refused(
    tmp_path_factory: pytest.TempPathFactory, junk: bytes, place: int
) -> None:
    path = tmp_path_factory.mktemp("fdp") / "a.fdp"
    good = GOOD.encode()
    path.write_bytes(good[:place] + junk + good[place:])
    try:
        assert read_fdp(path)
    except FormatError as error:
        assert str(path) in str(error)


def test_an_entity_bomb_takes_no_memory(tmp_path: Path) -> None:
    entities = '<!ENTITY a0 "ha">' + "".join(
        f'<!ENTITY a{n} "{f"&a{n - 1};" * 10}">' for n in range(1, 12)
    )
    path = written(tmp_path, f"<!DOCTYPE x [{entities}]><xfdp>&a11;</xfdp>")
    tracemalloc.start()
    with pytest.raises(FormatError, match="has a document type"):
        read_fdp(path)
    assert tracemalloc.get_traced_memory()[1] < 1e6
    tracemalloc.stop()


@pytest.mark.real
@pytest.mark.filterwarnings("ignore::risorius.errors.RisoriusWarning")
def test_a_real_file_gives_the_points_of_the_skin(real_data: Path) -> None:
    specs = read_fdp(real_data / "xface_fap" / "alice.fdp")
    assert len(specs) == 32
    assert specs["2.1"].vertex == 2395
    assert specs["8.4"].vertex == 211
    assert "3.5" not in specs
