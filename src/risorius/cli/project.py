"""`risorius project`: save, show, change and upgrade a project."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from risorius.cli.options import (
    AsJson,
    Axes,
    Debug,
    FlipLandmarks,
    HeadArgument,
    LandmarkFile,
    MethodOption,
    Parameters,
    Parts,
    Presets,
    ProfileOption,
    Quiet,
    Shapes,
    Unit,
    Vectors,
    as_parameters,
    as_parts,
)
from risorius.cli.talk import talking

__all__ = ["app", "change", "new", "show", "upgrade"]

app = typer.Typer(
    help="Keep a head and everything made for it in one text file that every verb reads.",
    no_args_is_help=True,
)

ProjectFile = Annotated[
    Path, typer.Argument(metavar="PROJECT", help="Project file (.json).", show_default=False)
]
Recipes = Annotated[
    bool,
    typer.Option(
        "--recipes",
        help="Put editable copies of the presets and of the vector set beside the project, and "
        "let it use them.",
    ),
]


@app.command("new")
def new(
    head: HeadArgument,
    output: Annotated[
        Path,
        typer.Option(
            "--output",
            "-o",
            metavar="PROJECT",
            help="Project file to write (.json).",
            show_default=False,
        ),
    ],
    landmarks: LandmarkFile = None,
    unit: Unit = None,
    axes: Axes = None,
    part: Parts = None,
    flip_landmarks: FlipLandmarks = False,
    method: MethodOption = None,
    profile: ProfileOption = None,
    parameter: Parameters = None,
    shapes: Shapes = None,
    presets: Presets = None,
    vectors: Vectors = None,
    recipes: Recipes = False,
    json: AsJson = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> None:
    """Save a head and its settings as a project.

    Example:  risorius project new head.obj -l head.landmarks.json -o head.json --recipes,
    then  risorius rig head.json -o face.glb
    """
    with talking(json=json, quiet=quiet, debug=debug) as talk:
        from risorius.cli.keeping import keep
        from risorius.cli.sources import Given, resolve
        from risorius.errors import FormatError

        if output.exists():
            raise FormatError(
                f"{output}: exists already; change it with `risorius project set`, or remove it"
            )
        given = Given(
            landmarks=landmarks,
            unit=unit,
            axes=axes,
            parts=as_parts(part),
            flip_landmarks=flip_landmarks,
            method=method.value if method else None,
            profile=profile.value if profile else None,
            parameters=as_parameters(parameter),
            shapes=shapes,
            presets=presets,
            vector_set=vectors,
        )
        keep(resolve(head, given), output, talk, recipes=recipes)


@app.command("set")
def change(
    project: ProjectFile,
    head: Annotated[
        str | None,
        typer.Option("--head", metavar="HEAD", help="Another head.", show_default=False),
    ] = None,
    landmarks: LandmarkFile = None,
    unit: Unit = None,
    axes: Axes = None,
    part: Parts = None,
    flip_landmarks: FlipLandmarks = False,
    method: MethodOption = None,
    profile: ProfileOption = None,
    parameter: Parameters = None,
    shapes: Shapes = None,
    presets: Presets = None,
    vectors: Vectors = None,
    recipes: Recipes = False,
    json: AsJson = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> None:
    """Change settings of a project; what is not mentioned stays.

    Example:  risorius project set head.json --profile faithful --shapes arkit
    """
    with talking(json=json, quiet=quiet, debug=debug) as talk:
        from risorius.cli.keeping import keep
        from risorius.cli.sources import Given, with_given, with_head
        from risorius.project import read_project

        given = Given(
            landmarks=landmarks,
            unit=unit,
            axes=axes,
            parts=as_parts(part),
            flip_landmarks=flip_landmarks,
            method=method.value if method else None,
            profile=profile.value if profile else None,
            parameters=as_parameters(parameter),
            shapes=shapes,
            presets=presets,
            vector_set=vectors,
        )
        found = with_head(read_project(project), head)
        keep(with_given(found, given), project, talk, recipes=recipes)


@app.command("show")
def show(
    project: ProjectFile, json: AsJson = False, quiet: Quiet = False, debug: Debug = False
) -> None:
    """Show what a project says, and whether its files are there; refuse wrong parameters.

    Example:  risorius project show head.json
    """
    with talking(json=json, quiet=quiet, debug=debug) as talk:
        from risorius.cli.keeping import describe
        from risorius.project import read_project, require_parameters

        found = read_project(project)
        describe(found, talk)
        require_parameters(found)


@app.command("upgrade")
def upgrade(
    project: ProjectFile, json: AsJson = False, quiet: Quiet = False, debug: Debug = False
) -> None:
    """Rewrite a project of an older risorius; the old file is kept beside it.

    Example:  risorius project upgrade head.json
    """
    with talking(json=json, quiet=quiet, debug=debug) as talk:
        from risorius.project import upgrade_project
        from risorius.project.files import VERSION

        backup = upgrade_project(project)
        talk.put(project=project, version=VERSION, backup=backup)
        if backup is None:
            talk.say(f"{project}: is of version {VERSION} already, nothing to do")
        else:
            talk.say(f"{project}: is of version {VERSION} now; the old file is {backup}")
