"""Eyelids: they turn about an axis through the eyeball and close along each other's contour."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from risorius._check import BoolArray, FloatArray, IntArray
from risorius.anatomy.jaw import rotate
from risorius.anatomy.radial_surface import RadialSurface
from risorius.anatomy.smooth_step import smooth_step
from risorius.mesh.core import TriMesh
from risorius.mesh.lids import LidMargins

__all__ = ["Eyelids", "LidParameters", "build_eyelids"]


@dataclass(frozen=True)
class LidParameters:
    """How the lids move.

    Parameters
    ----------
    upper_band, lower_band : float
        Width of the skin that follows the margins of closing lids, in openings of the eye.
    inner_band : float
        The same behind the margins.
    plate, crease : float
        An opening upper lid rises as one piece up to the first and stretches up to the second
        distance from its margin, in openings of the eye: the levator lifts the tarsal plate.
    lower_share : float
        Share of the opening that the lower lid closes (spec: 15 %).
    wide : float
        How far a lid opens at -1, in openings of the eye.
    lower_drop : float
        The same for the lower lid.
    axis_depth : float
        Where the axis lies behind the corners if there is no eyeball, in eye widths.
    clearance : float
        Least distance of a moving lid from the eyeball [mm].
    corner_rest : float
        Share of the eye's width over which the lids come to rest at the corners.
    """

    upper_band: float = 0.8
    lower_band: float = 0.8
    inner_band: float = 0.6
    plate: float = 0.45
    crease: float = 1.05
    lower_share: float = 0.15
    wide: float = 0.28
    lower_drop: float = 0.12
    axis_depth: float = 0.38
    clearance: float = 0.25
    corner_rest: float = 0.06


@dataclass(frozen=True, eq=False)
class Eyelids:
    """The two lids of one eye, bound to a skin of n vertices.

    Parameters
    ----------
    vertices : (k,) int32
        Skin vertices of the lids; the arrays below belong to them.
    upper : (k,) bool
        Whether a vertex is on the upper lid.
    place : (k,) float64
        Place along the eye, 0 inner to 1 outer corner.
    weight : (k,) float64
        How far a vertex follows its closing margin, 1 at the margin.
    lifted : (k,) float64
        The same for an opening lid.
    closing : (k,) float64
        Angle from the vertex's margin to the line where the lids meet, at its place [rad].
    opening : (k,) float64
        Angle of the whole opening at its place [rad].
    centre, axis : (3,) float64
        Axis of both lids: a point [mm] and a unit vector; positive turns lower.
    floor : (k,) float64
        Least distance from the centre that a vertex keeps where it comes to lie [mm], relative
        to the eyeball's surface; minus infinity without an eyeball.
    surface : RadialSurface or None
        The eyeball's radius by direction.
    """

    vertices: IntArray
    upper: BoolArray
    place: FloatArray
    weight: FloatArray
    lifted: FloatArray
    closing: FloatArray
    opening: FloatArray
    centre: FloatArray
    axis: FloatArray
    floor: FloatArray
    surface: RadialSurface | None
    parameters: LidParameters

    def angles(self, *, upper: float, lower: float) -> FloatArray:
        """Return the turn (k,) [rad] of each lid vertex for lid controls in [-1, 1]."""
        p = self.parameters
        close, lift = self.weight * self.closing, self.lifted * self.opening
        down = upper * (close if upper >= 0.0 else p.wide * lift)
        up = lower * close if lower >= 0.0 else -lower * p.lower_drop * lift
        return np.where(self.upper, down, up)

    def move(
        self,
        positions: FloatArray,
        *,
        upper: float,
        lower: float,
        gaze: tuple[float, float] = (0.0, 0.0),
    ) -> FloatArray:
        """Return the skin positions (n, 3) with the lids moved, starting from `positions`.

        The lid vertices turn about the axis and keep clear of the eyeball, whose cornea goes
        with the `gaze`, yaw and pitch [deg]; the lids ride over it.
        """
        yaw, pitch = gaze
        looking = self.surface is not None and (yaw != 0.0 or pitch != 0.0)
        if upper == 0.0 and lower == 0.0 and not looking:
            return positions
        result = positions.copy()
        start = positions[self.vertices]
        angle = self.angles(upper=upper, lower=lower)
        turned = rotate(start, about=self.centre, axis=self.axis, angle=angle)
        if self.surface is not None:
            arm = turned - self.centre
            distance = np.linalg.norm(arm, axis=1)
            least = self.surface.radius(arm, yaw=yaw, pitch=pitch) + self.floor
            free = (angle != 0.0) | looking
            lift = np.where(free, np.maximum(least - distance, 0.0), 0.0)
            turned = turned + arm * (lift / np.maximum(distance, 1e-9))[:, None]
        result[self.vertices] = turned
        return result


def _contour(x: FloatArray, y: FloatArray, samples: FloatArray, *, outwards: float) -> FloatArray:
    """Return a margin's pitch at the places `samples`, as a smooth curve through both corners.

    Half an ellipse times a cubic: a traced margin may hop between the front and the back edge of
    the lid, the lid must not. It hugs the side `outwards` (1 above, -1 below) of the line, so
    that a closed lid leaves no gap.

    Parameters
    ----------
    x, y : (k,) float64
        Place along the eye and pitch [rad] of the margin's vertices.
    samples : (q,) float64
        Places asked for.
    outwards : float
    """

    def basis(t: FloatArray) -> FloatArray:
        bump, wave = np.sqrt(np.clip(t * (1.0 - t), 0.0, None)), 2.0 * t - 1.0
        return np.stack([bump, bump * wave, bump * wave**2, bump * wave**3], axis=1)

    start, slope = float(y[0]), float(y[-1] - y[0])
    inside = np.clip(x, 0.0, 1.0)
    system, right = basis(inside), y - start - slope * inside
    weights = np.ones(len(x))
    coefficients = np.zeros(4)
    for _ in range(12):
        weighted = system * weights[:, None]
        normal = system.T @ weighted + 1e-6 * weights.sum() * np.eye(4)
        coefficients = np.linalg.solve(normal, weighted.T @ right)
        residual = outwards * (right - system @ coefficients)
        weights = np.where(residual > 0.0, 8.0, 1.0)
    t = np.clip(samples, 0.0, 1.0)
    return start + slope * t + basis(t) @ coefficients


def build_eyelids(
    mesh: TriMesh,
    margins: LidMargins,
    eye: TriMesh | None,
    eye_centre: FloatArray | None,
    *,
    parameters: LidParameters | None = None,
) -> Eyelids:
    """Bind the lids of one eye.

    Parameters
    ----------
    mesh : TriMesh
        Skin in the canonical frame.
    margins : LidMargins
        From `risorius.mesh.lids.find_lids`.
    eye : TriMesh or None
        The eyeball, if the head has one.
    eye_centre : (3,) float64 or None
        Its centre [mm].
    parameters : LidParameters, optional
    """
    p = parameters or LidParameters()
    inner, outer = mesh.positions[list(margins.slit.corners)]
    across = (outer - inner) / margins.width
    middle = 0.5 * (inner + outer)
    depth = p.axis_depth * margins.width
    centre = middle - [0.0, 0.0, depth]
    if eye_centre is not None and np.linalg.norm(eye_centre - centre) < margins.width:
        centre = eye_centre
    # The axis lies in the frontal direction of the corners; a turn about +x lowers what is ahead.
    axis = across if across[0] > 0 else -across
    axis = axis - [0.0, 0.0, axis[2]]
    axis /= np.linalg.norm(axis)
    up = np.cross([0.0, 0.0, 1.0], axis)
    arm = mesh.positions - centre
    pitch = np.arctan2(arm @ up, arm[:, 2])
    place = (mesh.positions - inner) @ across / margins.width
    upper_pitch, lower_pitch = (
        _contour(place[line], pitch[line], place, outwards=side)
        for line, side in ((margins.slit.upper, 1.0), (margins.slit.lower, -1.0))
    )
    opening = np.maximum(upper_pitch - lower_pitch, 0.0)
    on_upper = margins.upper
    inside = margins.slit.inside
    band = np.where(on_upper, p.upper_band, p.lower_band) * margins.height
    band = np.where(inside, p.inner_band * margins.height, band)
    flat = 0.06 * margins.height
    weight = 1.0 - smooth_step((margins.distance - flat) / np.maximum(band - flat, 1e-9))
    beyond = margins.distance - p.plate * margins.height
    lifted = 1.0 - smooth_step(beyond / np.maximum((p.crease - p.plate) * margins.height, 1e-9))
    lifted = np.where(on_upper & ~inside, lifted, weight)
    beside = np.clip(1.0 - np.maximum(-place, place - 1.0) / 0.12, 0.0, 1.0)
    near = smooth_step(beside) * (arm[:, 2] > 0.0) * np.isfinite(margins.distance)
    weight, lifted = near * np.nan_to_num(weight), near * np.nan_to_num(lifted)
    vertices = np.flatnonzero(np.maximum(weight, lifted) > 1e-6).astype(np.int32)
    meet = p.lower_share * opening
    # Towards the corners the lids come to rest, or their skin would fold over the canthus.
    ends = smooth_step(np.minimum(place, 1.0 - place) / p.corner_rest)
    closing = np.where(on_upper, opening - meet, -meet) * ends
    surface, floor = None, np.full(len(vertices), -np.inf)
    if eye is not None and eye_centre is not None and centre is eye_centre:
        surface = RadialSurface.of_mesh(eye, centre)
        rest = np.linalg.norm(arm[vertices], axis=1) - surface.radius(arm[vertices])
        floor = np.minimum(rest, p.clearance)
    return Eyelids(
        vertices, on_upper[vertices], place[vertices], weight[vertices], lifted[vertices],
        closing[vertices], opening[vertices], centre, axis, floor, surface, p,
    )  # fmt: skip
