"""Paints a cut with OpenGL into a picture of its own. No Qt: it takes a context from whoever has one."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from .....simulation.gpu.graphics import compiled
from .....simulation.gpu.wedges_picture import WedgesPicture
from ..cell_colours import CellColours
from ..cell_patch import CellPatch
from ..cut_picture import CutPaths, CutPicture
from ..tool_outline import DrawnTool
from .cut_frame import CLIP_PLANES, CutFrame
from .facets import Facets
from .ground import Foot, GroundShadow, shadow_reach
from .path_ribbons import PathRibbons, RibbonProjection
from .render_target import MetalTarget, RenderTarget
from .stock_textures import Rectangle, StockExtent, StockTextures
from .tool_body import Place, ToolBody

if TYPE_CHECKING:
    import moderngl

SAMPLES = 4

_LINE_SHARE = 0.6
"""Of an edge's colour in the fine line along it, which is about half a pixel wide."""

_SPILL_PX = 8
"""So far beyond its outline metal may show: pixels share lines of sight while things move, and colours are mixed."""


class CutScene:
    """Heights, colours and paths on the graphics side, and the picture that was painted of them last.

    Attributes:
        picture: what is shown; None = nothing. detail: a part of it that was cut again with finer cells; None = there
            is none.
    """

    def __init__(self, ctx: moderngl.Context) -> None:
        """Make the programs.

        Raises:
            moderngl.Error: the graphics system does not take them.
        """
        self.ctx = ctx
        self.picture: CutPicture | None = None
        self.detail: CutPicture | None = None
        self._stock = compiled(ctx, "part.vert", "stock.frag", "STOCK")
        self._over = {part: compiled(ctx, "screen.vert", "screen.frag", part) for part in ("PLAIN", "LINES")}
        self._over_all = {part: ctx.vertex_array(program, []) for part, program in self._over.items()}
        self._palette = ctx.texture((256, 1), 4)
        self._whole, self._part = (StockTextures(ctx, self._stock, self._palette) for _ in range(2))
        self._paths = PathRibbons(ctx, compiled(ctx, "path.vert", "path.frag", "PATH"))
        self._tool, self._facets, self._ground = ToolBody(ctx), Facets(ctx), GroundShadow(ctx)
        self._stage: RenderTarget | None = None
        self._metal: dict[bool, MetalTarget] = {}

    def show_picture(self, picture: CutPicture | None) -> None:
        """Take heights over; colours stay until others are shown, details do not."""
        self.picture, self.detail = picture, None
        if picture is not None:
            self._whole.fill(picture)

    def show_colours(self, colouring: CellColours) -> None:
        """Take over what colour each cell of the picture has."""
        self._whole.colour(colouring.values)
        self._palette.write(colouring.key.palette.tobytes())

    def show_detail(self, detail: CutPicture | None, values: NDArray[np.uint8] | None = None) -> None:
        """Take over a finer look at a part of the picture, and its colours in the same palette."""
        self.detail = detail
        if detail is not None and values is not None:
            self._part.fill(detail)
            self._part.colour(values)

    def patch(self, patch: CellPatch) -> None:
        """Take over a rectangle of cells of the whole that has changed; only that is handed to the graphics system.

        A finer look at a part stays as it was: whoever patches the whole shows none.
        """
        if self.picture is not None:
            self._whole.patch(patch)

    def show_paths(self, paths: CutPaths | None) -> None:
        """Take over the way of the tool."""
        self._paths.fill(paths)

    def show_tool(self, tool: DrawnTool | None) -> None:
        """Show a tool at its place, or none."""
        self._tool.fill(tool)

    def place_tool(self, tip: Place) -> None:
        """Put the tool elsewhere: its tip, mm."""
        self._tool.tip = tip

    def show_wedges(self, wedges: WedgesPicture | None) -> None:
        """Show the facets of a sweep, or none."""
        self._facets.fill(wedges)

    def draw(self, frame: CutFrame) -> None:
        """Paint a picture at once."""
        for _ in self.draw_in_steps(frame):
            pass

    def draw_in_steps(self, frame: CutFrame) -> Iterator[bool]:
        """Paint a picture piece by piece; the one before stays the one that is shown until the last piece is done, but
        that a picture at rest is shown with a line of sight in a pixel as soon as these are known.

        Between the pieces, which take some 20 ms without graphics hardware, nobody may paint with this scene.

        Yields:
            Whether there is another picture to be shown now.
        """
        stage = self._stage_of(frame.size)
        metal = self._metal_of(frame)
        if self.picture is None:
            self._compose(frame, stage, stage.quick, metal)
        elif frame.budget:
            extents = self._extents(self._reach(frame, self.picture), self.picture)
            yield from self._draw_metal(frame, extents, metal, at_once=True)
            self._compose(frame, stage, stage.quick, metal)
        else:  # first a line of sight in a pixel, then more where that is not enough
            extents = self._extents(self._reach(frame, self.picture), self.picture)
            once = replace(frame, budget=frame.size[0] * frame.size[1])
            plain = self._metal_of(once)
            yield from self._draw_metal(once, extents, plain)
            self._compose(frame, stage, stage.quick, plain)
            yield True
            plain.find_uneven()
            yield from self._draw_metal(frame, extents, metal, plain)
            self._compose(frame, stage, stage.smooth, plain, metal)
        yield True

    def _compose(
        self,
        frame: CutFrame,
        stage: RenderTarget,
        back: moderngl.Framebuffer,
        metal: MetalTarget,
        finer: MetalTarget | None = None,
    ) -> None:
        """Put metal, paths and tool together in a framebuffer, and have that shown."""
        back.use()
        back.clear(*frame.look.canvas, 1.0, depth=1.0)
        if self.picture is not None:
            reach = self._reach(frame, self.picture)
            back.scissor = self._seen_area(frame, self.picture)
            self._put_over(frame, reach, metal, finer)
            back.scissor = (0, 0, *frame.size)
            for plane in CLIP_PLANES:
                self.ctx.enable_direct(plane)
            self._paths.draw(
                frame.look,
                frame.shown,
                RibbonProjection(frame.camera, frame.size, frame.clip, reach, bool(frame.budget)),
            )
            for plane in CLIP_PLANES:
                self.ctx.disable_direct(plane)
            for body in (self._facets, self._tool):
                body.draw(frame, reach, back)
        self.ctx.copy_framebuffer(stage.front, back)

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
        for target in self._metal.values():
            target.release()
        for held in (self._whole, self._part, self._palette, self._paths, self._tool, self._facets, self._ground):
            held.release()
        for array in self._over_all.values():
            array.release()
        for program in (self._stock, *self._over.values()):
            program.release()

    def _draw_metal(
        self,
        frame: CutFrame,
        extents: list[StockExtent],
        metal: MetalTarget,
        plain: MetalTarget | None = None,
        at_once: bool = False,
    ) -> Iterator[bool]:
        """Paint the whole, but for the part that there is a finer look at, and that part."""
        target = metal.framebuffer
        target.use()
        target.clear(*frame.look.canvas, 1.0, depth=1.0)
        if (standing := self._whole.standing) is not None and self.picture is not None:
            self._ground.draw(frame, Foot(standing, float(self.picture.low[2])), plain)
        for field, extent in zip((self._whole, self._part), extents, strict=False):
            target.use()
            for _ in field.draw(frame, extent, plain, at_once):
                yield False
                target.use()

    def _extents(self, reach: float, picture: CutPicture) -> list[StockExtent]:
        """Return where there is something of the whole, and of the part that there is a finer look at."""
        sides = _rectangle(picture)
        if self.detail is None:
            return [StockExtent(reach, sides)]
        return [StockExtent(reach, sides, _rectangle(self.detail)), StockExtent(reach, sides)]

    def _put_over(self, frame: CutFrame, reach: float, metal: MetalTarget, finer: MetalTarget | None) -> None:
        """Fill the framebuffer in use with the metal: its finer picture where there is one and the other one is uneven,
        with fine lines along edges.
        """
        self.ctx.enable_only(self.ctx.DEPTH_TEST)
        part = "PLAIN" if finer is None else "LINES"
        program, textures = self._over[part], {"picture": metal.colours, "depths": metal.depths}
        if finer is not None:
            textures |= {"finer": finer.colours, "finer_depths": finer.depths, "uneven": metal.uneven}
            program["fold"] = 0.25 / (frame.camera.scale * reach)
            program["edge"], program["line_share"] = frame.look.edge, _LINE_SHARE
        for place, (name, texture) in enumerate(textures.items()):
            texture.use(place)
            program[name] = place
        program["size"] = frame.size
        self.ctx.depth_func = "1"
        self._over_all[part].render(self.ctx.TRIANGLES, vertices=3)
        self.ctx.depth_func = "<"

    def _seen_area(self, frame: CutFrame, picture: CutPicture) -> tuple[int, int, int, int]:
        """Return what of the picture metal, or its shadow, can be seen in: left, lower edge, width and height, px."""
        shadow = shadow_reach(frame, _rectangle(picture))
        foot = picture.low - (shadow, shadow, 0.0), np.append(picture.high[:2] + shadow, picture.low[2])
        boxes = (picture.low, picture.high), foot
        corners = np.vstack([np.array(np.meshgrid(*zip(*box, strict=True))).reshape(3, -1).T for box in boxes])
        seen = frame.camera.project(corners, frame.size)[:, :2]
        seen[:, 1] = frame.size[1] - seen[:, 1]
        low = np.clip(np.floor(seen.min(axis=0)) - _SPILL_PX, 0, frame.size).astype(int)
        high = np.clip(np.ceil(seen.max(axis=0)) + _SPILL_PX, low, frame.size).astype(int)
        return int(low[0]), int(low[1]), int(high[0] - low[0]), int(high[1] - low[1])

    def _reach(self, frame: CutFrame, picture: CutPicture) -> float:
        """Return how far from the camera's target there may be something, mm."""
        low, high = picture.low, picture.high
        for box in (self._paths.box, self._tool.box, self._facets.box):
            if box is not None:
                low, high = np.minimum(low, box[0]), np.maximum(high, box[1])
        far = np.maximum(np.abs(low - frame.camera.target), np.abs(high - frame.camera.target))
        return 1.01 * float(np.linalg.norm(far)) + 1.0

    def _stage_of(self, size: tuple[int, int]) -> RenderTarget:
        if self._stage is not None and self._stage.front.size != size:
            self._stage.release()
            self._stage = None
        if self._stage is None:
            self._stage = RenderTarget.made(self.ctx, size, min(SAMPLES, self.ctx.max_samples))
        return self._stage

    def _metal_of(self, frame: CutFrame) -> MetalTarget:
        """Return where the metal of a picture is painted: one size for pictures at rest, another one while things
        move.
        """
        moving = bool(frame.budget)
        held = self._metal.get(moving)
        if held is not None and held.framebuffer.size != frame.rays:
            held.release()
            held = None
        if held is None:
            held = self._metal[moving] = MetalTarget.made(self.ctx, frame.rays)
        return held


def _rectangle(picture: CutPicture) -> Rectangle:
    """Return what of the plane a picture covers, mm."""
    (x0, y0, _), (x1, y1, _) = picture.low.tolist(), picture.high.tolist()
    return x0, y0, x1, y1
