"""Paints a cut with OpenGL into a picture of its own. No Qt: it takes a context from whoever has one."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from app.resources import resource
from app.ui.cut.camera import Camera, Floats
from app.ui.cut.colouring import Colouring
from app.ui.cut.path_ribbons import PathRibbons, Sight
from app.ui.cut.picking import Section
from app.ui.cut.picture import CutPaths, CutPicture
from app.ui.cut.stage import CutLook, Stage

if TYPE_CHECKING:
    import moderngl

CLIP_PLANES = (0x3000, 0x3001)
"""GL_CLIP_DISTANCE0 and 1, which moderngl has no names for: the section, and what was cut through."""

SAMPLES = 4
BAND_QUADS = 30_000
"""Squares that are painted before somebody else may do something."""

_HEIGHTS, _VALUES, _PALETTE, _RELIEF = 0, 1, 2, 3
_LEAST_SLANT = 0.02
_SHARP = 0.7
"""Where a cell is wider than so many px, its neighbours need not be averaged."""


@dataclass(frozen=True, slots=True)
class Frame:
    """One picture to be painted.

    Attributes:
        camera: from where. size: width and height, px, >= 1.
        look: colours and light.
        budget: about how many squares the metal may be painted with; 0 = as many as can be seen, with smooth edges.
        section: takes metal away.
        shown: looks of paths that are painted.
    """

    camera: Camera
    size: tuple[int, int]
    look: CutLook
    budget: int = 0
    section: Section | None = None
    shown: frozenset[int] = frozenset(range(4))


class CutScene:
    """Heights, colours and paths on the graphics side, and the picture that was painted of them last.

    Attributes:
        picture: what is shown; None = nothing.
    """

    def __init__(self, ctx: moderngl.Context) -> None:
        """Make the programs.

        Raises:
            moderngl.Error: the graphics system does not take them.
        """
        self.ctx = ctx
        self.picture: CutPicture | None = None
        parts = (("field", "TOP"), ("field", "TOP_CLIPPED"), ("wall", "SIDE"), ("floor", "UNDERSIDE"))
        self._whole_field, self._clipped_field, self._wall, self._floor = (
            _program(ctx, f"{name}.vert", "metal.frag", part) for name, part in parts)
        programs = (self._whole_field, self._clipped_field, self._wall, self._floor)
        self._bare = {program: ctx.vertex_array(program, []) for program in programs}
        self._paths = PathRibbons(ctx, _program(ctx, "path.vert", "path.frag", "PATH"))
        self._heights: moderngl.Texture | None = None
        self._values, self._relief, self._palette = (ctx.texture((1, 1), bands) for bands in (1, 4, 4))
        self._stage: Stage | None = None
        self._highest, self._has_holes = 0.0, False

    def show_picture(self, picture: CutPicture | None) -> None:
        """Take heights over; colours stay until others are shown."""
        self.picture = picture
        if picture is None:
            return
        self._heights = self._filled(self._heights, picture.heights)
        self._heights.filter = (self.ctx.LINEAR, self.ctx.LINEAR)
        self._relief = self._filled(self._relief, picture.relief)
        self._relief.build_mipmaps()
        self._highest, self._has_holes = float(picture.heights.max()), bool(picture.heights.min() <= picture.floor)

    def show_colours(self, colouring: Colouring) -> None:
        """Take over what colour each cell of the picture has."""
        self._values = self._filled(self._values, colouring.values)
        self._values.filter = (self.ctx.NEAREST, self.ctx.NEAREST)
        self._palette = self._filled(self._palette, colouring.palette[None])

    def show_paths(self, paths: CutPaths | None) -> None:
        """Take over the way of the tool."""
        self._paths.fill(paths)

    def draw(self, frame: Frame) -> None:
        """Paint a picture at once."""
        for _ in self.draw_in_steps(frame):
            pass

    def draw_in_steps(self, frame: Frame) -> Iterator[None]:
        """Paint a picture piece by piece; the one before stays the one that is shown until the last piece is done.

        Between the pieces, which take some 20 ms without graphics hardware, nobody may paint with this scene.
        """
        stage = self._stage_of(frame.size)
        back = stage.quick if frame.budget else stage.smooth
        back.use()
        back.clear(*frame.look.canvas, 1.0, depth=1.0)
        picture = self.picture
        if picture is not None and self._heights is not None:
            for step in self._draw_metal(frame, picture):
                yield step
                back.use()
            self._paths.draw(frame.look, frame.shown, self._sight(frame))
            self._clip_planes(on=False)
        self.ctx.copy_framebuffer(stage.front, back)
        yield None

    def copy_to(self, target: moderngl.Framebuffer) -> None:
        """Put the painted picture into another framebuffer of the same size."""
        if self._stage is not None:
            self.ctx.copy_framebuffer(target, self._stage.front)

    def pixels(self) -> NDArray[np.uint8]:
        """Return the painted picture, (height, width, 3), its upper row first."""
        if self._stage is None:
            return np.zeros((1, 1, 3), np.uint8)
        width, height = self._stage.front.size
        flat = np.frombuffer(self._stage.front.read(components=3, alignment=1), np.uint8)
        return flat.reshape(height, width, 3)[::-1]

    def release(self) -> None:
        """Give everything back to the graphics system."""
        if self._stage is not None:
            self._stage.release()
        for held in (self._heights, self._values, self._palette, self._relief, self._paths, *self._bare.values(), *self._bare):
            if held is not None:
                held.release()

    def _draw_metal(self, frame: Frame, picture: CutPicture) -> Iterator[None]:
        for program in self._bare:
            self._set_uniforms(program, frame, picture)
        self._begin_metal()
        self._draw_walls(frame, picture)
        if frame.camera.pitch < 0:
            self._bare[self._floor].render(self.ctx.TRIANGLE_STRIP, vertices=4)
        (column, row), (last_column, last_row) = self._seen_cells(frame, picture)
        stride = _stride(frame, picture, (last_column - column) * (last_row - row))
        across, along = -(-(last_column - column) // stride), -(-(last_row - row) // stride)
        field = self._clipped_field if self._has_holes or frame.section is not None else self._whole_field
        sharp = picture.pitch * frame.camera.scale > _SHARP
        self._relief.filter = (self.ctx.LINEAR if sharp else self.ctx.LINEAR_MIPMAP_NEAREST, self.ctx.LINEAR)
        field["stride"], field["last"] = stride, (last_column, last_row)
        band = max(1, BAND_QUADS // max(across, 1))
        for begin in range(0, along, band):
            self._begin_metal()
            field["first"] = (column, row + begin * stride)
            self._bare[field].render(self.ctx.TRIANGLE_STRIP, vertices=2 * (across + 1), instances=min(band, along - begin))
            if begin + band < along:
                self.ctx.finish()
                yield None

    def _draw_walls(self, frame: Frame, picture: CutPicture) -> None:
        """Paint the sides of the stock that face the eye, and the face of the section."""
        low, high = picture.low, picture.high
        corners = [(low[0], low[1]), (high[0], low[1]), (high[0], high[1]), (low[0], high[1])]
        coarse = _stride(frame, picture, picture.heights.size)
        facings = ((0.0, -1.0), (1.0, 0.0), (0.0, 1.0), (-1.0, 0.0))
        for k, facing in enumerate(facings):
            if np.dot(facing, frame.camera.axes[2, :2]) > 0:
                self._draw_wall(corners[k], corners[(k + 1) % 4], facing, (picture.columns if k % 2 == 0 else picture.rows) // coarse)
        if frame.section is None:
            return
        ends = section_ends(frame.section, low, high)
        if ends is not None:
            self._wall["face"] = 1
            self._wall["section"] = (0.0, 0.0, 0.0)
            self._draw_wall(*ends, frame.section.normal, (picture.columns + picture.rows) // coarse)
            self._wall["face"] = 0
            self._wall["section"] = self._clip(frame)

    def _draw_wall(self, begin: tuple[float, float], end: tuple[float, float], facing: tuple[float, float], pieces: int) -> None:
        self._wall["begin"], self._wall["end"] = begin, end
        self._wall["facing"] = (*facing, 0.0)
        self._wall["pieces"] = max(pieces, 1)
        self._bare[self._wall].render(self.ctx.TRIANGLE_STRIP, vertices=2 * (max(pieces, 1) + 1))

    def _set_uniforms(self, program: moderngl.Program, frame: Frame, picture: CutPicture) -> None:
        look, axes = frame.look, frame.camera.axes
        light = _unit(np.asarray(look.light) @ axes)
        values = {
            "heights": _HEIGHTS, "values": _VALUES, "palette": _PALETTE, "relief": _RELIEF, "face": 0, "section": self._clip(frame),
            "corner": (picture.x0, picture.y0, picture.pitch), "last_cell": (picture.columns - 1, picture.rows - 1),
            "floor_z": picture.floor, "light": tuple(light), "halfway": tuple(_unit(light + axes[2])), "stock": look.stock,
            "hatch": look.hatch, "strength": look.strength,
        }  # fmt: skip
        for name, value in values.items():
            if name in program:
                program[name] = value
        program["to_clip"] = tuple(frame.camera.matrix(frame.size, self._reach(frame)).T.ravel())

    def _sight(self, frame: Frame) -> Sight:
        return Sight(frame.camera, frame.size, self._clip(frame), self._reach(frame), bool(frame.budget))

    def _begin_metal(self) -> None:
        """Set the state of the graphics system, which others may have changed since the last piece."""
        self.ctx.enable_only(self.ctx.DEPTH_TEST)
        self._clip_planes(on=True)
        places = ((self._heights, _HEIGHTS), (self._values, _VALUES), (self._palette, _PALETTE), (self._relief, _RELIEF))
        for texture, place in places:
            if texture is not None:
                texture.use(place)

    def _clip_planes(self, on: bool) -> None:
        for plane in CLIP_PLANES:
            (self.ctx.enable_direct if on else self.ctx.disable_direct)(plane)

    def _clip(self, frame: Frame) -> tuple[float, float, float]:
        """Return the section as the shaders take it; none = everything lies 1 mm on the side that stays."""
        return (*frame.section.normal, frame.section.offset) if frame.section is not None else (0.0, 0.0, 1.0)

    def _reach(self, frame: Frame) -> float:
        """Return how far from the camera's target there may be something, mm."""
        if self.picture is None:
            return 1.0
        low, high = self.picture.low, self.picture.high
        if self._paths.box is not None:
            low, high = np.minimum(low, self._paths.box[0]), np.maximum(high, self._paths.box[1])
        far = np.maximum(np.abs(low - frame.camera.target), np.abs(high - frame.camera.target))
        return 1.01 * float(np.linalg.norm(far)) + 1.0

    def _seen_cells(self, frame: Frame, picture: CutPicture) -> tuple[tuple[int, int], tuple[int, int]]:
        """Return the first and the last column and row that can be in the picture."""
        width, height = frame.size
        rays = [frame.camera.ray(at, frame.size) for at in ((0, 0), (width, 0), (0, height), (width, height))]
        counts = np.array([picture.columns, picture.rows])
        slant = rays[0].direction[2]
        if abs(slant) < _LEAST_SLANT:
            return (0, 0), (picture.columns - 1, picture.rows - 1)
        levels = (picture.floor, self._highest)
        places = np.array([ray.origin + (z - ray.origin[2]) / slant * ray.direction for ray in rays for z in levels])
        cells = (places[:, :2] - picture.low[:2]) / picture.pitch
        first = np.clip(np.floor(cells.min(axis=0)) - 1, 0, counts - 1).astype(int)
        last = np.clip(np.ceil(cells.max(axis=0)) + 1, 0, counts - 1).astype(int)
        return (int(first[0]), int(first[1])), (int(last[0]), int(last[1]))

    def _filled(self, texture: moderngl.Texture | None, data: NDArray[np.float32] | NDArray[np.uint8]) -> moderngl.Texture:
        """Return a texture with data, (rows, columns) or (rows, columns, bands), in it: the old one, where it fits."""
        size, bands = (data.shape[1], data.shape[0]), data.shape[2] if data.ndim == 3 else 1
        kind = "f4" if data.dtype == np.float32 else "f1"
        if texture is None or (texture.size, texture.components, texture.dtype) != (size, bands, kind):
            if texture is not None:
                texture.release()
            texture = self.ctx.texture(size, bands, dtype=kind, alignment=1)
            texture.repeat_x = texture.repeat_y = False
        texture.write(np.ascontiguousarray(data), alignment=1)
        return texture

    def _stage_of(self, size: tuple[int, int]) -> Stage:
        if self._stage is not None and self._stage.front.size != size:
            self._stage.release()
            self._stage = None
        if self._stage is None:
            self._stage = Stage.made(self.ctx, size, min(SAMPLES, self.ctx.max_samples))
        return self._stage


