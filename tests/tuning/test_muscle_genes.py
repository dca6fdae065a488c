"""Genes of vector muscles, and styles made of them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from risorius.errors import FormatError, ParameterError
from risorius.tuning import Genome, MuscleCandidates, apply_genes, muscle_parameters, parse_style
from risorius.tuning.style import Style, read_style, write_style
from risorius.vectormuscle import VectorFace
from tests.face_fixtures import builtin_face

WIDTH = 130.0
MUSCLES = {muscle.name: muscle for muscle in builtin_face().vectors.muscles}


def _values(share: float, names: tuple[str, ...] = tuple(MUSCLES)) -> dict[str, float]:
    """Return all genes of some muscles at `share` of the way from low to high."""
    genes = muscle_parameters([MUSCLES[name] for name in names], genes="all")
    return {gene.name: gene.low + share * (gene.high - gene.low) for gene in genes}


def test_a_linear_muscle_has_ten_genes_that_both_sides_share() -> None:
    pair = [MUSCLES["zygomaticus_major_l"], MUSCLES["zygomaticus_major_r"]]
    names = [gene.name for gene in muscle_parameters(pair)]
    assert len(names) == 10
    assert all(name.startswith("zygomaticus_major.") for name in names)
    assert len(muscle_parameters(pair, mirror=False)) == 20


def test_further_genes_say_how_skin_follows_and_bulges() -> None:
    linear, sheet = MUSCLES["zygomaticus_major_l"], MUSCLES["frontalis_inner_l"]
    for muscle, further in (
        (linear, {"out", "corner", "drag", "reach", "bulge", "sink"}),
        (sheet, {"fixed", "fade_origin", "fade_insertion", "out", "drag", "reach"}),
    ):
        ten = {gene.name for gene in muscle_parameters([muscle])}
        everything = {gene.name for gene in muscle_parameters([muscle], genes="all")}
        assert {name.split(".")[1] for name in everything - ten} == further
    # A muscle that pulls the whole lip has no corner to hold.
    names = {gene.name for gene in muscle_parameters([MUSCLES["corrugator_l"]], genes="all")}
    assert "corrugator.corner" not in names


def test_shares_stay_inside_their_limits() -> None:
    changed = apply_genes(
        MUSCLES["zygomaticus_major_l"],
        {"zygomaticus_major.drag": 5.0, "zygomaticus_major.corner": -5.0},
        width=WIDTH,
    ).to_json()
    assert changed["drag"] == 0.95
    assert "corner" not in changed


@pytest.mark.parametrize("name", MUSCLES)
def test_genes_at_their_start_change_nothing(name: str) -> None:
    genes = muscle_parameters([MUSCLES[name]], genes="all")
    start = {gene.name: gene.start for gene in genes}
    assert apply_genes(MUSCLES[name], start, width=WIDTH).to_json() == MUSCLES[name].to_json()


@pytest.mark.parametrize("share", [0.0, 0.3, 1.0])
def test_every_value_in_bounds_makes_a_muscle_and_sides_stay_mirrored(share: float) -> None:
    values = _values(share)
    tuned = {name: apply_genes(muscle, values, width=WIDTH) for name, muscle in MUSCLES.items()}
    for name, muscle in tuned.items():
        if name.endswith("_l"):
            left, right = muscle.mirrored().ends(), tuned[f"{name[:-2]}_r"].ends()
            assert np.abs(np.sort(left, axis=0) - np.sort(right, axis=0)).max() < 1e-6 * WIDTH
        elif not name.endswith("_r"):
            shift = muscle.ends().mean(axis=0) - MUSCLES[name].ends().mean(axis=0)
            assert shift[0] == pytest.approx(0.0, abs=1e-9)


def test_a_place_shifts_by_its_share_of_the_width() -> None:
    genes = {"corrugator.origin_x": 0.08, "corrugator.insertion_y": -0.05}
    for side, sign in (("l", 1.0), ("r", -1.0)):
        before = MUSCLES[f"corrugator_{side}"]
        after = apply_genes(before, genes, width=WIDTH)
        shift = after.ends() - before.ends()
        assert np.allclose(shift, [[sign * 0.08 * WIDTH, 0, 0], [0, -0.05 * WIDTH, 0]])


def test_a_side_of_its_own_goes_before_the_gene_of_both() -> None:
    genes = {"corrugator.strength": 0.5, "corrugator_l.strength": 0.9}
    ratio = [
        apply_genes(MUSCLES[name], genes, width=WIDTH).to_json()["strength"]
        / MUSCLES[name].to_json()["strength"]
        for name in ("corrugator_l", "corrugator_r")
    ]
    assert ratio == pytest.approx([0.9, 0.5])


def test_only_the_zones_of_tuned_muscles_are_bound_anew_and_right() -> None:
    face = builtin_face()
    values = _values(0.8, ("zygomaticus_major_l",))
    pose = {"zygomaticus_major_l": 1.0, "zygomaticus_major_r": 1.0, "jaw_pitch": 5.0}
    names = ("zygomaticus_major_l", "zygomaticus_major_r")
    candidates = MuscleCandidates(face, names, pose, WIDTH)
    quick = candidates.positions(values)
    slow = VectorFace.build(face.head, face.vectors.replaced(candidates.muscles(values)))
    assert np.abs(quick - slow.pose(pose)).max() < 1e-9
    assert np.abs(quick - face.pose(pose)).max() > 0.5
    assert candidates.genome == Genome(muscle_parameters(candidates.proposed))


def test_a_face_refuses_a_muscle_that_it_does_not_have() -> None:
    stranger = replace(MUSCLES["procerus"], name="vomer")
    with pytest.raises(ParameterError, match="this face has no vomer"):
        builtin_face().with_muscles([stranger])


def test_a_style_survives_its_file_and_tunes_the_next_head(tmp_path) -> None:
    style = Style(_values(0.7, ("mentalis_l", "corrugator_l")))
    write_style(style, tmp_path / "mine.style.json")
    again = read_style(tmp_path / "mine.style.json")
    assert again.parameters == pytest.approx(style.parameters, abs=1e-6)
    muscles = [MUSCLES["corrugator_l"], MUSCLES["risorius_l"]]
    tuned = again.on_vectors(muscles, width=WIDTH)
    assert (tuned[0].ends() != muscles[0].ends()).any()
    assert tuned[1] is muscles[1]
    known = [gene.name for gene in muscle_parameters(muscles, genes="all")]
    assert all(name.startswith("mentalis.") for name in again.unknown(known))


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"schema": "risorius/vector-set"}, 'expected "schema": "risorius/style"'),
        (
            {"version": 2},
            "written in version 2 of risorius/style",
        ),
        ({"parameters": [1]}, "'parameters' must be an object"),
        ({"method": 3}, "'method' must be a word"),
    ],
)
def test_a_malformed_style_is_refused(change: dict[str, object], sentence: str) -> None:
    good = Style({"mentalis.strength": 1.2}).to_json()
    with pytest.raises(FormatError, match=sentence):
        parse_style(good | change, source="x.json")


def test_a_style_with_words_for_numbers_is_refused() -> None:
    data = Style().to_json() | {"parameters": {"mentalis.strength": "strong"}}
    with pytest.raises(ParameterError, match="'strong' is not a number"):
        parse_style(data, source="x.json")
