# pyright: basic
# ruff: noqa: PLR0913, PLR0915, PLR0917
"""The colour of every pixel: reflected light, layers, the mean over the samples."""

import math

import numpy as np
from numba import njit

from risorius.render.kernels.occlusion import blended, corner_shares

__all__ = ["shade"]

_BACK = 0.35
_WRAP = 0.30
# One sample does for pixels whose depths differ by less than this share of what counts as even,
# and whose faces have normals with at least this cosine between them.
_FLAT = 0.5
_STRAIGHT = 0.9


@njit(cache=True, nogil=True, error_model="numpy")
def _albedo(colours, rows, u, v, w, ramps, ramp_first, ramp_size):
    """Return the blended colour, or the entry of its ramp that the blended numbers name.

    A negative size says that they are a vector, and its angle from +Z the place.
    """
    red, green, blue = blended(colours, rows, u, v, w)
    if ramp_size == 0:
        return red, green, blue
    if ramp_size < 0:
        ramp_size = -ramp_size
        red = math.atan2(math.sqrt(red * red + green * green), blue) / math.pi
    place = min(max(red, 0.0), 1.0) * (ramp_size - 1)
    low = min(int(place), max(ramp_size - 2, 0))
    high = min(low + 1, ramp_size - 1)
    part = place - low
    i, j = ramp_first + low, ramp_first + high
    return (
        ramps[i, 0] + part * (ramps[j, 0] - ramps[i, 0]),
        ramps[i, 1] + part * (ramps[j, 1] - ramps[i, 1]),
        ramps[i, 2] + part * (ramps[j, 2] - ramps[i, 2]),
    )


@njit(cache=True, nogil=True, error_model="numpy")
def _reflected(albedo, normal, view, specular, gloss, lights, sky, ground, open_sky, is_back):
    """Return the light that leaves towards the eye, linear RGB.

    Diffuse light wraps around the terminator in the tint of the albedo (a cheap stand-in for
    light that travels through skin); highlights are Blinn's with Schlick's Fresnel factor.
    """
    nx, ny, nz = normal
    vx, vy, vz = view
    facing = max(nx * vx + ny * vy + nz * vz, 0.0)
    rise = 0.5 - 0.5 * ny
    strongest = max(albedo[0], albedo[1], albedo[2], 1e-6)
    tint = (albedo[0] / strongest, albedo[1] / strongest, albedo[2] / strongest)
    # Occluded light has bounced off the same stuff: folds go warm before they go dark.
    dim = 0.4 * (1.0 - open_sky)
    sky_red = open_sky * (1.0 - dim * (1.0 - tint[0]))
    sky_green = open_sky * (1.0 - dim * (1.0 - tint[1]))
    sky_blue = open_sky * (1.0 - dim * (1.0 - tint[2]))
    direct = 0.05 + 0.95 * open_sky
    red = sky_red * (ground[0] + rise * (sky[0] - ground[0]))
    green = sky_green * (ground[1] + rise * (sky[1] - ground[1]))
    blue = sky_blue * (ground[2] + rise * (sky[2] - ground[2]))
    base = 0.08 * specular
    power = 2.0 ** (2.0 + 8.0 * gloss)
    shine_red = shine_green = shine_blue = 0.0
    for k in range(lights.shape[0]):
        lx, ly, lz = lights[k, 0], lights[k, 1], lights[k, 2]
        cosine = nx * lx + ny * ly + nz * lz
        hard = max(cosine, 0.0)
        soft = max((cosine + _WRAP) / (1.0 + _WRAP), 0.0) ** 2
        extra = max(soft - hard, 0.0)
        red += direct * lights[k, 3] * (hard + extra * tint[0])
        green += direct * lights[k, 4] * (hard + extra * tint[1] ** 2)
        blue += direct * lights[k, 5] * (hard + extra * tint[2] ** 2)
        if hard > 0.0 and base > 0.0:
            hx, hy, hz = lx + vx, ly + vy, lz + vz
            length = math.sqrt(hx * hx + hy * hy + hz * hz) + 1e-30
            along = max((nx * hx + ny * hy + nz * hz) / length, 0.0)
            if power * (1.0 - along) > 12.0:
                continue
            away = 1.0 - min(max((vx * hx + vy * hy + vz * hz) / length, 0.0), 1.0)
            fresnel = base + (1.0 - base) * away**5 * specular
            lobe = direct * hard * fresnel * (power + 8.0) / 8.0 * along**power
            shine_red += lobe * lights[k, 3]
            shine_green += lobe * lights[k, 4]
            shine_blue += lobe * lights[k, 5]
    # The sky mirrored at grazing angles gives cheeks and eyes their sheen.
    sheen = (base + (1.0 - base) * specular * 0.35 * (1.0 - facing) ** 5) * open_sky
    up = 0.5 - 0.5 * (2.0 * facing * ny - vy)
    shine_red += sheen * (ground[0] + up * (sky[0] - ground[0]))
    shine_green += sheen * (ground[1] + up * (sky[1] - ground[1]))
    shine_blue += sheen * (ground[2] + up * (sky[2] - ground[2]))
    red, green, blue = albedo[0] * red, albedo[1] * green, albedo[2] * blue
    if is_back:
        return _BACK * red, _BACK * green, _BACK * blue
    return red + shine_red, green + shine_green, blue + shine_blue


