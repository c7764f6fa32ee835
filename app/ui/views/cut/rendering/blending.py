"""How bodies are painted that the metal under them shines through, in the right order whatever their own. No Qt."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import moderngl


def blend_over(ctx: moderngl.Context) -> None:
    """Have what is painted lie over what is there, by its alpha; the picture's own alpha adds up."""
    over = (ctx.SRC_ALPHA, ctx.ONE_MINUS_SRC_ALPHA, ctx.ONE, ctx.ONE)
    ctx.blend_func = over  # type: ignore[assignment]  # four are taken too: the last two are for alpha


def passes(ctx: moderngl.Context, target: moderngl.Framebuffer, hidden: float, closed: bool) -> Iterator[float]:
    """Set the state of the graphics system for each time that a body is to be rendered, and give the share of its alpha
    then.

    First what lies behind metal, faintly; then depths alone; then what is nearest to the eye, so that no inner side
    shines through.

    Args:
        ctx: the graphics context. target: the framebuffer in use.
        hidden: how much is left of what lies behind metal, 0 = nothing.
        closed: only sides that face the eye are painted.
    """
    ctx.enable_only(ctx.DEPTH_TEST | ctx.BLEND | (ctx.CULL_FACE if closed else ctx.NOTHING))
    blend_over(ctx)
    for rule, colours, depths, share in ((">", True, False, hidden), ("<", False, True, 1.0), ("<=", True, False, 1.0)):
        if share:
            ctx.depth_func, target.color_mask, target.depth_mask = rule, (colours,) * 4, depths
            target.use()  # masks hold from then on
            yield share
    ctx.depth_func, target.depth_mask = "<", True
    target.use()
    ctx.enable_only(ctx.DEPTH_TEST)
