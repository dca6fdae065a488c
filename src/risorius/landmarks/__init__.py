"""Named points of the face: the MPEG-4 table, landmark sets, checks of sides and completeness."""

from risorius.landmarks.feature_points import FeaturePoint, feature_points, mirror_name
from risorius.landmarks.landmark_set import Landmark, LandmarkSet, LandmarkSpec, resolve

__all__ = [
    "FeaturePoint",
    "Landmark",
    "LandmarkSet",
    "LandmarkSpec",
    "feature_points",
    "mirror_name",
    "resolve",
]
