from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from risorius.head.part import PART_KINDS
from risorius.head.part_names import kind_of_name

BARE = {"eye", "teeth", "lashes"}


@pytest.mark.parametrize(
    ("name", "kind"),
    [
        ("skin", "skin"),
        ("Head", "skin"),
        ("CC_Base_Body", "skin"),
        ("Wolf3D_Head", "skin"),
        ("eyelid_left", "skin"),
        ("eye_sockets", "skin"),
        ("vermilion_upper", "skin"),
        ("Ear.L", "skin"),
        ("eye_left", "eye_left"),
        ("EyeRight", "eye_right"),
        ("eyeball_L", "eye_left"),
        ("R_cornea", "eye_right"),
        ("iris", "eye"),
        ("Eyes", "eye"),
        ("eye_left_right", "eye"),
        ("teeth_upper", "teeth_upper"),
        ("LowerTeeth", "teeth_lower"),
        ("teeth_jaw", "teeth_lower"),
        ("Wolf3D_Teeth", "teeth"),
        ("denture", "teeth"),
        ("gums_tongue", "gums"),
        ("Gum_lower", "gums"),
        ("tongue01", "tongue"),
        ("mouth_bag", "mouth_inside"),
        ("Oral cavity", "mouth_inside"),
        ("eyelashes_left", "lashes_left"),
        ("lash.R", "lashes_right"),
        ("Eyelash", "lashes"),
        ("eyebrows", "attached"),
        ("beard", "attached"),
        ("TearLine", "attached"),
        ("shirt", None),
        ("default", None),
        ("", None),
        ("___", None),
        ("Object_7", None),
    ],
)
def test_names_tell_the_kind(name: str, kind: str | None) -> None:
    assert kind_of_name(name) == kind


def test_every_part_kind_but_the_rest_is_understood_as_its_own_name() -> None:
    for kind in PART_KINDS:
        if kind not in ("attached", "other"):
            assert kind_of_name(kind) == kind


def test_upper_and_lower_case_do_not_matter_at_word_borders() -> None:
    for name in ("teeth_upper", "Teeth_Upper", "TEETH_UPPER", "TeethUpper", "teethUpper"):
        assert kind_of_name(name) == "teeth_upper"


@given(st.text(max_size=30))
def test_any_text_is_a_known_kind_or_none(name: str) -> None:
    assert kind_of_name(name) in {*PART_KINDS, *BARE, None}
