"""Where a cut is painted, and in what colours and light. No Qt."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import moderngl

TILE = 16
"""Pixels across, and down, of the parts of a picture that more lines of sight are followed in."""

_HAIR_MASK = 0xF8F8F8F8
"""Of each colour, and of what tells faces apart, the steps of a byte from the eighth on."""

Rgb = tuple[float, float, float]
Rgba = tuple[float, float, float, float]


@dataclass(frozen=True, slots=True)
class RenderStyle:
    """Colours, 0 to 1, and light.

    Attributes:
        canvas: ground. stock: metal that was not cut, and sides. hatch: face of a section, and what is out of reach.
        paths: colours of paths by look. widths: px. dashes: period and drawn part, px; (0, 0) = solid.
        light: towards the light, as (right, up, towards the eye).
        strength: of the ambient light, of the light, of its mirror image.
        tools: colours of cutting parts, a cycle. steel, holder: of shanks and holders. edge: of what turns away from
            the eye.
        facets: of cylinders and of wedges.
        shadow: share of the canvas' light that does not reach the ground below the stock.
    """

    canvas: Rgb
    stock: Rgb
    hatch: Rgb
    paths: tuple[Rgba, Rgba, Rgba, Rgba]
    widths: tuple[float, float, float, float] = (1.2, 1.6, 1.8, 1.8)
    dashes: tuple[tuple[float, float], ...] = ((5.0, 2.0), (0.0, 0.0), (0.0, 0.0), (9.0, 5.5))
    light: Rgb = (-0.45, 0.62, 0.64)
    strength: Rgb = (0.36, 0.70, 0.10)
    tools: tuple[Rgb, ...] = ((0.0, 0.62, 0.45),)
    steel: Rgb = (0.74, 0.76, 0.79)
    holder: Rgb = (0.30, 0.32, 0.36)
    edge: Rgb = (0.12, 0.13, 0.15)
    shadow: float = 0.0
    facets: tuple[Rgb, Rgb] = ((0.34, 0.71, 0.91), (0.90, 0.62, 0.0))


@dataclass(frozen=True, slots=True)
class MetalTarget:
    """Where lines of sight are followed: colours and depths that can be looked up, in a size of their own.

    Attributes:
        uneven: 255 where colours differ from those next to them, so that more lines of sight may find more; after
            `find_uneven`; _found: the same, up to whole tiles.
    """

    framebuffer: moderngl.Framebuffer
    colours: moderngl.Texture
    depths: moderngl.Texture
    uneven: moderngl.Texture
    _found: NDArray[np.bool_]

    @staticmethod
    def made(ctx: moderngl.Context, size: tuple[int, int]) -> MetalTarget:
        """Return a new one, width and height in px."""
        colours, depths = ctx.texture(size, 4), ctx.depth_texture(size)
        for texture, filtering in ((colours, ctx.LINEAR), (depths, ctx.NEAREST)):
            texture.filter = (filtering, filtering)
            texture.repeat_x = texture.repeat_y = False
        depths.compare_func = ""
        uneven = ctx.texture(size, 1, alignment=1)
        uneven.filter = (ctx.NEAREST, ctx.NEAREST)
        return MetalTarget(
            ctx.framebuffer([colours], depths),
            colours,
            depths,
            uneven,
            np.zeros([-(-count // TILE) * TILE for count in size[::-1]], bool),
        )

    def find_uneven(self) -> None:
        """Find where colours differ by more than a hair from those next to them."""
        import cv2

        width, height = self.colours.size
        seen = np.frombuffer(self.colours.read(), np.uint8).reshape(height, width, 4)
        square = np.ones((3, 3), np.uint8)
        spread = np.asarray(cv2.absdiff(cv2.dilate(seen, square), cv2.erode(seen, square)))
        worst = spread.view(np.uint32)[..., 0] & np.uint32(_HAIR_MASK)
        self._found.fill(0)
        self._found[:height, :width] = worst > 0
        self.uneven.write(np.ascontiguousarray(self._found[:height, :width] * np.uint8(255)), alignment=1)

    def uneven_tiles(self, low: int, high: int) -> NDArray[np.float64]:
        """Return (n, 4) tiles that hold all places that are uneven: x0, y0, x1, y1, shares of the picture from the
        lower left.

        Args:
            low, high: first row, from below, that is asked for, and the one behind the last.
        """
        count = np.array(self._found.shape) // TILE
        held = self._found.reshape(count[0], TILE, count[1], TILE).any(axis=(1, 3))
        rows, columns = np.nonzero(held)
        asked = (rows * TILE < high) & ((rows + 1) * TILE > low)
        size = np.array(self.colours.size * 2, float)
        corners = np.column_stack([columns, rows, columns + 1, rows + 1])[asked] * TILE / size
        return np.asarray(np.minimum(corners, 1.0))

    def release(self) -> None:
        """Give the memory back."""
        for held in (self.framebuffer, self.colours, self.depths, self.uneven):
            held.release()


@dataclass(frozen=True, slots=True)
class RenderTarget:
    """Framebuffers of one size: painted into with one sample a pixel while things move and with several at rest, and
    shown.
    """

    quick: moderngl.Framebuffer
    smooth: moderngl.Framebuffer
    front: moderngl.Framebuffer
    held: tuple[moderngl.Renderbuffer, ...]

    @staticmethod
    def made(ctx: moderngl.Context, size: tuple[int, int], samples: int) -> RenderTarget:
        """Return new framebuffers.

        Args:
            ctx: the graphics context. size: width and height, px.
            samples: a pixel at rest, >= 0.
        """
        colours = [ctx.renderbuffer(size, 4, samples=count) for count in (0, samples, 0)]
        depths = [ctx.depth_renderbuffer(size, samples=count) for count in (0, samples)]
        quick, smooth = (ctx.framebuffer([colour], depth) for colour, depth in zip(colours[:2], depths, strict=True))
        return RenderTarget(quick, smooth, ctx.framebuffer([colours[2]]), (*colours, *depths))

    def release(self) -> None:
        """Give the memory back."""
        for framebuffer in (self.quick, self.smooth, self.front):
            framebuffer.release()
        for buffer in self.held:
            buffer.release()
