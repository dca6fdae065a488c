"""Small made-up heads for tests: sheets with a mouth, spheres for eyes, arches for teeth."""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
import numpy.typing as npt

from risorius._check import BoolArray, IntArray
from risorius.landmarks import Landmark, LandmarkSet, LandmarkSpec, mirror_name
from risorius.mesh.core import TriMesh
from risorius.mesh.polygon_mesh import Labels, PolygonMesh

# Canonical frame [mm]; the right side follows by mirroring.
_LEFT_AND_CENTRE = {
    "2.1": (0.0, -115.0, 75.0),
    "2.2": (0.0, -72.0, 86.0),
    "2.3": (0.0, -72.5, 86.0),
    "2.4": (22.0, -73.0, 74.0),
    "2.6": (11.0, -72.0, 83.0),
    "2.8": (11.0, -72.6, 83.0),
    "3.7": (46.0, -1.0, 60.0),
    "3.11": (17.0, 1.0, 68.0),
    "8.1": (0.0, -66.0, 90.0),
    "8.2": (0.0, -82.0, 89.0),
    "8.3": (25.0, -73.0, 73.0),
    "8.5": (12.0, -66.0, 86.0),
    "8.7": (12.0, -81.0, 85.0),
    "9.3": (0.0, -45.0, 104.0),
    "10.1": (72.0, 10.0, -10.0),
}


def landmark_points() -> dict[str, tuple[float, float, float]]:
    """Return the places of 26 landmarks of an adult in the canonical frame [mm]."""
    points = dict(_LEFT_AND_CENTRE)
    for name, (x, y, z) in _LEFT_AND_CENTRE.items():
        if mirror_name(name) != name:
            points[mirror_name(name)] = (-x, y, z)
    return points


def landmark_set(
    points: Mapping[str, npt.ArrayLike] | None = None,
    *,
    rotation: npt.ArrayLike | None = None,
    scale: float = 1.0,
    origin: npt.ArrayLike = (0.0, 0.0, 0.0),
) -> LandmarkSet:
    """Return landmarks, one vertex each, moved by ``scale * rotation @ p + origin``."""
    points = landmark_points() if points is None else points
    turn = np.eye(3) if rotation is None else np.asarray(rotation)
    places = scale * np.array([*points.values()], dtype=np.float64) @ turn.T + np.asarray(origin)
    marks = [Landmark(name, (vertex,), (1.0,)) for vertex, name in enumerate(points)]
    return LandmarkSet(marks, places)


def quad_mesh() -> PolygonMesh:
    """Return a unit square, a triangle on it and a pentagon beside it: 8 vertices."""
    positions = np.array(
        [
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [1.0, 1.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.5, 2.0, 0.0],
            [2.0, -0.5, 0.0],
            [3.0, 0.5, 0.0],
            [2.0, 1.5, 0.0],
        ]
    )
    return PolygonMesh.from_polygons(positions, [[0, 1, 2, 3], [3, 2, 4], [1, 5, 6, 7, 2]])


