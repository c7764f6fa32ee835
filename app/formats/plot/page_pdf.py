"""Sheets as a PDF file, written without Qt: polylines at true size, dashes by the reader, one page a sheet; letters
drawn, or in a font that every reader has.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import replace
from itertools import chain
from typing import TYPE_CHECKING

from .flat import FlatPolyline, flat_drawing, flat_frame
from .page import PageContent, Pen, PlotPage, TextLine
from .pdf_stream import stream
from .pdf_text import runs_of

if TYPE_CHECKING:
    from .pdf_fonts import PdfFonts, SetWords

_POINTS_PER_MM = 72 / 25.4

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
    pages = tuple(pages)
    words = ("\ufeff" + title).encode("utf-16-be").hex()
    objects = [b"<< /Type /Catalog /Pages 2 0 R >>", b"", f"<< /Title <{words}> >>".encode()]
    fonts = _fonts_of(pages) if in_font else None
    resources = "<< >>"
    if fonts is not None:
        made, places = fonts.objects(len(objects) + 1)
        objects += made
        named = " ".join(f"/F{number} {place} 0 R" for number, place in places.items())
        resources = f"<< /Font << {named} >> >>"
    kids: list[str] = []
    for page in pages:
        content = "\n".join(_content(page, fonts)).encode("ascii")
        kids.append(f"{len(objects) + 1} 0 R")
        size = f"{_n(page.width * _POINTS_PER_MM)} {_n(page.height * _POINTS_PER_MM)}"
        objects.append(
            (
                f"<< /Type /Page /Parent 2 0 R /MediaBox [0 0 {size}] /Resources {resources} "
                f"/Contents {len(objects) + 2} 0 R >>"
            ).encode()
        )
        objects.append(stream(content))
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


def _fonts_of(pages: Iterable[PlotPage]) -> PdfFonts:
    """Return the fonts that the words round the drawings are written in."""
    from .pdf_fonts import PdfFonts  # what reads fonts, where letters are asked for

    return PdfFonts(words.text for page in pages for words in page.frame.words)


def _content(page: PlotPage, fonts: PdfFonts | None) -> Iterator[str]:
    """Yield what draws a page; its unit is made 1 mm."""
    x0, y0, x1, y1 = page.window
    yield f"{_POINTS_PER_MM:.8f} 0 0 {_POINTS_PER_MM:.8f} 0 0 cm 1 J 1 j"
    yield f"q {_n(x0)} {_n(y0)} {_n(x1 - x0)} {_n(y1 - y0)} re W n"
    yield from _lines(flat_drawing(page))
    yield "Q"
    if fonts is None:
        yield from _lines(flat_frame(page))
        return
    frame = page.frame
    yield from _lines(flat_frame(replace(page, frame=PageContent((), frame.patches, (), frame.traces))))
    yield from _lines(flat_frame(replace(page, frame=PageContent(frame.strokes))))
    for words in chain.from_iterable(map(runs_of, frame.words)):
        run = fonts.set(words)
        if run is not None:
            yield _text(words, run)
        else:
            yield from _lines(flat_frame(replace(page, frame=PageContent(words=(words,)))))


def _text(words: TextLine, run: SetWords) -> str:
    """Return what writes a line of text; bold letters of a font that has none have a line round them."""
    cos, sin = math.cos(words.angle), math.sin(words.angle)
    back = words.anchor * run.width
    x = words.at[0] - words.lift * sin - back * cos
    y = words.at[1] + words.lift * cos - back * sin
    font = f"/F{run.font} {_n(run.size)} Tf"
    turn = f"{_n(cos)} {_n(sin)} {_n(-sin)} {_n(cos)} {_n(x)} {_n(y)} Tm"
    colour = _colour(words.pen)
    written = f"BT {colour} rg {font} {turn} {run.string} Tj ET"
    if not (words.bold and run.upright):
        return written
    return f"q {colour} RG {_n(_BOLDER * words.height)} w [] 0 d 2 Tr {written} Q"


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
