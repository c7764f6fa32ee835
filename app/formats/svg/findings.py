"""Sentences about what an SVG shows otherwise than it is read: properties, widths, gaps and arrowheads of outlines."""

from __future__ import annotations

from collections.abc import Iterator

from ...core.wording import place_mm, together
from ...model.finding import Finding, FindingKind
from ..drawing_account import remark
from .strokes import BroadOutline
from .walk import SvgContent


def paint_findings(content: SvgContent) -> Iterator[Finding]:
    """Say what of the picture is not in the part, and what may lie elsewhere than in the picture."""
    yield from _unfollowed(content)
    yield from _within(content)
    for layer in content.painted.layers:
        yield _broad([each for each in content.painted.broad if each.layer == layer])
    yield from _details(content)


def _unfollowed(content: SvgContent) -> Iterator[Finding]:
    count = content.unfollowed.total()
    if count:
        what = "1 element is" if count == 1 else f"{count} elements are"
        yield Finding(
            FindingKind.LEFT_OUT,
            f"{what} moved or formed by {together(sorted(content.unfollowed))}, which is not followed, so that the "
            "part differs from the picture; ungroup it in the editor, or save as plain SVG.",
            amount=float(count),
        )


def _within(content: SvgContent) -> Iterator[Finding]:
    if content.within:
        what = "1 outline lies" if content.within == 1 else f"{content.within} outlines lie"
        yield remark(
            f"{what} within the area that the path paints (fill-rule: nonzero) and cannot be seen; left out.",
            float(content.within),
        )


def _broad(alike: list[BroadOutline]) -> Finding:
    """Say that the middle lines of broad outlines on one layer are read."""
    (x, y), layer, count = alike[0].at, alike[0].layer, len(alike)
    least, most = min(each.width for each in alike), max(each.width for each in alike)
    wide = f"{most:.4g}" if most - least < 1e-3 * most else f"{least:.4g} to {most:.4g}"
    text = (
        f"1 outline on layer {layer} at ({place_mm(x)}, {place_mm(y)}) is drawn {wide} mm wide; its middle line is "
        "read. Turn the outline into a path where its borders are meant."
        if count == 1
        else f"{count} outlines on layer {layer}, the first at ({place_mm(x)}, {place_mm(y)}), are drawn {wide} mm "
        "wide; their middle lines are read. Turn the outlines into paths where their borders are meant."
    )
    return Finding(FindingKind.ASSUMED, text, x, y, counts=False, amount=float(count), layer=layer)


def _details(content: SvgContent) -> Iterator[Finding]:
    painted = content.painted
    told = (
        (painted.dashed, "a dashed outline, which is read whole"),
        (painted.marked, "markers such as arrowheads, which are not read"),
        (painted.patterned, "a pattern as its filling, which is not read"),
        (painted.unseen, "an outline of width 0, which is read though nobody sees it"),
    )
    for count, what in told:
        if count:
            who = "1 shape has" if count == 1 else f"{count} shapes have"
            yield remark(f"{who} {what}.", float(count))
