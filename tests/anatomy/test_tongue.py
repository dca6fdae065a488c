from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from risorius.anatomy.jaw import JawPose
from risorius.anatomy.tongue import build_tongue, tongue_in_gums
from risorius.head import Head
from tests.face_fixtures import builtin_face, made_up_head
from tests.synthetic import assemble, head_pieces, head_specs, sphere

# 40 mm long along z, tip at 70; the lips stand at 85.
POINTS = sphere((0.0, -70.0, 50.0), (14.0, 5.0, 20.0))[0]
TONGUE = build_tongue(POINTS, 85.0)
TIP, ROOT = int(np.argmax(POINTS[:, 2])), POINTS[:, 2] < 40.0

one = st.floats(-1.0, 1.0)


def test_at_rest_it_lies_still() -> None:
    np.testing.assert_array_equal(TONGUE.displace(out=0.0, up=0.0, side=0.0), 0.0)


def test_out_brings_the_tip_beyond_the_lips_by_less_than_half_the_tongue() -> None:
    moved = POINTS + TONGUE.displace(out=1.0, up=0.0, side=0.0)
    assert TONGUE.length == pytest.approx(40.0)
    assert moved[TIP, 2] - POINTS[TIP, 2] == pytest.approx(TONGUE.reach)
    assert 85.0 + 0.25 * 40.0 < moved[TIP, 2] < 85.0 + 0.5 * 40.0


def test_up_lifts_and_side_goes_to_the_characters_left() -> None:
    up = TONGUE.displace(out=0.0, up=1.0, side=0.0)[TIP]
    left = TONGUE.displace(out=0.0, up=0.0, side=1.0)[TIP]
    assert up[1] > 5.0
    assert abs(up[0]) < 1e-12
    assert left[0] > 5.0
    assert abs(left[1]) < 1e-12


@given(st.floats(0.0, 1.0), one, one)
def test_the_root_stays_and_left_mirrors_right(out: float, up: float, side: float) -> None:
    left = TONGUE.displace(out=out, up=up, side=side)
    right = TONGUE.displace(out=out, up=up, side=-side)
    np.testing.assert_array_equal(left[ROOT], 0.0)
    np.testing.assert_allclose(right * [-1.0, 1.0, 1.0], left, atol=1e-12)


@given(st.floats(0.0, 1.0))
def test_a_tongue_that_comes_out_keeps_its_order_from_root_to_tip(out: float) -> None:
    along = POINTS[:, 2] + TONGUE.displace(out=out, up=0.0, side=0.0)[:, 2]
    order = np.argsort(POINTS[:, 2])
    assert (np.diff(along[order]) > -1e-9).all()


def test_a_tongue_beyond_the_lips_already_only_stretches() -> None:
    # The tip stands at 70: lips at 60 are passed already, lips at 85 are 15 away.
    assert build_tongue(POINTS, 60.0).reach == pytest.approx(TONGUE.reach - 15.0)


def _head_with_gums(*extra: str):
    pieces = head_pieces("bag")
    tongue = pieces.pop("tongue")
    upper = sphere((0.0, -60.0, 45.0), (26.0, 4.0, 26.0))
    first = len(tongue[0])
    polygons = [*tongue[1], *[tuple(v + first for v in face) for face in upper[1]]]
    pieces["gums"] = (np.concatenate([tongue[0], upper[0]]), polygons)
    for name in extra:
        pieces.pop(name)
    names = {"gums": "gums", "teeth_upper": "teeth_upper", "teeth_lower": "teeth_lower"}
    names = {piece: name for piece, name in names.items() if piece in pieces}
    return Head.from_mesh(assemble(pieces, names=names), head_specs("bag")), first


def test_a_tongue_that_is_one_piece_with_the_gums_is_found_between_the_teeth() -> None:
    head, count = _head_with_gums()
    tongue = tongue_in_gums(head, 44.0, 85.0)
    assert tongue is not None
    moved = tongue.along > 0.0
    assert moved[:count].sum() > 20
    assert not moved[count:].any()


def test_without_lower_teeth_no_tongue_is_looked_for() -> None:
    head, _ = _head_with_gums("teeth_lower")
    assert tongue_in_gums(head, 44.0, 85.0) is None


def test_gums_alone_are_no_tongue() -> None:
    head = made_up_head()
    assert "gums" not in head.parts
    pieces = head_pieces("bag")
    pieces["gums"] = sphere((0.0, -60.0, 45.0), (26.0, 4.0, 26.0))
    found = Head.from_mesh(assemble(pieces, names={"gums": "gums"}), head_specs("bag"))
    assert tongue_in_gums(found, 44.0, 85.0) is None


def test_the_built_in_tongue_comes_out_between_the_lips_and_follows_the_jaw() -> None:
    face = builtin_face()
    source = face.head.parts["tongue"].source
    tip = source[np.argmax(face.head.positions[source, 2])]
    out = face.displace({"tongue_out": 1.0})[tip]
    lips = face.head.landmarks.positions(("2.2", "2.3"))[:, 2].max()
    assert face.head.positions[tip, 2] + out[2] > lips + 5.0
    opened = face.displace({"jaw_pitch": 12.0})[source]
    moved = face.mechanics.jaw.move(face.head.positions[source], JawPose(pitch=12.0))
    np.testing.assert_allclose(face.head.positions[source] + opened, moved, atol=1e-9)
