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


def pdf_stream(objects: dict[int, bytes], number: int) -> bytes:
    """What is packed in an object, whose length it tells."""
    head, _, packed = objects[number].partition(b"\nstream\n")
    (length,) = re.findall(rb"/Length (\d+)", head)
    assert packed[int(length) :] == b"\nendstream"
    return zlib.decompress(packed[: int(length)])


def font_program(objects: dict[int, bytes], font: int) -> bytes:
    """The outlines of a font of many letters, by the way that the format has it."""
    descendant = pointed(objects[font], b"DescendantFonts [")
    return pdf_stream(objects, pointed(objects[pointed(objects[descendant], b"FontDescriptor ")], b"FontFile2 "))


def pointed(body: bytes, entry: bytes) -> int:
    """The number of the object that an entry means."""
    (number,) = re.findall(rb"/" + re.escape(entry) + rb"(\d+) 0 R", body)
    return int(number)


def signs_of(objects: dict[int, bytes], font: int) -> dict[str, str]:
    """The signs of a font by the hexadecimal digits that they are written with, by what the file tells of them."""
    if b"/WinAnsiEncoding" in objects[font]:
        assert b"/Helvetica" in objects[font]
        return {f"{code:02x}": bytes([code]).decode("cp1252", "replace") for code in range(256)}
    assert b"/Encoding /Identity-H" in objects[font]
    table = pdf_stream(objects, pointed(objects[font], b"ToUnicode ")).decode("ascii")
    counts = [int(each) for each in re.findall(r"(\d+) beginbfchar", table)]
    pairs = re.findall(r"^<(\w{4})> <(\w+)>$", table.partition("endcodespacerange")[2], re.MULTILINE)
    assert len(pairs) == sum(counts) and all(1 <= each <= 100 for each in counts)
    return {code: bytes.fromhex(sign).decode("utf-16-be") for code, sign in pairs}


def pdf_pages(data: bytes) -> list[list[PdfWord]]:
    """The words of each page, in the order in which they are written."""
    objects = pdf_objects(data)
    pages = []
    for body in objects.values():
        if b"/Type /Page " not in body:
            continue
        fonts = {name.decode(): int(place) for name, place in re.findall(rb"/F(\d+) (\d+) 0 R", body)}
        signs = {name: signs_of(objects, place) for name, place in fonts.items()}
        pages.append(_words(pdf_stream(objects, pointed(body, b"Contents ")).decode("ascii"), signs))
    return pages


def _words(content: str, signs: dict[str, dict[str, str]]) -> list[PdfWord]:
    """The words of a page's content."""
    found = re.findall(r"(2 Tr )?BT .*? /F(\d+) (\S+) Tf \S+ \S+ \S+ \S+ (\S+) (\S+) Tm <(.*?)> Tj ET", content)
    assert content.count("BT") == content.count("ET") == len(found)
    words = []
    for round_it, font, size, x, y, codes in found:
        step = len(next(iter(signs[font])))
        text = "".join(signs[font][codes[k : k + step]] for k in range(0, len(codes), step))
        words.append(PdfWord(text, float(x), float(y), float(size), font == "2" or bool(round_it)))
    return words
