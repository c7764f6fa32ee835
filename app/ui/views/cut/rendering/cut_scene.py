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
from .path_ribbons import PathRibbons, RibbonProjection
from .render_target import MetalTarget, RenderTarget
from .stock_textures import Rectangle, StockExtent, StockTextures
from .tool_body import Place, ToolBody

if TYPE_CHECKING:
    import moderngl

SAMPLES = 4


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
        self._over = compiled(ctx, "screen.vert", "screen.frag", "OVER")
        self._over_all = ctx.vertex_array(self._over, [])
        self._palette = ctx.texture((256, 1), 4)
        self._whole, self._part = (StockTextures(ctx, self._stock, self._palette) for _ in range(2))
        self._paths = PathRibbons(ctx, compiled(ctx, "path.vert", "path.frag", "PATH"))
        self._tool, self._facets = ToolBody(ctx), Facets(ctx)
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

    def draw_in_steps(self, frame: CutFrame) -> Iterator[None]:
        """Paint a picture piece by piece; the one before stays the one that is shown until the last piece is done.

        Between the pieces, which take some 20 ms without graphics hardware, nobody may paint with this scene.
        """
        stage = self._stage_of(frame.size)
        back = stage.quick if frame.budget else stage.smooth
        reach, metal, finer = 0.0, self._metal_of(frame), None
        if self.picture is not None:
            reach = self._reach(frame, self.picture)
            extents = self._extents(reach, self.picture)
            if not frame.budget:  # first a line of sight in a pixel, then more where that is not enough
                once = replace(frame, budget=frame.size[0] * frame.size[1])
                finer, metal = metal, self._metal_of(once)
                yield from self._draw_metal(once, extents, metal)
                metal.find_uneven()
                yield from self._draw_metal(frame, extents, finer, metal)
            else:
                yield from self._draw_metal(frame, extents, metal, at_once=True)
        back.use()
        back.clear(*frame.look.canvas, 1.0, depth=1.0)
        if self.picture is not None:
            self._put_over(frame.size, metal, finer)
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
        for target in self._metal.values():
            target.release()
        for held in (self._whole, self._part, self._palette, self._paths, self._tool, self._facets):
            held.release()
        for program in (self._stock, self._over_all, self._over):
            program.release()

    def _draw_metal(
        self,
        frame: CutFrame,
        extents: list[StockExtent],
        metal: MetalTarget,
        plain: MetalTarget | None = None,
        at_once: bool = False,
    ) -> Iterator[None]:
        """Paint the whole, but for the part that there is a finer look at, and that part."""
        target = metal.framebuffer
        target.use()
        target.clear(*frame.look.canvas, 1.0, depth=1.0)
        for field, extent in zip((self._whole, self._part), extents, strict=False):
            target.use()
            for step in field.draw(frame, extent, plain, at_once):
                yield step
                target.use()

    def _extents(self, reach: float, picture: CutPicture) -> list[StockExtent]:
        """Return where there is something of the whole, and of the part that there is a finer look at."""
        sides = _rectangle(picture)
        if self.detail is None:
            return [StockExtent(reach, sides)]
        return [StockExtent(reach, sides, _rectangle(self.detail)), StockExtent(reach, sides)]

    def _put_over(self, size: tuple[int, int], metal: MetalTarget, finer: MetalTarget | None) -> None:
        """Fill the framebuffer in use, of a size in px, with the metal: its finer picture where there is one and the
        other one is uneven.
        """
        self.ctx.enable_only(self.ctx.DEPTH_TEST)
        textures = (metal.colours, metal.depths, (finer or metal).colours, metal.uneven)
        for place, (name, texture) in enumerate(zip(("picture", "depths", "finer", "uneven"), textures, strict=True)):
            texture.use(place)
            self._over[name] = place
        self._over["has_finer"], self._over["size"] = int(finer is not None), size
        self.ctx.depth_func = "1"
        self._over_all.render(self.ctx.TRIANGLES, vertices=3)
        self.ctx.depth_func = "<"

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
