"""CONVENTIONS.md holds for the whole package."""

from __future__ import annotations

import ast
import re
from importlib import import_module
from pathlib import Path
from types import ModuleType

import pytest

from risorius import errors
from risorius.controls.presets import EMOTIONS
from risorius.controls.standard import MUSCLES, SINGLE_MUSCLES, device_controls, muscle_controls
from risorius.head.frame import MILLIMETRES
from risorius.head.part import PART_KINDS
from risorius.landmarks import feature_points
from risorius.project import PROFILES
from tests.conventions import (
    LONGEST_FILE,
    REPOSITORY,
    SHAPE,
    SOURCE,
    complaints,
    read_book,
    table,
    words,
)

TEXT = (REPOSITORY / "CONVENTIONS.md").read_text("utf-8")
BOOK = read_book(TEXT, errors=frozenset(errors.__all__))
FILES = sorted(SOURCE.rglob("*.py"))


def _dotted(path: Path) -> str:
    parts = ("risorius", *path.relative_to(SOURCE).with_suffix("").parts)
    return ".".join(part for part in parts if part != "__init__")


MODULES = [_dotted(path) for path in FILES]


@pytest.mark.parametrize("path", FILES, ids=MODULES)
def test_public_api_follows_the_conventions(path: Path) -> None:
    found = complaints(path.read_text("utf-8"), _dotted(path), BOOK)
    assert not found, "\n" + "\n".join(found)


@pytest.fixture(scope="module")
def modules() -> dict[str, ModuleType]:
    return {name: import_module(name) for name in MODULES if not name.endswith("__main__")}


def test_every_name_in_all_exists(modules: dict[str, ModuleType]) -> None:
    missing = [
        f"{name}.{public}"
        for name, module in modules.items()
        for public in getattr(module, "__all__", ())
        if not hasattr(module, public)
    ]
    assert missing == []


def test_every_error_class_derives_from_the_common_one(modules: dict[str, ModuleType]) -> None:
    strangers = [
        f"{name}.{key}"
        for name, module in modules.items()
        for key, value in vars(module).items()
        if isinstance(value, type)
        and issubclass(value, BaseException)
        and value.__module__ == name
        and not issubclass(value, (errors.RisoriusError, errors.RisoriusWarning))
    ]
    assert strangers == []


def test_every_control_names_its_side_at_the_end_and_has_a_mirror() -> None:
    controls = list(device_controls())
    for muscle in (*MUSCLES, *SINGLE_MUSCLES):
        controls.extend(muscle_controls(muscle))
    by_name = {control.name: control for control in controls}
    assert len(by_name) == len(controls)
    for name, control in by_name.items():
        assert re.fullmatch(r"[a-z]+(_[a-z]+)*", name)
        assert not {"left", "right"} & set(words(name))
        assert control.low <= control.default <= control.high
        mirror = by_name[control.mirror]
        assert mirror.mirror == name
        assert (mirror.low, mirror.high) == (control.low, control.high)
        if name.endswith(("_l", "_r")):
            assert control.mirror == name[:-1] + {"l": "r", "r": "l"}[name[-1]]
        else:
            assert control.mirror == name


def test_every_part_names_its_side_at_the_end() -> None:
    for kind in PART_KINDS:
        sides = {"left", "right", "l", "r"} & set(words(kind))
        assert not sides or kind.endswith(("_left", "_right"))


def test_every_landmark_of_our_own_names_its_side_at_the_end() -> None:
    own = [point for name, point in feature_points().items() if not name[0].isdigit()]
    assert own
    for point in own:
        assert point.name.endswith({"left": "_l", "right": "_r", "centre": ""}[point.side])


def test_units_on_the_page_are_those_of_the_code() -> None:
    page = {name.strip("`"): float(value) for name, value in table("unit", TEXT)}
    assert page == MILLIMETRES


def test_emotions_on_the_page_are_those_of_the_code() -> None:
    assert tuple(row[0].strip("`") for row in table("emotion", TEXT)) == EMOTIONS


def test_profiles_on_the_page_are_those_of_the_code() -> None:
    assert tuple(row[0].strip("`") for row in table("profile", TEXT)) == PROFILES


def test_exit_codes_on_the_page_are_those_of_the_code(modules: dict[str, ModuleType]) -> None:
    exits = modules["risorius.cli.exits"]
    codes = {0, *(getattr(exits, name) for name in exits.__all__)}
    assert {int(row[0]) for row in table("exit code", TEXT)} == codes


def test_every_file_schema_in_the_code_is_on_the_page() -> None:
    page = {row[0].strip("`") for row in table("schema", TEXT)}
    used: dict[str, str] = {}
    for path in FILES:
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            text = node.value if isinstance(node, ast.Constant) else None
            if isinstance(text, str) and re.fullmatch(r"risorius/[a-z_-]+", text):
                used[text] = _dotted(path)
    assert "risorius/presets" in used
    assert {name: place for name, place in used.items() if name not in page} == {}


