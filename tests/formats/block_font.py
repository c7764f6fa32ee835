"""A font whose letters are rectangles, so that every text in it has closed forms; capitals 700 of 1000 units high."""

from collections.abc import Iterator
from pathlib import Path

import pytest
from fontTools.fontBuilder import FontBuilder
from fontTools.pens.ttGlyphPen import TTGlyphPen

from app.geometry import typeface
from app.geometry.sample import bounds, union
from app.model.curves import Curve

LETTERS = {
    "H": (100, 0, 500, 700, 600),
    "p": (100, -200, 400, 500, 500),
    "Ø": (0, 0, 700, 700, 700),
    "±": (100, 100, 300, 300, 400),
}
"""x0, y0, x1, y1 and the advance, units."""
NAMES = {"H": "H", "p": "p", "Ø": "Oslash", "±": "plusminus", " ": "space"}


def _glyph(box: tuple[int, ...]) -> object:
    pen = TTGlyphPen(None)
    x0, y0, x1, y1 = box[:4]
    pen.moveTo((x0, y0))
    for corner in ((x0, y1), (x1, y1), (x1, y0)):
        pen.lineTo(corner)
    pen.closePath()
    return pen.glyph()


def save(path: Path, family: str = "Block", style: str = "Regular") -> None:
    """Write the font."""
    blank = TTGlyphPen(None).glyph()
    made = FontBuilder(1000, isTTF=True)
    made.setupGlyphOrder([".notdef", *NAMES.values()])
    made.setupCharacterMap({ord(letter): name for letter, name in NAMES.items()})
    made.setupGlyf({".notdef": blank, "space": blank} | {NAMES[letter]: _glyph(box) for letter, box in LETTERS.items()})
    made.setupHorizontalMetrics(
        {".notdef": (500, 0), "space": (300, 0)} | {NAMES[k]: (box[4], box[0]) for k, box in LETTERS.items()}
    )
    made.setupHorizontalHeader(ascent=800, descent=-200)
    made.setupNameTable({"familyName": family, "styleName": style})
    made.setupOS2(sCapHeight=700)
    made.setupPost()
    made.save(path)


def forget_fonts() -> None:
    """Forget which fonts are installed."""
    for known in (typeface._files, typeface._faces, typeface._installed):
        known.cache_clear()


@pytest.fixture
def fonts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A machine on which the block font is all there is: as block.ttf, family Block, and its bold style as
    heavy.ttf.
    """
    folder = tmp_path / "fonts"
    folder.mkdir()
    save(folder / "block.ttf")
    save(folder / "heavy.ttf", style="Bold")
    monkeypatch.setattr(typeface, "_folders", lambda: (folder,))
    forget_fonts()
    yield folder
    forget_fonts()


def boxes(curves: list[Curve]) -> list[tuple[float, float, float, float]]:
    """Return the box of each letter, which are four lines each."""
    assert len(curves) % 4 == 0
    found = [union([bounds(curve) for curve in curves[k : k + 4]]) for k in range(0, len(curves), 4)]
    return [(box[0], box[1], box[2], box[3]) for box in found if box is not None]
