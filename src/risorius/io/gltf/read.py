"""Read glTF files as heads and as rigs, our own ones back to the input's vertices and polygons."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray, IntArray
from risorius.errors import FormatError, RisoriusWarning
from risorius.head.frame import Frame
from risorius.io.gltf.document import Document, open_document
from risorius.io.gltf.nodes import Placed, placed_meshes
from risorius.io.gltf.primitives import Piece, read_pieces
from risorius.io.gltf.topology import Source, restore, source_of
from risorius.io.rig_json import RigInfo, rig_info
from risorius.landmarks.landmark_set import LandmarkSpec
from risorius.mesh.polygon_mesh import Labels, PolygonMesh
from risorius.rig.rig import MorphTarget, Rig