@dataclass(frozen=True, eq=False)
class SlitSheet:
    """A bulging sheet with a slit along y = `height`, and what is known about it."""

    mesh: TriMesh
    corners: tuple[int, int]
    upper: IntArray
    lower: IntArray
    above: BoolArray
    inside: BoolArray

    @property
    def middles(self) -> tuple[int, int]:
        """Middle of the upper and of the lower line."""
        return int(self.upper[len(self.upper) // 2]), int(self.lower[len(self.lower) // 2])

    def nearest(self, x: float, y: float) -> int:
        """Return the vertex of the front that is nearest to (x, y)."""
        distance = np.linalg.norm(self.mesh.positions[:, :2] - (x, y), axis=1)
        return int(np.argmin(np.where(self.inside, np.inf, distance)))


def slit_sheet(
    kind: Literal["slit", "bag", "welded"],
    *,
    half_width: float = 25.0,
    opening: float = 4.0,
    height: float = 0.0,
    half_cells: int = 5,
    margin_cells: tuple[int, int, int] = (7, 10, 10),
) -> SlitSheet:
    """Return a sheet that faces +z, mirror-symmetric about x = 0.

    ``"slit"``: the lips are a boundary loop; ``"bag"``: they turn inwards into a closed bag;
    ``"welded"``: one row of vertices serves both lips. `margin_cells` counts the cells beside,
    above and below the slit. Corners and lines run from the left (+x) corner to the right one.
    """
    beside, over, under = margin_cells
    step = half_width / half_cells
    columns = np.arange(half_cells + beside, -half_cells - beside - 1, -1)
    open_columns = np.flatnonzero(np.abs(columns) < half_cells)
    places: list[tuple[float, float]] = []
    grids = []
    lift = np.where(np.abs(columns) < half_cells, 1.0 - (columns / half_cells) ** 2, 0.0)
    for side, rows in ((1.0, over), (-1.0, under)):
        grid = np.zeros((rows + 1, len(columns)), int)
        for row in range(rows + 1):
            for number, column in enumerate(columns):
                shared = side < 0 and row == 0 and not (number in open_columns and kind != "welded")
                if shared:
                    grid[0, number] = grids[0][0, number]
                    continue
                grid[row, number] = len(places)
                gap = 0.5 * opening * lift[number] * (1.0 - row / rows) * (kind != "welded")
                places.append((column * step, height + side * (row * step + gap)))
        grids.append(grid)
    positions = np.array([(x, y, 90.0 - (x * x + (y - height) ** 2) / 300.0) for x, y in places])
    faces = [*_quads(grids[0]), *_quads(grids[1][::-1])]
    ends = (open_columns[0] - 1, open_columns[-1] + 1)
    upper, lower = (grid[0, ends[0] : ends[1] + 1] for grid in grids)
    above = np.zeros(len(positions), bool)
    above[grids[0][1:]] = True
    above[grids[0][0, open_columns]] = True
    inside = np.zeros(len(positions), bool)
    if kind == "bag":
        loop = np.concatenate([upper, lower[-2:0:-1]])
        bag, bag_faces, bag_above = _bag(positions[loop], loop, len(positions), height)
        positions = np.concatenate([positions, bag])
        faces += bag_faces
        above = np.append(above, bag_above)
        inside = np.append(inside, np.ones(len(bag), bool))
    corners = (int(upper[0]), int(upper[-1]))
    return SlitSheet(TriMesh(positions, np.array(faces)), corners, upper, lower, above, inside)


def _quads(grid: npt.NDArray[np.int_]) -> list[tuple[int, int, int]]:
    """Return two triangles for each cell of `grid`, whose x falls along and y rises down.

    The diagonals mirror about the middle column.
    """
    faces = []
    middle = (grid.shape[1] - 1) / 2
    for row in range(grid.shape[0] - 1):
        for column in range(grid.shape[1] - 1):
            a, b = grid[row, column], grid[row, column + 1]
            c, d = grid[row + 1, column], grid[row + 1, column + 1]
            if column < middle:
                faces += [(a, c, d), (a, d, b)]
            else:
                faces += [(a, c, b), (b, c, d)]
    return faces


def _bag(
    rim: npt.NDArray[np.float64], loop: npt.NDArray[np.int_], first: int, height: float
) -> tuple[npt.NDArray[np.float64], list[tuple[int, int, int]], BoolArray]:
    """Extrude the `rim` (k, 3) backwards in three rings and close it with a fan."""
    count = len(rim)
    rings = [loop]
    points = []
    away = np.sign(np.round(rim[:, 1] - height, 9))
    for number in (1, 2, 3):
        ring = rim.copy()
        ring[:, 0] *= 1.0 - 0.02 * number
        ring[:, 1] += 2.5 * number * away
        ring[:, 2] -= 5.0 * number
        points.append(ring)
        rings.append(first + (number - 1) * count + np.arange(count))
    faces = []
    for front, back in itertools.pairwise(rings):
        for k in range(count):
            m = (k + 1) % count
            faces += [(front[k], front[m], back[m]), (front[k], back[m], back[k])]
    pole = first + 3 * count
    faces += [(rings[3][k], rings[3][(k + 1) % count], pole) for k in range(count)]
    points.append(points[-1].mean(axis=0)[None] - [0.0, 0.0, 5.0])
    above = np.append(np.tile(away > 0, 3), False)
    return np.concatenate(points), faces, above


Piece = tuple[npt.NDArray[np.float64], list[tuple[int, ...]]]


def sphere(
    centre: npt.ArrayLike, radii: npt.ArrayLike, *, rows: int = 9, columns: int = 14
) -> Piece:
    """Return an ellipsoid of quads and triangles with poles ahead and behind."""
    polar = np.pi * np.arange(1, rows) / rows
    round_ = 2.0 * np.pi * np.arange(columns) / columns
    grid = np.stack(np.meshgrid(polar, round_, indexing="ij"), axis=-1).reshape(-1, 2)
    unit = np.stack(
        [
            np.sin(grid[:, 0]) * np.cos(grid[:, 1]),
            np.sin(grid[:, 0]) * np.sin(grid[:, 1]),
            np.cos(grid[:, 0]),
        ],
        axis=1,
    )
    unit = np.concatenate([unit, [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]]])
    front, back = len(unit) - 2, len(unit) - 1
    polygons: list[tuple[int, ...]] = []
    for k in range(columns):
        m = (k + 1) % columns
        polygons.append((front, k, m))
        polygons.append(((rows - 2) * columns + m, (rows - 2) * columns + k, back))
        for row in range(rows - 2):
            a = row * columns
            polygons.append((a + k, a + columns + k, a + columns + m, a + m))
    return np.asarray(centre) + unit * np.asarray(radii), polygons


def arch(*, height: float, half_width: float = 24.0, front: float = 72.0) -> Piece:
    """Return a closed U-shaped bar like a row of teeth, middle of the front at z = `front`."""
    turn = np.linspace(0.0, np.pi, 17)
    spine = np.stack(
        [half_width * np.cos(turn), np.full(17, height), front - 45.0 * (1.0 - np.sin(turn))],
        axis=1,
    )
    outward = np.stack([np.cos(turn), np.zeros(17), np.sin(turn)], axis=1)
    corners = [spine + s * 2.5 * outward + [0.0, t * 3.5, 0.0] for s, t in _SQUARE]
    points = np.stack(corners, axis=1).reshape(-1, 3)
    polygons: list[tuple[int, ...]] = [(3, 2, 1, 0), (64, 65, 66, 67)]
    for k in range(16):
        for c in range(4):
            a, b = 4 * k + c, 4 * k + (c + 1) % 4
            polygons.append((a, b, b + 4, a + 4))
    return points, polygons


_SQUARE = ((1.0, -1.0), (1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0))


def head_pieces(kind: Literal["slit", "bag", "welded"] = "slit") -> dict[str, Piece]:
    """Return the loose pieces of a made-up head in the canonical frame [mm].

    The skin is a sheet with a mouth and without eye holes that carries `landmark_points`.
    """
    skin = face_sheet(kind)
    eyes = {f"eye_{side}": sphere((x, 0.0, 52.0), (12.0,) * 3) for side, x in _EYE_X.items()}
    return {
        "skin": (skin.mesh.positions, [tuple(face) for face in skin.mesh.faces.tolist()]),
        **eyes,
        "teeth_upper": arch(height=-67.0),
        "teeth_lower": arch(height=-79.0),
        "tongue": sphere((0.0, -76.0, 38.0), (15.0, 5.0, 24.0)),
    }


_EYE_X = {"left": 31.5, "right": -31.5}


def face_sheet(kind: Literal["slit", "bag", "welded"] = "slit") -> SlitSheet:
    """Return the skin of the made-up head."""
    return slit_sheet(
        kind,
        half_width=22.0,
        opening=1.5,
        height=-72.25,
        half_cells=5,
        margin_cells=(14, 32, 18),
    )


def head_specs(kind: Literal["slit", "bag", "welded"] = "slit") -> dict[str, LandmarkSpec]:
    """Return landmarks for `head_pieces`, as vertices of a mesh that begins with its skin."""
    skin = face_sheet(kind)
    specs = {
        name: LandmarkSpec(vertex=skin.nearest(x, y))
        for name, (x, y, _) in landmark_points().items()
    }
    upper, lower = skin.middles
    fixed = {"2.4": skin.corners[0], "2.5": skin.corners[1], "2.2": upper, "2.3": lower}
    return specs | {name: LandmarkSpec(vertex=vertex) for name, vertex in fixed.items()}


def placed_specs(kind: Literal["slit", "bag", "welded"] = "slit") -> dict[str, LandmarkSpec]:
    """Return the landmarks of `head_specs` as positions [mm]."""
    positions = face_sheet(kind).mesh.positions
    specs = head_specs(kind)
    places = {name: positions[spec.vertex] for name, spec in specs.items()}
    return {name: LandmarkSpec(position=tuple(place)) for name, place in places.items()}


def exploded(piece: Piece) -> Piece:
    """Return the piece with vertices of its own for every polygon, as texture seams do it."""
    points, polygons = piece
    order = [vertex for polygon in polygons for vertex in polygon]
    ends = np.cumsum([len(polygon) for polygon in polygons])
    own = [tuple(range(end - len(polygon), end)) for end, polygon in zip(ends.tolist(), polygons)]
    return points[order], own


def assemble(pieces: Mapping[str, Piece], *, names: Mapping[str, str] | None = None) -> PolygonMesh:
    """Return one mesh of all `pieces`; those in `names` (piece -> name) become named objects."""
    names = names or {}
    positions, polygons, labels = [], [], []
    first = 0
    shown = tuple(dict.fromkeys(names.values()))
    for piece, (points, faces) in pieces.items():
        positions.append(points)
        polygons += [[vertex + first for vertex in face] for face in faces]
        labels += [shown.index(names[piece]) if piece in names else -1] * len(faces)
        first += len(points)
    mesh = PolygonMesh.from_polygons(np.concatenate(positions), polygons)
    return replace(mesh, objects=Labels(shown, np.array(labels, np.int32)))
