"""Shapes of both sides together, as engines play them, on real heads."""

from __future__ import annotations

import numpy as np
import pytest

from risorius import LayeredFace
from risorius.controls.presets import default_presets
from risorius.rig.sides import added
from tests.real.heads import REAL_HEADS, real_head

pytestmark = pytest.mark.real

STEMS = ("mouthDimple", "mouthStretch", "mouthSmile", "mouthPress")


@pytest.mark.parametrize("name", REAL_HEADS)
def test_neither_teeth_nor_lining_come_through_lips_that_both_sides_draw(name: str) -> None:
    face = LayeredFace.build(real_head(name))
    book, contact = default_presets(), face.contact
    skin, lining = contact.skin, contact.lining
    part = face.head.skin
    for stem in STEMS:
        left, right = (
            book.fit(book.arkit[f"{stem}{side}"], face.controls).pose for side in ("Left", "Right")
        )
        moved = face.displace(added(left, right))[part.first_source()]
        front = np.einsum("kc,kcd->kd", lining.shares, moved[lining.corners])
        nearer = np.einsum("kd,kd->k", moved[lining.vertices] - front, lining.directions)
        assert (nearer - lining.slack).max() < 0.25, stem
        placed = (skin.positions + moved)[contact.vertices]
        middles = 0.5 * (placed[contact.sides[:, 0]] + placed[contact.sides[:, 1]])
        # The lining of the mouth may lie back among the teeth, where nobody sees it.
        outer = ~skin.hidden[contact.vertices][contact.sides].any(axis=1)
        for kind, arch in contact.arches.items():
            inside = np.linalg.norm(arch.shortfall(middles, middles=True), axis=1)
            assert inside[outer].max() < 0.02, (stem, kind)
