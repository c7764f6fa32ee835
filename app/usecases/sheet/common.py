"""What all sheets say alike: paths, tools, hashes."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from ... import __version__
from ...core.digest import sha256
from ...core.durations import minutes_words
from ...formats.plot.page import Pen, TracedPolyline
from ...formats.plot.picture import CONTOUR, LINK, PART, POCKET, RAPID, PicturePathStyle, StyledPath
from ...formats.sheet.content import SheetColumn, SheetHash, SheetTable
from ...formats.tools.holders import named_holders
from ...geometry.primitives import Rows, samples
from ...model.tool import Tool

MADE_BY = f"Hitofude {__version__}"
PENS = {
    PART: Pen(1, PART.colour, 0.4),
    POCKET: Pen(1, POCKET.colour, 0.18),
    CONTOUR: Pen(1, CONTOUR.colour, 0.3),
    LINK: Pen(1, LINK.colour, 0.15),
    RAPID: Pen(1, RAPID.colour, 0.12, (0.5, 1.2)),
}
CLAMP_PEN = Pen(1, "#B3261E", 0.4)
_CHORD = 0.02
"""mm; how far chords of the picture may be from arcs."""

TOOL_COLUMNS = (
    SheetColumn("T", 0.05, True),
    SheetColumn("Tool", 0.27),
    SheetColumn("Ø mm", 0.07, True),
    SheetColumn("Flutes", 0.06, True),
    SheetColumn("Stick-out mm", 0.12, True),
    SheetColumn("Holder", 0.14),
    SheetColumn("rpm", 0.08, True),
    SheetColumn("Feed mm/min", 0.13, True),
    SheetColumn("Min", 0.08, True),
)


def traced(rows: Rows, pen: Pen) -> Iterable[TracedPolyline]:
    """Yield connected rows as polylines; where one does not begin at the end of the one before, a new one begins."""
    if not len(rows):
        return
    cuts = np.flatnonzero(np.any(np.abs(rows[1:, :2] - rows[:-1, 2:4]) > 1e-6, axis=1)) + 1
    for run in np.split(rows, cuts):
        points = np.concatenate([samples(run, _CHORD)[1], run[-1:, 2:4]])
        yield TracedPolyline(pen, points)


def styled(paths: Sequence[StyledPath]) -> tuple[TracedPolyline, ...]:
    """Return paths as the picture of a sheet has them."""
    return tuple(line for path in paths for line in traced(path.rows, PENS[path.style]))


def legend(
    styles: Iterable[PicturePathStyle], lines: Sequence[TracedPolyline]
) -> tuple[tuple[str, TracedPolyline], ...]:
    """Return the word of each kind of line that is there, with a line of it."""
    first = {line.pen: line for line in reversed(lines)}
    return tuple((style.name, first[PENS[style]]) for style in styles if PENS[style] in first)


def tool_table(tools: Sequence[Tool], seconds: Sequence[float], depths: Sequence[float]) -> SheetTable:
    """Return the table of tools.

    Args:
        seconds: how long each moves. depths: how far below the stock's top each goes, mm.
    """
    rows = tuple(_tool_row(tool, time, depth) for tool, time, depth in zip(tools, seconds, depths, strict=True))
    return SheetTable("Tools", TOOL_COLUMNS, rows)


def _tool_row(tool: Tool, seconds: float, depth: float) -> tuple[str, ...]:
    stick_out = f"{tool.stick_out:g}" if tool.stick_out else f"> {max(depth, 0.0):.3g}"
    return (
        str(tool.number),
        _tool_words(tool),
        f"{tool.diameter:g}",
        str(tool.flutes),
        stick_out,
        _holder_words(tool),
        f"{tool.spindle_speed:.0f}",
        f"{tool.feed_rate:.0f}",
        minutes_words(seconds),
    )


def _tool_words(tool: Tool) -> str:
    """Return name or kind, and what else tells its shape."""
    shape = [f"R {tool.corner_radius:g}"] if tool.corner_radius else []
    shape += [f"{np.degrees(tool.tip_angle):.4g}°"] if tool.tip_angle else []
    shape += [f"flutes {tool.flute_length:g} mm long"] if tool.flute_length else []
    return ", ".join([tool.name or tool.kind.value.capitalize(), *shape])


def _holder_words(tool: Tool) -> str:
    if not tool.holder:
        return "not given"
    known = next((holder.name for holder in named_holders() if holder.outline == tool.holder), "")
    radius = max(radius for _, radius in tool.holder)
    return known or f"Ø {2 * radius:g} x {tool.holder[-1][0]:g} mm"


def hashed(*files: tuple[str, bytes]) -> tuple[SheetHash, ...]:
    """Return the SHA-256 of files, each with a word for it."""
    return tuple(SheetHash(what, sha256(data)) for what, data in files)
