"""Words of a PDF that its font has no signs for, such as Japanese ones: outlines of a font of this machine."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from ...core.errors import HitofudeError
from ...geometry.stroke_font import StrokeFont, placed
from ...geometry.transform import Similarity
from ...geometry.typeface import Typeface, installed
from .flat import CAPITAL, letters_in
from .page import TextLine
from .pdf_text import is_helvetica, is_wide, runs_of, text_width

FAMILIES = (
    *("Noto Sans CJK JP", "Noto Sans JP", "IPAexGothic", "IPAGothic", "VL Gothic", "TakaoGothic"),  # Linux
    *("Hiragino Sans", "Hiragino Kaku Gothic ProN", "Yu Gothic", "Meiryo", "MS Gothic"),  # macOS, Windows
    *("Noto Sans", "DejaVu Sans", "Arial Unicode MS", "Arial"),
)
"""Fonts that are looked for, in this order: first those that have Japanese letters."""


def outlined_words(words: TextLine) -> list[NDArray[np.float64]] | None:
    """Return the closed contours of a line's letters, mm on paper, to be filled even-odd; None where no font of this
    machine has all of its letters.
    """
    for family in FAMILIES:
        typeface = _typeface(family)
        try:
            if typeface is not None and not typeface.lacking(words.text):
                return _set(typeface.face(words.text), words)
        except HitofudeError:  # one of its letters cannot be read
            continue
    return None


def _set(face: StrokeFont, words: TextLine) -> list[NDArray[np.float64]]:
    """Return the contours of a line; wide signs fill the room that `text_width` gives them."""
    if is_wide(words.text):
        long = sum(glyph.advance for glyph, _ in placed(face, words.text))
        words = replace(words, height=text_width(words.text, 1.0) * words.height * face.capital / (CAPITAL * long))
    return list(letters_in(face, words, Similarity()))


def has_letters(text: str) -> bool:
    """Tell whether each sign of a text is in Helvetica, or in a font of this machine that has all its run."""
    runs = runs_of(TextLine(text, (0.0, 0.0), 1.0))
    return all(is_helvetica(run.text) or outlined_words(run) is not None for run in runs)


@lru_cache(len(FAMILIES))
def _typeface(family: str) -> Typeface | None:
    path = installed("", family)
    try:
        return None if path is None else Typeface(path)
    except HitofudeError:
        return None
