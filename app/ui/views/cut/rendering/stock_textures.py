"""One field of heights on the graphics side: its top, its sides, its floor. No Qt."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from .....simulation.gpu.graphics import compiled
from ..camera import Floats
from ..cell_patch import CellPatch
from ..cut_picture import CutPicture
from .cut_frame import CLIP_PLANES, CutFrame, section_ends

if TYPE_CHECKING:
    import moderngl

BAND_QUADS = 30_000
"""Squares that are painted before somebody else may do something."""

Hole = tuple[float, float, float, float]
NO_HOLE: Hole = (1.0, 1.0, -1.0, -1.0)
"""x0, y0, x1, y1 of what is not painted, mm; an empty one."""

_HEIGHTS, _VALUES, _PALETTE, _RELIEF = 0, 1, 2, 3
_SHARP = 0.7
"""Where a cell is wider than so many px, its neighbours need not be averaged."""


@dataclass(frozen=True, eq=False)
class StockShaders:
    """How metal is painted: its top, whole or with something taken away, its sides and its floor; each with an empty
    array.
    """

    whole: moderngl.Program
    clipped: moderngl.Program
    wall: moderngl.Program
    floor: moderngl.Program
    bare: dict[moderngl.Program, moderngl.VertexArray]

    @staticmethod
    def made(ctx: moderngl.Context) -> StockShaders:
        """Compile them.

        Raises:
            moderngl.Error: the graphics system does not take them.
        """
        parts = (("field", "TOP"), ("field", "TOP_CLIPPED"), ("wall", "SIDE"), ("floor", "UNDERSIDE"))
        whole, clipped, wall, floor = (compiled(ctx, f"{name}.vert", "metal.frag", part) for name, part in parts)
        return StockShaders(
            whole, clipped, wall, floor, {each: ctx.vertex_array(each, []) for each in (whole, clipped, wall, floor)}
        )

    def release(self) -> None:
        """Give everything back to the graphics system."""
        for program, array in self.bare.items():
            array.release()
            program.release()


class StockTextures:
    """Heights and colours of one picture as textures."""

    def __init__(self, ctx: moderngl.Context, programs: StockShaders, palette: moderngl.Texture) -> None:
        self._ctx, self._programs, self._palette = ctx, programs, palette
        self._picture: CutPicture | None = None
        self._range, self._averaged = (0.0, 0.0), True
        self._heights = ctx.texture((1, 1), 1, dtype="f4")
        self._values, self._relief = (ctx.texture((1, 1), bands) for bands in (1, 4))

    def fill(self, picture: CutPicture) -> None:
        """Take heights over; colours stay until others come."""
        ctx, self._picture = self._ctx, picture
        self._heights = self._filled(self._heights, picture.heights)
        self._heights.filter = (ctx.LINEAR, ctx.LINEAR)
        self._relief = self._filled(self._relief, picture.relief)
        self._relief.build_mipmaps()
        self._range, self._averaged = (picture.lowest, picture.highest), True

    def patch(self, patch: CellPatch) -> None:
        """Take other heights, relief and colours over for a rectangle of cells; after `fill` and `colour`."""
        low, high = self._range
        self._range = min(low, float(patch.heights.min())), max(high, float(patch.heights.max()))
        place = (patch.col, patch.row, patch.heights.shape[1], patch.heights.shape[0])
        for texture, data in (
            (self._heights, patch.heights),
            (self._relief, patch.relief),
            (self._values, patch.values),
        ):
            texture.write(np.ascontiguousarray(data), viewport=place, alignment=1)
        self._averaged = False

    def colour(self, values: NDArray[np.uint8]) -> None:
        """Take over the place of each cell in the palette."""
        self._values = self._filled(self._values, values)
        self._values.filter = (self._ctx.NEAREST, self._ctx.NEAREST)

    def draw(self, frame: CutFrame, reach: float, hole: Hole = NO_HOLE) -> Iterator[None]:
        """Paint into the framebuffer in use, piece by piece; nothing before `fill`.

        Args:
            frame: how it is looked at.
            reach: nothing is farther than this from the camera's target, mm.
            hole: what somebody else paints.
        """
        picture, programs = self._picture, self._programs
        if picture is None:
            return
        for program in programs.bare:
            self._set_uniforms(program, frame, picture, reach)
            if "hole" in program:
                program["hole"] = hole
        self._begin()
        self._draw_walls(frame, picture)
        if frame.camera.pitch < 0:
            programs.bare[programs.floor].render(self._ctx.TRIANGLE_STRIP, vertices=4)
        has_holes = self._range[0] <= picture.floor or frame.section is not None or hole is not NO_HOLE
        yield from self._draw_top(frame, picture, programs.clipped if has_holes else programs.whole)

    def release(self) -> None:
        """Give everything back to the graphics system."""
        for held in (self._heights, self._values, self._relief):
            held.release()

    def _draw_top(self, frame: CutFrame, picture: CutPicture, field: moderngl.Program) -> Iterator[None]:
        ctx, array = self._ctx, self._programs.bare[field]
        (column, row), (last_column, last_row) = frame.seen_cells(picture, self._range[1])
        stride = frame.stride(picture, (last_column - column) * (last_row - row))
        across, along = -(-(last_column - column) // stride), -(-(last_row - row) // stride)
        sharp = picture.pitch * frame.camera.scale > _SHARP
        if not (sharp or self._averaged or frame.budget):
            self._relief.build_mipmaps()
            self._averaged = True
        self._relief.filter = (ctx.LINEAR if sharp or not self._averaged else ctx.LINEAR_MIPMAP_NEAREST, ctx.LINEAR)
        field["stride"], field["last"] = stride, (last_column, last_row)
        band = max(1, BAND_QUADS // max(across, 1))
        for begin in range(0, along, band):
            self._begin()
            field["first"] = (column, row + begin * stride)
            array.render(ctx.TRIANGLE_STRIP, vertices=2 * (across + 1), instances=min(band, along - begin))
            if begin + band < along:
                ctx.finish()
                yield None

    def _draw_walls(self, frame: CutFrame, picture: CutPicture) -> None:
        """Paint the sides that face the eye, and the face of the section."""
        wall, low, high = self._programs.wall, picture.low, picture.high
        corners = [(low[0], low[1]), (high[0], low[1]), (high[0], high[1]), (low[0], high[1])]
        coarse = frame.stride(picture, picture.heights.size)
        facings = ((0.0, -1.0), (1.0, 0.0), (0.0, 1.0), (-1.0, 0.0))
        for k, facing in enumerate(facings):
            if np.dot(facing, frame.camera.axes[2, :2]) > 0:
                self._draw_wall(
                    corners[k],
                    corners[(k + 1) % 4],
                    facing,
                    (picture.columns if k % 2 == 0 else picture.rows) // coarse,
                )
        ends = section_ends(frame.section, low, high) if frame.section is not None else None
        if frame.section is not None and ends is not None:
            wall["face"] = 1
            wall["section"] = (0.0, 0.0, 0.0)
            self._draw_wall(*ends, frame.section.normal, (picture.columns + picture.rows) // coarse)
            wall["face"] = 0
            wall["section"] = frame.clip

    def _draw_wall(
        self, begin: tuple[float, float], end: tuple[float, float], facing: tuple[float, float], pieces: int
    ) -> None:
        wall = self._programs.wall
        wall["begin"], wall["end"] = begin, end
        wall["facing"] = (*facing, 0.0)
        wall["pieces"] = max(pieces, 1)
        self._programs.bare[wall].render(self._ctx.TRIANGLE_STRIP, vertices=2 * (max(pieces, 1) + 1))

    def _set_uniforms(self, program: moderngl.Program, frame: CutFrame, picture: CutPicture, reach: float) -> None:
        look, axes = frame.look, frame.camera.axes
        light = _unit(np.asarray(look.light) @ axes)
        values = {
            "heights": _HEIGHTS,
            "values": _VALUES,
            "palette": _PALETTE,
            "relief": _RELIEF,
            "face": 0,
            "section": frame.clip,
            "corner": (picture.x0, picture.y0, picture.pitch),
            "last_cell": (picture.columns - 1, picture.rows - 1),
            "floor_z": picture.floor,
            "light": tuple(light),
            "halfway": tuple(_unit(light + axes[2])),
            "stock": look.stock,
            "hatch": look.hatch,
            "edge": look.edge,
            "strength": look.strength,
        }
        for name, value in values.items():
            if name in program:
                program[name] = value
        program["to_clip"] = tuple(frame.camera.matrix(frame.size, reach).T.ravel())

    def _begin(self) -> None:
        """Set the state of the graphics system, which others may have changed since the last piece."""
        self._ctx.enable_only(self._ctx.DEPTH_TEST)
        for plane in CLIP_PLANES:
            self._ctx.enable_direct(plane)
        places = (
            (self._heights, _HEIGHTS),
            (self._values, _VALUES),
            (self._palette, _PALETTE),
            (self._relief, _RELIEF),
        )
        for texture, place in places:
            texture.use(place)

    def _filled(self, texture: moderngl.Texture, data: NDArray[np.float32] | NDArray[np.uint8]) -> moderngl.Texture:
        """Return a texture with data, (rows, columns) or (rows, columns, bands), in it: the old one, where it fits."""
        size, bands = (data.shape[1], data.shape[0]), data.shape[2] if data.ndim == 3 else 1
        kind = "f4" if data.dtype == np.float32 else "f1"
        if (texture.size, texture.components, texture.dtype) != (size, bands, kind):
            texture.release()
            texture = self._ctx.texture(size, bands, dtype=kind, alignment=1)
            texture.repeat_x = texture.repeat_y = False
        texture.write(np.ascontiguousarray(data), alignment=1)
        return texture


def _unit(vector: Floats) -> Floats:
    return np.asarray(vector / np.linalg.norm(vector))
