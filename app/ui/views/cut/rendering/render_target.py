"""Where a cut is painted, and in what colours and light. No Qt."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import moderngl

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
    facets: tuple[Rgb, Rgb] = ((0.34, 0.71, 0.91), (0.90, 0.62, 0.0))


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
