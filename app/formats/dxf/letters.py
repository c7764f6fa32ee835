"""Words to curves: the codes among them (%%c, Unicode, control characters, lines along the words), a run of letters of
one look, set on a baseline along X, and what all the runs of a text entity are together.
"""

from __future__ import annotations

import math
import re
import unicodedata
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from enum import Enum

from ...geometry.affine import IDENTITY, Affine, transformed
from ...geometry.stroke_font import placed
from ...model.curves import Curve, Line, Point
from ..drawing import LeftOutReason, LeftOutSort
from .fonts import FontName, Fonts, LetterSet

_THICK = 1 / 14
"""How thick lines along outlined words are, in heights of the capitals."""


class LeftOutError(Exception):
    """A text is of a sort that is not read.

    Attributes:
        sort: which one.
    """

    def __init__(self, kind: str, reason: LeftOutReason) -> None:
        self.sort = LeftOutSort(kind, reason)
        super().__init__(self.sort.said)


@dataclass(frozen=True, slots=True)
class LetterStyle:
    """What letters look like.

    Attributes:
        font: as the drawing names it.
        height: of the capitals, drawing units, > 0.
        width: factor of all lengths along the baseline, > 0.
        oblique: by so much uprights lean to the right, degrees.
        tracking: factor of the distance from letter to letter.
        bars: lines along the words.
    """

    font: FontName
    height: float
    width: float = 1.0
    oblique: float = 0.0
    tracking: float = 1.0
    bars: frozenset[TextBar] = frozenset()


_CODE = re.compile(r"%%(?:([cdpouk%])|(\d{3}))|\\U\+([0-9a-f]{4})|\\M\+([1-5])([0-9a-f]{4})|\^(.)", re.IGNORECASE)
_SIGNS = {"c": "Ø", "d": "°", "p": "±", "%": "%"}
_OF_STROKED_FONTS = {127: "°", 128: "±", 129: "Ø"}
_PAGES = {"1": "cp932", "2": "cp950", "3": "cp949", "4": "johab", "5": "cp936"}


class TextBar(Enum):
    """A line along the words; the value is its height over the baseline in heights of the capitals."""

    UNDER = -0.2
    OVER = 1.2
    THROUGH = 0.5


_BARS = {"u": TextBar.UNDER, "o": TextBar.OVER, "k": TextBar.THROUGH}


def numbered_signs(text: str) -> str:
    """Return a text with Unicode and multibyte numbers, `\\U+00B1` and `\\M+1889F`, as the letters that they mean."""
    return _CODE.sub(lambda match: _sign(match) if match[3] or match[4] else match[0], text)


def stretches(text: str) -> Iterator[tuple[str, frozenset[TextBar]]]:
    """Yield the stretches of a text of one line, and the lines along each; codes are the letters that they mean."""
    at, bars = 0, frozenset[TextBar]()
    words = ""
    for match in _CODE.finditer(text):
        words += text[at : match.start()]
        at = match.end()
        bar = _BARS.get((match[1] or "").lower())
        if bar is None:
            words += _sign(match)
            continue
        if words:
            yield legible(words), bars
        words, bars = "", bars ^ {bar}
    words += text[at:]
    if words:
        yield legible(words), bars


def _sign(match: re.Match[str]) -> str:
    sign, number, point, page, double, control = match.groups()
    if sign:
        return _SIGNS.get(sign.lower(), "")
    if number:
        return _OF_STROKED_FONTS.get(int(number)) or bytes([int(number) % 256]).decode("cp1252", "replace")
    if point:
        return chr(int(point, 16))
    if page:
        return bytes.fromhex(double).lstrip(b"\0").decode(_PAGES[page], "replace")
    return "^" if control == " " else " " if control.upper() in "IJM" else str(control)


def legible(words: str) -> str:
    """Return words with blanks in place of all that only moves on, and without what has no shape."""
    blanks = (
        "" if unicodedata.category(c) == "Cf" else " " if c.isspace() or unicodedata.category(c) == "Cc" else c
        for c in words
    )
    return "".join(blanks)


