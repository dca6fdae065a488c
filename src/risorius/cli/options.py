"""Options and arguments that several verbs share."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

__all__ = [
    "AsJson",
    "Axes",
    "Bones",
    "BonesOption",
    "Debug",
    "FlipLandmarks",
    "FromHead",
    "FromLandmarks",
    "HeadArgument",
    "LandmarkFile",
    "MandibleFile",
    "Method",
    "MethodOption",
    "MuscleMapFile",
    "Parameters",
    "Parts",
    "Presets",
    "Profile",
    "ProfileOption",
    "Quiet",
    "RecipeFile",
    "Shapes",
    "SkullFile",
    "SkullLandmarks",
    "SourcePoints",
    "StyleFile",
    "TargetPoints",
    "Unit",
    "Vectors",
    "VectorsOutput",
    "as_parameters",
    "as_parts",
    "as_size",
    "as_weights",
]


class Method(StrEnum):
    """Methods that pose a face."""

    layered = "layered"
    springs = "springs"
    vector = "vector"


class Bones(StrEnum):
    """Where spring muscles find skull and jaw."""

    given = "given"
    builtin = "builtin"
    cut = "cut"


class Profile(StrEnum):
    """How closely a method follows its publication."""

    improved = "improved"
    faithful = "faithful"


_OUTPUT = "Output"
_HEAD = "About the head"
_METHOD = "About the method"

AsJson = Annotated[
    bool,
    typer.Option("--json", help="Print one JSON object instead of text.", rich_help_panel=_OUTPUT),
]
Quiet = Annotated[
    bool, typer.Option("--quiet", "-q", help="Print errors only.", rich_help_panel=_OUTPUT)
]
Debug = Annotated[
    bool,
    typer.Option("--debug", help="Show where an error comes from.", rich_help_panel=_OUTPUT),
]
HeadArgument = Annotated[
    str,
    typer.Argument(
        metavar="HEAD",
        help="Mesh (OBJ, PLY, STL, GLB or glTF), project (.json), or 'builtin' for the head that "
        "ships with risorius.",
        show_default=False,
    ),
]
LandmarkFile = Annotated[
    Path | None,
    typer.Option(
        "--landmarks",
        "-l",
        metavar="FILE",
        help="Named points of the face. Left out: those in HEAD, or HEAD's name with the ending "
        ".landmarks.json.",
        rich_help_panel=_HEAD,
        show_default=False,
    ),
]
Unit = Annotated[
    str | None,
    typer.Option(
        metavar="UNIT",
        help="Unit of the file: mm, cm, dm, m, in or ft.  [default: found from the landmarks]",
        rich_help_panel=_HEAD,
        show_default=False,
    ),
]
Axes = Annotated[
    str | None,
    typer.Option(
        metavar="UP_FORWARD",
        help="Up and forward axis of the file, such as +Y+Z or +Z-Y.  "
        "[default: found from the landmarks]",
        rich_help_panel=_HEAD,
        show_default=False,
    ),
]
Parts = Annotated[
    list[str] | None,
    typer.Option(
        "--part",
        metavar="KIND=NAME",
        help="Which object, group or material is a part, such as tongue=Object_7; repeatable.  "
        "[default: found by name and shape]",
        rich_help_panel=_HEAD,
        show_default=False,
    ),
]
FlipLandmarks = Annotated[
    bool,
    typer.Option(
        "--flip-landmarks",
        help="Exchange left and right in the landmark names.",
        rich_help_panel=_HEAD,
    ),
]
MethodOption = Annotated[
    Method | None,
    typer.Option(
        "--method",
        "-m",
        help="Method that poses the face.  [default: layered]",
        rich_help_panel=_METHOD,
        show_default=False,
    ),
]
ProfileOption = Annotated[
    Profile | None,
    typer.Option(
        "--profile",
        help="improved, or faithful to the publication.  [default: improved]",
        rich_help_panel=_METHOD,
        show_default=False,
    ),
]
Shapes = Annotated[
    str | None,
    typer.Option(
        "--shapes",
        metavar="SET,...",
        help="Sets of shapes: singles (every control by itself), emotions, arkit; also facs, "
        "visemes_oculus, visemes_mpeg4, fap (MPEG-4 parameters) and mpeg4_84 (the thesis's set).  "
        "[default: singles,emotions,arkit]",
        rich_help_panel=_METHOD,
        show_default=False,
    ),
]
Presets = Annotated[
    Path | None,
    typer.Option(
        metavar="FILE",
        help="Poses of emotions and ARKit shapes, instead of those that ship with risorius.",
        rich_help_panel=_METHOD,
        show_default=False,
    ),
]
Vectors = Annotated[
    Path | None,
    typer.Option(
        metavar="FILE",
        help="Vector muscles, instead of those that ship with risorius.",
        rich_help_panel=_METHOD,
        show_default=False,
    ),
]

MuscleMapFile = Annotated[
    Path | None,
    typer.Option(
        "--muscle-map",
        metavar="FILE",
        help="Muscles of the layered face, instead of those that ship with risorius.",
        rich_help_panel=_METHOD,
        show_default=False,
    ),
]
RecipeFile = Annotated[
    Path | None,
    typer.Option(
        "--recipe",
        metavar="FILE",
        help="Outlines of spring muscles, instead of those that ship with risorius.",
        rich_help_panel=_METHOD,
        show_default=False,
    ),
]
BonesOption = Annotated[
    Bones | None,
    typer.Option(
        "--bones",
        help="Bones of spring muscles: the skull given with --skull, the built-in one, or cut from "
        "the head's own mesh.  [default: given if there is a --skull, else builtin]",
        rich_help_panel=_METHOD,
        show_default=False,
    ),
]
SkullFile = Annotated[
    Path | None,
    typer.Option(
        "--skull",
        metavar="FILE",
        help="Skull of the layered face or of spring muscles, instead of the built-in one: a mesh "
        "with the objects cranium and mandible, or the cranium alone and --mandible.",
        rich_help_panel=_METHOD,
        show_default=False,
    ),
]
MandibleFile = Annotated[
    Path | None,
    typer.Option(
        "--mandible",
        metavar="FILE",
        help="Mandible of --skull, if it is a file of its own.",
        rich_help_panel=_METHOD,
        show_default=False,
    ),
]
SkullLandmarks = Annotated[
    Path | None,
    typer.Option(
        "--skull-landmarks",
        metavar="FILE",
        help="Bone landmarks of --skull, named as in the muscle map.",
        rich_help_panel=_METHOD,
        show_default=False,
    ),
]
Parameters = Annotated[
    list[str] | None,
    typer.Option(
        "--parameter",
        metavar="NAME=VALUE",
        help="Parameter of the method that differs from its profile, such as support=0.5; "
        "repeatable.",
        rich_help_panel=_METHOD,
        show_default=False,
    ),
]

VectorsOutput = Annotated[
    Path,
    typer.Option(
        "--output",
        "-o",
        metavar="OUT",
        help="Vector set to write (.json), for --vectors of `risorius rig`.",
        show_default=False,
    ),
]
FromHead = Annotated[
    str,
    typer.Option(
        "--from",
        metavar="SOURCE",
        help="Head that the muscles are right on: a mesh, a project or 'builtin'.",
    ),
]
FromLandmarks = Annotated[
    Path | None,
    typer.Option(
        "--from-landmarks",
        metavar="FILE",
        help="Landmarks of SOURCE, if they are not found beside it.",
        show_default=False,
    ),
]
StyleFile = Annotated[
    Path | None,
    typer.Option(
        "--style",
        metavar="FILE",
        help="What `risorius tune --style-output` kept of another head, of the same method.",
        rich_help_panel=_METHOD,
        show_default=False,
    ),
]
SourcePoints = Annotated[
    list[str] | None,
    typer.Option(
        "--source-point",
        metavar="NAME=X,Y,Z",
        help="Feature point of SOURCE by hand, in the unit of its file; repeatable.",
        rich_help_panel=_METHOD,
        show_default=False,
    ),
]
TargetPoints = Annotated[
    list[str] | None,
    typer.Option(
        "--target-point",
        metavar="NAME=X,Y,Z",
        help="Feature point of HEAD by hand: nose_tip, head_top, head_left, head_right, nose_root, "
        "socket_left, socket_right, nose_base, nose_left or nose_right; repeatable.",
        rich_help_panel=_METHOD,
        show_default=False,
    ),
]


def as_parameters(given: list[str] | None) -> dict[str, float | str]:
    """Return ``NAME=VALUE`` options as name -> number or word."""
    result: dict[str, float | str] = {}
    for text in given or []:
        name, equals, value = text.partition("=")
        if not (name and equals and value):
            raise typer.BadParameter(f"{text!r} is not NAME=VALUE", param_hint="--parameter")
        try:
            result[name] = float(value)
        except ValueError:
            result[name] = value
    return result


def as_parts(given: list[str] | None) -> dict[str, str]:
    """Return ``KIND=NAME`` options as part kind -> name."""
    result: dict[str, str] = {}
    for text in given or []:
        kind, equals, name = text.partition("=")
        if not (kind and equals and name):
            raise typer.BadParameter(
                f"{text!r} is not KIND=NAME, such as tongue=Object_7", param_hint="--part"
            )
        for earlier, taken in result.items():
            if (earlier == kind) != (taken == name):
                raise typer.BadParameter(
                    f"{earlier}={taken} and {kind}={name} contradict each other; a part is one "
                    "object, group or material, and each of these is one part",
                    param_hint="--part",
                )
        result[kind] = name
    return result


def as_weights(given: str | None, *, option: str = "--pose") -> dict[str, float]:
    """Return ``name=weight,...`` as name -> weight; a name alone has weight 1."""
    result: dict[str, float] = {}
    for text in (given or "").split(","):
        if not text.strip():
            continue
        name, equals, weight = (piece.strip() for piece in text.partition("="))
        try:
            result[name] = float(weight) if equals else 1.0
        except ValueError:
            raise typer.BadParameter(
                f"{text!r} is not name=weight, such as joy=0.5", param_hint=option
            ) from None
    return result


def as_size(given: str) -> tuple[int, int]:
    """Return ``WxH`` as (width, height) in pixels."""
    width, _, height = given.lower().partition("x")
    if not (
        width.isdigit()
        and height.isdigit()
        and 16 <= int(width) <= 8192
        and 16 <= int(height) <= 8192
    ):
        raise typer.BadParameter(
            f"{given!r} is not WIDTHxHEIGHT in pixels from 16 to 8192, such as 800x600",
            param_hint="--size",
        )
    return int(width), int(height)
