from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest

from risorius.errors import FormatError, ParameterError
from risorius.playback import pictures
from risorius.playback.pictures import Film, write_film, write_pictures
from risorius.render.png import read_png
from tests.playback.rigs import played_rig
from tests.tools import require_module

FILM = Film(size=(48, 48))


def _frames(*weights: float) -> list[np.ndarray]:
    return [played_rig().posed({"jawOpen": weight}) for weight in weights]


def test_every_frame_becomes_a_picture_and_motion_shows(tmp_path: Path) -> None:
    assert write_pictures(played_rig(), _frames(0.0, 1.0, 0.0), tmp_path / "f", film=FILM) == 3
    files = sorted((tmp_path / "f").iterdir())
    assert [file.name for file in files] == [f"frame_{n:05d}.png" for n in range(3)]
    first, second, third = (read_png(file) for file in files)
    assert first.shape == (48, 48, 3)
    assert np.array_equal(first, third)
    assert not np.array_equal(first, second)


def test_pictures_of_an_earlier_run_are_replaced_and_other_files_are_kept(tmp_path: Path) -> None:
    folder = tmp_path / "f"
    write_pictures(played_rig(), _frames(0.0, 1.0), folder, film=FILM)
    write_pictures(played_rig(), _frames(0.0), folder, film=FILM)
    assert len(list(folder.iterdir())) == 1
    (folder / "notes.txt").write_text("mine")
    with pytest.raises(FormatError, match=r"holds 'notes\.txt'"):
        write_pictures(played_rig(), _frames(0.0), folder, film=FILM)
    assert (folder / "notes.txt").read_text() == "mine"


def test_a_film_without_ffmpeg_is_refused(tmp_path: Path, monkeypatch) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    with pytest.raises(FormatError, match=r"needs the program ffmpeg.*risorius\[video\]"):
        write_film(played_rig(), _frames(0.0), tmp_path / "x.mp4", film=FILM)


def _encoder(folder: Path, monkeypatch, body: str) -> None:
    """Put a stand-in for ffmpeg on the path."""
    program = folder / "ffmpeg"
    program.write_text(f"#!{sys.executable}\nimport sys\n{body}\n")
    program.chmod(0o755)
    monkeypatch.setenv("PATH", str(folder))
    assert pictures.has_ffmpeg()


def test_the_encoder_gets_every_frame_whole(tmp_path: Path, monkeypatch) -> None:
    _encoder(tmp_path, monkeypatch, "open(sys.argv[-1], 'wb').write(sys.stdin.buffer.read())")
    path = tmp_path / "x.mp4"
    assert write_film(played_rig(), _frames(0.0, 1.0), path, film=FILM) == 2
    assert path.stat().st_size == 2 * 48 * 48 * 3


def test_a_failing_encoder_is_quoted_and_leaves_no_file(tmp_path: Path, monkeypatch) -> None:
    _encoder(tmp_path, monkeypatch, "sys.stderr.write('no such codec'); sys.exit(3)")
    with pytest.raises(FormatError, match="ffmpeg failed: no such codec"):
        write_film(played_rig(), _frames(0.0), tmp_path / "x.mp4", film=FILM)
    assert not (tmp_path / "x.mp4").exists()


def test_a_film_needs_even_sides(tmp_path: Path, monkeypatch) -> None:
    _encoder(tmp_path, monkeypatch, "")
    with pytest.raises(ParameterError, match="must be even"):
        write_film(played_rig(), _frames(0.0), tmp_path / "x.mp4", film=Film(size=(47, 48)))


def test_a_real_encoder_makes_a_film_that_it_can_read_again(tmp_path: Path, monkeypatch) -> None:
    require_module("imageio_ffmpeg")
    import imageio_ffmpeg as encoder

    monkeypatch.setenv("PATH", str(tmp_path))
    path = tmp_path / "x.mp4"
    frames = _frames(0.0, 0.5, 1.0, 0.5, 0.0)
    assert write_film(played_rig(), frames, path, film=FILM) == 5
    reader = encoder.read_frames(str(path))
    about = next(reader)
    assert about["size"] == (48, 48)
    assert about["fps"] == 25.0
    shown = [np.frombuffer(frame, np.uint8).reshape(48, 48, 3).astype(int) for frame in reader]
    assert len(shown) == 5
    # What is shown is the head, and it moves: the first frame is nearer to the last than to the
    # middle, where the mouth is open.
    assert np.abs(shown[0] - shown[4]).mean() < 0.5 * np.abs(shown[0] - shown[2]).mean()