@dataclass(frozen=True, slots=True)
class TextCurves:
    """What a text draws.

    Attributes:
        strokes: that are followed and bound nothing. outlines: closed contours.
        layer, kind: of the entity.
        at: where it begins.
        fonts: ("", each font that it is drawn in), and for the engraving face (the font that it stands for, "").
        lacking: letters that are in no font, and so are missing.
        assumed: other programs may set its letters in other places.
        words: all of them. height: of the largest letters, drawing units.
    """

    strokes: tuple[Curve, ...]
    outlines: tuple[Curve, ...]
    layer: str = "0"
    kind: str = "TEXT"
    at: Point = (0.0, 0.0)
    fonts: tuple[tuple[str, str], ...] = ()
    lacking: str = ""
    assumed: bool = False
    words: str = ""
    height: float = 0.0

    @property
    def size(self) -> int:
        """How many curves there are."""
        return len(self.strokes) + len(self.outlines)

    def drawn(self) -> Iterator[Curve]:
        """Yield its curves."""
        yield from self.outlines
        yield from self.strokes

    def moved(self, to: Affine, layer: str = "") -> TextCurves:
        """Return it under a map; what is on layer 0 goes to `layer`, where one is named."""
        strokes, outlines = (tuple(_moved(curves, to)) for curves in (self.strokes, self.outlines))
        return replace(
            self,
            strokes=strokes,
            outlines=outlines,
            at=to.point(self.at),
            height=self.height * math.sqrt(abs(to.xx * to.yy - to.xy * to.yx)),
            layer=layer if layer and self.layer == "0" else self.layer,
        )


def _moved(curves: Iterable[Curve], to: Affine) -> Iterator[Curve]:
    return (curve for each in curves if (curve := transformed(each, to)) is not None)


@dataclass(frozen=True)
class LetterRun:
    """Some words of one look, set with some letters."""

    words: str
    look: LetterStyle
    letters: LetterSet

    @property
    def unit(self) -> float:
        """Drawing units of one unit of the face, across the baseline."""
        return self.look.height / self.letters.face.capital

    @property
    def advance(self) -> float:
        """From the beginning of the words to where more of them go on, drawing units."""
        along = self._along()
        return along[-1] if along else 0.0

    @property
    def ink(self) -> float:
        """From the beginning of the words to the end of what is drawn, drawing units."""
        return max(self.advance - self.letters.face.between * self.unit * self.look.width, 0.0) if self.words else 0.0

    def _along(self) -> list[float]:
        """Return where each letter begins, and where the last one ends."""
        factor = self.unit * self.look.width
        found = list(placed(self.letters.face, self.words))
        ends = [at + glyph.advance for glyph, at in found[-1:]]
        return [x * factor * self.look.tracking for x in [*(at for _, at in found), *ends]]

    def curves(self, x: float, y: float) -> Iterator[tuple[Curve, bool]]:
        """Yield the curves of the words that begin at (x, y) on the baseline, and whether each is a stroke."""
        unit, lean = self.unit, math.tan(math.radians(self.look.oblique))
        for letter, along in zip(self.words, self._along(), strict=False):
            to = Affine(unit * self.look.width, unit * lean, 0.0, unit, x + along, y)
            yield from (
                (curve, letter in self.letters.strokes) for curve in _moved(self.letters.face.glyphs[letter].curves, to)
            )
        for bar in self.look.bars:
            at = y + bar.value * self.look.height
            yield from bar_curves((x + lean * (at - y), at), self.ink, self.look.height, not self.letters.font)


def run_of(words: str, look: LetterStyle, fonts: Fonts) -> LetterRun:
    """Return words with the letters that they are set with."""
    return LetterRun(words, look, fonts.of(look.font, words))


def bar_curves(start: Point, length: float, height: float, stroke: bool) -> Iterator[tuple[Curve, bool]]:
    """Yield a level line: one stroke, or the outline of a bar about it, for letters of some height."""
    (x, y), half = start, height * _THICK / 2
    if stroke:
        yield Line((x, y), (x + length, y)), True
        return
    corners = [(x, y - half), (x + length, y - half), (x + length, y + half), (x, y + half)]
    yield from ((Line(a, b), False) for a, b in zip(corners, corners[1:] + corners[:1], strict=True))


def lettered(curves: Iterable[tuple[Curve, bool]], runs: Iterable[LetterRun], to: Affine = IDENTITY) -> TextCurves:
    """Return what curves (and whether each is a stroke) of some runs are together, under a map."""
    drawn, runs = list(curves), list(runs)
    letters = [("" if run.letters.font else run.look.font.said, run.letters) for run in runs if run.words.strip()]
    strokes, outlines = (tuple(curve for curve, stroke in drawn if stroke is requested) for requested in (True, False))
    fonts = tuple(dict.fromkeys((said, each.font) for said, each in letters))
    lacking = "".join(dict.fromkeys(letter for _, each in letters for letter in each.lacking))
    words, height = "".join(run.words for run in runs), max((run.look.height for run in runs), default=0.0)
    return TextCurves(strokes, outlines, fonts=fonts, lacking=lacking, words=words, height=height).moved(to)
