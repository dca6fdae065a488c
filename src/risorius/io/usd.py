"""Write rigs as USD: UsdSkel blend shapes, one mesh per part, polygons as they are.

References
----------
Pixar, "UsdSkel schemas": SkelRoot, Skeleton, SkelAnimation, BlendShape.
"""

from __future__ import annotations

import json
import os
import re
import tempfile
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray
from risorius._formats import Format, register
from risorius.errors import FormatError
from risorius.head.frame import Frame
from risorius.io.atomic import atomic_write
from risorius.io.finite import require_finite
from risorius.io.looks import look_of
from risorius.io.rig_json import rig_to_json
from risorius.io.track import WeightTrack, show_of_shapes
from risorius.io.usd_mesh import PartMesh, PartShape, part_meshes
from risorius.io.usd_track import JOINT, add_track
from risorius.rig.rig import Rig

__all__ = ["write_usd"]

_ROOT = "/Head"
_MILLIMETRES_PER_METRE = 1000.0
_REASON = re.compile(r" : '(.*)'")
_EPOCH = 400_000_000  # a day in 1982: archives keep the time of their files, ours shall not


def write_usd(
    rig: Rig, path: str | Path, *, animation: bool = False, track: WeightTrack | None = None
) -> None:
    """Write a rig as ``.usdc``, ``.usda``, ``.usdz`` or ``.usd``.

    Parameters
    ----------
    rig : Rig
    path : path
    animation : bool
        Add an animation that shows one shape after the other, a second each.
    track : WeightTrack, optional
        Add an animation that plays this instead, one time code for each of its moments. Where it
        turns the head, the joint stands at the track's pivot and turns there.

    Raises
    ------
    ImportError
        If the extra ``usd`` is not installed.
    FormatError
        If the rig has no polygons or the file cannot be written.
    ShapeError
        If the track was made for another rig.

    Notes
    -----
    The numbers are those of the input; the stage says how many metres its unit is and which axis
    points up. Landmarks, controls and poses stand in the layer's custom data as JSON.
    """
    pxr = _library()
    path = Path(path)
    if track is not None:
        track.require_fits(len(rig.targets))
    parts = part_meshes(rig)
    require_finite(rig.mesh.positions, f"{path}: the neutral")
    if not parts:
        raise FormatError(f"{path}: USD needs polygons, the rig has only vertices")
    if track is None and animation and rig.targets:
        track = show_of_shapes(len(rig.targets))
    stage = _stage(rig, parts, track)
    with atomic_write(path) as temporary, tempfile.TemporaryDirectory() as folder:
        packed = path.suffix.lower() == ".usdz"
        file = Path(folder) / "head.usdc" if packed else temporary
        try:
            done = stage.GetRootLayer().Export(str(file))
            if done and packed:
                os.utime(file, (_EPOCH, _EPOCH))
                inner = pxr.Sdf.AssetPath(str(file))
                done = pxr.UsdUtils.CreateNewUsdzPackage(inner, str(temporary))
        except RuntimeError as error:
            raise FormatError(_refusal(path, str(error))) from error
        if not done:
            raise FormatError(_refusal(path, ""))


def _refusal(path: Path, dump: str) -> str:
    """Return one sentence for the library's `dump`, which has a line of its source per error."""
    reasons = list(dict.fromkeys(_REASON.findall(dump)))[:2]
    told = f" ({'; '.join(reasons)})" if reasons else ""
    return f"{path}: the USD library cannot write the file{told}; is there room on the disk?"


def _library() -> Any:
    """Return the package `pxr` with the modules that are needed here."""
    try:
        for module in ("Gf", "Sdf", "Tf", "Usd", "UsdGeom", "UsdSkel", "UsdUtils", "Vt"):
            import_module(f"pxr.{module}")
    except ImportError:
        raise ImportError("writing USD needs usd-core: pip install risorius[usd]") from None
    return import_module("pxr")


def _stage(rig: Rig, parts: list[PartMesh], track: WeightTrack | None) -> Any:
    """Return a stage in memory: a skeleton of one joint that carries the blend shapes."""
    pxr = _library()
    stage = pxr.Usd.Stage.CreateInMemory()
    pxr.UsdGeom.SetStageMetersPerUnit(stage, rig.frame.scale / _MILLIMETRES_PER_METRE)
    stage.GetRootLayer().customLayerData = {
        "risorius": json.dumps(rig_to_json(rig), ensure_ascii=False, allow_nan=False)
    }
    root = pxr.UsdSkel.Root.Define(stage, _ROOT)
    stage.SetDefaultPrim(root.GetPrim())
    up_axis, upright = _up(rig.frame)
    pxr.UsdGeom.SetStageUpAxis(stage, up_axis)
    if upright is not None:
        matrix = np.eye(4)
        matrix[:3, :3] = upright.T  # USD multiplies rows from the left
        root.AddTransformOp().Set(pxr.Gf.Matrix4d(matrix.tolist()))
    skeleton = pxr.UsdSkel.Skeleton.Define(stage, f"{_ROOT}/Skeleton")
    skeleton.CreateJointsAttr([JOINT])
    place = pxr.Gf.Matrix4d(1.0)
    if track is not None and track.turns is not None:
        place.SetTranslate(pxr.Gf.Vec3d(track.turns.pivot.tolist()))
    rest = pxr.Vt.Matrix4dArray(1, place)
    skeleton.CreateBindTransformsAttr(rest)
    skeleton.CreateRestTransformsAttr(rest)
    animator = pxr.UsdSkel.Animation.Define(stage, f"{_ROOT}/Animation")
    animator.CreateBlendShapesAttr(pxr.Vt.TokenArray(list(rig.names)))
    animator.CreateBlendShapeWeightsAttr(pxr.Vt.FloatArray(len(rig.targets)))
    if track is not None:
        add_track(pxr, stage, animator, track)
    pxr.UsdSkel.BindingAPI.Apply(skeleton.GetPrim()).CreateAnimationSourceRel().AddTarget(
        animator.GetPath()
    )
    taken: set[str] = {"Skeleton", "Animation"}
    for part in parts:
        _add_part(stage, part, _identifier(part.name, taken), skeleton)
    return stage


