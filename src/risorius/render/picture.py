"""Draw surfaces into a picture, without display or graphics card."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from risorius._check import FloatArray, as_number
from risorius.errors import ParameterError, ShapeError
from risorius.render.bands import in_bands
from risorius.render.buffers import nearest, transparent_layers
from risorius.render.camera import Camera, picture_size
from risorius.render.colours import encode_srgb, linear_rgb
from risorius.render.kernels.occlusion import occlude, reduce_depth, soften, spiral
from risorius.render.kernels.shade import shade
from risorius.render.lights import Lights
from risorius.render.overlay import Overlay, draw_overlay
from risorius.render.scene import Float32Array, Scene, gather
from risorius.render.surface import Surface

__all__ = ["BACKDROP", "OCCLUSION_SHARE", "render"]

BACKDROP: FloatArray = np.array([linear_rgb("#4b525c"), linear_rgb("#23262b")])
"""Default background, top and bottom (2, 3)."""
BACKDROP.flags.writeable = False

_TRANSPARENT_LAYERS = 6
OCCLUSION_SHARE = 0.05
"""Default radius of occlusion, share of the diagonal of what is drawn."""

_LIFT_SHARE = 0.004
_SPIRAL = spiral()
_SRGB = 255.0 * encode_srgb(np.linspace(0.0, 1.0, 4097))


def render(
    surfaces: Sequence[Surface],
    camera: Camera,
    *,
    size: tuple[int, int],
    supersample: int = 2,
    background: npt.ArrayLike = BACKDROP,
    lights: Lights | None = None,
    overlays: Sequence[Overlay] = (),
) -> npt.NDArray[np.uint8]:
    """Draw `surfaces` as `camera` sees them; the same input gives the same bytes.

    Parameters
    ----------
    surfaces : sequence of Surface
        What is drawn; may be empty.
    camera : Camera
        Where it is seen from.
    size : (width, height)
        Of the picture [pixels].
    supersample : int
        Samples per pixel and direction, 1..4; a pixel is the mean of its samples.
    background : (3,) or (2, 3) array_like
        Linear RGB in 0..1, of the whole or of top and bottom.
    lights : Lights, optional
        Default: ``Lights()``.
    overlays : sequence of Overlay
        Lines and dots, drawn in this order.

    Returns
    -------
    (height, width, 3) uint8
        sRGB.

    Notes
    -----
    Of transparent surfaces the six nearest layers are drawn; they neither hide overlays nor
    occlude each other. Cost grows with the samples, ``width * height * supersample**2``, and
    the number of triangles.
    """
    width, height = picture_size(size)
    step = int(as_number("supersample", supersample, low=1, high=4))
    if step != supersample:
        raise ParameterError(f"supersample: {supersample!r} is not a whole number")
    backdrop = _background_rows(background, height)
    lights = Lights() if lights is None else lights
    scene = gather(surfaces, camera, (width * step, height * step))
    inverse_depth, face = nearest(scene, 0, scene.opaque_face_count)
    layers, layer_rows = transparent_layers(scene, inverse_depth, _TRANSPARENT_LAYERS)
    radius = lights.occlusion_radius
    radius = OCCLUSION_SHARE * scene.diagonal if radius is None else radius
    occlusion = lights.occlusion if radius > 0.0 else 0.0
    depth, open_sky = np.zeros((1, 1), np.float32), np.ones((1, 1), np.float32)
    if occlusion > 0.0:
        depth, open_sky = _open_sky(
            scene, inverse_depth, face, step=step, focal=camera.focal(height), radius=radius
        )
    picture = np.empty((height, width, 3), np.float32)
    in_bands(
        shade,
        range(height),
        *(step, face, layers, layer_rows.start, layer_rows.stop, inverse_depth),
        *(scene.edges, scene.volume),
        *(scene.face_surface, scene.materials, scene.normals, scene.normal_rows),
        *(scene.colours, scene.colour_rows, scene.ramps),
        *(lights.rows(), np.array(lights.sky), np.array(lights.ground)),
        *(depth, open_sky, occlusion, radius, camera.focal(height * step)),
        *(backdrop, _SRGB, picture),
    )
    scratch = np.zeros((height, width), np.float32)
    lift = _LIFT_SHARE * scene.diagonal if overlays else 0.0
    for overlay in overlays:
        draw_overlay(overlay, camera, picture, inverse_depth, lift=lift, scratch=scratch)
    return np.rint(picture).astype(np.uint8)


def _open_sky(
    scene: Scene,
    inverse_depth: Float32Array,
    face: npt.NDArray[np.int32],
    *,
    step: int,
    focal: float,
    radius: float,
) -> tuple[Float32Array, Float32Array]:
    """Return depth [mm] and open sky (1 = nothing near hides it) of each pixel."""
    height, width = face.shape[0] // step, face.shape[1] // step
    rows = range(height)
    depth = np.empty((height, width), np.float32)
    normal = np.zeros((height, width, 3), np.float32)
    open_sky, half = np.empty_like(depth), np.empty_like(depth)
    in_bands(
        reduce_depth,
        rows,
        *(step, inverse_depth, face, scene.edges, scene.volume),
        *(scene.normals, scene.normal_rows, depth, normal),
    )
    in_bands(occlude, rows, depth, normal, focal, radius, _SPIRAL, open_sky)
    in_bands(soften, rows, depth, radius, False, open_sky, half)
    in_bands(soften, rows, depth, radius, True, half, open_sky)
    return depth, open_sky


def _background_rows(background: npt.ArrayLike, height: int) -> FloatArray:
    colour = np.asarray(background, dtype=np.float64)
    if colour.shape not in ((3,), (2, 3)):
        raise ShapeError(f"background: expected shape (3,) or (2, 3), got {colour.shape}")
    if not ((colour >= 0.0) & (colour <= 1.0)).all():
        raise ParameterError("background: linear colours lie in 0..1")
    top, bottom = colour.reshape(-1, 3)[[0, -1]]
    share = ((np.arange(height) + 0.5) / height)[:, None]
    return top + share * (bottom - top)
