"""Tools and stock that a program tells of in its comments."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

from ...model.part import Units
from .own_header import MARK, MOST_BYTES, Comments, ProgramNotes, ProgramUnits, StockBoxNote, own_notes
from .program import StockNote, ToolNote
from .text import ProgramBuffer

MOST_TOOLS = 500
"""That comments may tell of."""

_TOOL_WORDS = (b"tool", b"cutter", b"mill", b"drill", b"dia", b"d=", b"radius", b"bit", b"ball", b"flat", b"tc:")
_CHANGE_WORDS = (b"m6", b"m06")
_STOCK_WORDS = (b"stock", b"workpiece", b"material size", b"top of material", b"blank", b"billet")
_CHANGE = re.compile(r"(?<![a-z#\d])t\s?0{0,3}(\d{1,4})(?![\d.])", re.IGNORECASE)
_COMMENT = re.compile(r"\([^()]{0,400}\)?|;.*")
_LINES_BELOW, _BLOCKS_BELOW = 60, 5
"""A comment belongs to a T word so many lines below it, if no more than so many of them are blocks."""
_TOGETHER = 10
"""Comments that are so many lines apart may tell of one tool; PyCAM has a line for each of its properties."""
_BOUNDS_AROUND = 200
"""Comments before and behind one that tells of the stock, in which its other bounds may stand."""


def notes(data: bytes, unnamed: Units = Units.MM) -> ProgramNotes:
    """Return the tools and the stock that comments tell of, in the order of the text.

    Our own header is believed alone (`own_header`); else what CAM systems and people say: "(T1 D=6. CR=0. - ZMIN=-5. -
    flat end mill)", "(TOOL 2 - 6MM BALL ENDMILL)", ";tool_radius = 3.0", '(Assumes 4"x4"x2" finished stock)'. A comment
    that names no number belongs to the T word beside or below it. Lengths without a unit are in the units of the
    program near them.

    Args:
        data: the file's bytes; any encoding, any line ends.
        unnamed: units of a program that names none.
    """
    text = ProgramBuffer(data[:MOST_BYTES])
    comments = Comments(text.data, text.data.lower(), text.encoding)
    if comments.lower.find(MARK) >= 0:
        return own_notes(comments)
    if not any(mark in comments.data for mark in (b"(", b";")):
        return ProgramNotes()
    units = ProgramUnits(comments, unnamed)
    return ProgramNotes(_tools(comments, units), _stock(comments, units))


def _tools(comments: Comments, units: ProgramUnits) -> tuple[ToolNote, ...]:
    """Return a note a tool number: the first that tells a diameter, with what others near it add."""
    noted: dict[int, list[ToolNote]] = {}
    for note in sorted(_told(comments, units), key=lambda note: note.line):
        noted.setdefault(note.number, []).append(note)
    merged = [note for same in noted.values() if (note := _merged(same)).diameter > 0.0]
    return tuple(sorted(merged, key=lambda note: note.line)[:MOST_TOOLS])


def _merged(same: list[ToolNote]) -> ToolNote:
    first = next((note for note in same if note.diameter > 0.0), same[0])
    near = [note for note in same if abs(note.line - first.line) <= _TOGETHER]
    kind = next((note.kind for note in [first, *near] if note.kind), "")
    corner = next((note.corner_radius for note in [first, *near] if note.corner_radius > 0.0), 0.0)
    angle = next((note.angle for note in [first, *near] if note.angle > 0.0), 0.0)
    keeps_corner = kind in ("bull", "") and corner <= first.diameter / 2
    return replace(first, kind=kind, corner_radius=corner if keeps_corner else 0.0, angle=angle)


def _told(comments: Comments, units: ProgramUnits) -> Iterator[ToolNote]:
    """Yield what each comment tells: first those at tool changes, where a bare size will do."""
    from .foreign_notes import tool_of  # patterns that no program of our own needs

    seen = set()
    for at, text, number in _at_changes(comments):
        seen.add(at)
        note = tool_of(text, units.mm_at(at), at_change=True)
        yield replace(note, number=note.number or number, line=comments.line(at))
    for at, text in comments.texts(_TOOL_WORDS):
        note = tool_of(text, units.mm_at(at), at_change=False) if at not in seen else ToolNote(0)
        if note.kind or note.diameter or note.corner_radius:
            yield replace(note, number=note.number or _number_near(comments, at), line=comments.line(at))


class _ChangeComment(NamedTuple):
    """A comment at a tool change: its place and text, and the T number of the block."""

    at: int
    text: str
    number: int


def _at_changes(comments: Comments) -> Iterator[_ChangeComment]:
    """Yield the comments beside and right above blocks with T and M6."""
    for at in comments.places(_CHANGE_WORDS):
        begin, end = comments.line_begin(at), comments.line_end(at)
        block = comments.text(begin, end)
        change = _CHANGE.search(_COMMENT.sub(" ", block))
        if change is None or comments.around(at) is not None:
            continue
        above = comments.line_begin(begin - 1) if begin else begin
        alone = not _COMMENT.sub("", comments.text(above, begin)).strip()
        for match in _COMMENT.finditer(comments.text(above if alone else begin, end)):
            place = (above if alone else begin) + match.start() + 1
            yield _ChangeComment(place, match[0].strip("();"), int(change[1]))


def _number_near(comments: Comments, at: int) -> int:
    """Return the T number beside a comment or in the first blocks below it, 0 where there is none."""
    begin = end = comments.line_begin(at)
    blocks = 0
    for _ in range(_LINES_BELOW):
        begin, end = end, min(comments.line_end(end) + 1, len(comments.data))
        block = _COMMENT.sub(" ", comments.text(begin, end))
        change = _CHANGE.search(block)
        if change:
            return int(change[1])
        blocks += bool(block.strip())
        if blocks == _BLOCKS_BELOW:
            break
    return 0


def _stock(comments: Comments, units: ProgramUnits) -> StockNote | None:
    """Return the box, put together from what comments tell in the order of the text."""
    from .foreign_notes import bounds_of, box_of  # patterns that no program of our own needs

    box, first = StockBoxNote(), -1
    for at, text in sorted(comments.texts(_STOCK_WORDS)):
        more = box_of(text if any(c.isdigit() for c in text) else _next_line(comments, at), units.mm_at(at))
        first = at if first < 0 and more.is_known() else first
        box = box.merged(more)
    if not box.is_known():
        first = comments.lower.find(b"minx")
        box = bounds_of(comments.text(max(0, first - _BOUNDS_AROUND), first + _BOUNDS_AROUND)) if first >= 0 else box
    return box.note(comments.line(first)) if box.is_known() else None


def _next_line(comments: Comments, at: int) -> str:
    """Return the line after a comment that is a heading."""
    begin = min(comments.line_end(at) + 1, len(comments.data))
    return comments.text(begin, comments.line_end(begin))
