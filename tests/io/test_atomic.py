"""Files are complete or not there at all."""

import os
from pathlib import Path

import pytest

from risorius.errors import FormatError
from risorius.io.atomic import atomic_folder, atomic_write, write_bytes


def names(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


def test_a_file_appears_only_when_it_is_complete(tmp_path: Path):
    goal = tmp_path / "a.bin"
    with atomic_write(goal) as temporary:
        temporary.write_bytes(b"half")
        assert not goal.exists()
        assert temporary.parent == tmp_path
        assert temporary.suffix == ".bin"
    assert goal.read_bytes() == b"half"
    assert names(tmp_path) == ["a.bin"]


@pytest.mark.parametrize("error", [ValueError("no"), KeyboardInterrupt()])
def test_an_error_keeps_the_old_file_and_leaves_nothing(tmp_path: Path, error: BaseException):
    goal = tmp_path / "a.bin"
    goal.write_bytes(b"old")
    with pytest.raises(type(error)), atomic_write(goal) as temporary:
        temporary.write_bytes(b"new, cut o")
        raise error
    assert goal.read_bytes() == b"old"
    assert names(tmp_path) == ["a.bin"]


def test_a_system_error_becomes_a_format_error(tmp_path: Path):
    refusal = pytest.raises(FormatError, match=r"a\.bin: cannot be written \(No space")
    with refusal, atomic_write(tmp_path / "a.bin") as temporary:
        temporary.write_bytes(b"x")
        raise OSError(28, "No space left on device")
    assert names(tmp_path) == []


def test_a_missing_folder_and_a_folder_in_the_way_are_named(tmp_path: Path):
    with pytest.raises(FormatError, match="does not exist; create it first"):
        write_bytes(tmp_path / "absent" / "a.bin", b"")
    with pytest.raises(FormatError, match="is a folder"):
        write_bytes(tmp_path, b"")
    (tmp_path / "file").write_bytes(b"")
    with pytest.raises(FormatError, match="is a file"), atomic_folder(tmp_path / "file"):
        pass
    assert names(tmp_path) == ["file"]


def test_the_permissions_of_a_replaced_file_stay(tmp_path: Path):
    goal = tmp_path / "a.bin"
    goal.write_bytes(b"old")
    goal.chmod(0o640)
    write_bytes(goal, b"new")
    assert goal.stat().st_mode & 0o777 == 0o640


def test_a_new_file_obeys_the_umask(tmp_path: Path):
    (tmp_path / "plain").write_bytes(b"")
    write_bytes(tmp_path / "ours", b"")
    assert (tmp_path / "ours").stat().st_mode == (tmp_path / "plain").stat().st_mode


@pytest.mark.skipif(os.name == "nt", reason="links need a privilege on Windows")
def test_a_link_stays_a_link(tmp_path: Path):
    (tmp_path / "real.bin").write_bytes(b"old")
    (tmp_path / "link.bin").symlink_to(tmp_path / "real.bin")
    write_bytes(tmp_path / "link.bin", b"new")
    assert (tmp_path / "link.bin").is_symlink()
    assert (tmp_path / "real.bin").read_bytes() == b"new"


def test_a_very_long_name_can_be_written(tmp_path: Path):
    goal = tmp_path / ("n" * 240 + ".bin")
    write_bytes(goal, b"x")
    assert goal.read_bytes() == b"x"


def test_a_folder_is_replaced_as_a_whole(tmp_path: Path):
    goal = tmp_path / "rig"
    goal.mkdir()
    (goal / "old.obj").write_bytes(b"old")
    with atomic_folder(goal) as temporary:
        (temporary / "new.obj").write_bytes(b"new")
        assert names(goal) == ["old.obj"]
    assert names(goal) == ["new.obj"]
    assert names(tmp_path) == ["rig"]


def test_an_error_keeps_the_old_folder(tmp_path: Path):
    goal = tmp_path / "rig"
    goal.mkdir()
    (goal / "old.obj").write_bytes(b"old")
    with pytest.raises(ValueError, match="no"), atomic_folder(goal) as temporary:
        (temporary / "new.obj").write_bytes(b"new")
        raise ValueError("no")
    assert names(goal) == ["old.obj"]
    assert names(tmp_path) == ["rig"]
