"""Where surfaces are: rays, closest points, visibility, convex hulls."""

from risorius.spatial.closest import ClosestPoints, closest_points, signed_distance
from risorius.spatial.hull import Hull, convex_hull
from risorius.spatial.raycast import RayHits, Scene
from risorius.spatial.visibility import visible_along, visible_from

__all__ = [
    "ClosestPoints",
    "Hull",
    "RayHits",
    "Scene",
    "closest_points",
    "convex_hull",
    "signed_distance",
    "visible_along",
    "visible_from",
]
