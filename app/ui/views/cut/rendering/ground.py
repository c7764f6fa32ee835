"""The soft shadow of the stock on what it lies on. No Qt."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from .....simulation.gpu.graphics import compiled
from ..camera import Floats
from .cut_frame import CutFrame
from .render_target import MetalTarget
from .stock_textures import Rectangle

if TYPE_CHECKING:
    import moderngl

_BLUR = 0.06
"""How far a shadow reaches on either side of a border, of the stock's longer side."""

_FLATTEST = 0.05
"""Height of the eye over the horizon, as a sine, below which nobody sees the ground."""


@dataclass(frozen=True, slots=True)
class Foot:
    """What stands on the ground: x0, y0, x1, y1, and the height of the ground, mm."""

    sides: Rectangle
    z: float


def shadow_reach(frame: CutFrame, sides: Rectangle) -> float:
    """Return how far beyond the sides of a foot there is shadow, mm; 0 = none is seen."""
    sees = frame.look.shadow > 0.0 and frame.camera.axes[2][2] >= _FLATTEST
    return _BLUR * max(sides[2] - sides[0], sides[3] - sides[1]) if sees else 0.0


class GroundShadow:
    """Darkens the canvas round the stock's foot, seen from above."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx = ctx
        self._program = compiled(ctx, "part.vert", "ground.frag", "GROUND")
        self._parts = ctx.buffer(reserve=16)
        self._array = ctx.vertex_array(self._program, [(self._parts, "4f4/i", "part")])

    def draw(self, frame: CutFrame, foot: Foot, plain: MetalTarget | None) -> None:
        """Paint it into the framebuffer in use, which has just been cleared.

        Args:
            frame: how it is looked at. foot: of what stands on the ground. plain: see `StockTextures.draw`.
        """
        blur = shadow_reach(frame, foot.sides)
        if blur <= 0.0:
            return
        low, high = np.array(foot.sides[:2]), np.array(foot.sides[2:])
        if frame.section is not None:  # what is taken away throws none
            axis = int(abs(frame.section.normal[1]) > abs(frame.section.normal[0]))
            sign = frame.section.normal[axis]
            end = low if sign < 0 else high
            end[axis] = np.clip(sign * frame.section.offset, low[axis], high[axis])
        self._set_uniforms(frame, replace(foot, sides=(*low.tolist(), *high.tolist())), blur)
        parts = _area(frame, low - blur, high + blur, foot.z)[None]
        self._program["finer"] = int(plain is not None)
        if plain is not None:
            rows = np.round(parts[0, [1, 3]] * plain.colours.size[1]).astype(int).tolist()
            parts = plain.uneven_tiles(*rows)
            plain.uneven.use(0)
            self._program["uneven"] = 0
        self._ctx.enable_only(self._ctx.NOTHING)
        self._parts.orphan(max(parts.nbytes // 2, 16))
        self._parts.write(np.ascontiguousarray(parts, "f4").tobytes())
        self._array.render(self._ctx.TRIANGLE_STRIP, vertices=4, instances=len(parts))

    def _set_uniforms(self, frame: CutFrame, foot: Foot, blur: float) -> None:
        camera, program = frame.camera, self._program
        across, down = (size / rays for size, rays in zip(frame.size, frame.rays, strict=True))
        values = {
            "eye": tuple(camera.ray((0.0, frame.size[1]), frame.size).origin),
            "right": tuple(camera.axes[0] * across / camera.scale),
            "up": tuple(camera.axes[1] * down / camera.scale),
            "away": tuple(-camera.axes[2]),
            "ground_z": foot.z,
            "sides": foot.sides,
            "blur": blur,
            "canvas": frame.look.canvas,
            "dark": frame.look.shadow,
        }
        for name, value in values.items():
            program[name] = value

    def release(self) -> None:
        """Give everything back to the graphics system."""
        for held in (self._array, self._parts, self._program):
            held.release()


def _area(frame: CutFrame, low: Floats, high: Floats, z: float) -> Floats:
    """Return where a rectangle of the ground is seen: x0, y0, x1, y1, shares of the picture from the lower left."""
    corners = np.array([(x, y, z) for x in (low[0], high[0]) for y in (low[1], high[1])])
    seen = frame.camera.project(corners, frame.size)[:, :2] / frame.size
    seen[:, 1] = 1.0 - seen[:, 1]
    return np.asarray(np.clip(np.concatenate([seen.min(axis=0), seen.max(axis=0)]), 0.0, 1.0))
