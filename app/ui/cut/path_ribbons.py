"""The tool's way on the graphics side: every straight piece becomes a ribbon of some pixels' width. No Qt."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from app.ui.cut.camera import Camera, Floats
from app.ui.cut.picture import CutPaths
from app.ui.cut.stage import CutLook

if TYPE_CHECKING:
    import moderngl

_ROW = np.dtype([("from", "3f4"), ("to", "3f4"), ("gone", "f4"), ("look", "u4")])
_LIFT_PX = 2.0
"""Paths are painted this much nearer to the eye than they are, so that the metal under them does not hide them."""


@dataclass(frozen=True, slots=True)
class Sight:
    """How the scene is looked at.

    Attributes:
        camera: from where. size: of the picture, px. section: normal and offset of the plane that takes away what lies beyond.
        reach: nothing is farther than this from the camera's target, mm.
    """

    camera: Camera
    size: tuple[int, int]
    section: tuple[float, float, float]
    reach: float


class PathRibbons:
    """Pieces of paths in a buffer.

    Attributes:
        box: lowest and highest corner of what is held, mm; None = nothing.
    """

    def __init__(self, ctx: moderngl.Context, program: moderngl.Program) -> None:
        self._ctx, self._program = ctx, program
        self._buffers: list[tuple[int, moderngl.Buffer, moderngl.VertexArray, int]] = []
        self.box: tuple[Floats, Floats] | None = None

    def fill(self, paths: CutPaths | None) -> None:
        """Hold other paths."""
        self._empty()
        if paths is None or not len(paths):
            self.box = None
            return
        self.box = (np.minimum(paths.start.min(axis=0), paths.end.min(axis=0)), np.maximum(paths.start.max(axis=0), paths.end.max(axis=0)))
        rows = np.zeros(len(paths), _ROW)
        lengths = np.linalg.norm(paths.end - paths.start, axis=1)
        rows["from"], rows["to"], rows["look"] = paths.start, paths.end, paths.look
        rows["gone"] = _gone(paths, lengths)
        for look in np.unique(paths.look).tolist():
            some = rows[paths.look == look]
            buffer = self._ctx.buffer(some.tobytes())
            array = self._ctx.vertex_array(self._program, [(buffer, "3f4 3f4 1f4 1u4/i", "from", "to", "gone", "look")])
            self._buffers.append((look, buffer, array, len(some)))

    def draw(self, look: CutLook, shown: frozenset[int], sight: Sight) -> None:
        """Paint the paths of some looks over what is there."""
        camera, size = sight.camera, sight.size
        if not self._buffers:
            return
        program = self._program
        program["to_clip"] = tuple(camera.matrix(size, sight.reach).T.ravel())
        program["size"] = size
        program["colours"], program["widths"], program["dashes"] = list(look.paths), list(look.widths), list(look.dashes)
        program["offset"] = tuple(camera.axes[2] * _LIFT_PX / camera.scale)
        program["scale"] = camera.scale
        program["section"] = sight.section
        self._ctx.enable(self._ctx.BLEND)
        over = (self._ctx.SRC_ALPHA, self._ctx.ONE_MINUS_SRC_ALPHA, self._ctx.ONE, self._ctx.ONE)
        self._ctx.blend_func = over  # type: ignore[assignment]  # four are taken too: the last two are for alpha
        for kind, _, array, count in self._buffers:
            if kind in shown:
                array.render(self._ctx.TRIANGLE_STRIP, vertices=4, instances=count)
        self._ctx.disable(self._ctx.BLEND)

    def release(self) -> None:
        """Give everything back."""
        self._empty()
        self._program.release()

    def _empty(self) -> None:
        for _, buffer, array, _ in self._buffers:
            array.release()
            buffer.release()
        self._buffers = []


def _gone(paths: CutPaths, lengths: Floats) -> Floats:
    """Return (n,) how far each piece begins behind the beginning of its unbroken path of one look, mm: there dashes begin anew."""
    total = np.cumsum(lengths) - lengths
    new = np.ones(len(paths), bool)
    new[1:] = (paths.look[1:] != paths.look[:-1]) | np.any(paths.start[1:] != paths.end[:-1], axis=1)
    heads = np.flatnonzero(new)
    return np.asarray(total - total[heads][np.cumsum(new) - 1])
