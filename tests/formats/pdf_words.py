"""A small reader of what PDF files of ours say: each page's words with their places, by the table at the file's end."""

from __future__ import annotations

import re
import zlib
from dataclasses import dataclass


@dataclass(frozen=True)
class PdfWord:
    """A line of text: its left end and its foot, mm from the page's lower left corner, and its size, mm."""

    text: str
    x: float
    y: float
    size: float
    bold: bool


def pdf_objects(data: bytes) -> dict[int, bytes]:
    """Objects by their number, found by the table of places, as readers do."""
    at = int(re.findall(rb"startxref\n(\d+)\n%%EOF", data)[-1])
    table = data[at:].split(b"trailer")[0].split(b"\n")
    assert table[0] == b"xref"
    found = {}
    for number, line in enumerate(table[3 : 2 + int(table[1].split()[1])], 1):
        begin = int(line.split()[0])
        head, _, body = data[begin:].partition(b" 0 obj\n")
        assert int(head) == number
        found[number] = body.partition(b"\nendobj\n")[0]
    return found


def pdf_pages(data: bytes) -> list[list[PdfWord]]:
    """The words of each page, in the order in which they are written."""
    objects = pdf_objects(data)
    fonts = [body for body in objects.values() if b"/Type /Font" in body]
    assert all(b"/Helvetica" in font and b"/WinAnsiEncoding" in font for font in fonts)
    pages = []
    for body in objects.values():
        if b"/Type /Page " not in body:
            continue
        (number,) = re.findall(rb"/Contents (\d+) 0 R", body)
        stream = objects[int(number)].split(b"stream\n", 1)[1].rsplit(b"\nendstream", 1)[0]
        content = zlib.decompress(stream).decode("ascii")
        found = re.findall(r"BT .*? /F(\d) (\S+) Tf \S+ \S+ \S+ \S+ (\S+) (\S+) Tm <(.*?)> Tj ET", content)
        assert content.count("BT") == content.count("ET") == len(found)
        pages.append(
            [
                PdfWord(bytes.fromhex(text).decode("cp1252"), float(x), float(y), float(size), font == "2")
                for font, size, x, y, text in found
            ]
        )
    return pages
