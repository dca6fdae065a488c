"""From the arguments of `transfer` and `tune` to an export under way."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, cast

import typer

from risorius._check import FloatArray
from risorius.cli.sources import Given, read_head, resolve
from risorius.cli.talk import Talk
from risorius.head.head import Head
from risorius.io.atomic import write_json
from risorius.project import BUILTIN, Project, presets_of, vectors_of
from risorius.tuning.style import Style
from risorius.vectormuscle.export import Export, ExportParameters
from risorius.vectormuscle.export_points import FeatureSet, find_features
from risorius.vectormuscle.vector_set import VectorSet

__all__ = ["Way", "as_feature", "begin_export", "tuned_expressions", "write_vectors"]


@dataclass(frozen=True)
class Way:
    """From where muscles are carried, and by which points.

    Parameters
    ----------
    source : str
        Head that the muscles are right on.
    source_landmarks : Path or None
    source_points, target_points : list of str or None
        Feature points given by hand as ``NAME=X,Y,Z``, in the frame and unit of their head's file.
    """

    source: str = BUILTIN
    source_landmarks: Path | None = None
    source_points: list[str] | None = None
    target_points: list[str] | None = None


def begin_export(project: Project, way: Way, talk: Talk, *, first: Iterable[str] = ()) -> Export:
    """Read both heads and return the export to the project's head before its first group.

    Parameters
    ----------
    project : Project
    way : Way
    talk : Talk
    first : iterable of str
        Expressions that are judged before all others.

    Raises
    ------
    RisoriusError
        If something of it is refused.
    """
    here = as_feature(way.source_points, "--source-point")
    there = as_feature(way.target_points, "--target-point")
    vectors, presets = vectors_of(project), presets_of(project)
    source = read_head(resolve(way.source, Given(landmarks=way.source_landmarks)), talk)
    target = read_head(project, talk)
    with talk.stage("feature points"):
        features = (
            find_features(source, given=_canonical(source, here)),
            find_features(target, given=_canonical(target, there)),
        )
        profile = cast(Literal["improved", "faithful"], project.profile)
        export = Export.begin(
            source,
            target,
            vectors,
            parameters=ExportParameters.of_profile(profile),
            features=features,
            presets=presets,
            first=first,
        )
    talk.put(source=way.source, features=_described(target, features[1]))
    found = [feature for feature, origin in features[1].sources.items() if origin == "found"]
    talk.say(f"  feature points found by shape: {', '.join(found) or '-'}")
    talk.say(f"  correspondences: {len(export.pairs)}")
    return export


def tuned_expressions(project: Project, style: Style) -> tuple[str, ...]:
    """Return the expressions of which a style knows all vector muscles.

    They go first when muscles are carried in the style, as they did when it was tuned.
    """
    names = {muscle.name for muscle in vectors_of(project).muscles}
    tuned = {name.partition(".")[0] for name in style.parameters}
    return tuple(
        expression
        for expression, pose in presets_of(project).emotions.items()
        if all({name, name[:-2]} & tuned for name, value in pose.items() if value and name in names)
    )


def write_vectors(vectors: VectorSet, path: Path, talk: Talk) -> None:
    """Write a vector set and say so."""
    write_json(path, vectors.to_json())
    talk.say(f"wrote {path}: {len(vectors.muscles)} muscles")
    talk.put(output=path, muscles=[muscle.name for muscle in vectors.muscles])


def as_feature(given: list[str] | None, option: str) -> dict[str, tuple[float, ...]]:
    """Return ``NAME=X,Y,Z`` options as name -> place."""
    result: dict[str, tuple[float, ...]] = {}
    for text in given or []:
        name, _, places = text.partition("=")
        try:
            row = tuple(float(number) for number in places.split(","))
        except ValueError:
            row = ()
        if not name or len(row) != 3:
            raise typer.BadParameter(
                f"{text!r} is not NAME=X,Y,Z, such as nose_tip=0,1.2,3", param_hint=option
            )
        result[name] = row
    return result


def _canonical(head: Head, points: dict[str, tuple[float, ...]]) -> dict[str, FloatArray]:
    return {name: head.frame.to_canonical([place])[0] for name, place in points.items()}


def _described(head: Head, features: FeatureSet) -> dict[str, dict[str, object]]:
    """Return the feature points in the frame and unit of the head's file."""
    return {
        name: {
            "position": head.frame.to_input(place[None])[0].round(4).tolist(),
            "from": features.sources[name],
        }
        for name, place in features.points.items()
    }
