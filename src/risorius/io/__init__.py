"""Files: one module per format; importing this package makes all of them known."""

from risorius.io import fdp, gltf, landmarks, motion, npz, obj, obj_folder, ply, stl, usd
from risorius.io.atomic import atomic_folder, atomic_write, write_bytes
from risorius.io.bounded import read_bytes_limited, read_json

__all__ = [
    "atomic_folder",
    "atomic_write",
    "fdp",
    "gltf",
    "landmarks",
    "motion",
    "npz",
    "obj",
    "obj_folder",
    "ply",
    "read_bytes_limited",
    "read_json",
    "stl",
    "usd",
    "write_bytes",
]
