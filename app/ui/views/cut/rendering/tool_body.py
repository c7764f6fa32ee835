"""The tool on the graphics side: a body of revolution at a place that may change with every picture. No Qt."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .....simulation.gpu.graphics import compiled
from ..camera import Floats
from ..tool_outline import DrawnTool, ToolOutline, ToolPart
from .blending import passes
from .cut_frame import CutFrame

if TYPE_CHECKING:
    import moderngl

Place = tuple[float, float, float]
"""mm."""

Box = tuple[Floats, Floats]
"""Lowest and highest corner, mm."""

_PIECE = np.dtype([("low", "4f4"), ("high", "4f4"), ("part", "u4")])
Pieces = NDArray[Any]
"""Of `_PIECE`."""

_SIDES, _MOVING_SIDES = 128, 64
_SMOOTH = np.cos(np.radians(20.0))
"""Pieces of an outline that meet at a flatter angle than this are painted as one curve."""

_ALPHAS = ((0.86, 1.0), (0.58, 0.98), (0.46, 0.96))
"""By part: of what faces the eye and of what turns away from it."""

_HIDDEN = 0.16
"""How much is left of a tool behind metal."""

_HELIX = np.tan(np.radians(30.0))


class ToolBody:
    """Holds the outline of a tool and paints it.

    Attributes:
        tool: what is held; None = nothing. tip: where its tip is, mm; a change takes effect with the next picture.
    """

    def __init__(self, ctx: moderngl.Context) -> None:
        """Make the program.

        Raises:
            moderngl.Error: the graphics system does not take it.
        """
        self._ctx, self._program = ctx, compiled(ctx, "tool.vert", "tool.frag", "TOOL")
        self._held: tuple[moderngl.Buffer, moderngl.VertexArray, int] | None = None
        self.tool: DrawnTool | None = None
        self.tip: Place = (0.0, 0.0, 0.0)

    def fill(self, tool: DrawnTool | None) -> None:
        """Hold another tool, or none."""
        self._empty()
        self.tool = tool
        if tool is not None:
            pieces = pieces_of(tool.outline)
            buffer = self._ctx.buffer(pieces.tobytes())
            array = self._ctx.vertex_array(self._program, [(buffer, "4f4 4f4 1u4/i", "low", "high", "part")])
            self._held = buffer, array, len(pieces)

    @property
    def box(self) -> Box | None:
        """Where it is; None where there is none."""
        if self.tool is None:
            return None
        outline, tip = self.tool.outline, np.array(self.tip)
        return tip - (outline.widest, outline.widest, 0.0), tip + (outline.widest, outline.widest, outline.height)

    def draw(self, frame: CutFrame, reach: float, target: moderngl.Framebuffer) -> None:
        """Paint the tool over what is there; what lies behind metal shows faintly.

        Args:
            frame: how it is looked at. reach: nothing is farther than this from the camera's target, mm.
            target: the framebuffer in use.
        """
        if self.tool is None or self._held is None:
            return
        ctx, (_, array, count) = self._ctx, self._held
        sides = _MOVING_SIDES if frame.budget else _SIDES
        self._set_uniforms(self.tool, frame, reach, sides)
        for share in passes(ctx, target, _HIDDEN, closed=True):
            self._program["share"] = share
            array.render(ctx.TRIANGLE_STRIP, vertices=2 * (sides + 1), instances=count)

    def release(self) -> None:
        """Give everything back to the graphics system."""
        self._empty()
        self._program.release()

    def _set_uniforms(self, tool: DrawnTool, frame: CutFrame, reach: float, sides: int) -> None:
        look, axes, program = frame.look, frame.camera.axes, self._program
        light = np.asarray(look.light) @ axes / np.linalg.norm(look.light)
        halfway = light + axes[2]
        widest = max(
            float(stretch.points[:, 1].max()) for stretch in tool.outline.stretches if stretch.part is ToolPart.CUTTING
        )
        values = {
            "tip": self.tip,
            "sides": sides,
            "alphas": list(_ALPHAS),
            "light": tuple(light),
            "eye": tuple(axes[2]),
            "right": tuple(axes[0]),
            "halfway": tuple(halfway / np.linalg.norm(halfway)),
            "strength": look.strength,
            "flutes": float(tool.flutes),
            "edge": look.edge,
            "inks": [look.tools[tool.ink % len(look.tools)], look.steel, look.holder],
            "lead": _HELIX / (2 * np.pi * widest),
            "to_clip": tuple(frame.camera.matrix(frame.size, reach).T.ravel()),
        }
        for name, value in values.items():
            program[name] = value

    def _empty(self) -> None:
        if self._held is not None:
            for held in self._held[1::-1]:
                held.release()
        self._held = None


def pieces_of(outline: ToolOutline) -> Pieces:
    """Return the straight pieces of an outline as the graphics side takes them, with normals that are smooth along
    curves.
    """
    made = []
    for stretch in outline.stretches:
        ways = np.diff(stretch.points, axis=0)
        normals = np.column_stack([-ways[:, 1], ways[:, 0]]) / np.linalg.norm(ways, axis=1)[:, None]
        shared = normals[:-1] + normals[1:]
        shared /= np.maximum(np.linalg.norm(shared, axis=1), 1e-9)[:, None]
        smooth = (np.sum(normals[:-1] * normals[1:], axis=1) > _SMOOTH)[:, None]
        rows = np.zeros(len(ways), _PIECE)
        rows["low"][:, :2], rows["high"][:, :2] = stretch.points[:-1], stretch.points[1:]
        rows["low"][:, 2:], rows["high"][:, 2:] = normals, normals
        rows["low"][1:, 2:] = np.where(smooth, shared, normals[1:])
        rows["high"][:-1, 2:] = np.where(smooth, shared, normals[:-1])
        rows["part"] = int(stretch.part)
        made.append(rows)
    return np.concatenate(made)
