"""Fonts of a PDF: Helvetica, which every reader has, and of the machine's fonts the letters that it lacks, such as
Japanese ones. Every word can be searched and copied.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import lru_cache
from hashlib import sha256
from itertools import chain

from ...core.errors import HitofudeError
from ...geometry.stroke_font import StrokeFont
from ...geometry.typeface import Typeface, installed
from .page import TextLine
from .pdf_stream import stream
from .pdf_text import is_helvetica, is_wide, pdf_string, runs_of, text_width

FAMILIES = (
    *("Noto Sans CJK JP", "Noto Sans JP", "IPAexGothic", "IPAGothic", "VL Gothic", "TakaoGothic"),  # Linux
    *("Hiragino Sans", "Hiragino Kaku Gothic ProN", "Yu Gothic", "Meiryo", "MS Gothic"),  # macOS, Windows
    *("Noto Sans", "DejaVu Sans", "Arial Unicode MS", "Arial"),
)
"""Fonts that are looked for, in this order: first those that have Japanese letters."""

_STANDARD = tuple(
    f"<< /Type /Font /Subtype /Type1 /BaseFont /{name} /Encoding /WinAnsiEncoding >>".encode()
    for name in ("Helvetica", "Helvetica-Bold")
)
_SYMBOLIC = 4
"""Flag of a font that has signs beyond the Latin ones."""
_TO_UNICODE = """/CIDInit /ProcSet findresource begin
12 dict begin
begincmap
/CIDSystemInfo << /Registry (Adobe) /Ordering (UCS) /Supplement 0 >> def
/CMapName /Adobe-Identity-UCS def
/CMapType 2 def
1 begincodespacerange
<0000> <FFFF>
endcodespacerange
{ranges}
endcmap
CMapName currentdict /CMap defineresource pop
end
end"""
_MOST_IN_BLOCK = 100
"""Signs in a block of such a table, by the format."""


class PdfFonts:
    """All fonts of a file, numbered from 1."""

    def __init__(self, texts: Iterable[str]) -> None:
        """Take of the machine's fonts the letters that some texts need beside Helvetica's."""
        letters: dict[Typeface, dict[str, None]] = {}
        for run in chain.from_iterable(map(_runs, texts)):
            typeface = None if is_helvetica(run) else _typeface_with(run)
            if typeface is not None:
                letters.setdefault(typeface, {}).update(dict.fromkeys(run))
        self._embedded = {
            typeface: _EmbeddedFont.of(typeface, "".join(of_it), len(_STANDARD) + number)
            for number, (typeface, of_it) in enumerate(letters.items(), 1)
        }

    def objects(self, first: int) -> tuple[list[bytes], dict[int, int]]:
        """Return the file's objects that make the fonts, and which of them each font is, by its number.

        Args:
            first: number of the first object.
        """
        objects = list(_STANDARD)
        places = {number: first + number - 1 for number in range(1, len(objects) + 1)}
        for font in self._embedded.values():
            places[font.number] = first + len(objects)
            objects += font.objects(first + len(objects))
        return objects, places

    def set(self, words: TextLine) -> SetWords | None:
        """Return how a run of text is written; None where no font has all of its letters."""
        if is_helvetica(words.text):
            width = text_width(words.text, words.height, words.bold)
            return SetWords(1 + words.bold, words.height, width, pdf_string(words.text), upright=False)
        typeface = _typeface_with(words.text)
        return None if typeface is None else self._embedded[typeface].set(words)


@dataclass(frozen=True)
class SetWords:
    """A run of text as a font writes it: the font's number, the letters' size, the width in the same unit, the string.

    Attributes:
        upright: the font has no bold letters of its own.
    """

    font: int
    size: float
    width: float
    string: str
    upright: bool


@dataclass(frozen=True)
class _EmbeddedFont:
    """Letters of a font of this machine, in the file: a sign's code is its place among them, from 1."""

    name: str
    face: StrokeFont
    letters: str
    em: int
    number: int

    @staticmethod
    def of(typeface: Typeface, letters: str, number: int) -> _EmbeddedFont:
        plain = re.sub(r"[^A-Za-z0-9-]", "", typeface.name) or "Font"
        tag = "".join(chr(ord("A") + byte % 26) for byte in sha256(letters.encode()).digest()[:6])
        face = typeface.face(letters, kerned=False)
        return _EmbeddedFont(f"{tag}+{plain}", face, letters, typeface.units_per_em, number)

    def set(self, words: TextLine) -> SetWords:
        """Return how a run is written; wide signs fill the room that `text_width` gives them."""
        long = sum(self.face.glyphs[letter].advance for letter in words.text) / self.em
        size = text_width(words.text, words.height) / long if is_wide(words.text) and long else words.height
        codes = "".join(f"{self.letters.index(letter) + 1:04x}" for letter in words.text)
        return SetWords(self.number, size, long * size, f"<{codes}>", upright=True)

    def objects(self, first: int) -> list[bytes]:
        """Return the font, its letters, what is told of them, their outlines, and which signs they are."""
        from .font_program import font_program  # writers of fonts, where one is written

        program = font_program(self.face, self.letters, self.em)
        system = "<< /Registry (Adobe) /Ordering (Identity) /Supplement 0 >>"
        widths = " ".join(str(self._thousandths(self.face.glyphs[letter].advance)) for letter in self.letters)
        return [
            f"<< /Type /Font /Subtype /Type0 /BaseFont /{self.name} /Encoding /Identity-H "
            f"/DescendantFonts [{first + 1} 0 R] /ToUnicode {first + 4} 0 R >>".encode(),
            f"<< /Type /Font /Subtype /CIDFontType2 /BaseFont /{self.name} /CIDSystemInfo {system} "
            f"/CIDToGIDMap /Identity /DW 1000 /W [1 [{widths}]] /FontDescriptor {first + 2} 0 R >>".encode(),
            self._descriptor(first + 3),
            stream(program, f"/Length1 {len(program)} "),
            stream(_TO_UNICODE.format(ranges="\n".join(_blocks(self.letters))).encode()),
        ]

    def _descriptor(self, program: int) -> bytes:
        below, capital = self._thousandths(-self.face.below), self._thousandths(self.face.capital)
        return (
            f"<< /Type /FontDescriptor /FontName /{self.name} /Flags {_SYMBOLIC} /FontBBox [0 {below} 1000 1000] "
            f"/ItalicAngle 0 /Ascent 1000 /Descent {below} /CapHeight {capital} /StemV 80 "
            f"/FontFile2 {program} 0 R >>"
        ).encode()

    def _thousandths(self, units: float) -> int:
        return round(1000 * units / self.em)


