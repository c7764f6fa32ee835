"""Words in curves: the engraving face and the outlines of fonts."""

import math
import string
from itertools import pairwise
from pathlib import Path

import pytest
from fontTools.fontBuilder import FontBuilder
from fontTools.pens.ttGlyphPen import TTGlyphPen

from app.core.errors import InputError
from app.drafting.commands.measure import measures
from app.drafting.document import Document
from app.drafting.expressions.errors import CommandError
from app.drafting.language.write import draw_text
from app.geometry.sample import bounds
from app.geometry.stroke_font import engraving, placed, rounded
from app.model.curves import Arc, Curve, Line, Spline

PRINTABLE = "".join(sorted(set(string.printable) - set(string.whitespace)))
MORE = "Ø°±µÄÖÜäöüßéèàçñ"


def drawn(line: str) -> list[Curve]:
    document = Document()
    document.run(line)
    return [entity.curve for entity in document.part.entities]


def extent(curves: list[Curve]) -> tuple[float, float, float, float]:
    boxes = [bounds(curve) for curve in curves]
    return (*(min(b[k] for b in boxes) for k in (0, 1)), *(max(b[k] for b in boxes) for k in (2, 3)))  # type: ignore[return-value]


@pytest.mark.parametrize("letter", PRINTABLE + MORE)
def test_every_letter_is_drawn_within_its_advance(letter: str) -> None:
    glyph = engraving().glyphs[letter]
    x0, y0, x1, y1 = extent(list(glyph.curves))
    assert x0 == pytest.approx(0, abs=1e-9)
    assert x1 + engraving().between == pytest.approx(glyph.advance)
    assert -4 - 1e-9 <= y0 <= y1 <= 18.4 + 1e-9
    assert all(isinstance(curve, Line | Arc) for curve in glyph.curves)


@pytest.mark.parametrize("letter", PRINTABLE + MORE)
def test_no_stretch_of_a_letter_is_engraved_twice(letter: str) -> None:
    lines = [curve for curve in engraving().glyphs[letter].curves if isinstance(curve, Line)]
    for n, a in enumerate(lines):
        way = complex(a.end[0] - a.start[0], a.end[1] - a.start[1])
        for b in lines[n + 1 :]:
            ends = [
                complex(p[0] - a.start[0], p[1] - a.start[1]) * way.conjugate() / abs(way) for p in (b.start, b.end)
            ]
            if all(abs(z.imag) < 1e-6 for z in ends):
                low, high = sorted(z.real for z in ends)
                assert min(high, abs(way)) - max(low, 0) < 1e-6


def test_roundings_join_without_a_corner_and_must_fit() -> None:
    curves = list(rounded([(0, 0, 0), (10, 0, 3), (10, 10, 0)]))
    assert [type(curve) for curve in curves] == [Line, Arc, Line]
    assert all(math.dist(a.end, b.start) < 1e-12 for a, b in pairwise(curves))
    assert (
        isinstance(curves[1], Arc)
        and curves[1].centre == pytest.approx((7, 3))
        and curves[1].sweep == pytest.approx(math.pi / 2)
    )
    with pytest.raises(ValueError, match="too large"):
        list(rounded([(0, 0, 0), (2, 0, 3), (2, 10, 0)]))


@pytest.mark.parametrize("height", [0.5, 3.0, 40.0])
def test_the_height_is_that_of_the_capitals(height: float) -> None:
    x0, y0, _, y1 = extent(drawn(f'text 5,7 {height} "HE"'))
    assert (x0, y0, y1) == pytest.approx((5, 7, 7 + height))


def test_letters_stand_beside_one_another_and_pairs_are_kerned() -> None:
    face = engraving()
    assert [at for _, at in placed(face, "HI")] == pytest.approx([0, 9 + face.between])
    assert [at for _, at in placed(face, "AV")] == pytest.approx([0, 10 + face.between - 2.4])


def test_an_angle_turns_the_words_about_their_beginning() -> None:
    level, upright = extent(drawn('text 5,7 10 "Engrave"')), extent(drawn('text 5,7 10 "Engrave" angle 90'))
    assert (7 + level[2] - 5, 5 - (level[3] - 7)) == pytest.approx((upright[3], upright[0]))


def test_words_that_are_drawn_are_one_step_and_read_back() -> None:
    document, again = Document(), Document()
    document.run('text 5,7 10 "N° 7"')
    again.run(draw_text(document.part).text)
    assert again.part.entities == document.part.entities
    document.run("undo")
    assert not document.part.entities


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ('text 0,0 10 "日本"', "no letter for 日 本"),
        ('text 0,0 0 "A"', "height"),
        ('text 0,0 10 "  "', "letters"),
        ("text 0,0 10", "words"),
        ('text 0,0 10 "A" font "no such font at all"', "no font"),
        ('text 0,0 10 "A" font "nowhere/none.ttf"', "no font file"),
    ],
)
def test_what_cannot_be_drawn_says_why(line: str, says: str) -> None:
    with pytest.raises(CommandError, match=says):
        Document().run(line)


