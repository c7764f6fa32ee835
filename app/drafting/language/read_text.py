"""The command that draws words: in strokes to engrave, or in the outlines of a font."""

from __future__ import annotations

from ...core.errors import InputError
from ...core.tolerances import WELD
from ...geometry.stroke_font import StrokeFont, engraving, placed
from ...geometry.transform import Similarity, transformed, turn
from ...model.curves import Curve
from ..commands.command import DraftingSession, Draw, counted
from ..expressions.arguments import Arguments
from ..expressions.values import wrong

MOST_LETTERS = 1000


def text(words: Arguments, session: DraftingSession) -> Draw:
    """Words on a baseline from a point on; the height is that of the capitals."""
    at = words.point("the lower left of the words")
    place, height = words.place, words.length("the height of the capitals")
    if height < 100 * WELD:
        raise wrong(f"The height is {height:g} mm; capitals are {100 * WELD:g} mm high or more.", place)
    said = words.name('the words, in "double quotes"')
    font, angle = "", 0.0
    while option := words.accept("font", "angle"):
        if option == "font":
            font = words.name('the font\'s name or file, in "double quotes"')
        else:
            angle = words.angle("the angle of the baseline")
    if not said.strip() or len(said) > MOST_LETTERS:
        raise InputError(f"There must be letters to draw, {MOST_LETTERS} at most.")
    face = _face(font, said)
    unit, turned = height / face.capital, turn(at, angle)
    curves, width = list[Curve](), 0.0
    for glyph, along in placed(face, said):
        onto = Similarity(turned.a * unit, complex(*turned((at[0] + along * unit, at[1]))))
        curves += [transformed(curve, onto) for curve in glyph.curves]
        width = along + glyph.advance - face.between
    figures = f"{width * unit:.3f} by {height:.3f} mm, {counted(len(curves), 'curve')}"
    return Draw("Text", tuple(curves), figures, at)


def _face(font: str, said: str) -> StrokeFont:
    if font:
        from ...geometry.typeface import outlined

        return outlined(font, said)
    face = engraving()
    lacking = " ".join(dict.fromkeys(letter for letter in said if letter not in face.glyphs))
    if lacking:
        raise InputError(
            f'The engraving face has no letter for {lacking}; choose other words, or a font: font "DejaVu Sans".'
        )
    return face
