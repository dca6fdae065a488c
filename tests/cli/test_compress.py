"""`risorius compress`."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from risorius.io.motion import read_stream, write_stream
from risorius.playback.inner_products import inner_products
from risorius.rig import Rig
from tests.cli.running import answer, run
from tests.io.glb import unpack
from tests.io.motion.streams import stream_of

FRAMES = [{"jawOpen": 0.1 * n, "mouthSmileLeft": 0.05 * n, "head_yaw": 3.0} for n in range(8)]


@pytest.fixture(scope="module")
def take(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("take") / "take.csv"
    write_stream(stream_of(FRAMES), path)
    return path


def test_the_weights_of_the_small_rig_reproduce_the_stream(
    tmp_path: Path, rig_file: Path, take: Path
) -> None:
    small, weights = tmp_path / "small.npz", tmp_path / "small.csv"
    options = ("--stream", take, "--error", "0.01", "-o", small, "--weights", weights, "--json")
    told = answer(run("compress", rig_file, *options))
    assert told["shapes"] == ["component_1"]  # both shapes go together in this take
    assert told["error_curve"][0] > 1.0 > 0.01 >= told["error_curve"][-1]
    rig, reduced = Rig.load(rig_file), Rig.load(small)
    moving = inner_products(rig)[1]
    for wanted, frame in zip(FRAMES, read_stream(weights), strict=True):
        assert frame.values["head_yaw"] == 3.0
        large = rig.posed({n: v for n, v in wanted.items() if n in rig.by_name})
        posed = reduced.posed({n: v for n, v in frame.values.items() if n in reduced.by_name})
        apart = (large - posed) * rig.frame.scale
        assert np.sqrt((apart**2).sum() / moving) < 0.02


def test_a_small_glb_plays_the_stream(tmp_path: Path, rig_file: Path, take: Path) -> None:
    out = tmp_path / "small.glb"
    told = answer(run("compress", rig_file, "--stream", take, "--count", "2", "-o", out, "--json"))
    assert len(told["shapes"]) <= 2
    json, _ = unpack(out.read_bytes())
    assert json["animations"][0]["name"] == "take"
    assert any(node["name"] == "head_turn" for node in json["nodes"])


def test_without_a_stream_every_shape_counts(tmp_path: Path, rig_file: Path) -> None:
    out = tmp_path / "small.npz"
    result = run("compress", rig_file, "-o", out, "--count", "10")
    assert result.exit_code == 0, result.stderr
    assert "10 shapes for" in result.stdout
    assert len(Rig.load(out).targets) == 10


@pytest.mark.parametrize(
    ("options", "code", "message"),
    [
        (("--count", "2", "--error", "1"), 2, "either --count or --error"),
        (("--weights", "w.csv"), 2, "needs --stream"),
        (("--error", "-1"), 1, "error: -1 is below 0"),
    ],
)
def test_what_cannot_be_compressed_is_refused(
    tmp_path: Path, rig_file: Path, options: tuple[str, ...], code: int, message: str
) -> None:
    result = run("compress", rig_file, "-o", tmp_path / "x.glb", *options)
    assert result.exit_code == code
    assert message in " ".join(result.stderr.replace("│", " ").split())
    assert list(tmp_path.iterdir()) == []