def section_ends(section: Section, low: Floats, high: Floats) -> tuple[tuple[float, float], tuple[float, float]] | None:
    """Return where a section enters and leaves the stock seen from above, mm; None where it passes by it."""
    normal = np.array(section.normal)
    middle, along = section.offset * normal, np.array([-normal[1], normal[0]])
    begin, end = -np.inf, np.inf
    for axis in (0, 1):
        if abs(along[axis]) > 1e-12:
            bounds = sorted(((low[axis] - middle[axis]) / along[axis], (high[axis] - middle[axis]) / along[axis]))
            begin, end = max(begin, bounds[0]), min(end, bounds[1])
        elif not low[axis] <= middle[axis] <= high[axis]:
            return None
    if begin >= end:
        return None
    first, last = middle + begin * along, middle + end * along
    return (float(first[0]), float(first[1])), (float(last[0]), float(last[1]))


def _unit(vector: Floats) -> Floats:
    return np.asarray(vector / np.linalg.norm(vector))


def _stride(frame: Frame, picture: CutPicture, cells: int) -> int:
    """Return how many cells lie between two vertices: not finer than a pixel, and within the budget."""
    finest = max(1, int(1.0 / (picture.pitch * frame.camera.scale)))
    return max(finest, int(np.ceil(np.sqrt(cells / frame.budget)))) if frame.budget else finest


def _program(ctx: moderngl.Context, vertex: str, fragment: str, part: str) -> moderngl.Program:
    """Return a program, compiled with the name of the part it paints defined."""
    head, defined = "#version 330\n", f"#version 330\n#define {part}\n"
    sources = [resource("shaders", name).read_text("utf-8").replace(head, defined, 1) for name in (vertex, fragment)]
    return ctx.program(vertex_shader=sources[0], fragment_shader=sources[1])
