"""Meshes: triangles and polygons, topology, normals, smooth fields, geodesics, surface points."""

from risorius.mesh.core import TriMesh
from risorius.mesh.polygon_mesh import Labels, PolygonMesh
from risorius.mesh.surface_point import SurfacePoints
from risorius.mesh.topology import TopologyReport, report
from risorius.mesh.welding import Weld, weld

__all__ = [
    "Labels",
    "PolygonMesh",
    "SurfacePoints",
    "TopologyReport",
    "TriMesh",
    "Weld",
    "report",
    "weld",
]