@njit(cache=True, nogil=True, error_model="numpy")
def _rolled_off(value):
    """Return `value` with highlights above 0.6 bent softly towards 1."""
    if value <= 0.6:
        return value
    return 1.0 - 0.4 * math.exp((0.6 - value) / 0.4)


@njit(cache=True, nogil=True, error_model="numpy")
def _encoded(value, encoding):
    """Return the table `encoding` over 0..1 at `value`, blended between its entries."""
    place = min(max(value, 0.0), 1.0) * (encoding.shape[0] - 1)
    low = min(int(place), encoding.shape[0] - 2)
    return encoding[low] + (place - low) * (encoding[low + 1] - encoding[low])


@njit(cache=True, nogil=True, error_model="numpy")
def _sky_at(sy, sx, step, inverse_depth, depth, open_sky, radius):
    """Return the open sky of the pixel near the sample whose depth matches best.

    A sample far behind all of them looks out of a slit narrower than a pixel: it is dark.
    """
    y, x = sy // step, sx // step
    z = 1.0 / inverse_depth
    best, best_gap = open_sky[y, x], abs(depth[y, x] - z)
    if best_gap <= 0.1 * radius:
        return best
    height, width = depth.shape
    for qy in range(max(y - 1, 0), min(y + 2, height)):
        for qx in range(max(x - 1, 0), min(x + 2, width)):
            gap = abs(depth[qy, qx] - z)
            if gap < best_gap:
                best, best_gap = open_sky[qy, qx], gap
    return best * min(max(1.5 - best_gap / radius, 0.0), 1.0)


@njit(cache=True, nogil=True, error_model="numpy")
def _stride(y, x, step, face, face_surface, materials, inverse_depth, gap, normals, normal_rows):
    """Return how many samples of the pixel may be passed over after one that is shaded.

    None, unless all see one plain surface at about one depth, within `gap`: then the first and
    the last tell the rest; where they hardly differ, the first alone.
    """
    first = face[y * step, x * step]
    if first < 0:
        return 1
    surface = face_surface[first]
    if materials[surface, 3] == 0.0:
        return 1
    middle = normals[normal_rows[first, 0]]
    bent = False
    low = high = inverse_depth[y * step, x * step]
    for sy in range(y * step, y * step + step):
        for sx in range(x * step, x * step + step):
            f = face[sy, sx]
            low, high = min(low, inverse_depth[sy, sx]), max(high, inverse_depth[sy, sx])
            if f == first:
                continue
            if f < 0 or face_surface[f] != surface:
                return 1
            other = normals[normal_rows[f, 0]]
            along = middle[0] * other[0] + middle[1] * other[1] + middle[2] * other[2]
            bent = bent or along < _STRAIGHT
    apart = high - low
    if apart > gap * low * high:
        return 1
    return step * step - (1 if bent or apart > _FLAT * gap * low * high else 0)