@pytest.fixture
def font(tmp_path: Path) -> Path:
    """A font with one letter, O: a square with a rounded hole; capitals 700 of 1000 units high."""
    pen = TTGlyphPen(None)
    pen.moveTo((50, 0))
    for at in ((50, 700), (650, 700), (650, 0)):
        pen.lineTo(at)
    pen.closePath()
    pen.moveTo((350, 100))
    pen.qCurveTo((600, 100), (600, 600), (100, 600), (100, 100), (350, 100))
    pen.closePath()
    made = FontBuilder(1000, isTTF=True)
    made.setupGlyphOrder([".notdef", "O"])
    made.setupCharacterMap({ord("O"): "O"})
    made.setupGlyf({".notdef": TTGlyphPen(None).glyph(), "O": pen.glyph()})
    made.setupHorizontalMetrics({".notdef": (500, 0), "O": (700, 50)})
    made.setupHorizontalHeader(ascent=800, descent=-200)
    made.setupNameTable({"familyName": "Square", "styleName": "Regular"})
    made.setupOS2(sCapHeight=700)
    made.setupPost()
    made.save(tmp_path / "square.ttf")
    return tmp_path / "square.ttf"


def test_a_font_draws_closed_outlines_at_the_height_of_its_capitals(font: Path) -> None:
    curves = drawn(f'text 0,0 7 "OO" font "{font.as_posix()}"')
    assert extent(curves) == pytest.approx((0.5, 0, 13.5, 7))
    assert sum(isinstance(curve, Spline) for curve in curves) == 8
    ends = sorted((round(p[0], 6), round(p[1], 6)) for curve in curves for p in (curve.start, curve.end))
    assert ends[::2] == ends[1::2]


def test_outlines_form_regions_with_their_islands(font: Path) -> None:
    found = measures(dict(enumerate(drawn(f'text 0,0 7 "OO" font "{font.as_posix()}"'))))
    hole = 25 - 4 * 2.5**2 / 6  # a parabola cuts a sixth of its square off each corner
    assert found.area == pytest.approx(2 * (42 - hole), abs=1e-6)


def test_a_font_that_lacks_a_letter_or_is_none_says_so(font: Path, tmp_path: Path) -> None:
    with pytest.raises(CommandError, match="no letter for A"):
        Document().run(f'text 0,0 7 "OA" font "{font.as_posix()}"')
    (tmp_path / "broken.ttf").write_bytes(b"no font")
    with pytest.raises(CommandError, match="cannot be read"):
        Document().run(f'text 0,0 7 "O" font "{(tmp_path / "broken.ttf").as_posix()}"')


def test_a_font_with_any_byte_broken_draws_or_says_so(
    font: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    """Its tables were read by a library that raises whatever comes: struct.error, IndexError, MemoryError for a length
    of 4 GB.
    """
    whole, refused = font.read_bytes(), 0
    for k in range(0, len(whole), 5):
        (tmp_path / "broken.ttf").write_bytes(whole[:k] + b"\xff" * 2 + whole[k + 2 :])
        try:
            drawn(f'text 0,0 7 "O" font "{(tmp_path / "broken.ttf").as_posix()}"')
        except InputError as error:
            assert "broken.ttf" in str(error) or "no letter" in str(error)
            refused += 1
    assert 20 < refused < len(whole) // 5 and capfd.readouterr().err == ""


def test_a_letter_whose_parts_double_with_each_step_is_refused(tmp_path: Path) -> None:
    """Forty letters, each twice the one before: 2^40 parts."""
    names = [".notdef", *(f"g{k}" for k in range(40))]
    made, pens = FontBuilder(1000, isTTF=True), {name: TTGlyphPen(dict.fromkeys(names)) for name in names}
    for before, name in pairwise(names[1:]):
        pens[name].addComponent(before, (1, 0, 0, 1, 0, 0))
        pens[name].addComponent(before, (1, 0, 0, 1, 5, 0))
    made.setupGlyphOrder(names)
    made.setupCharacterMap({ord("O"): names[-1]})
    glyphs = {name: pen.glyph() for name, pen in pens.items()}
    for glyph in glyphs.values():
        glyph.xMin = glyph.yMin = glyph.xMax = glyph.yMax = 0  # to work them out takes as long as to draw it
    made.setupGlyf(glyphs, calcGlyphBounds=False)
    made.setupHorizontalMetrics(dict.fromkeys(names, (600, 0)))
    made.setupHorizontalHeader(ascent=800)
    made.setupNameTable({"familyName": "Bomb"})
    made.setupOS2(sCapHeight=700)
    made.setupPost()
    made.font.recalcBBoxes = False
    made.save(tmp_path / "bomb.ttf")
    with pytest.raises(CommandError, match="more than 1000 parts"):
        Document().run(f'text 0,0 7 "O" font "{(tmp_path / "bomb.ttf").as_posix()}"')
