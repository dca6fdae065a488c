"""Contact sheets and PNG files."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from risorius.errors import FormatError, ParameterError, ShapeError
from risorius.render import contact_sheet, read_png, write_png


def tile(width: int, height: int, value: int = 200) -> np.ndarray:
    return np.full((height, width, 3), value, np.uint8)


def noise(seed: int = 3) -> np.ndarray:
    return np.random.default_rng(seed).integers(0, 256, (21, 34, 3), dtype=np.uint8)


def test_a_sheet_has_room_for_all_pictures_labels_and_the_title() -> None:
    options = {"columns": 3, "gap": 5, "text_size": 10}
    sheet = contact_sheet([tile(40, 30)] * 7, ["a"] * 7, **options)
    assert sheet.shape == (5 + 3 * (30 + 15 + 5), 3 * (40 + 5) + 5, 3)
    titled = contact_sheet([tile(40, 30)] * 7, ["a"] * 7, title="Seven", **options)
    assert titled.shape[1] == sheet.shape[1]
    assert titled.shape[0] > sheet.shape[0]
    assert titled[: titled.shape[0] - sheet.shape[0]].max() > 150


def test_pictures_stand_row_by_row_and_small_ones_in_the_middle() -> None:
    pictures = [tile(20, 10, 50), tile(20, 10, 100), tile(10, 6, 150)]
    sheet = contact_sheet(pictures, ["", "", ""], columns=2, gap=4, text_size=10)
    assert (sheet[4:14, 4:24] == 50).all()
    assert (sheet[4:14, 28:48] == 100).all()
    second = 4 + 10 + 15 + 4
    assert (sheet[second + 2 : second + 8, 9:19] == 150).all()
    assert not (sheet[second + 2 : second + 8, 4:9] == 150).any()


def test_a_label_that_is_too_long_stays_in_its_cell() -> None:
    texts = ["m" * 400, "two\nlines " * 50]
    plain = contact_sheet([tile(40, 30)] * 2, ["", ""], columns=2, gap=8, text_size=12)
    sheet = contact_sheet([tile(40, 30)] * 2, texts, columns=2, gap=8, text_size=12)
    assert sheet.shape == plain.shape
    changed = (sheet != plain).any(axis=2)
    assert changed[38:56].any()
    assert not changed[:38].any()
    assert not changed[:, 48:56].any()


def test_the_same_sheet_has_the_same_bytes() -> None:
    sheets = [contact_sheet([noise()], ["neutral"], columns=1, title="Head") for _ in range(2)]
    np.testing.assert_array_equal(sheets[0], sheets[1])


def test_wrong_sheets_are_refused() -> None:
    with pytest.raises(ParameterError, match="at least one picture"):
        contact_sheet([], [], columns=2)
    with pytest.raises(ShapeError, match="labels: expected 1, got 2"):
        contact_sheet([tile(4, 4)], ["a", "b"], columns=2)
    with pytest.raises(ParameterError, match="columns: 0 is below 1"):
        contact_sheet([tile(4, 4)], ["a"], columns=0)
    with pytest.raises(ShapeError, match=r"images\[1\]: expected uint8"):
        contact_sheet([tile(4, 4), tile(4, 4) / 255.0], ["a", "b"], columns=2)
    with pytest.raises(ShapeError, match=r"images\[0\]: expected shape"):
        contact_sheet([tile(4, 4)[:, :, 0]], ["a"], columns=1)


def test_a_picture_survives_its_file(tmp_path: Path) -> None:
    path = tmp_path / "face.png"
    write_png(path, noise())
    np.testing.assert_array_equal(read_png(path), noise())
    first = path.read_bytes()
    write_png(path, noise())
    assert path.read_bytes() == first
    write_png(str(path), noise(4))
    np.testing.assert_array_equal(read_png(str(path)), noise(4))
    assert [entry.name for entry in tmp_path.iterdir()] == ["face.png"]


def test_a_failed_write_leaves_the_old_file_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "face.png"
    write_png(path, noise())

    def full(_: Path, __: Path) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "replace", full)
    with pytest.raises(FormatError, match="No space left"):
        write_png(path, noise(4))
    monkeypatch.undo()
    np.testing.assert_array_equal(read_png(path), noise())
    assert [entry.name for entry in tmp_path.iterdir()] == ["face.png"]


def test_a_picture_of_the_wrong_kind_is_not_written(tmp_path: Path) -> None:
    with pytest.raises(ShapeError, match="image: expected uint8"):
        write_png(tmp_path / "face.png", noise() / 255.0)
    assert not any(tmp_path.iterdir())


@given(
    st.one_of(
        st.binary(max_size=200),
        st.integers(0, 2000),
        st.tuples(st.integers(8, 600), st.binary(min_size=1, max_size=4)),
    )
)
def test_a_broken_file_is_refused_or_read(
    tmp_path_factory: pytest.TempPathFactory, harm: object
) -> None:
    path = tmp_path_factory.getbasetemp() / "broken.png"
    write_png(path, noise())
    data = path.read_bytes()
    if isinstance(harm, bytes):
        data = harm
    elif isinstance(harm, int):
        data = data[: min(harm, len(data) - 20)]
    else:
        data = data[: harm[0]] + harm[1] + data[harm[0] + len(harm[1]) :]
    path.write_bytes(data)
    try:
        picture = read_png(path)
    except FormatError as error:
        assert str(path) in str(error)
    else:
        assert picture.ndim == 3 and picture.dtype == np.uint8
        assert isinstance(harm, tuple)


def test_a_missing_file_and_another_format_are_refused(tmp_path: Path) -> None:
    with pytest.raises(FormatError, match="no such file"):
        read_png(tmp_path / "none.png")
    other = tmp_path / "face.gif"
    other.write_bytes(b"GIF89a" + bytes(40))
    with pytest.raises(FormatError, match="not a readable PNG file"):
        read_png(other)
