"""Faces for the texts of a DXF: of the fonts that it names where they are installed here, else the engraving face."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from ...core.errors import InputError
from ...geometry.affine import scaled, transformed
from ...geometry.stroke_font import Glyph, StrokeFont, engraving

if TYPE_CHECKING:
    from ...geometry.typeface import Typeface

_STROKED = ("", "txt", "standard")
"""Names without an ending of fonts that are strokes in every CAD program; they are no families."""
_LONGEST = 60
"""Letters of a name in a sentence."""


@dataclass(frozen=True, slots=True)
class FontName:
    """A font as a drawing names it: by the file of a text style, or by a family; both may be there, or none."""

    file: str = ""
    family: str = ""
    bold: bool = False
    italic: bool = False

    @property
    def said(self) -> str:
        """What the font is called in a sentence; "" where it is not named."""
        return "".join(c if c.isprintable() else "?" for c in self.file or self.family)[:_LONGEST].strip()

    @property
    def style(self) -> str:
        """The words for it in the names of fonts."""
        return " ".join(word for word, requested in (("bold", self.bold), ("italic", self.italic)) if requested)


@dataclass(frozen=True, slots=True)
class LetterSet:
    """Letters to set some words with.

    Attributes:
        face: has every letter of the words; one that is in no font has no curves in it.
        font: that they are of; "" = the engraving face.
        strokes: letters that are strokes and no outlines.
        lacking: letters that neither the font nor the engraving face has.
    """

    face: StrokeFont
    font: str
    strokes: frozenset[str]
    lacking: str


@dataclass
class Fonts:
    """The fonts that one drawing uses; every file is opened once.

    Attributes:
        styles: the library's table of text styles.
    """

    styles: Any
    _found: dict[FontName, Typeface | None] = field(default_factory=dict)

    def style(self, name: str) -> Any:
        """Return the text style of a name, None where the drawing has none."""
        return self.styles.get(name) if self.styles.has_entry(name) else None

    def of(self, name: FontName, words: str) -> LetterSet:
        """Return the letters for some words; those that the font lacks are of the engraving face."""
        strokes = engraving()
        font = self._font(name)
        if font is None:
            lacking = "".join(dict.fromkeys(letter for letter in words if letter not in strokes.glyphs))
            blank = Glyph((), strokes.glyphs[" "].advance)
            return LetterSet(
                replace(strokes, glyphs={**strokes.glyphs, **dict.fromkeys(lacking, blank)}),
                "",
                frozenset(words),
                lacking,
            )
        try:
            face, drawn = font.face(words, kerned=False), font.lacking(words)
        except InputError:  # a letter in it is damaged
            self._found[name] = None
            return self.of(name, words)
        factor = face.capital / strokes.capital
        others = {
            letter: _larger(strokes.glyphs.get(letter, Glyph((), strokes.glyphs[" "].advance)), factor)
            for letter in drawn
        }
        lacking = "".join(letter for letter in drawn if letter not in strokes.glyphs)
        return LetterSet(replace(face, glyphs={**face.glyphs, **others}), font.name, frozenset(drawn), lacking)

    def _font(self, name: FontName) -> Typeface | None:
        from ...geometry.typeface import Typeface  # reading fonts is for drawings with texts alone

        if name not in self._found:
            try:
                path = _path(name)
                self._found[name] = None if path is None else Typeface(path)
            except InputError:  # what cannot be read is as good as not there
                self._found[name] = None
        return self._found[name]


def _path(name: FontName) -> Any:
    """Return the file of an installed font; strokes (.shx) have none, unless the drawing tells their family too."""
    from ...geometry.typeface import installed

    bare = "." not in name.file
    family = name.family or (name.file if bare and name.file.casefold() not in _STROKED else "")
    return installed(name.file, family, name.style)


def _larger(glyph: Glyph, factor: float) -> Glyph:
    curves = (transformed(curve, scaled(factor)) for curve in glyph.curves)
    return Glyph(tuple(curve for curve in curves if curve is not None), glyph.advance * factor)


def style_font(style: Any) -> FontName:
    """Return the font of a text style of the library, or none for None."""
    if style is None:
        return FontName()
    file = str(style.dxf.get("font", "") or "")
    family, italic, bold = style.get_extended_font_data() if style.has_extended_font_data else ("", False, False)
    return FontName(file, str(family), bool(bold), bool(italic))
