"""Letters of the machine's fonts in a PDF: text that can be read again, drawn as the font draws it."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import pytest
from fontTools.fontBuilder import FontBuilder
from fontTools.pens.areaPen import AreaPen
from fontTools.pens.t2CharStringPen import T2CharStringPen
from fontTools.ttLib import TTFont
from PySide6.QtCore import QByteArray, Qt
from PySide6.QtGui import QFont, QImage, QPainter, QPainterPath, QRawFont, QTransform

from app.formats.plot.font_program import font_program
from app.formats.plot.page import PageContent, PlotPage, TextLine
from app.formats.plot.page_pdf import pages_pdf
from app.formats.plot.pdf_fonts import FAMILIES, PdfFonts, has_letters
from app.geometry.transform import Similarity
from app.geometry.typeface import Typeface, installed
from tests.formats import pdf_words
from tests.formats.pdf_words import pdf_objects, pdf_pages

WORDS = "段取り票 深さ、仕上げ"
RUSSIAN = "Деталь 8"


def page(*words: TextLine) -> bytes:
    one = PlotPage(100.0, 100.0, (0.0, 0.0, 1.0, 1.0), Similarity(), PageContent(), PageContent(words=words))
    return pages_pdf([one], "a", in_font=True)


def raw_font(data: bytes) -> QRawFont:
    """A font of 256 pixels a body, without hints."""
    font = QRawFont()
    font.loadFromData(QByteArray(data), 256.0, QFont.HintingPreference.PreferNoHinting)
    assert font.isValid()
    return font


def painted(path: QPainterPath) -> np.ndarray:
    """A letter as Qt paints it, 256 pixels a body."""
    image = QImage(320, 400, QImage.Format.Format_Grayscale8)
    image.fill(0)
    painter = QPainter(image)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    painter.fillPath(QTransform.fromTranslate(20, 300).map(path), Qt.GlobalColor.white)
    painter.end()
    return np.frombuffer(image.constBits(), np.uint8).reshape(400, image.bytesPerLine()).astype(float)


@pytest.mark.parametrize("words", [WORDS, RUSSIAN])
def test_words_are_read_again_where_they_stand(words: str) -> None:
    if not has_letters(words):
        pytest.skip("no font is installed here that has these letters")
    (read,) = pdf_pages(
        page(TextLine("Ø6 " + words, (20.0, 30.0), 7.0), TextLine(words, (90.0, 9.0), 5.0, 1.0, bold=True))
    )
    assert "".join(word.text for word in read) == f"Ø6 {words}{words}"
    assert read[0].x == 20.0 and {word.y for word in read} == {30.0, 9.0}
    assert read[-1].bold and not read[0].bold and 90.0 - len(words) * 5.0 <= read[-1].x < 90.0


def test_each_letter_looks_as_in_its_own_font(qapp: object, tmp_path: Path) -> None:
    path = next((found for found in (installed("", family) for family in FAMILIES) if found is not None), None)
    if path is None or Typeface(path).lacking(letters := "".join(dict.fromkeys(WORDS.replace(" ", "")))):
        pytest.skip("no font is installed here that has these letters")
    objects = pdf_objects(page(TextLine(WORDS.replace(" ", ""), (20.0, 30.0), 7.0)))
    (font,) = (number for number, body in objects.items() if b"/Subtype /Type0" in body)
    program = pdf_words.font_program(objects, font)
    embedded, whole = raw_font(program), raw_font(path.read_bytes())
    signs = {sign: int(code, 16) for code, sign in pdf_words.signs_of(objects, font).items()}
    assert len(program) < 0.01 * path.stat().st_size and set(signs) == set(letters)
    for letter in letters:
        got = painted(embedded.pathForGlyph(signs[letter]))
        expected = painted(whole.pathForGlyph(whole.glyphIndexesForString(letter)[0]))
        assert expected.sum() > 0 and np.abs(got - expected).sum() < 0.005 * expected.sum(), letter


def small_font(path: Path, licence: int = 0) -> Path:
    """A font of cubics: a disc for "я", which is 600 units wide."""
    pen = T2CharStringPen(600, None)
    reach, handle = 250.0, 250.0 * 0.5522847498
    pen.moveTo((300 + reach, 300))
    for turn in (1, 1j, -1, -1j):
        ends = [300 + 300j + turn * each for each in (reach + 1j * handle, handle + 1j * reach, 1j * reach)]
        pen.curveTo(*((each.real, each.imag) for each in ends))
    pen.closePath()
    disc, empty = pen.getCharString(), T2CharStringPen(500, None).getCharString()
    builder = FontBuilder(1000, isTTF=False)
    builder.setupGlyphOrder([".notdef", "disc"])
    builder.setupCharacterMap({ord("я"): "disc"})
    builder.setupCFF("Disc", {}, {".notdef": empty, "disc": disc}, {})
    builder.setupHorizontalMetrics({".notdef": (500, 0), "disc": (600, 50)})
    builder.setupHorizontalHeader(ascent=800, descent=-200)
    builder.setupNameTable({"familyName": "Disc", "styleName": "Regular"})
    builder.setupOS2(fsType=licence)
    builder.setupPost()
    builder.save(path)
    return path


def test_cubics_become_parabolas(tmp_path: Path) -> None:
    typeface = Typeface(small_font(tmp_path / "disc.otf"))
    font = TTFont(io.BytesIO(font_program(typeface.face("я"), "я", typeface.units_per_em)))
    assert {"glyf", "loca", "head", "hhea", "hmtx", "maxp"} <= set(font.keys()) and "CFF " not in font
    pen = AreaPen(font.getGlyphSet())
    name = font.getGlyphOrder()[1]
    font.getGlyphSet()[name].draw(pen)
    assert abs(pen.value) == pytest.approx(np.pi * 250.0**2, rel=0.005)
    assert font["hmtx"][name] == (600, 50)


@pytest.mark.parametrize(
    ("licence", "may"), [(0, True), (2, False), (4, True), (8, True), (0x100, False), (0x200, False)]
)
def test_a_font_that_nobody_may_embed_is_left_aside(tmp_path: Path, licence: int, may: bool) -> None:
    assert Typeface(small_font(tmp_path / "disc.otf", licence)).embeddable == may


def test_words_that_no_font_has_are_strokes() -> None:
    beyond = "\U0010fffd"
    assert not has_letters(beyond) and PdfFonts([beyond]).set(TextLine(beyond, (0.0, 0.0), 3.0)) is None
    assert pdf_pages(page(TextLine(beyond, (20.0, 30.0), 7.0))) == [[]]
