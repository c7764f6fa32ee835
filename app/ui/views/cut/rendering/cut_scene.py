"""Paints a cut with OpenGL into a picture of its own. No Qt: it takes a context from whoever has one."""

from __future__ import annotations

from collections.abc import Iterator
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
from .render_target import RenderTarget
from .stock_textures import StockShaders, StockTextures
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
        self._programs = StockShaders.made(ctx)
        self._palette = ctx.texture((256, 1), 4)
        self._whole, self._part = (StockTextures(ctx, self._programs, self._palette) for _ in range(2))
        self._paths = PathRibbons(ctx, compiled(ctx, "path.vert", "path.frag", "PATH"))
        self._tool, self._facets = ToolBody(ctx), Facets(ctx)
        self._stage: RenderTarget | None = None

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
        back.use()
        back.clear(*frame.look.canvas, 1.0, depth=1.0)
        if self.picture is not None:
            reach = self._reach(frame, self.picture)
            for step in self._draw_metal(frame, reach):
                yield step
                back.use()
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
        for held in (self._whole, self._part, self._palette, self._paths, self._tool, self._facets, self._programs):
            held.release()

    def _draw_metal(self, frame: CutFrame, reach: float) -> Iterator[None]:
        """Paint the whole, but for the part that there is a finer look at, and that part."""
        if self.detail is None:
            yield from self._whole.draw(frame, reach)
            return
        low, high = self.detail.low, self.detail.high
        yield from self._whole.draw(frame, reach, (low[0], low[1], high[0], high[1]))
        yield from self._part.draw(frame, reach)

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
