"""Stripes on a surface."""

from __future__ import annotations

import numpy as np
import pytest

from risorius.mesh.core import TriMesh
from risorius.wrinkles.stripes import stripe_wave
from tests.wrinkles.sheets import sheet, turned


def wave_of(mesh: TriMesh, direction, spacing: float, **options) -> np.ndarray:
    count = mesh.vertex_count
    along = np.broadcast_to(np.asarray(direction, np.float64), (count, 3))
    return stripe_wave(mesh, along, np.full(count, spacing), strength=np.ones(count), **options)


def crests(values: np.ndarray) -> np.ndarray:
    inner = (values[1:-1] > values[:-2]) & (values[1:-1] >= values[2:])
    return np.flatnonzero(inner) + 1


@pytest.mark.parametrize("spacing", [4.0, 6.0, 9.0])
def test_crests_are_as_far_apart_as_wanted(spacing: float) -> None:
    mesh = sheet(60.0, 1.0)
    wave = wave_of(mesh, [1.0, 0.0, 0.0], spacing).reshape(61, 61)
    for row in (10, 30, 50):
        assert np.diff(crests(wave[row])).mean() == pytest.approx(spacing, rel=0.06)
    # Along the stripes nothing changes.
    assert np.abs(np.diff(wave[5:-5, 5:-5], axis=0)).max() < 0.05


def test_the_sign_of_a_direction_does_not_matter() -> None:
    mesh = sheet(24.0, 1.0)
    along = np.tile([1.0, 0.0, 0.0], (mesh.vertex_count, 1))
    signs = np.random.default_rng(5).choice([-1.0, 1.0], mesh.vertex_count)[:, None]
    spacing, strength = np.full(len(along), 6.0), np.ones(len(along))
    mixed = stripe_wave(mesh, signs * along, spacing, strength=strength).reshape(25, 25)
    assert np.diff(crests(mixed[12])).mean() == pytest.approx(6.0, rel=0.1)
    assert np.abs(np.diff(mixed[3:-3, 3:-3], axis=0)).max() < 0.1


def test_stripes_turn_with_the_sheet() -> None:
    mesh, rotation = sheet(30.0, 1.0), turned(0.9)
    straight = wave_of(mesh, [1.0, 0.0, 0.0], 6.0)
    other = TriMesh(mesh.positions @ rotation.T, mesh.faces)
    both = wave_of(other, rotation[:, 0], 6.0)
    np.testing.assert_allclose(both, straight, atol=1e-4)


def test_the_same_seed_gives_the_same_stripes() -> None:
    mesh = sheet(15.0, 1.0)
    first = wave_of(mesh, [0.0, 1.0, 0.0], 5.0, seed=3)
    np.testing.assert_array_equal(first, wave_of(mesh, [0.0, 1.0, 0.0], 5.0, seed=3))
    assert np.abs(first).max() <= 1.0
