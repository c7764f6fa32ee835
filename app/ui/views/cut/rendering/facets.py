"""The sweep of a few moves on the graphics side, in the facets that the method of the wedges makes of it (figs 3, 7,
8). No Qt.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .....simulation.gpu.graphics import compiled
from .....simulation.gpu.wedges_picture import WedgesPicture
from ..camera import Floats
from .blending import passes
from .cut_frame import CutFrame

if TYPE_CHECKING:
    import moderngl

_ROW = np.dtype([("a", "3f4"), ("b", "3f4"), ("c", "3f4"), ("d", "3f4"), ("kind", "u4")])

_LIFT_PX = 3.0
"""They lie in the metal's own surface: they are painted this much nearer to the eye."""

_HIDDEN = 0.10


class Facets:
    """Holds facets and paints them with their edges.

    Attributes:
        box: lowest and highest corner of what is held, mm; None = nothing.
    """

    def __init__(self, ctx: moderngl.Context) -> None:
        """Make the program.

        Raises:
            moderngl.Error: the graphics system does not take it.
        """
        self._ctx, self._program = ctx, compiled(ctx, "facet.vert", "facet.frag", "FACET")
        self._held: tuple[moderngl.Buffer, moderngl.VertexArray, int] | None = None
        self.box: tuple[Floats, Floats] | None = None

    def fill(self, picture: WedgesPicture | None) -> None:
        """Hold other facets, or none."""
        self._empty()
        self.box = None
        if picture is not None and len(picture.quads):
            rows = np.zeros(len(picture.quads), _ROW)
            for k, corner in enumerate("abcd"):
                rows[corner] = picture.quads[:, k]
            rows["kind"] = picture.kind
            buffer = self._ctx.buffer(rows.tobytes())
            array = self._ctx.vertex_array(self._program, [(buffer, "3f4 3f4 3f4 3f4 1u4/i", *"abcd", "kind")])
            self._held = buffer, array, len(rows)
            self.box = picture.quads.min(axis=(0, 1)), picture.quads.max(axis=(0, 1))

    def draw(self, frame: CutFrame, reach: float, target: moderngl.Framebuffer) -> None:
        """Paint the facets over what is there.

        Args:
            frame: how it is looked at. reach: nothing is farther than this from the camera's target, mm.
            target: the framebuffer in use.
        """
        if self._held is None:
            return
        _, array, count = self._held
        look, axes, program = frame.look, frame.camera.axes, self._program
        program["to_clip"] = tuple(frame.camera.matrix(frame.size, reach).T.ravel())
        program["offset"] = tuple(axes[2] * _LIFT_PX / frame.camera.scale)
        program["inks"], program["strength"] = list(look.facets), look.strength
        program["light"] = tuple(np.asarray(look.light) @ axes / np.linalg.norm(look.light))
        for share in passes(self._ctx, target, _HIDDEN, closed=False):
            program["share"] = share
            array.render(self._ctx.TRIANGLE_STRIP, vertices=4, instances=count)

    def release(self) -> None:
        """Give everything back to the graphics system."""
        self._empty()
        self._program.release()

    def _empty(self) -> None:
        if self._held is not None:
            for held in self._held[1::-1]:
                held.release()
        self._held = None
