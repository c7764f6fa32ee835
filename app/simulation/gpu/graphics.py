"""OpenGL without a screen: a context, the programs that it runs, and whose it is. No Qt."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...core.errors import HitofudeError
from ...core.resources import resource

if TYPE_CHECKING:
    import moderngl

_HOW = "Install a graphics driver, or the packages libegl1 and libgl1, and start again."
_DEVICES = ("dri/renderD*", "nvidia[0-9]*", "dxg")
"""Of Mesa and others, of NVIDIA's own driver, of the Linux that runs under Windows."""

_SOFTWARE = (
    "llvmpipe",
    "softpipe",
    "swrast",
    "software rasterizer",
    "swiftshader",
    "gdi generic",
    "microsoft basic render",
)


def standalone_context() -> moderngl.Context:
    """Return an OpenGL context without a screen, which is not current: use it as `with context:`.

    Raises:
        HitofudeError: there is no OpenGL 3.3.
    """
    import moderngl

    try:
        settings: dict[str, Any] = {"backend": "egl"} if sys.platform == "linux" else {}
        context = moderngl.create_context(require=330, standalone=True, **settings)
    except Exception as fault:  # moderngl raises plain Exception
        raise HitofudeError(f"There is no OpenGL 3.3 here ({fault}). {_HOW}") from fault
    with context:
        return context


def has_device() -> bool:
    """Return whether there may be graphics hardware: on Linux a device for it; elsewhere only OpenGL tells."""
    if sys.platform != "linux":
        return True
    return any(any(Path("/dev").glob(name)) for name in _DEVICES)


def renderer_of(context: moderngl.Context) -> str:
    """Return the name of what paints, as its driver tells it."""
    return str(context.info["GL_RENDERER"])


def is_software(renderer: str) -> bool:
    """Return whether a renderer's name is that of one that paints with the processor."""
    return any(name in renderer.casefold() for name in _SOFTWARE)


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
