"""MTEXT to curves: its inline codes, paragraphs, lines that are full, and where all of it stands."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from itertools import chain as joined
from typing import Any

from ...geometry.affine import Affine
from ...model.curves import Curve
from .codes import TextBar, legible, numbered_signs
from .curves import NoLengthError
from .fonts import FontName, Fonts, style_font
from .letters import LeftOutError, LetterRun, LetterStyle, TextCurves, bar_curves, lettered, run_of
from .text import MOST_LETTERS

_APART = 5 / 3
"""From baseline to baseline, in heights of the capitals, at a spacing of 1."""
_TAB = 4.0
"""From one stop of a tabulator to the next, in heights of the capitals."""
_STACKED, _BETWEEN = 0.7, 0.2
"""Height of the letters of a fraction, and what lies between its two rows, in heights of the capitals beside it."""
_SLACK = 1e-9
_DOWNWARD = 3
_EXACT = 2


def columns_of(entity: Any) -> list[Any]:
    """Return an MTEXT and the further ones that are its columns, each with a place and a text of its own."""
    return [entity, *(entity.columns.linked_columns if entity.has_columns else ())]


def mtext_lettering(entity: Any, fonts: Fonts) -> TextCurves:
    """Return what an MTEXT draws, drawing units, seen from above.

    Lines break where the text says so, and between words where they would be wider than its width. Centred and right
    tabulators are taken as left ones, justified lines as begun on the left.

    Raises:
        NoLengthError: its height is none.
        LeftOutError: it stands in columns or runs downwards, or is too long.
    """
    dxf, style = entity.dxf, fonts.style(entity.dxf.style)
    at = (float(dxf.insert.x), float(dxf.insert.y))
    if dxf.get("flow_direction", 1) == _DOWNWARD:
        raise LeftOutError("MTEXT (vertical)")
    if entity.has_columns and len(entity.columns.linked_columns) + 1 < entity.columns.count:
        raise LeftOutError("MTEXT (in columns)")  # one text, broken where the lines of a font are as high as a column
    if len(entity.text) > MOST_LETTERS:
        raise LeftOutError(f"MTEXT (of more than {MOST_LETTERS} letters)")
    if not dxf.char_height > 0:
        raise NoLengthError(at)
    first = LetterStyle(
        style_font(style),
        float(dxf.char_height),
        float(style.dxf.width if style else 1.0),
        float(style.dxf.oblique if style else 0.0),
    )
    page = _TextPage(fonts, first, float(dxf.get("width", 0.0) or 0.0), int(dxf.attachment_point))
    page.fill(entity.text)
    page.set_lines(float(dxf.line_spacing_factor), dxf.line_spacing_style == _EXACT)
    made = lettered(page.curves(), [run for line in page.lines for run in line.runs], _frame(entity, at))
    return replace(made, layer=dxf.layer, kind="MTEXT", at=at)


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


@dataclass(frozen=True)
class _Box:
    """Something that stands in a line: words, or a fraction of two rows.

    Attributes:
        rows: words and where they begin, from the box's beginning and from the baseline.
        advance, ink: along the baseline, drawing units.
        look: of the letters beside it. lift: where it stands between the bottom (0) and the top (1) of its line.
        bar: whether a line parts the rows.
    """

    rows: tuple[tuple[LetterRun, float, float], ...]
    advance: float
    ink: float
    look: LetterStyle
    lift: float = 0.0
    bar: bool = False

    def curves(self, x: float, y: float) -> Iterator[tuple[Curve, bool]]:
        for run, right, up in self.rows:
            yield from run.curves(x + right, y + up)
        if self.bar:
            strokes = not any(run.letters.font for run, _, _ in self.rows)
            yield from bar_curves((x, y + self.look.height / 2), self.ink, self.look.height, strokes)


@dataclass
class _TextLine:
    """A line of boxes.

    Attributes:
        boxes: and where each begins. nominal: height of its capitals where it is empty.
        begin, end: between which the line lies, from the page's left edge; end <= begin: it goes on without end.
        align: "l", "c" or "r". y: of its baseline.
    """

    nominal: float
    begin: float = 0.0
    end: float = 0.0
    align: str = "l"
    boxes: list[tuple[_Box, float]] = field(default_factory=list)
    x: float = 0.0
    y: float = 0.0

    @property
    def height(self) -> float:
        return max((box.look.height for box, _ in self.boxes), default=self.nominal)

    @property
    def ink(self) -> float:
        return max((at + box.ink for box, at in self.boxes), default=0.0)

    @property
    def runs(self) -> list[LetterRun]:
        return [run for box, _ in self.boxes for run, _, _ in box.rows]


class _TextPage:
    """The lines of one MTEXT, its zero at the upper left corner, then at the insertion point."""

    def __init__(self, fonts: Fonts, look: LetterStyle, width: float, attachment: int) -> None:
        self.lines: list[_TextLine] = []
        self._fonts, self._look, self._width = fonts, look, width
        self._across, self._down = (attachment - 1) % 3, (attachment - 1) // 3
        self._words: list[_Box] = []  # that nothing may part, for no blank stands between them
        self._blank = 0.0  # before them
        self._fresh = True  # the next line is the first of its paragraph

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
                self._words.append(self._box(legible(token.data), look, _lift(context)))
            elif token.type == TokenType.STACK:
                self._words.append(self._fraction(token.data, look))
            elif token.type in (TokenType.NEW_PARAGRAPH, TokenType.NEW_COLUMN):
                self._put(context)
                self._line(context)  # at least one line a paragraph
                self._fresh, self._blank = True, 0.0
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

    def _box(self, words: str, look: LetterStyle, lift: float = 0.0) -> _Box:
        run = run_of(words, look, self._fonts)
        return _Box(((run, 0.0, 0.0),), run.advance, run.ink, look, lift)

    def _fraction(self, data: tuple[str, str, str], look: LetterStyle) -> _Box:
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
            return _Box(rows, sum(run.advance for run, _, _ in rows), over.advance + slash.advance + under.ink, look)
        ink, gap = max(over.ink, under.ink), look.height * _BETWEEN / 2
        middle = look.height / 2
        rows2 = (
            (over, (ink - over.ink) / 2, middle + gap),
            (under, (ink - under.ink) / 2, middle - gap - small.height),
        )
        return _Box(rows2, max(over.advance, under.advance), ink, look, bar=sort == "/")

    def _space(self, kind: Any, look: LetterStyle, context: Any) -> None:
        from ezdxf.tools.text import TokenType

        if kind == TokenType.NBSP:
            self._words.append(self._box(" ", look))
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

    def _open(self, context: Any) -> _TextLine:
        return self._line(context) if self._fresh else self.lines[-1]

    def _line(self, context: Any, follows: bool = False) -> _TextLine:
        """Return a new line: the first of a paragraph, unless it `follows` one that is full or the paragraph has one
        already.
        """
        if not self._fresh and not follows:
            return self.lines[-1]
        requested, unit = context.paragraph, self._look.height
        begin = requested.left * unit + (0.0 if follows else requested.indent * unit)
        end = self._width - requested.right * unit if self._width > 0 else 0.0
        align = {"DEFAULT": "lcr"[self._across], "CENTER": "c", "RIGHT": "r"}.get(requested.align.name, "l")
        self.lines.append(_TextLine(context.cap_height or unit, begin, end, align))
        self._fresh = False
        return self.lines[-1]

    def set_lines(self, spacing: float, exact: bool) -> None:
        """Give every line its place: baselines apart, lines aligned, all of it about the insertion point."""
        if not self.lines:
            return
        wide = self._width if self._width > 0 else max(line.begin + line.ink for line in self.lines)
        y = 0.0
        for k, line in enumerate(self.lines):
            y -= line.height if k == 0 else spacing * _APART * (self._look.height if exact else line.height)
            end = line.end if line.end > line.begin else wide
            free = end - line.begin - line.ink
            line.x = line.begin + {"l": 0.0, "c": free / 2, "r": free}[line.align] - wide * self._across / 2
            line.y = y
        for line in self.lines:
            line.y -= y * self._down / 2

    def curves(self) -> Iterator[tuple[Curve, bool]]:
        """Yield the curves of all lines, and whether each is a stroke."""
        return joined.from_iterable(
            box.curves(line.x + at, line.y + box.lift * (line.height - box.look.height))
            for line in self.lines
            for box, at in line.boxes
        )


def _lift(context: Any) -> float:
    """Return where smaller letters stand in their line, from its bottom (0) to its top (1)."""
    return {"BOTTOM": 0.0, "CENTER": 0.5, "MIDDLE": 0.5, "TOP": 1.0}.get(context.align.name, 0.0)
