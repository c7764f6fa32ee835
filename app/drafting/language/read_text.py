"""The command that draws words: in strokes to engrave, or in the outlines of a font; on a line, or along curves.

Braces in the words hold an expression, or the date.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from datetime import date
from enum import Enum

from ...core.errors import InputError
from ...core.tolerances import WELD
from ...core.wording import counted
from ...geometry.stroke_font import StrokeFont, engraving, placed
from ...geometry.transform import transformed
from ...model.curves import Curve, Point, reversed_curve
from ..commands.command import DraftingSession, Draw
from ..commands.explode import exploded
from ..curves.baseline import Baseline, CurvedBaseline, StraightBaseline
from ..curves.chains import CurveChain, chained
from ..expressions.arguments import Arguments
from ..expressions.errors import CommandError
from ..expressions.evaluate import number_of
from ..expressions.grammar import read_value
from ..expressions.syntax import TextSpan
from ..expressions.values import Length, Scope, wrong
from ..expressions.words import number_text

MOST_LETTERS = 1000
"""Letters of one command, at most."""


class Alignment(Enum):
    """What of the words stands where the baseline begins; along curves, where on them the words stand."""

    LEFT = "left"
    CENTRE = "centre"
    RIGHT = "right"

    def begin(self, width: float, room: float) -> float:
        """Return where words of a width begin, from the baseline's beginning, mm.

        Args:
            room: the length of the curves; 0 where all of the words is measured from one point.
        """
        return {Alignment.LEFT: 0.0, Alignment.CENTRE: 0.5, Alignment.RIGHT: 1.0}[self] * (room - width)


@dataclass(frozen=True, slots=True)
class _TextStyle:
    """How words are drawn: font is a name or file, "" the engraving face; angle in degrees; lift in mm; anchor is what
    the aligned end of words along curves stands nearest to.
    """

    font: str = ""
    alignment: Alignment = Alignment.LEFT
    angle: float = 0.0
    lift: float = 0.0
    back: bool = False
    anchor: Point | None = None


def text(words: Arguments, session: DraftingSession) -> Draw:
    """Words on a baseline from a point on, or along curves; the height is that of the capitals."""
    chain, place = None, words.place
    if not words.is_point() and words.accept("along"):
        place = words.place
        chain = _chain(words, session, place)
    else:
        words.point("the lower left of the words")
    at, height_place = words.last, words.place
    height = words.length("the height of the capitals")
    if height < 100 * WELD:
        raise wrong(f"The height is {height:g} mm; capitals are {100 * WELD:g} mm high or more.", height_place)
    words_place = words.place
    said = with_fields(words.name('the words, in "double quotes"'), words_place, session.scope)
    style = _style(words, along=chain is not None)
    if not said.strip() or len(said) > MOST_LETTERS:
        raise InputError(f"There must be letters to draw, {MOST_LETTERS} at most.")
    baseline = StraightBaseline(at, style.angle) if chain is None else _curved(chain, style)
    return _drawn(said, height, baseline, style, place)


def _style(words: Arguments, along: bool) -> _TextStyle:
    font, alignment, angle, lift, back, anchor = "", Alignment.LEFT, 0.0, 0.0, False, None
    while option := words.accept("font", "align", *(("lift", "back", "at") if along else ("angle",))):
        if option == "font":
            font = words.name('the font\'s name or file, in "double quotes"')
        elif option == "align":
            alignment = _alignment(words)
        elif option == "angle":
            angle = words.angle("the angle of the baseline")
        elif option == "lift":
            lift = words.length("how far the letters stand off the curve")
        elif option == "at":
            anchor = words.point("the point by the curve where the words stand")
        else:
            back = True
    return _TextStyle(font, alignment, angle, lift, back, anchor)


def _alignment(words: Arguments) -> Alignment:
    side = words.accept(*(each.value for each in Alignment), "center")
    if not side:
        raise words.wrong("left, centre or right is expected: where the words stand.")
    return Alignment.CENTRE if side == "center" else Alignment(side)


def _chain(words: Arguments, session: DraftingSession, place: TextSpan) -> CurveChain:
    """Return the curves that words go along, which must be one chain.

    Raises:
        CommandError: they are none, or more than one chain.
    """
    ids = words.some("the curve that the words go along, by its number or name")
    curves = {number: curve for number in ids if (curve := session.part.curve(number)) is not None}
    if len(curves) < len(ids):
        lacking = next(number for number in ids if number not in curves)
        raise wrong(f"{lacking} is no curve of the drawing; words go along curves that are there.", place)
    words.takes(curves.values())
    chains = chained(curves)
    if len(chains) != 1:
        raise wrong(f"These are {len(chains)} chains of curves; words go along one.", place)
    return chains[0]


def _curved(chain: CurveChain, style: _TextStyle) -> CurvedBaseline:
    onward = chain.curves if not style.back else tuple(map(reversed_curve, reversed(chain.curves)))
    return CurvedBaseline.of([piece for curve in onward for piece in exploded(curve)], chain.closed, style.lift)


def _drawn(said: str, height: float, baseline: Baseline, style: _TextStyle, place: TextSpan) -> Draw:
    face = _face(style.font, said)
    unit, found = height / face.capital, list(placed(face, said))
    last, last_at = found[-1]
    width = (last_at + last.advance - face.between) * unit
    begin = _begin(width, height, baseline, style, place)
    curves = list[Curve]()
    for glyph, along in found:
        inked = glyph.advance - face.between
        onto = baseline.placed(begin + along * unit, inked * unit, unit)
        curves += [transformed(curve, onto) for curve in glyph.curves]
    figures = f"{width:.3f} by {height:.3f} mm, {counted(len(curves), 'curve')}"
    return Draw("Text", tuple(curves), figures, baseline.start, lettering=not style.font)


def _begin(width: float, height: float, baseline: Baseline, style: _TextStyle, place: TextSpan) -> float:
    """Return where on a baseline words of a width begin, mm.

    Raises:
        CommandError: there is no room for them.
    """
    if not isinstance(baseline, CurvedBaseline):
        return style.alignment.begin(width, 0.0)
    room = baseline.length
    if width > room + WELD:
        fits = math.floor(100 * height * room / width) / 100
        raise wrong(
            f"The words are {width:.3f} mm long and the curve is {room:.3f} mm; make them {fits:.2f} mm high at most, "
            "or take a longer curve.",
            place,
        )
    if style.anchor is None:
        return style.alignment.begin(width, room)
    begin = baseline.nearest(style.anchor) + style.alignment.begin(width, 0.0)
    if not baseline.closed and not -WELD <= begin <= room - width + WELD:
        raise wrong(
            f"The words would stand from {begin:.3f} to {begin + width:.3f} mm of a curve that is {room:.3f} mm long; "
            "give another point, or another alignment.",
            place,
        )
    return begin


def _face(font: str, said: str) -> StrokeFont:
    if font:
        from ...geometry.typeface import outlined

        return outlined(font, said)
    face = engraving()
    lacking = " ".join(dict.fromkeys(letter for letter in said if letter not in face.glyphs))
    if lacking:
        raise InputError(
            f'The engraving face has no letter for {lacking}; choose other words, or a font: font "DejaVu Sans".'
        )
    return face


DATE = "date"
"""The field that is the day on which the text is carried out, as 2026-03-08."""

_PARTS = re.compile(r"\{\{|\}\}|\{([^{}:]*)(?::(\d{1,2})?(?:\.(\d))?)?\}|[{}]|[^{}]+")
_FINEST = 6
"""Decimals of a number that is written without a format."""


def with_fields(words: str, place: TextSpan, scope: Scope) -> str:
    """Return words with every field in braces written out.

    `{k + 1}` is the shortest way to write a number, `{k + 1:3}` one with three digits or more before its point,
    `{w:.2}` one with two behind it; lengths are in the unit of plain numbers. `{date}` is today. Doubled braces are
    braces.

    Args:
        words: as they stand between the quotes. place: of those, with the quotes.

    Raises:
        CommandError: a field cannot be read, with the place of what is wrong in it.
    """
    return "".join(_written(part, place, scope) for part in _PARTS.finditer(words))


def _written(part: re.Match[str], place: TextSpan, scope: Scope) -> str:
    text = part[0]
    if text in ("{{", "}}"):
        return text[0]
    column = place.column + 1 + part.start()
    if text in ("{", "}"):
        raise CommandError(
            f"A field is written {{k + 1}}, {{k + 1:3}} or {{w:.2}}; a brace itself is written {2 * text}.",
            column,
            place.line,
        )
    if not text.startswith("{"):
        return text
    if not part[1].strip():
        raise wrong("A field is empty; write a number such as {k + 1}, or {date}.", place)
    if part[1].strip().lower() == DATE and DATE not in (scope.names or {}):
        return date.today().isoformat()
    return _number(part, column, place.line, scope)


def _number(part: re.Match[str], column: int, line: int, scope: Scope) -> str:
    try:
        value = number_of(read_value(part[1]), scope)
    except CommandError as error:  # counted from the field's own beginning
        raise CommandError(error.reason, column + error.column, line) from None
    if isinstance(value, Length):
        value /= scope.plain
    digits, decimals = part[2], part[3]
    if digits is None and decimals is None:
        return number_text(round(value, _FINEST))
    behind = int(decimals or 0)
    wide = int(digits or 1) + (behind + 1 if behind else 0) + (value < 0)
    return f"{value:0{wide}.{behind}f}"
