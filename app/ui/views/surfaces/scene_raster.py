"""A scene as an image: shaded surfaces, lines over them, fainter where a surface hides them. No Qt."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from enum import Enum, Flag, auto

import numpy as np
from numpy.typing import NDArray

from ....model.scene import LineType
from ....usecases.scene.lines import LineRole, SceneLines
from ..cut.camera import Camera
from .shown_scene import ScenePicture

Floats = NDArray[np.float64]
Rgb = tuple[int, int, int]


class SceneLayer(Flag):
    """What can be shown and hidden."""

    SURFACES = auto()
    PATHS = auto()
    LINKS = auto()
    RAPIDS = auto()
    POINTS = auto()
    NAMES = auto()
    ALL = SURFACES | PATHS | LINKS | RAPIDS | POINTS | NAMES


class SceneColourBy(Enum):
    """What tells paths apart."""

    SURFACE = "surface"
    TOOL = "tool"
    LINE = "line"


LAYER_OF = {
    LineRole.SURFACE: SceneLayer.PATHS,
    LineRole.PATH: SceneLayer.PATHS,
    LineRole.LINK: SceneLayer.LINKS,
    LineRole.RAPID: SceneLayer.RAPIDS,
    LineRole.PLUNGE: SceneLayer.RAPIDS,
    LineRole.TIP: SceneLayer.PATHS,
}
_WIDTHS = {
    LineRole.SURFACE: 1.0,
    LineRole.PATH: 1.6,
    LineRole.LINK: 0.9,
    LineRole.RAPID: 1.0,
    LineRole.PLUNGE: 1.4,
    LineRole.TIP: 1.2,
}
_DOTS = (1.0, 3.0, 1.0, 3.0)
PATTERNS: Mapping[LineType, tuple[float, ...]] = {
    LineType.SOLID: (0.0,) * 4,
    LineType.DOTTED: (2.0, 3.0, 2.0, 3.0),
    LineType.CHAIN: (9.0, 3.0, 2.0, 3.0),
}
"""Dash and gap, twice, px."""
SURFACE_STRENGTH = 0.55
"""How strongly surfaces are coloured: paths in the full colour are to be seen on them."""
_HIDDEN, _BEHIND = 0.22, 0.35
"""What is left of a line behind a surface; px that count as behind."""
_SAMPLES, _FINE_RATIO = 2, 1.5
"""So many samples each way for a pixel of surfaces, unless the screen's own pixels are fine enough."""
_LEAST_PX, _COARSE_PX = 0.3, 1.5
"""Steps of lines that are shorter are left out: of a picture that stands, and of one on the move."""
_DENSE_PX, _FAINTEST = 4.0, 0.18
"""Passes nearer together than this are drawn fainter, so that the surface is seen between them; down to this."""


@dataclass(frozen=True)
class SceneColours:
    """Colours, (red, green, blue), 0 to 255.

    Attributes:
        ground, ink, rapid, plunge: of the theme. surfaces: by number. tools: by T number. lines: line type of each
            surface.
    """

    ground: Rgb
    ink: Rgb
    rapid: Rgb
    plunge: Rgb
    surfaces: Sequence[Rgb] = ()
    tools: Mapping[int, Rgb] = field(default_factory=dict)
    lines: Sequence[LineType] = ()


@dataclass(frozen=True, eq=False)
class SceneRaster:
    """An image and what is where in it.

    Attributes:
        pixels: (h, w, 4) uint8, blue, green, red, 255. depths: (h, w) mm towards the eye, -inf where no surface is.
        owners: (h, w) number of the surface, -1 where none is. pieces: how many straight pieces of lines were drawn.
    """

    pixels: NDArray[np.uint8]
    depths: NDArray[np.float32]
    owners: NDArray[np.int16]
    pieces: int


