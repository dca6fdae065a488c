from __future__ import annotations

import numpy as np

from risorius.anatomy.cheeks import cheek_fields, lips_middle
from tests.face_fixtures import builtin_face, made_up_head, made_up_mechanics, mirror_vertices

HEAD, LIPS = builtin_face().head, builtin_face().mechanics.lips
FIELDS = cheek_fields(HEAD, LIPS)
POINTS = HEAD.skin.mesh.positions


def test_each_cheek_moves_its_own_side_only() -> None:
    np.testing.assert_array_equal(FIELDS["l"][POINTS[:, 0] <= 0.0], 0.0)
    np.testing.assert_array_equal(FIELDS["r"][POINTS[:, 0] >= 0.0], 0.0)


def test_the_two_cheeks_are_mirror_images() -> None:
    partner = mirror_vertices(POINTS)
    np.testing.assert_allclose(FIELDS["r"][partner] * [-1.0, 1.0, 1.0], FIELDS["l"], atol=1e-9)


def test_air_pushes_outwards_and_by_less_than_a_quarter_of_the_mouth() -> None:
    length = np.linalg.norm(FIELDS["l"], axis=1)
    assert 0.08 * LIPS.width < length.max() < 0.25 * LIPS.width
    blown = length > 0.5 * length.max()
    assert (FIELDS["l"][blown, 0] > 0.0).all()


def test_lips_lining_and_the_rest_of_the_head_keep_still() -> None:
    lips = np.union1d(LIPS.slit.upper, LIPS.slit.lower)
    lips = lips[LIPS.to_corner[lips] > 0.1 * LIPS.width]
    for field in FIELDS.values():
        np.testing.assert_array_equal(field[LIPS.inside], 0.0)
        np.testing.assert_array_equal(field[lips], 0.0)
        for name in ("9.3", "2.1", "3.3", "4.1", "10.1", "11.4"):
            np.testing.assert_array_equal(field[HEAD.skin_vertex(name)], 0.0)


def test_a_head_without_jaw_corners_has_cheeks_too() -> None:
    head, lips = made_up_head(), made_up_mechanics().lips
    assert "2.13" not in head.landmarks
    fields = cheek_fields(head, lips)
    assert abs(lips_middle(head.skin.mesh.positions, lips)) < 1e-9
    for side, sign in (("l", 1.0), ("r", -1.0)):
        length = np.linalg.norm(fields[side], axis=1)
        middle = head.skin.mesh.positions[np.argmax(length)]
        assert length.max() > 0.05 * lips.width
        assert sign * middle[0] > 0.4 * lips.width
