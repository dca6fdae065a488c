"""Files: one module per format; importing this package makes all of them known."""

from risorius.io import landmarks, obj
from risorius.io.atomic import atomic_folder, atomic_write, write_bytes
from risorius.io.bounded import read_bytes_limited, read_json

__all__ = [
    "atomic_folder",
    "atomic_write",
    "landmarks",
    "obj",
    "read_bytes_limited",
    "read_json",
    "write_bytes",
]
