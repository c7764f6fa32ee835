"""What all sheets say alike: paths, tools, hashes."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ... import __version__
from ...core.digest import sha256
from ...core.wording import minutes_words, together
from ...formats.plot.page import Pen, TracedPolyline
from ...formats.plot.picture import CONTOUR, LINK, PART, POCKET, RAPID, PicturePathStyle, StyledPath
from ...formats.sheet.content import SheetColumn, SheetFact, SheetHash, SheetTable
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
_COMMENT, _OFFSET = re.compile(r"\([^()\n]*\)|;[^\n]*"), re.compile(r"G0*5[4-9](?:\.\d)?(?![\d.])")
_PLACE = 5e-4
"""mm; a zero so near to a corner is the corner."""
_CHORD = 0.02
"""mm; how far chords of the picture may be from arcs."""

TOOL_COLUMNS = (
    SheetColumn("T", 0.05, number=True),
    SheetColumn("Tool", 0.27),
    SheetColumn("Ø mm", 0.07, number=True),
    SheetColumn("Flutes", 0.06, number=True),
    SheetColumn("Stick-out mm", 0.12, number=True),
    SheetColumn("Holder", 0.14),
    SheetColumn("rpm", 0.08, number=True),
    SheetColumn("Feeds mm/min", 0.13, number=True),
    SheetColumn("Min", 0.08, number=True),
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
    words: Mapping[PicturePathStyle, str], lines: Sequence[TracedPolyline]
) -> tuple[tuple[str, TracedPolyline], ...]:
    """Return the word of each kind of line that is seen, with a line of it."""
    first = {line.pen: line for line in reversed(lines) if np.any(line.points != line.points[0])}
    return tuple((word, first[PENS[style]]) for style, word in words.items() if PENS[style] in first)


def corner_words(right: float, up: float) -> str:
    """Return where the zero is, mm from the stock's lower left corner."""
    if abs(right) < _PLACE and abs(up) < _PLACE:
        return "the stock's lower left corner"
    across = f"{abs(right):.5g} mm {'right' if right >= 0 else 'left'}"
    along = f"{abs(up):.5g} mm {'above' if up >= 0 else 'below'}"
    return f"{across} of and {along} the stock's lower left corner"


def offset_fact(texts: Iterable[str]) -> SheetFact:
    """Return which work offset the zero has to be set in, as programs say."""
    plain = (_COMMENT.sub("", text.upper()) for text in texts)
    found = dict.fromkeys(re.sub("G0*", "G", word) for text in plain for word in _OFFSET.findall(text))
    return SheetFact("Work offset", together(found) or "the program chooses none: that which the control has")


@dataclass(frozen=True)
class ToolUse:
    """What a program does with a tool.

    Attributes:
        tool: its shape, and how it is held. seconds: of its motions.
        depth: how far below the stock's top it goes, mm.
        speeds: of its spindle, rpm. feeds: of its motions that are no rapids, mm/min; what is not above 0 is not known.
        flutes_known: whether anybody has said how many flutes it has.
    """

    tool: Tool
    seconds: float
    depth: float
    speeds: NDArray[np.float64]
    feeds: NDArray[np.float64]
    flutes_known: bool = True


def tool_table(uses: Sequence[ToolUse]) -> SheetTable:
    """Return a row a tool, in their order: what it is and how it is held, rpm, feeds, minutes."""
    return SheetTable("Tools", TOOL_COLUMNS, tuple(map(_tool_row, uses)))


def span_words(values: NDArray[np.float64]) -> str:
    """Return the least and the greatest of values, or the one that there is; a dash where none is known."""
    known = values[values > 0]
    if not len(known):
        return "-"
    low, high = f"{known.min():.0f}", f"{known.max():.0f}"
    return low if low == high else f"{low} to {high}"


def _tool_row(use: ToolUse) -> tuple[str, ...]:
    tool = use.tool
    stick_out = f"{tool.stick_out:g}" if tool.stick_out else f"> {max(use.depth, 0.0):.3g}"
    return (
        str(tool.number),
        _tool_words(tool),
        f"{tool.diameter:g}",
        str(tool.flutes) if use.flutes_known else "-",
        stick_out,
        _holder_words(tool),
        span_words(use.speeds),
        span_words(use.feeds),
        minutes_words(use.seconds),
    )


def _tool_words(tool: Tool) -> str:
    """Return name or kind, and what else tells its shape."""
    shape = [f"R {tool.corner_radius:g}"] if tool.corner_radius else []
    shape += [f"{np.degrees(tool.tip_angle):.4g}°"] if tool.tip_angle else []
    shape += [f"flutes {tool.flute_length:g} mm long"] if tool.flute_length else []
    return ", ".join([tool.label, *shape])


def _holder_words(tool: Tool) -> str:
    if not tool.holder:
        return "not given"
    known = next((holder.name for holder in named_holders() if holder.outline == tool.holder), "")
    radius = max(radius for _, radius in tool.holder)
    return known or f"Ø {2 * radius:g} x {tool.holder[-1][0]:g} mm"


def own_words(note: str) -> str:
    """Return what somebody has written for the sheet, as a sentence; nothing where it is empty."""
    note = " ".join(note.split())
    if not note or note[-1] in ".!?。":
        return note
    return f"{note}." if note[-1].isascii() else f"{note}。"


def zero_note(note: str) -> Iterator[SheetFact]:
    """Yield what somebody has written about how the zero is set."""
    if own := own_words(note):
        yield SheetFact("Setting the zero", "", own)


def hashed(*files: tuple[str, bytes]) -> tuple[SheetHash, ...]:
    """Return the SHA-256 of files, each with a word for it."""
    return tuple(SheetHash(what, sha256(data)) for what, data in files)
