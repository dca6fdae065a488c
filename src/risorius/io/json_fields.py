"""Take fields out of parsed JSON; a wrong type is refused with its place."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, cast

from risorius.errors import FormatError
from risorius.io.finite import LARGEST

__all__ = ["LARGEST_INDEX", "Fields"]

LARGEST_INDEX = 2**31 - 1


class Fields:
    """A JSON object and the place where it stands, for messages.

    Parameters
    ----------
    value : object
        What the JSON holds there; anything but an object is refused.
    where : str
        For example ``"head.glb: nodes[3]"``.
    """

    def __init__(self, value: object, where: str) -> None:
        if not isinstance(value, dict):
            raise FormatError(f"{where}: expected a JSON object")
        self.value = cast("dict[str, Any]", value)
        self.where = where

    def __contains__(self, key: str) -> bool:
        return self.value.get(key) is not None

    def __iter__(self) -> Iterator[str]:
        return iter(self.value)

    def place(self, key: str) -> str:
        """Return where the field `key` stands."""
        return f"{self.where}.{key[:60]}" if ": " in self.where else f"{self.where}: {key[:60]}"

    def _get(self, key: str) -> Any:
        value = self.value.get(key)
        if value is None:
            raise FormatError(f"{self.place(key)}: is missing")
        return value

    def integer(self, key: str, *, low: int = 0, default: int | None = None) -> int:
        """Return a whole number from `low` to `LARGEST_INDEX`."""
        if default is not None and key not in self:
            return default
        return whole_number(self._get(key), self.place(key), low=low)

    def number(self, key: str, *, default: float | None = None) -> float:
        """Return a finite number."""
        if default is not None and key not in self:
            return default
        return finite_number(self._get(key), self.place(key))

    def text(self, key: str, *, default: str | None = None) -> str:
        """Return a text."""
        value = default if default is not None and key not in self else self._get(key)
        if not isinstance(value, str):
            raise FormatError(f"{self.place(key)}: expected a text")
        return value

    def items(self, key: str) -> list[Any]:
        """Return a list; an absent one is empty."""
        value = self.value.get(key)
        if value is not None and not isinstance(value, list):
            raise FormatError(f"{self.place(key)}: expected a list")
        return cast("list[Any]", value or [])

    def numbers(self, key: str, count: int) -> list[float]:
        """Return a list of exactly `count` finite numbers."""
        values = self.items(key)
        if len(values) != count:
            raise FormatError(f"{self.place(key)}: expected a list of {count} numbers")
        return [finite_number(value, self.place(key)) for value in values]

    def texts(self, key: str) -> list[str]:
        """Return a list of texts; an absent one is empty."""
        values = self.items(key)
        if not all(isinstance(value, str) for value in values):
            raise FormatError(f"{self.place(key)}: expected a list of texts")
        return values

    def fields(self, key: str) -> Fields:
        """Return an object; an absent one is empty."""
        value = self.value.get(key)
        return Fields({} if value is None else value, self.place(key))


def whole_number(value: object, where: str, *, low: int = 0) -> int:
    """Return `value` if it is a whole number from `low` to `LARGEST_INDEX`."""
    if isinstance(value, float) and value.is_integer():
        value = int(value)
    if isinstance(value, bool) or not isinstance(value, int):
        raise FormatError(f"{where}: expected a whole number")
    if not low <= value <= LARGEST_INDEX:
        raise FormatError(f"{where}: must lie in {low}..{LARGEST_INDEX}")
    return value


def finite_number(value: object, where: str) -> float:
    """Return `value` as float if it is a number (infinite ones are no JSON)."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise FormatError(f"{where}: expected a number")
    if not abs(value) <= LARGEST:  # NaN, too
        raise FormatError(f"{where}: must lie within {LARGEST:g}")
    return float(value)
