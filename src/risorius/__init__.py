"""Turn a static 3D head into a face that moves by muscles, and into a blendshape rig.

The names below are loaded when they are first used, so that ``import risorius`` is quick.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from risorius import _formats

if TYPE_CHECKING:
    from risorius.anatomy.template import builtin_head as builtin_head
    from risorius.cloning.clone import clone as clone
    from risorius.controls.control import Control as Control
    from risorius.controls.control import Pose as Pose
    from risorius.errors import RisoriusError as RisoriusError
    from risorius.errors import RisoriusWarning as RisoriusWarning
    from risorius.head.head import Head as Head
    from risorius.head.head import HeadOptions as HeadOptions
    from risorius.layered.face import LayeredFace as LayeredFace
    from risorius.rig.bake import bake as bake
    from risorius.rig.face import Face as Face
    from risorius.rig.rig import MorphTarget as MorphTarget
    from risorius.rig.rig import Rig as Rig
    from risorius.springmuscle.face import SpringFace as SpringFace
    from risorius.springmuscle.parameters import SpringParameters as SpringParameters
    from risorius.vectormuscle.face import VectorFace as VectorFace
    from risorius.vectormuscle.face import VectorParameters as VectorParameters

__version__ = "0.1.0"

_HOME = {
    "Control": "risorius.controls.control",
    "Face": "risorius.rig.face",
    "Head": "risorius.head.head",
    "HeadOptions": "risorius.head.head",
    "LayeredFace": "risorius.layered.face",
    "MorphTarget": "risorius.rig.rig",
    "Pose": "risorius.controls.control",
    "Rig": "risorius.rig.rig",
    "RisoriusError": "risorius.errors",
    "RisoriusWarning": "risorius.errors",
    "SpringFace": "risorius.springmuscle.face",
    "SpringParameters": "risorius.springmuscle.parameters",
    "VectorFace": "risorius.vectormuscle.face",
    "VectorParameters": "risorius.vectormuscle.face",
    "bake": "risorius.rig.bake",
    "builtin_head": "risorius.anatomy.template",
    "clone": "risorius.cloning.clone",
}

__all__ = [
    "Control",
    "Face",
    "Head",
    "HeadOptions",
    "LayeredFace",
    "MorphTarget",
    "Pose",
    "Rig",
    "RisoriusError",
    "RisoriusWarning",
    "SpringFace",
    "SpringParameters",
    "VectorFace",
    "VectorParameters",
    "__version__",
    "bake",
    "builtin_head",
    "clone",
]

# The formats announce themselves when their package is imported: on the first read or write.
_formats.load_on_demand("risorius.io")


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module 'risorius' has no attribute {name!r}")
    value = getattr(import_module(_HOME[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
