"""The rules of CONVENTIONS.md as functions from source text to a list of complaints."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parent.parent
SOURCE = REPOSITORY / "src" / "risorius"
LONGEST_FILE = 400

_ENTRY = r"(?:\.\.\.|\d+|[a-z]{1,2}|dimension|count|vertex_count|height|width|rows|columns)"
_SUM = rf"{_ENTRY}(?: ?[+*-] ?{_ENTRY})*"
SHAPE = re.compile(rf"\({_SUM}(?:, ?{_SUM})+,?\)|\({_SUM},\)|\(\.\.\.\)")
_ARRAY = re.compile(r"Array|ndarray")
_REAL = re.compile(r"FloatArray|float64|float32")
_WHOLE = re.compile(r"IntArray|int32|int64|integer")
_WORD = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+")

# What may be raised beside the classes of risorius.errors, and where.
_PROTOCOL_ERRORS = {
    "AttributeError": {"__getattr__"},
    "KeyError": {"__getitem__"},
    "IndexError": {"__getitem__"},
    "StopIteration": {"__next__"},
}
Function = ast.FunctionDef | ast.AsyncFunctionDef


@dataclass(frozen=True)
class Book:
    """What CONVENTIONS.md says.

    `refused` words with their replacement, `idle` words that say nothing about a module,
    standing `arrays` and `errors` by name.
    """

    refused: dict[str, str]
    idle: frozenset[str]
    arrays: frozenset[str]
    errors: frozenset[str]


def table(header: str, text: str) -> list[list[str]]:
    """Return the cells of the rows below the Markdown table row that starts with `header`."""
    lines = text.splitlines()
    start = next(i for i, line in enumerate(lines) if line.startswith(f"| {header} |"))
    rows: list[list[str]] = []
    for line in lines[start + 2 :]:
        if not line.startswith("|"):
            break
        rows.append([cell.strip() for cell in line.strip("|").split("|")])
    return rows


def read_book(text: str, *, errors: frozenset[str]) -> Book:
    """Read the tables that the checks need."""
    refused: dict[str, str] = {}
    idle: set[str] = set()
    for say, instead in table("say", text):
        refused_here = re.findall(r"`(\w+)`", instead)
        if say.startswith("`"):
            refused |= dict.fromkeys(refused_here, say)
        else:
            idle |= set(refused_here)
    arrays = frozenset(re.findall(r"`(\w+)`", " ".join(row[0] for row in table("name", text))))
    return Book(refused, frozenset(idle), arrays, errors)


def words(identifier: str) -> list[str]:
    """Split snake_case and CamelCase into lower-case words."""
    return [word.lower() for word in _WORD.findall(identifier)]


def complaints(source: str, name: str, book: Book) -> list[str]:
    """Return every breach of the conventions in one module.

    Parameters
    ----------
    source : str
        Text of the module.
    name : str
        Its dotted name; modules of the command line may print and exit.
    book : Book
    """
    tree = ast.parse(source)
    found = [f"{name}: {text}" for text in _module_rules(tree, name, book)]
    found += [f"{name}: {text}" for text in _raised(tree, name, book)]
    found += [f"{name}: {text}" for text in _public_rules(tree, name, book)]
    return found


def _is_hidden(name: str) -> bool:
    return any(part.startswith("_") for part in name.split("."))


def _is_command_line(name: str) -> bool:
    return name.split(".")[1:2] == ["cli"]


def _public_names(tree: ast.Module) -> list[str] | None:
    for node in tree.body:
        target = node.targets[0] if isinstance(node, ast.Assign) else getattr(node, "target", None)
        if isinstance(target, ast.Name) and target.id == "__all__":
            return list(ast.literal_eval(node.value))  # pyright: ignore
    return None


def _module_rules(tree: ast.Module, name: str, book: Book) -> Iterator[str]:
    if not ast.get_docstring(tree):
        yield "the module has no docstring"
    for word in words(name.rpartition(".")[2]):
        if word in book.refused:
            yield f"module name: say {book.refused[word]} instead of {word!r}"
        if word in book.idle:
            yield f"module name: {word!r} says nothing; name what is in it"
    if _public_names(tree) is None and not _is_hidden(name):
        yield "no __all__"
    for node in ast.walk(tree):
        if isinstance(node, ast.ExceptHandler):
            caught = ast.unparse(node.type) if node.type else "everything"
            passed_on = isinstance(node.body[-1], ast.Raise) and node.body[-1].exc is None
            if caught in ("everything", "Exception", "BaseException") and not passed_on:
                yield f"line {node.lineno}: catches {caught}; name what can happen"
        if isinstance(node, ast.Call) and not _is_command_line(name):
            called = ast.unparse(node.func)
            if called in ("print", "exit", "quit", "sys.exit", "os._exit"):
                yield f"line {node.lineno}: calls {called}; only the command line may"


def _raised(tree: ast.Module, name: str, book: Book) -> Iterator[str]:
    if _is_command_line(name):
        return
    for function in ast.walk(tree):
        if not isinstance(function, Function):
            continue
        for node in ast.walk(function):
            if not isinstance(node, ast.Raise) or not isinstance(node.exc, ast.Call):
                continue
            kind = ast.unparse(node.exc.func).rpartition(".")[2]
            allowed = kind in book.errors or kind == "ImportError"
            if not kind[:1].isupper() or allowed:
                continue
            if function.name not in _PROTOCOL_ERRORS.get(kind, ()):
                yield f"line {node.lineno}: raises {kind}, which is not in risorius.errors"


def _public_rules(tree: ast.Module, name: str, book: Book) -> Iterator[str]:
    public = set(_public_names(tree) or ())
    for node in tree.body:
        if getattr(node, "name", "") not in public:
            continue
        if isinstance(node, ast.ClassDef):
            yield from _class_rules(node, book)
        elif isinstance(node, Function):
            yield from _function_rules(node, node.name, book)
            # The signature of a verb is what a person types, in the order that help shows.
            if not _is_command_line(name):
                yield from _defaults(node, node.name)


def _spelling(identifier: str, where: str, book: Book) -> Iterator[str]:
    for word in words(identifier):
        if word in book.refused:
            yield f"{where}: say {book.refused[word]} instead of {word!r}"


def _class_rules(node: ast.ClassDef, book: Book) -> Iterator[str]:
    text = ast.get_docstring(node) or ""
    if not text:
        yield f"{node.name}: no docstring"
    yield from _spelling(node.name, node.name, book)
    for member in node.body:
        if isinstance(member, ast.AnnAssign) and isinstance(member.target, ast.Name):
            field = member.target.id
            if field.startswith("_"):
                continue
            where = f"{node.name}.{field}"
            yield from _spelling(field, where, book)
            if _is_array(member.annotation):
                yield from _kind_of_array(field, ast.unparse(member.annotation), where)
                if field not in book.arrays and not _shape_of(field, text):
                    yield f"{where}: the docstring gives no shape"
        elif isinstance(member, Function):
            name = member.name
            if name in ("__init__", "__call__") or not name.startswith("_"):
                where = f"{node.name}.{name}"
                yield from _function_rules(member, where, book, class_text=text)
                yield from _defaults(member, where)


def _function_rules(
    node: Function, where: str, book: Book, *, class_text: str = ""
) -> Iterator[str]:
    text = ast.get_docstring(node) or ""
    if node.name == "__init__":
        text = class_text
    elif not text:
        yield f"{where}: no docstring"
    elif not text.split("\n\n")[0].rstrip().endswith((".", ":", "``")):
        yield f"{where}: the docstring does not begin with a sentence"
    if node.name != "__init__":
        yield from _spelling(node.name, where, book)
    parameters = [*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs]
    strange = [
        parameter.arg
        for parameter in parameters
        if _is_array(parameter.annotation) and parameter.arg not in book.arrays
    ]
    for parameter in parameters:
        place = f"{where}({parameter.arg})"
        yield from _spelling(parameter.arg, place, book)
        if parameter.annotation is not None:
            yield from _kind_of_array(parameter.arg, ast.unparse(parameter.annotation), place)
    any_shape = SHAPE.search(text) is not None
    for name in strange:
        if not (any_shape if len(strange) == 1 else _shape_of(name, text)):
            yield f"{where}({name}): the docstring gives no shape"
    if _returns_array(node) and not any_shape and node.name != "__init__":
        yield f"{where}: the docstring gives no shape of the result"


def _is_array(annotation: ast.expr | None) -> bool:
    """Tell arrays (also optional ones) from containers and functions of arrays."""
    if annotation is None:
        return False
    text = ast.unparse(annotation).removesuffix(" | None")
    inside = not text.startswith(("npt.", "np.", "NDArray")) and "[" in text
    return _ARRAY.search(text) is not None and not inside


def _returns_array(node: Function) -> bool:
    return node.returns is not None and _ARRAY.search(ast.unparse(node.returns)) is not None


def _kind_of_array(name: str, annotation: str, where: str) -> Iterator[str]:
    if name in ("positions", "rest_positions", "points", "normals", "deltas", "bary", "uvs"):
        if _WHOLE.search(annotation) and not _REAL.search(annotation):
            yield f"{where}: {name} are real numbers, not {annotation}"
    elif name in ("faces", "vertices", "indices") and _REAL.search(annotation):
        yield f"{where}: {name} are indices, not {annotation}"


def _shape_of(name: str, text: str) -> bool:
    """Tell whether `text` gives the shape of `name`: in its entry or right behind its mention."""
    entry = re.compile(rf"^\s*(?:\w+, )*{name}(?:, \w+)* : (.*)$", re.MULTILINE)
    if any(SHAPE.search(found) for found in entry.findall(text)):
        return True
    behind = re.compile(rf"\b{name}`*\s+(\(.*)", re.DOTALL)
    return any(SHAPE.match(found) for found in behind.findall(text))


def _defaults(node: Function, where: str) -> Iterator[str]:
    positional = [*node.args.posonlyargs, *node.args.args]
    optional = positional[len(positional) - len(node.args.defaults) :]
    if len(optional) > 1:
        names = ", ".join(parameter.arg for parameter in optional)
        yield f"{where}: only one of {names} may be positional, put * before the others"
    for parameter, default in zip(optional, node.args.defaults, strict=True):
        if isinstance(default, ast.Constant) and isinstance(default.value, bool):
            yield f"{where}({parameter.arg}): a switch must be keyword-only"