@njit(cache=True, nogil=True, error_model="numpy")
def _is_veiled(y, x, step, layer):
    """Whether a sample of the pixel sees something transparent."""
    for sy in range(y * step, y * step + step):
        for sx in range(x * step, x * step + step):
            if layer[sy, sx] >= 0:
                return True
    return False


@njit(cache=True, nogil=True, error_model="numpy")
def shade(
    row_from,
    row_to,
    step,
    face,
    layers,
    layer_from,
    layer_to,
    inverse_depth,
    edges,
    volume,
    face_surface,
    materials,
    normals,
    normal_rows,
    colours,
    colour_rows,
    ramps,
    lights,
    sky,
    ground,
    depth,
    open_sky,
    occlusion,
    radius,
    focal,
    background,
    encoding,
    picture,
):
    """Write `picture` (h, w, 3) on the scale of `encoding` for a band of rows.

    `face` (h step, w step) is what each sample sees of the opaque surfaces, `layers` what it
    sees of transparent ones, nearest first, in the rows from `layer_from` to `layer_to`.
    `materials` rows are specular, gloss, opacity, whether plain, first row and size of the
    ramp. Where all samples of a pixel see one plain surface and nothing transparent before it,
    only some are shaded.
    """
    rows, columns = face.shape
    half_w, half_h = 0.5 * columns - 0.5, 0.5 * rows - 0.5
    for y in range(row_from, row_to):
        has_layers = layers.shape[0] and layer_from < (y + 1) * step and layer_to > y * step
        for x in range(picture.shape[1]):
            red = green = blue = 0.0
            skip = 1
            if step > 1 and not (has_layers and _is_veiled(y, x, step, layers[0])):
                gap = 0.1 * radius
                skip = _stride(
                    y, x, step, face, face_surface, materials, inverse_depth, gap,
                    normals, normal_rows,
                )  # fmt: skip
            share = 1.0 / ((step * step - 1) // skip + 1)
            for sample in range(0, step * step, skip):
                sy, sx = y * step + sample // step, x * step + sample % step
                px, py = sx - half_w, sy - half_h
                left = share
                away = -1.0 / math.sqrt(px * px + py * py + focal * focal)
                view = (px * away, py * away, focal * away)
                depth_count = layers.shape[0] if layer_from <= sy < layer_to else 0
                for layer in range(depth_count + 1):
                    f = face[sy, sx] if layer == depth_count else layers[layer, sy, sx]
                    if f < 0:
                        continue
                    look = materials[face_surface[f]]
                    u, v, w = corner_shares(edges[f], px, py)
                    albedo = _albedo(
                        colours, colour_rows[f], u, v, w, ramps, int(look[4]), int(look[5])
                    )
                    nx, ny, nz = blended(normals, normal_rows[f], u, v, w)
                    is_back = volume[f] > 0.0
                    scale = 1.0 / (math.sqrt(nx * nx + ny * ny + nz * nz) + 1e-30)
                    if is_back:
                        scale = -scale
                    normal = (nx * scale, ny * scale, nz * scale)
                    seen = cover = 1.0
                    if layer < depth_count:
                        facing = normal[0] * view[0] + normal[1] * view[1] + normal[2] * view[2]
                        cover = 1.0 - (1.0 - look[2]) ** (1.0 / max(abs(facing), 0.12))
                    elif occlusion > 0.0:
                        near = inverse_depth[sy, sx]
                        seen = _sky_at(sy, sx, step, near, depth, open_sky, radius)
                        seen = 1.0 - occlusion * (1.0 - seen)
                    light = _reflected(
                        albedo, normal, view, look[0], look[1], lights, sky, ground, seen, is_back
                    )
                    part = left * cover
                    red += part * _rolled_off(light[0])
                    green += part * _rolled_off(light[1])
                    blue += part * _rolled_off(light[2])
                    left -= part
                    if left <= 0.0:
                        break
                red += left * background[y, 0]
                green += left * background[y, 1]
                blue += left * background[y, 2]
            picture[y, x, 0] = np.float32(_encoded(red, encoding))
            picture[y, x, 1] = np.float32(_encoded(green, encoding))
            picture[y, x, 2] = np.float32(_encoded(blue, encoding))
