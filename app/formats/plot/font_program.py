"""Letters of a face as a TrueType font of their own: what a PDF needs of them and no more, neither hints nor tables of
layout.
"""

from __future__ import annotations

import io
from typing import Any

from fontTools.fontBuilder import FontBuilder
from fontTools.pens.cu2quPen import Cu2QuPen
from fontTools.pens.ttGlyphPen import TTGlyphPen

from ...geometry.stroke_font import StrokeFont
from ...model.curves import Spline

_EMPTY = ".notdef"
_EPOCH = 2082844800
"""The beginning of 1970, s from that of 1904, by which fonts tell their time."""
_ERROR = 0.5
"""How far a cubic's arcs of parabolas may leave it, units of the font; corners are rounded to whole units anyway."""


def font_program(face: StrokeFont, letters: str, units_per_em: int) -> bytes:
    """Return a TrueType font in which glyph 1 is the first letter, 2 the second, and so on.

    Args:
        face: has all the letters, their contours closed, of lines and parabolas or cubics.
        letters: each once, at least one.
        units_per_em: of the face's units.
    """
    names = [_EMPTY, *(f"g{number}" for number, _ in enumerate(letters, 1))]
    glyphs = [TTGlyphPen(None).glyph(), *(_glyph(face, letter) for letter in letters)]
    advances = [units_per_em, *(round(face.glyphs[letter].advance) for letter in letters)]
    builder = FontBuilder(units_per_em)
    builder.updateHead(created=_EPOCH, modified=_EPOCH)  # equal letters make equal files, whenever they are written
    builder.setupGlyphOrder(names)
    builder.setupGlyf(dict(zip(names, glyphs, strict=True)))
    lefts = (getattr(glyph, "xMin", 0) for glyph in glyphs)
    builder.setupHorizontalMetrics(dict(zip(names, zip(advances, lefts, strict=True), strict=True)))
    builder.setupHorizontalHeader(ascent=units_per_em, descent=-round(face.below))
    written = io.BytesIO()
    builder.save(written)
    return written.getvalue()


def _glyph(face: StrokeFont, letter: str) -> Any:
    """Return a letter as a glyph of TrueType: corners, and handles of parabolas."""
    outline = TTGlyphPen(None)
    pen = Cu2QuPen(outline, _ERROR)
    end = None
    for curve in face.glyphs[letter].curves:
        if curve.start != end:
            if end is not None:
                pen.closePath()
            pen.moveTo(curve.start)
        end = curve.end
        if isinstance(curve, Spline):
            (pen.qCurveTo if curve.degree == 2 else pen.curveTo)(*curve.control_points[1:])
        else:
            pen.lineTo(end)
    if end is not None:
        pen.closePath()
    return outline.glyph(dropImpliedOnCurves=True)
