"""The sheet on A4: heading, picture beside what has to be known, tables, the certificate; what does not fit goes on on
another page.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ...geometry.transform import Similarity
from ...model.curves import Line, Point
from ..plot.page import Box, FilledPolygon, PageContent, Pen, PenStroke, PlotPage, TextLine
from ..plot.pdf_text import text_width, wrapped
from .content import Legend, SetupPicture, SetupSheet, SheetColumn, SheetTable

WIDTH, HEIGHT, MARGIN = 210.0, 297.0, 12.0
"""A4 upright and its margin, mm."""
INNER = WIDTH - 2 * MARGIN
"""Width between the margins, mm."""
INK, MUTED, RULE, BAND, GOOD, BAD, OPEN = "#1E2227", "#5C626A", "#C9CCD1", "#F1F2EE", "#0B6B4B", "#B3261E", "#8A5A00"
_SMALL, _TITLE = 2.5, 7.0
"""Heights of letters, mm."""
_LEGEND_ROW, _LEGEND_EDGE = 4.5, 3.0
"""Height of a row of the legend and what is left at its edge, mm."""
_FOOT = 14.0
"""What is left below for the foot of the page, mm."""


@dataclass(frozen=True)
class _Density:
    """How close everything stands, mm.

    Attributes:
        body: size of letters. lead: distance of lines, of the letters' size. row: what a row of a table has beside its
            lines.
        heading: what a heading takes. label: what the label of a fact takes. fact: what stands between two facts.
        picture: width and height.
    """

    body: float = 3.0
    lead: float = 1.3
    row: float = 1.5
    heading: float = 7.0
    label: float = 3.6
    fact: float = 2.1
    picture: tuple[float, float] = (108.0, 80.0)

    @property
    def line(self) -> float:
        """From line to line."""
        return self.body * self.lead

    @property
    def first(self) -> float:
        """From the top of a row to the foot of the letters of its first line."""
        return self.row / 2 + 0.85 * self.body


_COMPACT = _Density(body=2.7, lead=1.16, row=0.8, heading=5.7, label=3.0, fact=1.5, picture=(82.0, 58.0))
"""Lengths of a sheet that shall do with one page, mm."""


def sheet_pages(sheet: SetupSheet) -> tuple[PlotPage, ...]:
    """Return the pages of a sheet: one, where it has room on one if everything stands closer."""
    pages = _laid_out(sheet, _Density())
    closer = _laid_out(sheet, _COMPACT) if len(pages) == 2 else pages
    return closer if len(closer) == 1 else pages


def _laid_out(sheet: SetupSheet, density: _Density) -> tuple[PlotPage, ...]:
    pages = _SheetPages(sheet, density)
    pages.heading()
    pages.picture_and_facts()
    for table in sheet.tables:
        pages.table(table)
    pages.certificate()
    pages.sentences(sheet.words.counts, sheet.findings, BAD)
    pages.sentences(sheet.words.remarks, sheet.remarks, MUTED)
    pages.hashes()
    return pages.done()


class _PlacedCell(NamedTuple):
    """Where the text of a table's cell begins, or ends if it is a number, mm; its column and its lines."""

    x: float
    column: SheetColumn
    lines: list[str]


@dataclass(frozen=True)
class _Look:
    """How a line of text looks.

    Attributes:
        size: mm. anchor: where it stands by its place: 0 behind it, 0.5 about it, 1 before it.
    """

    size: float
    bold: bool = False
    anchor: float = 0.0
    colour: str = INK


@dataclass
class _SheetPage:
    """A page that is being filled."""

    words: list[TextLine] = field(default_factory=list)
    strokes: list[PenStroke] = field(default_factory=list)
    patches: list[FilledPolygon] = field(default_factory=list)
    drawing: PageContent = field(default_factory=PageContent)
    window: Box = (0.0, 0.0, 0.0, 0.0)
    place: Similarity = field(default_factory=Similarity)


