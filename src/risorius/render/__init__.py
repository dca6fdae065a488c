"""Headless pictures of heads: software rasteriser, overlays, contact sheets."""

from risorius.render.buffers import Buffers, buffers
from risorius.render.camera import Camera
from risorius.render.colours import display_rgb, heat_colours, heat_ramp, linear_rgb
from risorius.render.lights import Light, Lights
from risorius.render.materials import SKIN, colour_of_material, eye_paint, look_of_material
from risorius.render.overlay import Marker, Overlay, Polyline
from risorius.render.picture import BACKDROP, render
from risorius.render.png import read_png, write_png
from risorius.render.sheet import contact_sheet
from risorius.render.surface import Surface

__all__ = [
    "BACKDROP",
    "SKIN",
    "Buffers",
    "Camera",
    "Light",
    "Lights",
    "Marker",
    "Overlay",
    "Polyline",
    "Surface",
    "buffers",
    "colour_of_material",
    "contact_sheet",
    "display_rgb",
    "eye_paint",
    "heat_colours",
    "heat_ramp",
    "linear_rgb",
    "look_of_material",
    "read_png",
    "render",
    "write_png",
]
