"""One field of heights on the graphics side, and the lines of sight that are followed over it. No Qt."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ..camera import Floats
from ..cell_patch import CellPatch
from ..cut_picture import CutPicture, Heights
from .cut_frame import FINE, CutFrame
from .render_target import MetalTarget

if TYPE_CHECKING:
    import moderngl

STRIP_RAYS = 100_000
"""Lines of sight that are followed before somebody else may do something."""

Rectangle = tuple[float, float, float, float]
"""x0, y0, x1, y1, mm."""

NO_HOLE: Rectangle = (1.0, 1.0, -1.0, -1.0)

BLOCK = 8
"""Squares between cells, across and down, whose highest is known: what passes over it meets none of them."""

_HEIGHTS, _VALUES, _PALETTE, _RELIEF, _BLOCKS, _WALLS, _UNEVEN = range(7)
_LINE = 0.45
"""Of an edge's colour in the line along it while things move."""

_LEAST_METAL = 1e-3
"""Metal that is less high is none, mm."""

_SHARP = 0.7
"""Where a cell is wider than so many px, its neighbours need not be averaged."""


@dataclass(frozen=True, slots=True)
class StockExtent:
    """Where there is something to be met.

    Attributes:
        reach: nothing is farther than this from the camera's target, mm.
        sides: of the stock, which may be larger than what is painted.
        hole: what somebody else paints.
    """

    reach: float
    sides: Rectangle
    hole: Rectangle = NO_HOLE


def block_heights(heights: Heights, rows: slice, columns: slice) -> Heights:
    """Return the highest corner of the squares of each block.

    Squares lie between the centres of cells, and round the outer ones: block k holds the squares 8 k to 8 k + 7, so the
    cells 8 k - 1 to 8 k + 7.

    Args:
        heights: (n, m) of all cells. rows, columns: of the blocks that are asked for, of n // 8 + 1 and m // 8 + 1.
    """
    part = heights
    for axis, blocks in enumerate((rows, columns)):
        cells = np.arange(BLOCK * blocks.start - 1, BLOCK * blocks.stop)
        wide = np.take(part, np.clip(cells, 0, heights.shape[axis] - 1), axis=axis)
        wide = np.moveaxis(wide, axis, 0)
        own = wide[:-1].reshape(-1, BLOCK, wide.shape[1]).max(axis=1)
        part = np.moveaxis(np.maximum(own, wide[BLOCK::BLOCK]), 0, axis)
    return np.ascontiguousarray(part)


