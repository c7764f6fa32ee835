"""MTEXT to curves: its inline codes, paragraphs, lines and columns that are full, and where all of it stands."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import chain as joined
from typing import Any

from ...geometry.affine import Affine
from ...model.curves import Curve
from ..drawing import MOST_LETTERS, LeftOutReason
from .curves import NoLengthError
from .fonts import FontName, Fonts, style_font
from .letter_boxes import LetterBox, LetterLine
from .letters import LeftOutError, LetterStyle, TextBar, TextCurves, legible, lettered, numbered_signs, run_of
from .vertical import DownColumn, PlacedBox, is_vertical, stacked

_APART = 5 / 3
"""From baseline to baseline, in heights of the capitals, at a spacing of 1."""
_TAB = 4.0
"""From one stop of a tabulator to the next, in heights of the capitals."""
_STACKED, _BETWEEN = 0.7, 0.2
"""Height of the letters of a fraction, and what lies between its two rows, in heights of the capitals beside it."""
_SLACK = 1e-9
"""Of a length, for rounding."""
_DOWNWARD, _AS_STYLED = 3, 5
"""Codes of the direction of letters: downwards, or as the style says (group 72)."""
_EXACT = 2
"""Code of line spacing that is kept whatever stands in the line (group 73)."""


def columns_of(entity: Any) -> list[Any]:
    """Return an MTEXT and the further ones that are its columns, each with a place and a text of its own."""
    return [entity, *_linked(entity)]


def _linked(entity: Any) -> list[Any]:
    """Return the columns that are texts of their own, as before R2018; where all of them are empty the first one holds
    the whole text.
    """
    linked = entity.columns.linked_columns if entity.has_columns else ()
    return [each for each in linked if each.text]


def mtext_lettering(entity: Any, fonts: Fonts) -> TextCurves:
    """Return what an MTEXT draws, drawing units, seen from above.

    Lines break where the text says so, and between words where they would be wider than its width; columns where the
    text says so, and where a baseline would lie below their height. Lines that run downwards stand to the right of one
    another and break only where the text says so, in columns also where these end; a column is full where a line would
    lie beyond its width. Other programs may set these otherwise, which is told. Centred and right tabulators are taken
    as left ones, justified lines as begun on the left.

    Raises:
        NoLengthError: its height is none.
        LeftOutError: it is too long.
    """
    dxf, style = entity.dxf, fonts.style(entity.dxf.style)
    at = (float(dxf.insert.x), float(dxf.insert.y))
    columns = LetterColumns.of(entity.columns) if entity.has_columns and not _linked(entity) else ONE_COLUMN
    flow = dxf.get("flow_direction", 1)
    down = flow == _DOWNWARD or (flow == _AS_STYLED and is_vertical(style))
    if len(entity.text) > MOST_LETTERS:
        raise LeftOutError("MTEXT", LeftOutReason.TOO_LONG)
    if not dxf.char_height > 0:
        raise NoLengthError(at)
    first = LetterStyle(
        style_font(style),
        float(dxf.char_height),
        float(style.dxf.width if style else 1.0),
        float(style.dxf.oblique if style else 0.0),
    )
    width = columns.width or float(dxf.get("width", 0.0) or 0.0)
    attachment = int(dxf.attachment_point)
    page = (_DownPage if down else _TextPage)(fonts, first, attachment, 0.0 if down else width, columns)
    page.fill(entity.text)
    page.set_lines(float(dxf.line_spacing_factor), dxf.line_spacing_style == _EXACT)
    made = lettered(page.curves(), [run for line in page.lines for run in line.runs], _frame(entity, at))
    return replace(made, layer=dxf.layer, kind="MTEXT", at=at, assumed=down and columns is not ONE_COLUMN)


def _frame(entity: Any, at: tuple[float, float]) -> Affine:
    """Return the map from the page, whose zero is the insertion point, to the drawing, seen from above."""
    from ezdxf.math import Vec3

    dxf, normal = entity.dxf, entity.dxf.extrusion.normalize()
    if dxf.hasattr("text_direction"):
        along = dxf.text_direction.normalize()
    else:
        along = Vec3(entity.ocs().to_wcs(Vec3.from_deg_angle(dxf.rotation)))
    up = normal.cross(along)
    return Affine(along.x, up.x, along.y, up.y, *at)


@dataclass(frozen=True, slots=True)
class LetterColumns:
    """Columns beside one another, all of one width.

    Attributes:
        heights: of each, drawing units; what is beyond the last has its height, where `repeated`, else no end.
        repeated: there are as many columns as the text fills.
        width, gutter: of a column, and between two, drawing units. reversed: they go on to the left.
    """

    heights: tuple[float, ...] = ()
    repeated: bool = False
    width: float = 0.0
    gutter: float = 0.0
    reversed: bool = False

    @staticmethod
    def of(columns: Any) -> LetterColumns:
        """Return what the drawing says; columns without a height are one that has no end."""
        manual = bool(columns.heights) and not columns.auto_height
        heights = columns.heights if manual else [columns.defined_height] * max(int(columns.count), 1)
        heights = tuple(abs(float(height)) for height in heights)
        return LetterColumns(
            heights if all(heights) else (),
            columns.has_dynamic_auto_height,
            abs(float(columns.width)),
            float(columns.gutter_width),
            bool(columns.reversed_column_flow),
        )

    @property
    def height(self) -> float:
        """Of the tallest, drawing units; 0 where none has one."""
        return max(self.heights, default=0.0)

    def depth(self, column: int) -> float:
        """Return how far below its top a baseline may lie in a column, by its number from 0, drawing units."""
        last = len(self.heights) - 1
        if column < last or (self.repeated and last >= 0):
            return self.heights[min(column, last)]
        return math.inf

    def breadth(self, column: int) -> float:
        """Return how wide a column is, by its number from 0, in which lines run downwards; the last has no end."""
        last = len(self.heights) - 1
        return self.width if self.width and (column < last or self.repeated) else math.inf

    def starts(self, count: int, width: float) -> list[float]:
        """Return the left edges of so many columns as wide as told, from that of the leftmost, drawing units."""
        starts = [k * (width + self.gutter) for k in range(count)]
        return starts[::-1] if self.reversed else starts


ONE_COLUMN = LetterColumns()


class _TextPage:
    """The lines of one MTEXT, its zero at the upper left corner, then at the insertion point."""

    def __init__(
        self,
        fonts: Fonts,
        look: LetterStyle,
        attachment: int,
        width: float = 0.0,
        columns: LetterColumns = ONE_COLUMN,
    ) -> None:
        self.lines: list[LetterLine] = []
        self._fonts, self._look, self._width, self._columns = fonts, look, width, columns
        self._across, self._down = (attachment - 1) % 3, (attachment - 1) // 3
        self._words: list[LetterBox] = []  # that nothing may part, for no blank stands between them
        self._blank = 0.0  # before them
        self._fresh = True  # the next line is the first of its paragraph
        self._opens = False  # and of its column

    def fill(self, content: str) -> None:
        """Take a text with its inline codes, and break it into lines."""
        from ezdxf.tools.text import MTextContext, MTextParser, TokenType

        start = MTextContext()
        start.cap_height, start.width_factor, start.oblique = self._look.height, self._look.width, self._look.oblique
        styled = start.font_face
        context = start
        for token in MTextParser(numbered_signs(content), start):
            context = token.ctx
            look = self._seen(context, styled)
            if token.type == TokenType.WORD:
                self._words.append(LetterBox.of(run_of(legible(token.data), look, self._fonts), _lift(context)))
            elif token.type == TokenType.STACK:
                self._words.append(self._fraction(token.data, look))
            elif token.type in (TokenType.NEW_PARAGRAPH, TokenType.NEW_COLUMN):
                self._put(context)
                self._line(context)  # at least one line a paragraph
                self._fresh, self._blank, self._opens = True, 0.0, token.type == TokenType.NEW_COLUMN
            elif token.type in (TokenType.SPACE, TokenType.NBSP, TokenType.TABULATOR):
                self._space(token.type, look, context)
        self._put(context)

    def _seen(self, context: Any, styled: Any) -> LetterStyle:
        """Return what letters look like under a context of the parser."""
        face = context.font_face
        font = self._look.font
        if face is not styled and face != styled:
            named = face.family
            as_file = "." in named
            font = FontName(
                named if as_file else "", "" if as_file else named, face.weight >= 600, "italic" in face.style.lower()
            )
        flags = (
            (TextBar.UNDER, context.underline),
            (TextBar.OVER, context.overline),
            (TextBar.THROUGH, context.strike_through),
        )
        return LetterStyle(
            font,
            context.cap_height or self._look.height,
            context.width_factor or 1.0,
            context.oblique,
            context.char_tracking_factor or 1.0,
            frozenset(bar for bar, requested in flags if requested),
        )

    def _fraction(self, data: tuple[str, str, str], look: LetterStyle) -> LetterBox:
        """Return a fraction: one row over the other, about the middle of the capitals beside it, or both beside a
        stroke.
        """
        upper, lower, sort = data
        small = replace(look, height=look.height * _STACKED)
        over, under = (run_of(legible(numbered_signs(words)).strip(), small, self._fonts) for words in (upper, lower))
        if sort == "#" or not sort:
            slash = run_of("/" if sort else "", look, self._fonts)
            rows = (
                (over, 0.0, look.height - small.height),
                (slash, over.advance, 0.0),
                (under, over.advance + slash.advance, 0.0),
            )
            return LetterBox(
                rows, sum(run.advance for run, _, _ in rows), over.advance + slash.advance + under.ink, look
            )
        ink, gap = max(over.ink, under.ink), look.height * _BETWEEN / 2
        middle = look.height / 2
        rows2 = (
            (over, (ink - over.ink) / 2, middle + gap),
            (under, (ink - under.ink) / 2, middle - gap - small.height),
        )
        return LetterBox(rows2, max(over.advance, under.advance), ink, look, bar=sort == "/")

    def _space(self, kind: Any, look: LetterStyle, context: Any) -> None:
        from ezdxf.tools.text import TokenType

        if kind == TokenType.NBSP:
            self._words.append(LetterBox.of(run_of(" ", look, self._fonts)))
            return
        self._put(context)
        if kind == TokenType.SPACE:
            self._blank += run_of(" ", look, self._fonts).advance
        else:
            at = self._at() + self._blank
            self._blank += next(stop for stop in self._stops(context, at) if stop > at + _SLACK) - at

    def _stops(self, context: Any, at: float) -> list[float]:
        """Return tabulator stops from the left edge of the page, at least one beyond a place in the line."""
        begin = self._open(context).begin
        own = [float(str(stop).lstrip("cr")) * self._look.height - begin for stop in context.paragraph.tab_stops or ()]
        step = _TAB * self._look.height
        return [*sorted(own), (at // step + 1) * step]

    def _at(self) -> float:
        """Return where the open line ends, from its beginning."""
        if self._fresh or not self.lines or not self.lines[-1].boxes:
            return 0.0
        box, at = self.lines[-1].boxes[-1]
        return at + box.advance

    def _put(self, context: Any) -> None:
        """Put the words that are waiting into the open line, or a new one where that is full."""
        if not self._words:
            return
        line, at = self._open(context), self._at() + self._blank
        ink = sum(box.advance for box in self._words[:-1]) + self._words[-1].ink
        if line.boxes and line.end > line.begin and at + ink > (line.end - line.begin) * (1 + _SLACK):
            line, at = self._line(context, follows=True), 0.0
        for box in self._words:
            line.boxes.append((box, at))
            at += box.advance
        self._words, self._blank = [], 0.0

    def _open(self, context: Any) -> LetterLine:
        return self._line(context) if self._fresh else self.lines[-1]

    def _line(self, context: Any, follows: bool = False) -> LetterLine:
        """Return a new line: the first of a paragraph, unless it `follows` one that is full or the paragraph has one
        already.
        """
        if not self._fresh and not follows:
            return self.lines[-1]
        requested, unit = context.paragraph, self._look.height
        begin = requested.left * unit + (0.0 if follows else requested.indent * unit)
        end = self._width - requested.right * unit if self._width > 0 else 0.0
        align = {"DEFAULT": "lcr"[self._across], "CENTER": "c", "RIGHT": "r"}.get(requested.align.name, "l")
        self.lines.append(LetterLine(context.cap_height or unit, begin, end, align, opens=self._opens))
        self._fresh = self._opens = False
        return self.lines[-1]

    def set_lines(self, spacing: float, exact: bool) -> None:
        """Give every line its place: baselines apart, lines aligned, all of it about the insertion point."""
        columns = self._set_columns(spacing, exact)
        if not columns:
            return
        wide = self._width if self._width > 0 else max(line.begin + line.ink for line in self.lines)
        starts = self._columns.starts(len(columns), wide)
        low = -self._columns.height if self._columns.height else min(lines[-1].y for lines in columns)
        for start, lines in zip(starts, columns, strict=True):
            for line in lines:
                free = (line.end if line.end > line.begin else wide) - line.begin - line.ink
                line.x = start + line.begin + {"l": 0.0, "c": free / 2, "r": free}[line.align]
                line.x -= (max(starts) + wide) * self._across / 2
                line.y -= low * self._down / 2

    def _set_columns(self, spacing: float, exact: bool) -> list[list[LetterLine]]:
        """Return the lines of each column, their baselines apart, from its top."""
        columns: list[list[LetterLine]] = []
        y = 0.0
        for line in self.lines:
            y -= spacing * _APART * (self._look.height if exact else line.height)
            full = bool(columns) and -y > self._columns.depth(len(columns) - 1) * (1 + _SLACK)
            if not columns or full or (line.opens and self._columns is not ONE_COLUMN):
                columns.append([])
                y = -line.height
            columns[-1].append(line)
            line.y = y
        return columns

    def curves(self) -> Iterator[tuple[Curve, bool]]:
        """Yield the curves of all lines, and whether each is a stroke."""
        return joined.from_iterable(
            box.curves(line.x + at, line.y + box.lift * (line.height - box.look.height))
            for line in self.lines
            for box, at in line.boxes
        )


class _DownPage(_TextPage):
    """The lines of an MTEXT that run downwards, letter below letter, each line to the right of the one before."""

    _cells: list[PlacedBox]

    def _space(self, kind: Any, look: LetterStyle, context: Any) -> None:
        self._words.append(LetterBox.of(run_of(" ", look, self._fonts)))

    def set_lines(self, spacing: float, exact: bool) -> None:
        """Give every letter its place: lines apart, each from the top, all of it about the insertion point."""
        columns = self._set_downwards(spacing, exact)
        wide = self._columns.width or max((column.right - column.left for column in columns), default=0.0)
        starts = self._columns.starts(len(columns), wide) or [0.0]
        cells = [
            replace(cell, x=cell.x + start - column.left)
            for start, column in zip(starts, columns, strict=False)
            for cell in column.cells
        ]
        low = -self._columns.height if self._columns.height else min((cell.y for cell in cells), default=0.0)
        to_left, to_top = (max(starts) + wide) * self._across / 2, low * self._down / 2
        self._cells = [replace(cell, x=cell.x - to_left, y=cell.y - to_top) for cell in cells]

    def _set_downwards(self, spacing: float, exact: bool) -> list[DownColumn]:
        """Return the letters of each column, from its top and about the middle of its first line."""
        columns = [DownColumn()]
        for line in self.lines:
            apart = spacing * _APART * (self._look.height if exact else line.height)
            rest = stacked([box for box, _ in line.boxes], self._fonts)
            if line.opens and self._columns is not ONE_COLUMN:
                columns.append(DownColumn())
            while True:
                if columns[-1].is_full(rest, apart, self._columns.breadth(len(columns) - 1)):
                    columns.append(DownColumn())
                rest = columns[-1].add(rest, apart, self._columns.depth(len(columns) - 1))
                if not rest:
                    break
        return columns

    def curves(self) -> Iterator[tuple[Curve, bool]]:
        return joined.from_iterable(cell.box.curves(cell.x, cell.y) for cell in self._cells)


def _lift(context: Any) -> float:
    """Return where smaller letters stand in their line, from its bottom (0) to its top (1)."""
    return {"BOTTOM": 0.0, "CENTER": 0.5, "MIDDLE": 0.5, "TOP": 1.0}.get(context.align.name, 0.0)