class _SheetPages:
    """Pages that are filled from the top down; `_y` is how far the last one is filled."""

    def __init__(self, sheet: SetupSheet, density: _Density) -> None:
        self._sheet, self._density = sheet, density
        self._pages = [_SheetPage()]
        self._y = HEIGHT - MARGIN

    @property
    def _page(self) -> _SheetPage:
        return self._pages[-1]

    def _room(self, height: float) -> None:
        """Go on on another page where so much does not fit."""
        if self._y - height < _FOOT:
            self._pages.append(_SheetPage())
            self._y = HEIGHT - MARGIN
            self._write(self._sheet.title, MARGIN, self._y - 4, _Look(4.0, bold=True))
            self._write(
                self._sheet.words.goes_on,
                WIDTH - MARGIN,
                self._y - 4,
                _Look(self._density.body, anchor=1.0, colour=MUTED),
            )
            self._rule(self._y - 6.5)
            self._y -= 9

    def _write(self, text: str, x: float, y: float, look: _Look) -> None:
        pen = Pen(1, look.colour)
        self._page.words.append(TextLine(text, (x, y), look.size, look.anchor, pen=pen, bold=look.bold))

    def _rule(self, y: float, colour: str = RULE, width: float = 0.2, x0: float = MARGIN, x1: float = 0.0) -> None:
        self._page.strokes.append(PenStroke(Pen(1, colour, width), (Line((x0, y), (x1 or WIDTH - MARGIN, y)),)))

    def _fill(self, box: Box, colour: str) -> None:
        x0, y0, x1, y1 = box
        self._page.patches.append(FilledPolygon(Pen(1, colour), ((x0, y0), (x1, y0), (x1, y1), (x0, y1))))

    def heading(self) -> None:
        """Write name, program and verdict."""
        sheet = self._sheet
        self._y -= 5.5
        title = wrapped(sheet.title, _TITLE, INNER - 46, bold=True)[0]
        self._write(title, MARGIN, self._y, _Look(_TITLE, bold=True))
        self._write(sheet.words.sheet, WIDTH - MARGIN, self._y, _Look(4.2, anchor=1.0, colour=MUTED))
        for line in wrapped(sheet.program, self._density.body, INNER)[:2]:
            self._y -= 5.2
            self._write(line, MARGIN, self._y, _Look(self._density.body, colour=MUTED))
        colour = OPEN if sheet.good is None else GOOD if sheet.good else BAD
        self._y -= 11.0
        self._fill((MARGIN, self._y, WIDTH - MARGIN, self._y + 7.6), colour)
        self._write(sheet.verdict, MARGIN + 3, self._y + 2.45, _Look(3.7, bold=True, colour="#FFFFFF"))
        self._y -= 4.0

    def picture_and_facts(self) -> None:
        """Draw the picture, and beside it what has to be known."""
        width, height = self._density.picture
        top = self._y
        self._picture((MARGIN, top - height, MARGIN + width, top), self._sheet.picture)
        x, room, y = MARGIN + width + 6, INNER - width - 6, top
        for fact in self._sheet.facts:
            self._write(fact.label, x, y - 3.0, _Look(_SMALL, bold=True, colour=MUTED))
            y -= self._density.label
            for line in wrapped(fact.said, self._density.body, room):
                self._write(line, x, y - 3.4, _Look(self._density.body))
                y -= self._density.line
            y -= self._density.fact
        self._y = min(top - height, y) - 3.0

    def _picture(self, frame: Box, picture: SetupPicture) -> None:
        """Draw stock, part and paths into a frame of the paper, with the stock's size and the zero."""
        x0, y0, x1, y1 = frame
        corners = [(x0, y0), (x1, y0), (x1, y1), (x0, y1), (x0, y0)]
        self._page.strokes.append(PenStroke(Pen(1, RULE, 0.2), tuple(Line(a, b) for a, b in pairwise(corners))))
        rows = _legend_rows(picture, x1 - x0 - 2 * _LEGEND_EDGE)
        legend, inner = _LEGEND_ROW * len(rows) + 1.5 if picture.legend else 0.0, 9.0
        window = (x0, y0 + legend, x1, y1)
        box = box_of(picture)
        size = max(box[2] - box[0], 1e-6), max(box[3] - box[1], 1e-6)
        scale = min((x1 - x0 - 2 * inner) / size[0], (y1 - y0 - legend - 2 * inner) / size[1])
        middle = complex((window[0] + window[2]) / 2, (window[1] + window[3]) / 2)
        place = Similarity(scale, middle - scale * complex((box[0] + box[2]) / 2, (box[1] + box[3]) / 2))
        self._page.window, self._page.place = window, place
        self._page.drawing = PageContent(traces=picture.lines)
        if picture.stock is not None:
            self._stock(picture.stock, place, place(box[2:]))
        if picture.zero is not None:
            self._zero(place(picture.zero))
        for number, row in enumerate(reversed(rows)):
            self._legend(row, x0 + _LEGEND_EDGE, y0 + 3.2 + number * _LEGEND_ROW)

    def _legend(self, row: Legend, x: float, y: float) -> None:
        """Write words, each behind a piece of its line."""
        for word, line in row:
            self._page.strokes.append(PenStroke(line.pen, (Line((x, y), (x + 7, y)),)))
            self._write(word, x + 8.5, y - 0.9, _Look(_SMALL, colour=MUTED))
            x += _legend_width(word)

    def _stock(self, stock: Box, place: Similarity, corner: Point) -> None:
        """Draw the stock's outline, its width above and its height at the right of all that is drawn, where no zero is.

        Args:
            corner: the upper right one of all that is drawn, on paper.
        """
        (x0, y0), (x1, y1) = place(stock[:2]), place(stock[2:])
        corners = [(x0, y0), (x1, y0), (x1, y1), (x0, y1), (x0, y0)]
        outline = tuple(Line(a, b) for a, b in pairwise(corners))
        self._page.strokes.append(PenStroke(Pen(1, MUTED, 0.3, (2.2, 1.2)), outline))
        thin = Pen(1, MUTED, 0.15)
        right, above = corner[0] + 4.2, corner[1] + 4.2
        arms = [Line((x0, above), (x1, above)), Line((right, y0), (right, y1))]
        arms += [Line((x, y1 + 1), (x, above + 1)) for x in (x0, x1)]
        arms += [Line((x1 + 1, y), (right + 1, y)) for y in (y0, y1)]
        self._page.strokes.append(PenStroke(thin, tuple(arms)))
        width, height = f"{stock[2] - stock[0]:.4g}", f"{stock[3] - stock[1]:.4g}"
        pen = Pen(1, INK)
        self._page.words.append(TextLine(width, ((x0 + x1) / 2, above), 2.8, 0.5, lift=0.8, pen=pen))
        self._page.words.append(TextLine(height, (right, (y0 + y1) / 2), 2.8, 0.5, math.pi / 2, 0.8, pen))

    def _zero(self, at: tuple[float, float]) -> None:
        """Draw the program's zero with its axes."""
        x, y = at
        pen, arm, head = Pen(1, BAD, 0.4), 9.0, 1.8
        turns = np.linspace(0.0, math.tau, 25)
        ring = [(x + 1.5 * math.cos(turn), y + 1.5 * math.sin(turn)) for turn in turns]
        circle = tuple(Line(a, b) for a, b in pairwise(ring))
        self._page.strokes.append(PenStroke(pen, (Line((x, y), (x + arm, y)), Line((x, y), (x, y + arm)), *circle)))
        for tip, side in (((x + arm + head, y), (0.0, 0.7)), ((x, y + arm + head), (0.7, 0.0))):
            foot = (tip[0] - head * (side[0] == 0), tip[1] - head * (side[1] == 0))
            ends = ((foot[0] + side[0], foot[1] + side[1]), (foot[0] - side[0], foot[1] - side[1]))
            self._page.patches.append(FilledPolygon(Pen(1, BAD), (tip, *ends)))
        self._write("X", x + arm + head + 0.8, y - 1.0, _Look(2.8, bold=True, colour=BAD))
        self._write("Y", x - 0.9, y + arm + head + 0.8, _Look(2.8, bold=True, colour=BAD))

    def _title(self, text: str, least: float) -> None:
        """Write a heading that so much is to follow on its page."""
        self._room(self._density.heading + 1.0 + least)
        self._y -= self._density.heading - 2.0
        self._write(text, MARGIN, self._y, _Look(3.7, bold=True))
        self._y -= 2.0

    def table(self, table: SheetTable) -> None:
        """Write a table; its head stands again on each page that it goes on on."""
        self._title(table.title, 14.0)
        self._table_head(table)
        rows = [(row, False) for row in table.rows] + ([(table.total, True)] if table.total else [])
        for row, bold in rows:
            widths = [column.width * INNER - 2.4 for column in table.columns]
            cells = [wrapped(cell, self._density.body, room, bold) for cell, room in zip(row, widths, strict=True)]
            height = max(map(len, cells)) * self._density.line + self._density.row
            before = len(self._pages)
            self._room(height)
            if len(self._pages) > before:
                self._table_head(table)
            for x, column, lines in self._columns(table.columns, cells):
                for number, line in enumerate(lines):
                    y = self._y - self._density.first - number * self._density.line
                    self._write(line, x, y, _Look(self._density.body, bold=bold, anchor=float(column.number)))
            self._y -= height
            self._rule(self._y)
        self._y -= 1.0

    def _table_head(self, table: SheetTable) -> None:
        self._fill((MARGIN, self._y - 5.4, WIDTH - MARGIN, self._y), BAND)
        titles = [[column.title] for column in table.columns]
        for x, column, (title,) in self._columns(table.columns, titles):
            self._write(title, x, self._y - 3.7, _Look(_SMALL, bold=True, anchor=float(column.number), colour=MUTED))
        self._y -= 5.4

    def _columns(self, columns: tuple[SheetColumn, ...], cells: list[list[str]]) -> list[_PlacedCell]:
        """Return each column's cell where it stands."""
        found, x = [], MARGIN
        for column, lines in zip(columns, cells, strict=True):
            width = column.width * INNER
            found.append(_PlacedCell(x + width - 1.2 if column.number else x + 1.2, column, lines))
            x += width
        return found

    def certificate(self) -> None:
        """Write what was proven, and by which bound."""
        self._title(self._sheet.words.certificate, 14.0)
        left = 62.0
        for proof in self._sheet.proofs:
            colour = {True: GOOD, False: BAD, None: OPEN}[proof.holds]
            claim = wrapped(proof.claim, self._density.body, left - 2, bold=True)
            bound = wrapped(proof.bound, self._density.body, INNER - left - 27)
            height = max(len(claim), len(bound)) * self._density.line + self._density.row
            self._room(height)
            for number, line in enumerate(claim):
                self._write(
                    line,
                    MARGIN,
                    self._y - self._density.first - number * self._density.line,
                    _Look(self._density.body, bold=True),
                )
            for number, line in enumerate(bound):
                self._write(
                    line,
                    MARGIN + left,
                    self._y - self._density.first - number * self._density.line,
                    _Look(self._density.body),
                )
            self._write(
                self._sheet.words.verdict(proof.holds),
                WIDTH - MARGIN,
                self._y - self._density.first,
                _Look(self._density.body, bold=True, anchor=1.0, colour=colour),
            )
            self._y -= height
            self._rule(self._y)
        self._y -= 1.0

    def sentences(self, title: str, sentences: tuple[str, ...], colour: str) -> None:
        """Write sentences, a point before each."""
        if not sentences:
            return
        self._title(title, 6.0)
        first = self._density.first
        for sentence in sentences:
            lines = wrapped(sentence, self._density.body, INNER - 4)
            self._room(len(lines) * self._density.line + 1.0)
            self._fill((MARGIN + 0.4, self._y - first + 0.4, MARGIN + 1.5, self._y - first + 1.5), colour)
            for line in lines:
                self._write(line, MARGIN + 4, self._y - first, _Look(self._density.body))
                self._y -= self._density.line
            self._y -= 0.9
        self._y -= 1.0

    def hashes(self) -> None:
        """Write the SHA-256 of every file that the certificate is about."""
        self._title("SHA-256", 5.0)
        for each in self._sheet.hashes:
            self._room(3.7)
            self._write(each.what, MARGIN, self._y - 3.2, _Look(_SMALL, colour=MUTED))
            self._write(each.sha256, WIDTH - MARGIN, self._y - 3.2, _Look(_SMALL, anchor=1.0))
            self._y -= 3.7

    def done(self) -> tuple[PlotPage, ...]:
        """Return the pages, each with its foot."""
        count = len(self._pages)
        for number, page in enumerate(self._pages, 1):
            self._foot(page, f"{self._sheet.made_by}    {number} / {count}")
        return tuple(
            PlotPage(
                WIDTH,
                HEIGHT,
                page.window,
                page.place,
                page.drawing,
                PageContent(tuple(page.strokes), tuple(page.patches), tuple(page.words)),
            )
            for page in self._pages
        )

    def _foot(self, page: _SheetPage, text: str) -> None:
        muted, words = Pen(1, MUTED), self._sheet.words
        for label, x0, x1 in ((words.set_up_by, MARGIN, 75.0), (words.date, 80.0, 115.0)):
            page.words.append(TextLine(label, (x0, 8.0), _SMALL, pen=muted))
            start = x0 + text_width(label, _SMALL) + 1.5
            page.strokes.append(PenStroke(Pen(1, MUTED, 0.15), (Line((start, 7.6), (x1, 7.6)),)))
        page.words.append(TextLine(text, (WIDTH - MARGIN, 8.0), _SMALL, 1.0, pen=muted))


def _legend_width(word: str) -> float:
    return 12.0 + text_width(word, _SMALL)


def _legend_rows(picture: SetupPicture, room: float) -> list[Legend]:
    """Return the legend in rows that are no wider than `room`, mm, as long as a word is not."""
    rows: list[Legend] = [()]
    for entry in picture.legend:
        row = (*rows[-1], entry)
        if rows[-1] and sum(_legend_width(word) for word, _ in row) > room:
            rows.append((entry,))
        else:
            rows[-1] = row
    return rows


def box_of(picture: SetupPicture) -> Box:
    """Return what is in the picture: the stock, and what is not far from it."""
    points = [line.points for line in picture.lines]
    corners = np.concatenate(points) if points else np.zeros((1, 2))
    low, high = corners.min(axis=0), corners.max(axis=0)
    if picture.stock is not None:
        low, high = np.minimum(low, picture.stock[:2]), np.maximum(high, picture.stock[2:])
    size = float(max(high - low))
    if picture.zero is not None and np.all(np.abs(np.array(picture.zero) - (low + high) / 2) < size):
        low, high = np.minimum(low, picture.zero), np.maximum(high, picture.zero)
    return (float(low[0]), float(low[1]), float(high[0]), float(high[1]))