def _up(frame: Frame) -> tuple[str, FloatArray | None]:
    """Return the up axis that USD can name, and a rotation where the head's is another."""
    for name, axis in (("Y", (0.0, 1.0, 0.0)), ("Z", (0.0, 0.0, 1.0))):
        if float(frame.rotation[1] @ np.array(axis)) > 0.8:
            return name, None
    return "Y", frame.rotation


def _add_part(stage: Any, part: PartMesh, name: str, skeleton: Any) -> None:
    pxr = _library()
    look = look_of(part.material, part.name)
    mesh = pxr.UsdGeom.Mesh.Define(stage, f"{_ROOT}/{name}")
    mesh.CreatePointsAttr(_vectors(part.positions))
    mesh.CreateFaceVertexCountsAttr(pxr.Vt.IntArray.FromNumpy(part.sizes.astype(np.int32)))
    mesh.CreateFaceVertexIndicesAttr(pxr.Vt.IntArray.FromNumpy(part.corners.astype(np.int32)))
    mesh.CreateSubdivisionSchemeAttr(pxr.UsdGeom.Tokens.none)
    mesh.CreateDoubleSidedAttr(look.both_sides)
    mesh.CreateExtentAttr(pxr.UsdGeom.PointBased.ComputeExtent(mesh.GetPointsAttr().Get()))
    mesh.CreateNormalsAttr(_vectors(part.normals))
    mesh.SetNormalsInterpolation(pxr.UsdGeom.Tokens.vertex)
    mesh.CreateDisplayColorAttr(_vectors(np.array([look.colour])))
    if len(part.uvs):
        primvar = pxr.UsdGeom.PrimvarsAPI(mesh).CreatePrimvar(
            "st", pxr.Sdf.ValueTypeNames.TexCoord2fArray, pxr.UsdGeom.Tokens.faceVarying
        )
        primvar.Set(pxr.Vt.Vec2fArray.FromNumpy(part.uvs.astype(np.float32)))
        primvar.SetIndices(pxr.Vt.IntArray.FromNumpy(part.uv_corners.astype(np.int32)))
    binding = pxr.UsdSkel.BindingAPI.Apply(mesh.GetPrim())
    binding.CreateSkeletonRel().AddTarget(skeleton.GetPath())
    binding.CreateJointIndicesPrimvar(True, 1).Set(pxr.Vt.IntArray([0]))
    binding.CreateJointWeightsPrimvar(True, 1).Set(pxr.Vt.FloatArray([1.0]))
    if not part.shapes:
        return
    binding.CreateBlendShapesAttr(pxr.Vt.TokenArray([shape.name for shape in part.shapes]))
    targets = binding.CreateBlendShapeTargetsRel()
    taken: set[str] = set()
    for shape in part.shapes:
        identifier = _identifier(shape.name, taken)
        targets.AddTarget(_add_shape(stage, shape, f"{mesh.GetPath()}/{identifier}"))


def _add_shape(stage: Any, shape: PartShape, path: str) -> Any:
    pxr = _library()
    prim = pxr.UsdSkel.BlendShape.Define(stage, path)
    prim.CreateOffsetsAttr(_vectors(shape.deltas))
    prim.CreateNormalOffsetsAttr(_vectors(shape.normal_deltas))
    prim.CreatePointIndicesAttr(pxr.Vt.IntArray.FromNumpy(shape.vertices.astype(np.int32)))
    return prim.GetPath()


def _identifier(name: str, taken: set[str]) -> str:
    """Return a name that USD accepts and that is not taken yet."""
    pxr = _library()
    stem = pxr.Tf.MakeValidIdentifier(name)
    identifier, repeats = stem, 1
    while identifier in taken:
        repeats += 1
        identifier = f"{stem}_{repeats}"
    taken.add(identifier)
    return identifier


def _vectors(values: npt.NDArray[np.float64]) -> Any:
    pxr = _library()
    return pxr.Vt.Vec3fArray.FromNumpy(np.ascontiguousarray(values, dtype=np.float32))


register(Format("usd", (".usdc", ".usda", ".usdz", ".usd"), write_rig=write_usd))