def test_no_source_file_holds_two_things() -> None:
    folders = ("src", "tests", "tools", "benchmarks", "examples")
    paths = [
        path
        for folder in folders
        for ending in ("py", "js", "html", "css")
        for path in (REPOSITORY / folder).rglob(f"*.{ending}")
        if "node_modules" not in path.parts
    ]
    assert len(paths) >= len(FILES)
    lengths = {str(path.relative_to(REPOSITORY)): _line_count(path) for path in paths}
    assert {name: count for name, count in lengths.items() if count > LONGEST_FILE} == {}
    idle = [name for name in lengths if set(words(Path(name).stem)) & BOOK.idle]
    assert idle == []


def _line_count(path: Path) -> int:
    return len(path.read_text("utf-8").splitlines())


# The checks above must be able to fail: one breach each, and the complaint that it earns.
_GOOD = '''"""A module."""

__all__ = ["Wobble", "wobble"]


class Wobble:
    """State.

    Parameters
    ----------
    positions : anything
    radii, gains : (n,) float64
        Two of them.
    """

    positions: FloatArray
    radii: FloatArray
    gains: FloatArray

    def __getitem__(self, name):
        raise KeyError(name)


def wobble(positions: FloatArray, gain: npt.ArrayLike, steps: int = 1, *, hard: bool = False):
    """Move `positions` by `gain` (k,)."""
    raise ParameterError("gain: must not be negative")
'''

_BREACHES = [
    ('"""A module."""\n', "", "the module has no docstring"),
    ('__all__ = ["Wobble", "wobble"]', "", "no __all__"),
    ('    """Move `positions` by `gain` (k,)."""\n', "", "wobble: no docstring"),
    ("by `gain` (k,).", "by `gain` (k,)", "wobble: the docstring does not begin with a sentence"),
    ("`gain` (k,)", "`gain`", "wobble(gain): the docstring gives no shape"),
    ("radii, gains :", "radii :", "Wobble.gains: the docstring gives no shape"),
    ("(n,) float64", "float64", "Wobble.radii: the docstring gives no shape"),
    ("steps: int", "num_steps: int", "wobble(num_steps): say"),
    ("positions: FloatArray\n", "verts: FloatArray\n", "Wobble.verts: say"),
    ("*, hard", "hard", "only one of steps, hard may be positional"),
    ("steps: int = 1, *, hard", "steps: int, hard", "wobble(hard): a switch must be keyword-only"),
    ("(positions: FloatArray", "(positions: IntArray", "positions are real numbers"),
    ("raise ParameterError", "raise ValueError", "raises ValueError"),
    ("def __getitem__", "def item", "raises KeyError"),
    ("    raise ParameterError", "    print", "calls print"),
    ("    raise ParameterError", "    sys.exit", "calls sys.exit"),
    ("    raise ParameterError", "    try: pass\n    except Exception: pass\n    x", "catches"),
    ("    raise ParameterError", "    try: pass\n    except: pass\n    x", "catches everything"),
]


def test_a_module_that_follows_the_conventions_earns_no_complaint() -> None:
    assert complaints(_GOOD, "risorius.fake", BOOK) == []


@pytest.mark.parametrize(("old", "new", "complaint"), _BREACHES)
def test_each_breach_earns_its_complaint(old: str, new: str, complaint: str) -> None:
    assert old in _GOOD
    found = complaints(_GOOD.replace(old, new), "risorius.fake", BOOK)
    assert any(complaint in text for text in found), found


def test_a_verb_of_the_command_line_may_have_many_options() -> None:
    source = _GOOD.replace("*, hard", "hard")
    assert complaints(source, "risorius.cli.fake", BOOK) == []
    assert len(complaints(source, "risorius.fake", BOOK)) == 2


def test_the_command_line_may_print_and_exit() -> None:
    source = _GOOD.replace("raise ParameterError", "print") + "\n    sys.exit(1)\n"
    assert complaints(source, "risorius.cli.fake", BOOK) == []
    assert len(complaints(source, "risorius.fake", BOOK)) == 2


def test_an_annotated_list_of_public_names_counts() -> None:
    source = _GOOD.replace("__all__ =", "__all__: list[str] =")
    assert complaints(source, "risorius.fake", BOOK) == []
    assert complaints(source.replace("gain` (k,)", "gain`"), "risorius.fake", BOOK) != []


def test_cleaning_up_after_any_error_and_passing_it_on_is_allowed() -> None:
    source = _GOOD + "    try: pass\n    except BaseException:\n        hard = 1\n        raise\n"
    assert complaints(source, "risorius.fake", BOOK) == []


def test_a_module_name_that_says_nothing_is_refused() -> None:
    found = complaints(_GOOD, "risorius.fake_utils", BOOK)
    assert len(found) == 1
    assert "'utils'" in found[0]


@pytest.mark.parametrize("text", ["(n,)", "(n, 3)", "(..., 3)", "(...)", "(m + 1,)", "(2*k, 3)"])
def test_a_shape_is_recognised(text: str) -> None:
    assert SHAPE.fullmatch(text)


@pytest.mark.parametrize("text", ["(object, group or material)", "(n)", "(see below)"])
def test_a_remark_in_brackets_is_not_a_shape(text: str) -> None:
    assert not SHAPE.search(text)
