"""The tool's way on the graphics side: every straight piece becomes a ribbon of some pixels' width. No Qt."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..camera import Camera, Floats
from ..cut_picture import CutPaths
from .blending import blend_over
from .render_target import RenderStyle

if TYPE_CHECKING:
    import moderngl

_ROW = np.dtype([("from", "3f4"), ("to", "3f4"), ("gone", "f4"), ("look", "u4")])
Rows = NDArray[Any]
"""Of `_ROW`."""

MOVING_PIECES = 20_000
"""While things move, no more pieces than about these are painted."""

_LIFT_PX = 2.0
"""Paths are painted this much nearer to the eye than they are, so that the metal under them does not hide them."""


@dataclass(frozen=True, slots=True)
class RibbonProjection:
    """How the scene is looked at.

    Attributes:
        camera: from where. size: of the picture, px. section: normal and offset of the plane that takes away what lies
            beyond.
        reach: nothing is farther than this from the camera's target, mm. moving: a coarse picture will do.
    """

    camera: Camera
    size: tuple[int, int]
    section: tuple[float, float, float]
    reach: float
    moving: bool


@dataclass(frozen=True, slots=True)
class _Ribbons:
    """The pieces of one look."""

    look: int
    buffer: moderngl.Buffer
    array: moderngl.VertexArray
    count: int


class PathRibbons:
    """Pieces of paths in a buffer.

    Attributes:
        box: lowest and highest corner of what is held, mm; None = nothing.
    """

    def __init__(self, ctx: moderngl.Context, program: moderngl.Program) -> None:
        self._ctx, self._program = ctx, program
        self._whole: list[_Ribbons] = []
        self._coarse: list[_Ribbons] = []
        self.box: tuple[Floats, Floats] | None = None

    def fill(self, paths: CutPaths | None) -> None:
        """Hold other paths."""
        self._empty()
        if paths is None or not len(paths):
            self.box = None
            return
        self.box = (
            np.minimum(paths.start.min(axis=0), paths.end.min(axis=0)),
            np.maximum(paths.start.max(axis=0), paths.end.max(axis=0)),
        )
        rows = rows_of(paths)
        self._whole = self._held(rows)
        if len(rows) > MOVING_PIECES:
            self._coarse = self._held(thinned(rows, -(-len(rows) // MOVING_PIECES)))

    def draw(self, look: RenderStyle, shown: frozenset[int], sight: RibbonProjection) -> None:
        """Paint the paths of some looks over what is there."""
        camera, size = sight.camera, sight.size
        if not self._whole:
            return
        program = self._program
        program["to_clip"] = tuple(camera.matrix(size, sight.reach).T.ravel())
        program["size"] = size
        program["colours"], program["widths"], program["dashes"] = (
            list(look.paths),
            list(look.widths),
            list(look.dashes),
        )
        program["offset"] = tuple(camera.axes[2] * _LIFT_PX / camera.scale)
        program["scale"] = camera.scale
        program["section"] = sight.section
        self._ctx.enable(self._ctx.BLEND)
        blend_over(self._ctx)
        for ribbons in self._coarse if sight.moving and self._coarse else self._whole:
            if ribbons.look in shown:
                ribbons.array.render(self._ctx.TRIANGLE_STRIP, vertices=4, instances=ribbons.count)
        self._ctx.disable(self._ctx.BLEND)

    def release(self) -> None:
        """Give everything back."""
        self._empty()
        self._program.release()

    def _held(self, rows: Rows) -> list[_Ribbons]:
        """Return buffers with rows, one for each look."""
        made = []
        for look in np.unique(rows["look"]).tolist():
            some = rows[rows["look"] == look]
            buffer = self._ctx.buffer(some.tobytes())
            array = self._ctx.vertex_array(self._program, [(buffer, "3f4 3f4 1f4 1u4/i", "from", "to", "gone", "look")])
            made.append(_Ribbons(look, buffer, array, len(some)))
        return made

    def _empty(self) -> None:
        for ribbons in (*self._whole, *self._coarse):
            ribbons.array.release()
            ribbons.buffer.release()
        self._whole, self._coarse = [], []


def rows_of(paths: CutPaths) -> Rows:
    """Return paths as the graphics side takes them.

    `gone` is how far a piece begins behind the beginning of its unbroken path of one look, mm: there dashes begin anew.
    """
    rows = np.zeros(len(paths), _ROW)
    rows["from"], rows["to"], rows["look"] = paths.start, paths.end, paths.look
    lengths = np.linalg.norm(paths.end - paths.start, axis=1)
    total = np.cumsum(lengths) - lengths
    heads = np.flatnonzero(_begins(rows))
    rows["gone"] = total - np.repeat(total[heads], np.diff(np.append(heads, len(rows))))
    return rows


def thinned(rows: Rows, step: int) -> Rows:
    """Return rows with up to `step` pieces that follow one another taken as one."""
    heads = np.flatnonzero(_begins(rows))
    behind = np.arange(len(rows)) - np.repeat(heads, np.diff(np.append(heads, len(rows))))
    first = np.flatnonzero(behind % step == 0)
    made = rows[first].copy()
    made["to"] = rows["to"][np.append(first[1:], len(rows)) - 1]
    return made


def _begins(rows: Rows) -> NDArray[np.bool_]:
    """Return (n,) where an unbroken path of one look begins."""
    new = np.ones(len(rows), bool)
    new[1:] = (rows["look"][1:] != rows["look"][:-1]) | np.any(rows["from"][1:] != rows["to"][:-1], axis=1)
    return new
