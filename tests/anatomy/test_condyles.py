from __future__ import annotations

import numpy as np
import pytest

from risorius.anatomy.condyles import builtin_condyles, condyles
from risorius.anatomy.template import builtin_head
from risorius.errors import LandmarkError
from risorius.head import Head
from tests.face_fixtures import made_up_head
from tests.synthetic import assemble, head_pieces, head_specs


def test_the_built_in_condyles_are_mirror_images_inside_the_head() -> None:
    left, right = builtin_condyles()
    np.testing.assert_allclose(right, left * [-1.0, 1.0, 1.0], atol=1e-9)
    skin = builtin_head().skin.mesh.positions
    assert 35.0 < left[0] < skin[:, 0].max()
    assert -60.0 < left[1] < 15.0


def test_condyles_marked_on_the_skin_lie_beneath_it() -> None:
    head = builtin_head()
    left, right = condyles(head)
    on_skin = head.landmarks.positions(("condyle_l", "condyle_r"))
    np.testing.assert_allclose(on_skin[0] - left, [14.0, 0.0, 0.0])
    np.testing.assert_allclose(on_skin[1] - right, [-14.0, 0.0, 0.0])


def test_marked_and_carried_condyles_agree_on_the_built_in_head() -> None:
    for marked, carried in zip(condyles(builtin_head()), builtin_condyles()):
        assert np.linalg.norm(marked - carried) < 12.0


def test_a_head_without_marks_gets_the_condyles_carried_over() -> None:
    left, right = condyles(made_up_head())
    np.testing.assert_allclose(right, left * [-1.0, 1.0, 1.0], atol=1e-3)
    chin = made_up_head().landmarks.position("2.1")
    eyes = made_up_head().landmarks.position("3.7")
    assert left[0] > 25.0
    assert chin[1] + 20.0 < left[1] < eyes[1] + 25.0
    assert left[2] < chin[2] - 25.0


def test_too_few_landmarks_to_carry_them_over_are_refused() -> None:
    keep = ("3.7", "3.8", "3.11", "3.12", "2.1", "9.3")
    specs = {name: spec for name, spec in head_specs().items() if name in keep}
    head = Head.from_mesh(assemble({"skin": head_pieces()["skin"]}), specs)
    with pytest.raises(LandmarkError, match=r"6 in common with the built-in head, 8 are needed"):
        condyles(head)
