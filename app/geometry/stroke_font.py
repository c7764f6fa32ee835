"""The engraving face: letters of single strokes, lines and arcs that join without a corner, from the resource
`fonts/hitofude.toml`.
"""

from __future__ import annotations

import cmath
import math
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache

from ..core.resources import resource
from ..model.curves import Arc, Curve, Line, Point
from .sample import bounds

_LOOSE = 1e-6
"""Stretches shorter than this, in units of the face, are not drawn: roundings that meet."""


@dataclass(frozen=True, slots=True)
class Glyph:
    """A letter in the units of its face, on the baseline, its origin at 0,0. advance: from its origin to that of the
    next.
    """

    curves: tuple[Curve, ...]
    advance: float


@dataclass(frozen=True, slots=True)
class StrokeFont:
    """Letters and how they stand beside one another.

    Attributes:
        capital: height of the capitals, units. between: the part of each advance that is empty at the end of a line,
            units.
        kerning: by a pair of letters what their distance is more than their advance, units.
        below: how far small letters reach below the baseline, units, >= 0.
    """

    name: str
    capital: float
    between: float
    glyphs: Mapping[str, Glyph]
    kerning: Mapping[tuple[str, str], float]
    below: float = 0.0


def placed(face: StrokeFont, words: str) -> Iterator[tuple[Glyph, float]]:
    """Yield the letters of a line and where their origins stand, units. Every letter must be one of the face."""
    at, before = 0.0, ""
    for letter in words:
        at += face.kerning.get((before, letter), 0.0)
        yield face.glyphs[letter], at
        at, before = at + face.glyphs[letter].advance, letter


@cache
def engraving() -> StrokeFont:
    """Return the engraving face."""
    table = tomllib.loads(resource("fonts", "hitofude.toml").read_text("utf-8"))
    strokes, metrics, kerning = table["glyphs"], table["metrics"], table["kerning"]
    glyphs = {letter: _glyph(letter, strokes, table["widths"].get(letter), metrics["between"]) for letter in strokes}
    pairs = {
        (pair[0], pair[1]): -kerning[kind] for kind in ("close", "tight") for pair in kerning[f"{kind}_pairs"].split()
    }
    return StrokeFont("engraving", metrics["capital"], metrics["between"], glyphs, pairs, reach_below(glyphs["p"]))


def reach_below(glyph: Glyph) -> float:
    """Return how far a letter reaches below the baseline, units, >= 0."""
    return max(0.0, -min((bounds(curve)[1] for curve in glyph.curves), default=0.0))


def _glyph(letter: str, strokes: Mapping[str, str], width: float | None, between: float) -> Glyph:
    drawn = list(_strokes(letter, strokes))
    inked = max((p[0] for stroke in drawn for p in stroke), default=0.0) if width is None else width
    return Glyph(tuple(curve for stroke in drawn for curve in rounded(stroke)), inked + between)


def _strokes(letter: str, strokes: Mapping[str, str]) -> Iterator[list[tuple[float, float, float]]]:
    for stroke in filter(None, map(str.strip, strokes[letter].split(";"))):
        if stroke[0] == "=":
            yield from _strokes(stroke[1:], strokes)
            continue
        corners = [[*map(float, corner.split(",")), 0.0] for corner in stroke.split()]
        yield [(c[0], c[1], c[2]) for c in corners]


def rounded(corners: list[tuple[float, float, float]]) -> Iterator[Curve]:
    """Yield the lines and arcs of a stroke through corners (x, y, radius of its rounding).

    Raises:
        ValueError: two roundings do not fit between their corners.
    """
    at = complex(*corners[0][:2])
    for (x0, y0, _), (x, y, r), (x1, y1, _) in zip(corners, corners[1:], corners[2:], strict=False):
        corner, way, on = complex(x, y), complex(x - x0, y - y0), complex(x1 - x, y1 - y)
        way, on = way / abs(way), on / abs(on)
        turn = cmath.phase(on / way)
        cut = r * math.tan(abs(turn) / 2)
        yield from _line(at, corner - cut * way, way)
        at = corner + cut * on
        if r:
            centre = corner - cut * way + way * 1j * math.copysign(r, turn)
            yield Arc(_point(corner - cut * way), _point(at), _point(centre), ccw=turn > 0)
    end = complex(*corners[-1][:2])
    before = complex(*corners[-2][:2])
    yield from _line(at, end, (end - before) / abs(end - before))


def _line(start: complex, end: complex, way: complex) -> Iterator[Line]:
    size = ((end - start) * way.conjugate()).real
    if size < -_LOOSE:
        raise ValueError(f"The roundings before {_point(end)} are too large by {-size:.3f}.")
    if size > _LOOSE:
        yield Line(_point(start), _point(end))


def _point(z: complex) -> Point:
    return (z.real, z.imag)
