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
from app.ui.cut.path_ribbons import PathRibbons
from app.ui.cut.picking import Section
from app.ui.cut.picture import CutPaths, CutPicture
from app.ui.cut.stage import CutLook, Stage

if TYPE_CHECKING:
    import moderngl

CLIP_DISTANCE = 0x3000
"""GL_CLIP_DISTANCE0, which moderngl has no name for."""

SAMPLES = 4
BAND_QUADS = 60_000
"""Squares that are painted before somebody else may do something."""

_HEIGHTS, _VALUES, _PALETTE = 0, 1, 2
_LEAST_SLANT = 0.02


@dataclass(frozen=True, slots=True)
class Frame:
    """One picture to be painted.

    Attributes:
        camera: from where. size: width and height, px, >= 1.
        look: colours and light.
        budget: about how many squares the metal may be painted with; 0 = as many as can be seen.
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
        self._field, self._wall, self._floor = (
            _program(ctx, f"{name}.vert", "metal.frag") for name in ("field", "wall", "floor"))
        self._bare = {program: ctx.vertex_array(program, []) for program in (self._field, self._wall, self._floor)}
        self._paths = PathRibbons(ctx, _program(ctx, "path.vert", "path.frag"))
        self._heights: moderngl.Texture | None = None
        self._values = ctx.texture((1, 1), 1, np.array([np.nan], "f4").tobytes(), dtype="f4")
        self._palette = ctx.texture((1, 1), 4, b"\xff\xff\xff\xff")
        self._stage: Stage | None = None
        self._highest = 0.0

    def show_picture(self, picture: CutPicture | None) -> None:
        """Take heights over; colours stay until others are shown."""
        self.picture = picture
        if picture is None:
            return
        size = (picture.columns, picture.rows)
        self._heights = self._filled(self._heights, size, picture.heights)
        self._heights.build_mipmaps()
        self._heights.filter = (self.ctx.LINEAR_MIPMAP_LINEAR, self.ctx.LINEAR)
        self._heights.repeat_x = self._heights.repeat_y = False
        self._highest = float(picture.heights.max())

    def show_colours(self, colouring: Colouring) -> None:
        """Take over what colour each cell has."""
        rows, columns = colouring.values.shape
        self._values = self._filled(self._values, (columns, rows), colouring.values)
        self._values.filter = (self.ctx.NEAREST, self.ctx.NEAREST)
        self._palette.release()
        self._palette = self.ctx.texture((len(colouring.palette), 1), 4, colouring.palette.tobytes())
        self._palette.filter = (self.ctx.NEAREST, self.ctx.NEAREST)
        self._palette.repeat_x = False

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
        stage.back.use()
        stage.back.clear(*frame.look.canvas, 1.0, depth=1.0)
        picture = self.picture
        if picture is not None and self._heights is not None:
            for step in self._draw_metal(frame, picture):
                yield step
                stage.back.use()
            self._paths.draw(frame.camera, frame.size, frame.look, frame.shown, self._clip(frame), self._reach(frame))
            self.ctx.disable_direct(CLIP_DISTANCE)
        self.ctx.copy_framebuffer(stage.front, stage.back)
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
        for held in (self._heights, self._values, self._palette, self._paths, *self._bare.values(), *self._bare):
            if held is not None:
                held.release()

    def _draw_metal(self, frame: Frame, picture: CutPicture) -> Iterator[None]:
        for program in self._bare:
            self._set_uniforms(program, frame, picture)
        self.ctx.enable_only(self.ctx.DEPTH_TEST)
        self.ctx.enable_direct(CLIP_DISTANCE)
        self._draw_walls(frame, picture)
        self._bare[self._floor].render(self.ctx.TRIANGLE_STRIP, vertices=4)
        (column, row), (last_column, last_row) = self._seen_cells(frame, picture)
        stride = _stride(frame, picture, (last_column - column) * (last_row - row))
        across, along = -(-(last_column - column) // stride), -(-(last_row - row) // stride)
        self._field["stride"].value = stride
        self._field["last"].value = (last_column, last_row)
        band = max(1, BAND_QUADS // max(across, 1))
        for begin in range(0, along, band):
            self._bind()
            self.ctx.enable_only(self.ctx.DEPTH_TEST)
            self.ctx.enable_direct(CLIP_DISTANCE)
            self._field["first"].value = (column, row + begin * stride)
            self._bare[self._field].render(self.ctx.TRIANGLE_STRIP, vertices=2 * (across + 1), instances=min(band, along - begin))
            if begin + band < along:
                self.ctx.finish()
                yield None

    def _draw_walls(self, frame: Frame, picture: CutPicture) -> None:
        """Paint the four sides of the stock and the face of the section."""
        self._bind()
        low, high = picture.low, picture.high
        corners = [(low[0], low[1]), (high[0], low[1]), (high[0], high[1]), (low[0], high[1])]
        facings = ((0.0, -1.0), (1.0, 0.0), (0.0, 1.0), (-1.0, 0.0))
        for k, facing in enumerate(facings):
            self._draw_wall(corners[k], corners[(k + 1) % 4], facing, picture.columns if k % 2 == 0 else picture.rows)
        if frame.section is None:
            return
        ends = section_ends(frame.section, low, high)
        if ends is not None:
            self._wall["face"].value = 1
            self._wall["section"].value = (0.0, 0.0, 0.0)
            self._draw_wall(*ends, frame.section.normal, picture.columns + picture.rows)
            self._wall["face"].value = 0
            self._wall["section"].value = self._clip(frame)

    def _draw_wall(self, begin: tuple[float, float], end: tuple[float, float], facing: tuple[float, float], pieces: int) -> None:
        self._wall["begin"].value, self._wall["end"].value = begin, end
        self._wall["facing"].value = (*facing, 0.0)
        self._wall["pieces"].value = pieces
        self._bare[self._wall].render(self.ctx.TRIANGLE_STRIP, vertices=2 * (pieces + 1))

    def _set_uniforms(self, program: moderngl.Program, frame: Frame, picture: CutPicture) -> None:
        look, axes = frame.look, frame.camera.axes
        light = np.asarray(look.light) @ axes
        values = {
            "heights": _HEIGHTS, "values": _VALUES, "palette": _PALETTE, "corner": (picture.x0, picture.y0, picture.pitch),
            "floor_z": picture.floor, "light": tuple(light / np.linalg.norm(light)), "eye": tuple(axes[2]), "stock": look.stock,
            "hatch": look.hatch, "strength": look.strength, "relief": look.relief, "section": self._clip(frame), "face": 0,
        }
        for name, value in values.items():
            if name in program:
                program[name].value = value
        program["to_clip"].write(frame.camera.matrix(frame.size, self._reach(frame)).T.tobytes())

    def _bind(self) -> None:
        if self._heights is not None:
            self._heights.use(_HEIGHTS)
        self._values.use(_VALUES)
        self._palette.use(_PALETTE)

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
        places = np.array([ray.origin + (z - ray.origin[2]) / slant * ray.direction for ray in rays for z in (picture.floor, self._highest)])
        cells = (places[:, :2] - picture.low[:2]) / picture.pitch
        first = np.clip(np.floor(cells.min(axis=0)) - 1, 0, counts - 1).astype(int)
        last = np.clip(np.ceil(cells.max(axis=0)) + 1, 0, counts - 1).astype(int)
        return (int(first[0]), int(first[1])), (int(last[0]), int(last[1]))

    def _filled(self, texture: moderngl.Texture | None, size: tuple[int, int], data: NDArray[np.float32]) -> moderngl.Texture:
        """Return a texture of one float a cell with data in it: the old one, where the size is the same."""
        if texture is not None and texture.size != size:
            texture.release()
            texture = None
        made = texture or self.ctx.texture(size, 1, dtype="f4")
        made.write(np.ascontiguousarray(data))
        return made

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


def _stride(frame: Frame, picture: CutPicture, cells: int) -> int:
    """Return how many cells lie between two vertices: not finer than a pixel, and within the budget."""
    finest = max(1, int(1.0 / (picture.pitch * frame.camera.scale)))
    return max(finest, int(np.ceil(np.sqrt(cells / frame.budget)))) if frame.budget else finest


def _program(ctx: moderngl.Context, vertex: str, fragment: str) -> moderngl.Program:
    sources = (resource("shaders", name).read_text("utf-8") for name in (vertex, fragment))
    return ctx.program(*sources)
