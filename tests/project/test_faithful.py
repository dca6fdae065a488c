from __future__ import annotations

import pytest

from risorius.anatomy.template import builtin_head
from risorius.errors import ParameterError
from risorius.layered import LayeredFace
from risorius.layered.faithful import FaithfulFace
from risorius.project.layered import layered_face
from risorius.project.project import Project

HEAD = builtin_head()


def test_the_profile_chooses_the_face() -> None:
    face = layered_face(Project(method="layered", profile="faithful"), HEAD, None)
    assert isinstance(face, FaithfulFace)
    assert not isinstance(face, LayeredFace)
    assert face.head is HEAD


def test_the_published_face_takes_no_parameters_from_a_project() -> None:
    project = Project(method="layered", profile="faithful", parameters={"anchor": 0.5})
    with pytest.raises(ParameterError, match="the method 'layered' has no 'anchor'"):
        layered_face(project, HEAD, None)
