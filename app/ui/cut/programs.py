"""Programs of the graphics system, compiled from the texts in resources/shaders. No Qt."""

from __future__ import annotations

from typing import TYPE_CHECKING

from app.resources import resource

if TYPE_CHECKING:
    import moderngl


def compiled(ctx: moderngl.Context, vertex: str, fragment: str, part: str) -> moderngl.Program:
    """Return a program, compiled with the name of the part it paints defined.

    Args:
        ctx: the graphics context. vertex, fragment: file names. part: what the texts look at.

    Raises:
        moderngl.Error: the graphics system does not take it.
    """
    head, defined = "#version 330\n", f"#version 330\n#define {part}\n"
    sources = [resource("shaders", name).read_text("utf-8").replace(head, defined, 1) for name in (vertex, fragment)]
    return ctx.program(vertex_shader=sources[0], fragment_shader=sources[1])
