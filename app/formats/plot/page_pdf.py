"""Sheets as a PDF file, written without Qt: polylines at true size, dashes by the reader, one page a sheet; letters
drawn, or in a font that every reader has.
"""

from __future__ import annotations

import math
import zlib
from collections.abc import Iterable, Iterator
from dataclasses import replace
from itertools import chain

import numpy as np
from numpy.typing import NDArray

from .flat import FlatPolyline, flat_drawing, flat_frame
from .page import PageContent, Pen, PlotPage, TextLine
from .pdf_text import is_helvetica, pdf_string, runs_of, text_width

_POINTS_PER_MM = 72 / 25.4
_FONTS = tuple(
    f"<< /Type /Font /Subtype /Type1 /BaseFont /{name} /Encoding /WinAnsiEncoding >>"
    for name in ("Helvetica", "Helvetica-Bold")
)

_BOLDER = 0.035
"""Width of the line round bold letters that are drawn, of their size."""


def pages_pdf(pages: Iterable[PlotPage], title: str, in_font: bool = False) -> bytes:
    """Return all sheets as PDF 1.4.

    Args:
        title: in the file.
        in_font: words round the drawing are text in Helvetica, where it has all their signs; else all are drawn.

    Raises:
        GeometryError: a spline cannot be followed.
    """
    words = ("\ufeff" + title).encode("utf-16-be").hex()
    objects = [b"<< /Type /Catalog /Pages 2 0 R >>", b"", f"<< /Title <{words}> >>".encode()]
    fonts = _FONTS if in_font else ()
    objects += [font.encode() for font in fonts]
    named = " ".join(f"/F{number} {3 + number} 0 R" for number in range(1, len(fonts) + 1))
    resources = f"<< /Font << {named} >> >>" if fonts else "<< >>"
    kids: list[str] = []
    for page in pages:
        content = zlib.compress("\n".join(_content(page, in_font)).encode("ascii"))
        kids.append(f"{len(objects) + 1} 0 R")
        size = f"{_n(page.width * _POINTS_PER_MM)} {_n(page.height * _POINTS_PER_MM)}"
        objects.append(
            (
                f"<< /Type /Page /Parent 2 0 R /MediaBox [0 0 {size}] /Resources {resources} "
                f"/Contents {len(objects) + 2} 0 R >>"
            ).encode()
        )
        objects.append(
            f"<< /Length {len(content)} /Filter /FlateDecode >>\nstream\n".encode() + content + b"\nendstream"
        )
    objects[1] = f"<< /Type /Pages /Kids [{' '.join(kids)}] /Count {len(kids)} >>".encode()
    return _file(objects)


def _file(objects: list[bytes]) -> bytes:
    """Return numbered objects with the table of where they begin."""
    parts, at, begins = [b"%PDF-1.4\n%\xe2\xe3\xcf\xd3\n"], 15, []
    for number, each in enumerate(objects, 1):
        begins.append(at)
        parts.append(f"{number} 0 obj\n".encode() + each + b"\nendobj\n")
        at += len(parts[-1])
    table = "".join(f"{begin:010d} 00000 n \n" for begin in begins)
    parts.append(f"xref\n0 {len(objects) + 1}\n0000000000 65535 f \n{table}".encode())
    parts.append(f"trailer\n<< /Size {len(objects) + 1} /Root 1 0 R /Info 3 0 R >>\nstartxref\n{at}\n%%EOF\n".encode())
    return b"".join(parts)


def _content(page: PlotPage, in_font: bool) -> Iterator[str]:
    """Yield what draws a page; its unit is made 1 mm."""
    x0, y0, x1, y1 = page.window
    yield f"{_POINTS_PER_MM:.8f} 0 0 {_POINTS_PER_MM:.8f} 0 0 cm 1 J 1 j"
    yield f"q {_n(x0)} {_n(y0)} {_n(x1 - x0)} {_n(y1 - y0)} re W n"
    yield from _lines(flat_drawing(page))
    yield "Q"
    if not in_font:
        yield from _lines(flat_frame(page))
        return
    from .pdf_outlines import outlined_words  # what reads fonts, where letters are asked for

    frame = page.frame
    yield from _lines(flat_frame(replace(page, frame=PageContent((), frame.patches, (), frame.traces))))
    yield from _lines(flat_frame(replace(page, frame=PageContent(frame.strokes))))
    for words in chain.from_iterable(map(runs_of, frame.words)):
        if is_helvetica(words.text):
            yield _text(words)
        elif (outlines := outlined_words(words)) is not None:
            yield _filled(words, outlines)
        else:
            yield from _lines(flat_frame(replace(page, frame=PageContent(words=(words,)))))


def _filled(words: TextLine, outlines: Iterable[NDArray[np.float64]]) -> str:
    """Return what fills the contours of letters even-odd; bold ones have a line round them."""
    runs = (" l ".join(f"{x:.4f} {y:.4f}" for x, y in points.tolist()).replace(" l ", " m ", 1) for points in outlines)
    colour, width = _colour(words.pen), _n(_BOLDER * words.height)
    contours = " ".join(f"{run} l h" for run in runs)
    return f"{colour} rg {colour} RG {width} w [] 0 d {contours} B*" if words.bold else f"{colour} rg {contours} f*"


def _text(words: TextLine) -> str:
    """Return what writes a line of text."""
    cos, sin = math.cos(words.angle), math.sin(words.angle)
    back = words.anchor * text_width(words.text, words.height, words.bold)
    x = words.at[0] - words.lift * sin - back * cos
    y = words.at[1] + words.lift * cos - back * sin
    font = f"/F{1 + words.bold} {_n(words.height)} Tf"
    turn = f"{_n(cos)} {_n(sin)} {_n(-sin)} {_n(cos)} {_n(x)} {_n(y)} Tm"
    return f"BT {_colour(words.pen)} rg {font} {turn} {pdf_string(words.text)} Tj ET"


def _lines(flats: Iterable[FlatPolyline]) -> Iterator[str]:
    at: Pen | None = None
    for flat in flats:
        if flat.pen != at:
            at = flat.pen
            colour = _colour(at)
            yield f"{colour} RG {colour} rg {_n(at.width)} w [{' '.join(map(_n, at.dash))}] 0 d"
        first, *others = [f"{x:.5f} {y:.5f}" for x, y in flat.points.tolist()]
        yield f"{first} m {' l '.join(others)} l {'f' if flat.filled else 'S'}"


def _colour(pen: Pen) -> str:
    return " ".join(_n(int(pen.colour[k : k + 2], 16) / 255) for k in (1, 3, 5))


def _n(value: float) -> str:
    """Return a number to ten nanometres, never with an exponent."""
    return f"{value:.5f}".rstrip("0").rstrip(".") or "0"