@dataclass(frozen=True)
class SceneStyle:
    """How a scene is painted: from where, with which colours, and what of it.

    Attributes:
        ratio: px of the picture for each of the window. coarse: the picture is on the move, and quick rather than fine.
    """

    camera: Camera
    inks: SceneColours
    layers: SceneLayer = SceneLayer.ALL
    colour_by: SceneColourBy = SceneColourBy.SURFACE
    ratio: float = 1.0
    coarse: bool = False


def raster(picture: ScenePicture, style: SceneStyle, size: tuple[int, int]) -> SceneRaster:
    """Return a picture painted; `size` is width and height, px of the screen."""
    from . import picture_kernels as kernels

    wide, high = size
    frame = frame_of(style.camera, size, style.ratio)
    pixels = np.empty((high, wide, 4), np.uint8)
    pixels[:] = (*style.inks.ground[::-1], 255)
    depths, owners = np.full((high, wide), -np.inf, np.float32), np.full((high, wide), -1, np.int16)
    if SceneLayer.SURFACES in style.layers and len(picture.triangles):
        times = 1 if style.coarse or style.ratio >= _FINE_RATIO else _SAMPLES
        fine = (times * high, times * wide)
        fine_frame = frame_of(style.camera, fine[::-1], times * style.ratio)
        fine_depths, fine_owners = np.full(fine, -np.inf, np.float32), np.full(fine, -1, np.int16)
        lights, shown = np.zeros(fine, np.float32), np.ones(int(picture.owner.max()) + 1, np.bool_)
        kernels.fill(picture.triangles, picture.owner, shown, fine_frame, fine_depths, fine_owners, lights)
        own = picture.compound and style.colour_by is SceneColourBy.SURFACE
        inks = np.array([(style.inks.surfaces[n] if own else style.inks.rapid)[::-1] for n in range(len(shown))])
        kernels.tint(
            fine_depths, fine_owners, lights, inks.astype(np.float64), SURFACE_STRENGTH, depths, owners, pixels
        )
    pieces = 0
    for each in picture.strands:
        if LAYER_OF[each.role] in style.layers:
            pieces += kernels.draw_lines(
                each.points, each.joined, frame, _pen(each, style, picture.pitch), depths, pixels
            )
    return SceneRaster(pixels, depths, owners, pieces)


def frame_of(camera: Camera, size: tuple[int, int], ratio: float) -> Floats:
    """Return what a camera sees as the kernels want it, see `picture_kernels`."""
    return np.array([*camera.axes.ravel(), *camera.target, camera.scale * ratio, *size], np.float64)


def _pen(each: SceneLines, style: SceneStyle, pitch: float) -> Floats:
    inks, by = style.inks, style.colour_by
    on = each.surface >= 0
    pattern = PATTERNS[LineType.SOLID]
    if each.role in (LineRole.RAPID, LineRole.PLUNGE):
        ink = inks.rapid if each.role is LineRole.RAPID else inks.plunge
        pattern = _DOTS if each.role is LineRole.RAPID else pattern
    elif by is SceneColourBy.LINE:
        ink = inks.ink
        pattern = PATTERNS[inks.lines[each.surface]] if on else _DOTS
    elif by is SceneColourBy.TOOL and each.tool:
        ink = inks.tools[each.tool]
    else:
        ink = inks.surfaces[each.surface] if on else inks.rapid
    if each.role is LineRole.TIP:
        pattern = _DOTS
    if each.role is LineRole.SURFACE:
        ink = tuple(round(0.55 * ground + 0.45 * value) for ground, value in zip(inks.ground, ink, strict=True))  # type: ignore[assignment]
    ratio, dense = style.ratio, min(max(pitch * style.camera.scale / _DENSE_PX, _FAINTEST), 1.0)
    strength = dense if each.role in (LineRole.PATH, LineRole.LINK) else 1.0
    return np.array(
        [
            *ink[::-1],
            _WIDTHS[each.role] * ratio,
            *(length * ratio for length in pattern),
            _HIDDEN,
            _BEHIND / style.camera.scale + 1e-4,
            strength,
            _COARSE_PX if style.coarse else _LEAST_PX,
        ]
    )