class StockTextures:
    """Heights and colours of one picture as textures.

    Attributes:
        standing: what of the plane has metal over it, mm, but for the breadth of a block; None = nothing has.
    """

    def __init__(self, ctx: moderngl.Context, program: moderngl.Program, palette: moderngl.Texture) -> None:
        self._ctx, self._program, self._palette = ctx, program, palette
        self._parts = ctx.buffer(reserve=16)
        self._array = ctx.vertex_array(program, [(self._parts, "4f4/i", "part")])
        self._picture: CutPicture | None = None
        self._cells: Heights = np.zeros((1, 1), np.float32)
        self._tops = self._cells
        self._highest, self._averaged = 0.0, True
        self.standing: Rectangle | None = None
        self._heights, self._blocks = (ctx.texture((1, 1), 1, dtype="f4") for _ in range(2))
        self._values, self._relief, self._walls = (ctx.texture((1, 1), bands) for bands in (1, 4, 4))

    def fill(self, picture: CutPicture) -> None:
        """Take heights over; colours stay until others come."""
        ctx, self._picture, self._cells = self._ctx, picture, picture.heights.copy()
        self._heights = self._filled(self._heights, picture.heights)
        every = (slice(0, count // BLOCK + 1) for count in picture.heights.shape)
        self._tops = block_heights(picture.heights, *every)
        self._blocks = self._filled(self._blocks, self._tops)
        self.standing = self._standing()
        self._relief = self._filled(self._relief, picture.relief[..., :4])
        self._walls = self._filled(self._walls, picture.relief[..., 4:])
        for texture in (self._heights, self._blocks, self._walls):
            texture.filter = (ctx.NEAREST, ctx.NEAREST)
        self._highest, self._averaged = picture.highest, False  # averaged when it rests: that takes a while

    def _standing(self) -> Rectangle | None:
        """Return what of the plane has metal over it, mm, but for the breadth of a block; None = nothing has."""
        if self._picture is None:
            return None
        picture, there = self._picture, self._tops > self._picture.floor + _LEAST_METAL
        found = [np.flatnonzero(there.any(axis=axis)) for axis in (0, 1)]
        if not len(found[0]):
            return None
        (x0, x1), (y0, y1) = (
            np.clip([BLOCK * at[0] - 1, BLOCK * at[-1] + BLOCK], 0, count) * picture.pitch
            for at, count in zip(found, (picture.columns, picture.rows), strict=True)
        )
        return picture.x0 + x0, picture.y0 + y0, picture.x0 + x1, picture.y0 + y1

    def patch(self, patch: CellPatch) -> None:
        """Take other heights, relief and colours over for a rectangle of cells; after `fill` and `colour`."""
        place = (patch.col, patch.row, patch.heights.shape[1], patch.heights.shape[0])
        for texture, data in (
            (self._heights, patch.heights),
            (self._relief, patch.relief[..., :4]),
            (self._walls, patch.relief[..., 4:]),
            (self._values, patch.values),
        ):
            texture.write(np.ascontiguousarray(data), viewport=place, alignment=1)
        self._patch_blocks(patch)
        self._averaged = False

    def colour(self, values: NDArray[np.uint8]) -> None:
        """Take over the place of each cell in the palette."""
        self._values = self._filled(self._values, values)
        self._values.filter = (self._ctx.NEAREST, self._ctx.NEAREST)

    def draw(
        self, frame: CutFrame, box: StockExtent, plain: MetalTarget | None = None, at_once: bool = False
    ) -> Iterator[None]:
        """Paint into the framebuffer in use, strip by strip; nothing before `fill`.

        Args:
            frame: how it is looked at.
            box: where there is something.
            plain: the picture with a line of sight in a pixel, where this one is to have `FINE` by `FINE`: they are
                followed where it is not even. None: all are.
            at_once: nobody wants to do something meanwhile.
        """
        picture = self._picture
        if picture is None:
            return
        width, height = frame.rays
        self._set_uniforms(frame, picture, box.reach)
        for name, around in (("hole", box.hole), ("stock_box", box.sides)):
            self._program[name] = picture_cells(picture, around)
        self._program["finer"] = int(plain is not None)
        if plain is not None:  # depths tell where edges are, once these are known
            self._program["line_share"] = 0.0
        if self._set_relief_filter(frame, picture, moving=at_once):
            self._ctx.finish()
            yield None
        low, high = self._rows_in_sight(frame, picture)
        parts = (
            plain.uneven_tiles(low // FINE, -(-high // FINE)) if plain is not None else _strips(low, high, frame.rays)
        )
        rays = (parts[:, 2:] - parts[:, :2]).prod(axis=1) * (width * height)
        batch = np.zeros(len(parts)) if at_once else np.floor(np.cumsum(rays) / STRIP_RAYS)
        for number in np.unique(batch):
            some = np.ascontiguousarray(parts[batch == number], "f4")
            self._begin(plain)
            self._parts.orphan(some.nbytes)
            self._parts.write(some.tobytes())
            self._array.render(self._ctx.TRIANGLE_STRIP, vertices=4, instances=len(some))
            if not at_once:
                self._ctx.finish()
                yield None

    def release(self) -> None:
        """Give everything back to the graphics system."""
        for held in (self._array, self._parts, self._heights, self._blocks, self._values, self._relief, self._walls):
            held.release()

    def _patch_blocks(self, patch: CellPatch) -> None:
        """Find the highest of each block anew that has a cell of the patch."""
        self._cells[patch.rows, patch.columns] = patch.heights
        rows, columns = (
            slice(part.start // BLOCK, min(part.stop // BLOCK, size // BLOCK) + 1)
            for part, size in zip((patch.rows, patch.columns), self._cells.shape, strict=True)
        )
        own = block_heights(self._cells, rows, columns)
        self._tops[rows, columns] = own
        self._highest, self.standing = float(self._tops.max()), self._standing()
        self._blocks.write(own, viewport=(columns.start, rows.start, own.shape[1], own.shape[0]), alignment=1)

    def _rows_in_sight(self, frame: CutFrame, picture: CutPicture) -> tuple[int, int]:
        """Return the first row of rays, from below, that may meet the stock's box, and the one behind the last."""
        low, high = picture.low, np.maximum(picture.high, (-np.inf, -np.inf, self._highest))
        corners = np.array(np.meshgrid(*zip(low, high, strict=True))).reshape(3, -1).T
        down = frame.camera.project(corners, frame.size)[:, 1] * frame.rays[1] / frame.size[1]
        rows = frame.rays[1] - np.array([down.max(), down.min()])
        first, last = np.clip([np.floor(rows[0]) - 1, np.ceil(rows[1]) + 1], 0, frame.rays[1]).astype(int)
        return int(first), int(last)

    def _set_relief_filter(self, frame: CutFrame, picture: CutPicture, moving: bool) -> bool:
        """Choose how the relief is seen from afar; return whether it had to be averaged for that."""
        ctx, sharp = self._ctx, picture.pitch * frame.camera.scale > _SHARP
        due = not (sharp or self._averaged or moving)
        if due:
            self._relief.build_mipmaps()
            self._averaged = True
        self._relief.filter = (ctx.LINEAR if sharp or not self._averaged else ctx.LINEAR_MIPMAP_NEAREST, ctx.LINEAR)
        return due

    def _set_uniforms(self, frame: CutFrame, picture: CutPicture, reach: float) -> None:
        look, camera, program = frame.look, frame.camera, self._program
        light, pitch = _unit(np.asarray(look.light) @ camera.axes), picture.pitch
        share = min(1.0, frame.rays[0] / frame.size[0])  # a line is as wide as what is seen of it
        across, down = (size / rays for size, rays in zip(frame.size, frame.rays, strict=True))
        start = camera.ray((0.0, frame.size[1]), frame.size).origin
        normal = np.array(frame.clip[:2]) if frame.section is not None else np.zeros(2)
        values = {
            "heights": _HEIGHTS,
            "values": _VALUES,
            "palette": _PALETTE,
            "relief": _RELIEF,
            "blocks": _BLOCKS,
            "walls": _WALLS,
            "uneven": _UNEVEN,
            "corner": (picture.x0, picture.y0, pitch),
            "last_cell": (picture.columns - 1, picture.rows - 1),
            "floor_z": picture.floor,
            "highest": self._highest,
            "eye": tuple((start - (picture.x0, picture.y0, 0.0)) / pitch + (0.5, 0.5, 0.0)),
            "right": tuple(camera.axes[0] * across / (camera.scale * pitch)),
            "up": tuple(camera.axes[1] * down / (camera.scale * pitch)),
            "away": tuple(-camera.axes[2]),
            "depth_gain": 0.5 * pitch / reach,
            "scale": pitch * camera.scale * share,
            "line_share": _LINE * share,
            "section": (*normal, (frame.clip[2] - float(normal @ picture.low[:2])) / pitch + 0.5 * float(normal.sum())),
            "light": tuple(light),
            "halfway": tuple(_unit(light + camera.axes[2])),
            "stock": look.stock,
            "hatch": look.hatch,
            "edge": look.edge,
            "strength": look.strength,
        }
        for name, value in values.items():
            program[name] = value

    def _begin(self, plain: MetalTarget | None) -> None:
        """Set the state of the graphics system, which others may have changed since the last piece."""
        self._ctx.enable_only(self._ctx.DEPTH_TEST)
        places = (
            (self._heights, _HEIGHTS),
            (self._values, _VALUES),
            (self._palette, _PALETTE),
            (self._relief, _RELIEF),
            (self._blocks, _BLOCKS),
            (self._walls, _WALLS),
        )
        for texture, place in places:
            texture.use(place)
        if plain is not None:
            plain.uneven.use(_UNEVEN)

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


def _strips(low: int, high: int, rays: tuple[int, int]) -> Floats:
    """Return (n, 4) strips of rows of rays, from the first to before the last, as shares: see `uneven_tiles`."""
    width, height = rays
    ends = np.append(np.arange(low, high, max(1, STRIP_RAYS // width)), high) / height
    strips = np.zeros((len(ends) - 1, 4))
    strips[:, 1], strips[:, 2], strips[:, 3] = ends[:-1], 1.0, ends[1:]
    return strips


def picture_cells(picture: CutPicture, around: Rectangle) -> Rectangle:
    """Return a rectangle as the shader takes it: in cells, 1 at the centre of the first one."""
    x0, y0, x1, y1 = (
        (at - corner) / picture.pitch + 0.5 for at, corner in zip(around, (picture.x0, picture.y0) * 2, strict=True)
    )
    return x0, y0, x1, y1


def _unit(vector: Floats) -> Floats:
    return np.asarray(vector / np.linalg.norm(vector))
