"""Codes within the texts of a DXF: %%c and its like, Unicode and multibyte numbers, control characters, lines along the
words.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterator
from enum import Enum

_CODE = re.compile(r"%%(?:([cdpouk%])|(\d{3}))|\\U\+([0-9a-f]{4})|\\M\+([1-5])([0-9a-f]{4})|\^(.)", re.IGNORECASE)
_SIGNS = {"c": "Ø", "d": "°", "p": "±", "%": "%"}
_OF_STROKED_FONTS = {127: "°", 128: "±", 129: "Ø"}
_PAGES = {"1": "cp932", "2": "cp950", "3": "cp949", "4": "johab", "5": "cp936"}


class TextBar(Enum):
    """A line along the words; the value is its height over the baseline in heights of the capitals."""

    UNDER = -0.2
    OVER = 1.2
    THROUGH = 0.5


_BARS = {"u": TextBar.UNDER, "o": TextBar.OVER, "k": TextBar.THROUGH}


def numbered_signs(text: str) -> str:
    """Return a text with Unicode and multibyte numbers, `\\U+00B1` and `\\M+1889F`, as the letters that they mean."""
    return _CODE.sub(lambda match: _sign(match) if match[3] or match[4] else match[0], text)


def stretches(text: str) -> Iterator[tuple[str, frozenset[TextBar]]]:
    """Yield the stretches of a text of one line, and the lines along each; codes are the letters that they mean."""
    at, bars = 0, frozenset[TextBar]()
    words = ""
    for match in _CODE.finditer(text):
        words += text[at : match.start()]
        at = match.end()
        bar = _BARS.get((match[1] or "").lower())
        if bar is None:
            words += _sign(match)
            continue
        if words:
            yield legible(words), bars
        words, bars = "", bars ^ {bar}
    words += text[at:]
    if words:
        yield legible(words), bars


def _sign(match: re.Match[str]) -> str:
    sign, number, point, page, double, control = match.groups()
    if sign:
        return _SIGNS.get(sign.lower(), "")
    if number:
        return _OF_STROKED_FONTS.get(int(number)) or bytes([int(number) % 256]).decode("cp1252", "replace")
    if point:
        return chr(int(point, 16))
    if page:
        return bytes.fromhex(double).lstrip(b"\0").decode(_PAGES[page], "replace")
    return "^" if control == " " else " " if control.upper() in "IJM" else str(control)


def legible(words: str) -> str:
    """Return words with blanks in place of all that only moves on, and without what has no shape."""
    blanks = (
        "" if unicodedata.category(c) == "Cf" else " " if c.isspace() or unicodedata.category(c) == "Cc" else c
        for c in words
    )
    return "".join(blanks)
