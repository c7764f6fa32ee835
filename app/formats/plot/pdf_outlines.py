"""Words of a PDF that its font has no signs for, such as Japanese ones: outlines of a font of this machine."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from ...core.errors import HitofudeError
from ...geometry.transform import Similarity
from ...geometry.typeface import Typeface, installed
from .flat import letters_in
from .page import TextLine

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
                return list(letters_in(typeface.face(words.text), words, Similarity()))
        except HitofudeError:  # one of its letters cannot be read
            continue
    return None


@lru_cache(len(FAMILIES))
def _typeface(family: str) -> Typeface | None:
    path = installed("", family)
    try:
        return None if path is None else Typeface(path)
    except HitofudeError:
        return None
