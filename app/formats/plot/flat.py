"""A sheet as nothing but polylines on paper, letters too: for formats that are written without Qt, its painter and its
fonts.
"""

from __future__ import annotations

import cmath
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...geometry.stroke_font import StrokeFont, engraving, placed
from ...geometry.transform import Similarity, transformed
from ...model.curves import Curve
from .page import PageContent, Pen, PlotPage, TextLine, chains, segments

Floats = NDArray[np.float64]

_TOLERANCE = 0.002
"""mm on paper between a curve and its chords."""
_STEPS = np.linspace(0.0, 1.0, 9)[1:, None]
"""Parameters of a cubic at which it is made chords of."""
CAPITAL, _LETTER_WIDTH = 0.72, 0.07
"""Height of capitals and width of their lines, of the height of a text."""


@dataclass(frozen=True, slots=True, eq=False)
class FlatPolyline:
    """A polyline, or the corners of a filled polygon: (n, 2) mm on paper from the lower left corner, y up."""

    pen: Pen
    points: Floats
    filled: bool = False


def flat_drawing(page: PlotPage) -> Iterator[FlatPolyline]:
    """Yield what lies in the page's window, in the order of drawing; the caller clips it there."""
    return _flat(page.drawing, page.place)


def flat_frame(page: PlotPage) -> Iterator[FlatPolyline]:
    """Yield what lies round the drawing."""
    return _flat(page.frame, Similarity())


def _flat(ink: PageContent, place: Similarity) -> Iterator[FlatPolyline]:
    for trace in ink.traces:
        yield FlatPolyline(trace.pen, trace.placed(place))
    for stroke in ink.strokes:
        for points in _polylines([transformed(curve, place) for curve in stroke.curves]):
            yield FlatPolyline(stroke.pen, points)
    for patch in ink.patches:
        yield FlatPolyline(patch.pen, np.array([place(corner) for corner in patch.corners]), filled=True)
    for words in ink.words:
        yield from _letters(words, place)


def _polylines(curves: Sequence[Curve]) -> Iterator[Floats]:
    for run in chains(curves):
        points = [np.array([run[0].start])]
        for curve in run:
            for ends in segments(curve, _TOLERANCE):
                points.append(_along(points[-1][-1], np.array(ends)))
        yield np.concatenate(points)


def _along(start: Floats, ends: Floats) -> Floats:
    """Return places along a cubic, or the end of a line."""
    if len(ends) == 1:
        return ends
    t, (b, c, d) = _STEPS, ends
    return np.asarray((1 - t) ** 3 * start + 3 * t * (1 - t) ** 2 * b + 3 * t**2 * (1 - t) * c + t**3 * d)


def _letters(words: TextLine, place: Similarity) -> Iterator[FlatPolyline]:
    """Yield a text in the engraving face; a letter that it lacks is a question mark."""
    face = engraving()
    text = "".join(letter if letter in face.glyphs else "?" for letter in words.text)
    pen = Pen(words.pen.number, words.pen.colour, words.height * _LETTER_WIDTH)
    for points in letters_in(face, replace(words, text=text), place):
        yield FlatPolyline(pen, points)


def letters_in(face: StrokeFont, words: TextLine, place: Similarity) -> Iterator[Floats]:
    """Yield the curves of a text's letters in a face, as polylines on paper; every letter must be one of the face."""
    letters = list(placed(face, words.text))
    if not letters:
        return
    size = words.height * CAPITAL / face.capital
    long = letters[-1][1] + letters[-1][0].advance - face.between
    turn = cmath.rect(1.0, words.angle)
    foot = complex(*place(words.at)) + turn * complex(-words.anchor * long * size, words.lift)
    for glyph, at in letters:
        to = Similarity(turn * size, foot + turn * size * at)
        yield from _polylines([transformed(curve, to) for curve in glyph.curves])


def dashes(points: Floats, pattern: Sequence[float]) -> Iterator[Floats]:
    """Yield the drawn parts of a polyline (n, 2), dash and gap by turns, running on along all of it."""
    along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])
    marks = np.concatenate([[0.0], np.cumsum(pattern)])
    starts = np.arange(0.0, along[-1], marks[-1])[:, None]
    first, last = (starts + marks[:-1:2]).ravel(), np.minimum((starts + marks[1::2]).ravel(), along[-1])
    drawn = first < along[-1]
    first, last = first[drawn], last[drawn]
    begins, ends = (
        np.stack([np.interp(at, along, points[:, axis]) for axis in (0, 1)], axis=1) for at in (first, last)
    )
    rows = zip(begins, ends, np.searchsorted(along, first, "right"), np.searchsorted(along, last, "left"), strict=True)
    for begin, end, low, high in rows:
        yield np.concatenate([begin[None], points[low:high], end[None]])
