"""glTF 2.0: heads and rigs in, rigs out."""

from risorius._formats import Format, register
from risorius.io.gltf.read import read_gltf_head, read_gltf_landmarks, read_gltf_rig
from risorius.io.gltf.write import write_glb
from risorius.io.track import WeightTrack

__all__ = ["WeightTrack", "read_gltf_head", "read_gltf_landmarks", "read_gltf_rig", "write_glb"]

register(
    Format(
        "glTF",
        (".glb", ".gltf"),
        read_head=read_gltf_head,
        read_rig=read_gltf_rig,
        read_landmarks=read_gltf_landmarks,
    )
)
register(Format("GLB", (".glb",), write_rig=write_glb))