def has_letters(text: str) -> bool:
    """Tell whether each sign of a text is in Helvetica, or in a font of this machine that has all its run."""
    return all(is_helvetica(run) or _typeface_with(run) is not None for run in _runs(text))


def _runs(text: str) -> Iterator[str]:
    return (run.text for run in runs_of(TextLine(text, (0.0, 0.0), 1.0)))


def _blocks(letters: str) -> Iterator[str]:
    """Yield the lines that tell which sign of Unicode each code means."""
    pairs = [f"<{code:04x}> <{letter.encode('utf-16-be').hex()}>" for code, letter in enumerate(letters, 1)]
    for k in range(0, len(pairs), _MOST_IN_BLOCK):
        block = pairs[k : k + _MOST_IN_BLOCK]
        yield "\n".join((f"{len(block)} beginbfchar", *block, "endbfchar"))


def _typeface_with(text: str) -> Typeface | None:
    """Return the first font of this machine that has all letters of a text, and may be in a file."""
    for family in FAMILIES:
        typeface = _typeface(family)
        try:
            if typeface is not None and not typeface.lacking(text):
                typeface.face(text, kerned=False)
                return typeface
        except HitofudeError:  # one of its letters cannot be read
            continue
    return None


@lru_cache(len(FAMILIES))
def _typeface(family: str) -> Typeface | None:
    path = installed("", family)
    try:
        typeface = None if path is None else Typeface(path)
    except HitofudeError:
        return None
    return typeface if typeface is not None and typeface.embeddable else None
