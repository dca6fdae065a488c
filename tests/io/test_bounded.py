"""Bytes and JSON of unknown origin."""

import os
from pathlib import Path

import pytest

from risorius.errors import FormatError
from risorius.io.bounded import parse_json, read_bytes_limited, read_json


def test_a_file_over_the_limit_is_refused(tmp_path: Path):
    path = tmp_path / "a.bin"
    path.write_bytes(b"12345")
    assert read_bytes_limited(path, limit=5) == b"12345"
    with pytest.raises(FormatError, match="larger than"):
        read_bytes_limited(path, limit=4)


@pytest.mark.skipif(not Path("/dev/zero").exists(), reason="this system has no device files")
def test_an_endless_device_is_refused():
    with pytest.raises(FormatError, match="not a regular file"):
        read_bytes_limited("/dev/zero")


@pytest.mark.skipif(
    os.name == "nt" or os.geteuid() == 0, reason="the administrator may read every file"
)
def test_an_unreadable_file_is_refused(tmp_path: Path):
    path = tmp_path / "a.bin"
    path.write_bytes(b"")
    path.chmod(0)
    with pytest.raises(FormatError, match="cannot be read"):
        read_bytes_limited(path)


def test_a_name_with_a_zero_byte_is_refused():
    with pytest.raises(FormatError, match="cannot be read"):
        read_bytes_limited("a\0b")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (b'{"a": 1,}', "line 1, column 9"),
        (b'{"a": NaN}', "NaN is not JSON"),
        (b'{"a": -Infinity}', "-Infinity is not JSON"),
        (b'{"a": 1e999}', "too large"),
        (b'{"a": ' + b"9" * 5000 + b"}", "5000 digits"),
        (b'{"a": 1, "a": 2}', '"a" is given twice'),
        (b"[" * 100_000, "nested too deeply"),
        (b'{"a":' * 100_000, "nested too deeply"),
        (b"\xff\xfe", "byte 0 is not UTF-8"),
        (b"", "line 1, column 1"),
    ],
)
def test_bad_json_is_refused_with_its_place(text: bytes, message: str):
    with pytest.raises(FormatError, match=f"^x.json: .*{message}"):
        parse_json(text, "x.json")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[1]", "expected a JSON object, found a list"),
        ("{}", 'expected "schema": "s", found null'),
        ('{"schema": "t"}', 'expected "schema": "s", found "t"'),
        ('{"schema": "s"}', '"version" must be'),
        ('{"schema": "s", "version": true}', '"version" must be'),
        ('{"schema": "s", "version": 0}', '"version" must be'),
        ('{"schema": "s", "version": 3}', "reads up to version 2; update risorius"),
    ],
)
def test_other_schemas_and_newer_versions_are_refused(tmp_path: Path, text: str, message: str):
    path = tmp_path / "x.json"
    path.write_text(text)
    with pytest.raises(FormatError, match=message):
        read_json(path, schema="s", version=2)


def test_older_versions_are_read(tmp_path: Path):
    path = tmp_path / "x.json"
    path.write_text('\ufeff{"schema": "s", "version": 1}', encoding="utf-8")
    assert read_json(path, schema="s", version=2) == {"schema": "s", "version": 1}
