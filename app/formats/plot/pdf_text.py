"""Text of a PDF in Helvetica, which every reader has: how wide it is, and which texts can be written in it."""

from __future__ import annotations

import cmath
import re
from collections.abc import Iterator
from dataclasses import replace

from .page import TextLine

_REGULAR = (
    "278 278 355 556 556 889 667 191 333 333 389 584 278 333 278 278 556 556 556 556 556 556 556 556 556 556 278 278 "
    "584 584 584 556 1015 667 667 722 722 667 611 778 722 278 500 667 556 833 722 778 667 778 722 667 611 722 667 944 "
    "667 667 611 278 278 278 469 556 333 556 556 500 556 556 278 556 556 222 222 500 222 833 556 556 556 556 333 500 "
    "278 556 500 722 500 500 500 334 260 334 584"
)
_BOLD = (
    "278 333 474 556 556 889 722 238 333 333 389 584 278 333 278 278 556 556 556 556 556 556 556 556 556 556 333 333 "
    "584 584 584 611 975 722 722 722 722 667 611 778 722 278 556 722 611 833 722 778 667 778 722 667 611 722 667 944 "
    "667 667 611 333 278 333 584 556 333 556 611 556 611 556 333 611 611 278 278 556 278 889 611 611 611 611 389 556 "
    "333 611 556 778 556 556 500 389 280 389 584"
)
_OTHERS = {"±": 584, "°": 400, "µ": 556, "·": 278, "—": 1000, "…": 1000, "ø": 611, "Ø": 778}
"""Widths in thousandths of the letters' size, from the metrics of the standard fonts: of the signs from the blank to
the tilde, and of some others; letters with accents are about as wide as a digit.
"""

_WIDTHS = {
    bold: {chr(32 + number): int(width) for number, width in enumerate(table.split())} | _OTHERS
    for bold, table in ((False, _REGULAR), (True, _BOLD))
}
_USUAL = 556
"""Width of a sign that the table lacks, thousandths of the size of letters: that of a digit."""
_WIDE = "\u2e80-\uffdc"
"""Signs as wide as high: those of Japanese, with its blanks, brackets and points."""
_WIDE_RUN = re.compile(f"[{_WIDE}]+|[^{_WIDE}]+")
_OPENS = "\uff08\uff3b「『【〈《"
_CLOSES = (
    "\uff09\uff3d」』】〉》、。\uff0c\uff0e\uff1a\uff1b\uff01\uff1f\uff5e・ー々ぁぃぅぇぉっゃゅょゎァィゥェォッャュョヮ"
)
"""No line of Japanese ends in the first, and none begins with the others."""
_PIECE = re.compile(rf"(\s*)([{_OPENS}]*(?:[\d.,]*\d mm[^\s{_WIDE}]*|[^\s{_WIDE}]+|[{_WIDE}])[{_CLOSES}]*)")
"""What stays on one line, and the blanks before it: a length, a word, or a sign of Japanese, with what must stand
beside it.
"""


def is_helvetica(text: str) -> bool:
    """Tell whether a text has no sign but those of the font's encoding."""
    try:
        text.encode("cp1252")
    except UnicodeEncodeError:
        return False
    return True


def is_wide(text: str) -> bool:
    """Tell whether all signs of a text are as wide as high."""
    return len(text) > 0 and not re.search(f"[^{_WIDE}]", text)


def text_width(text: str, size: float, bold: bool = False) -> float:
    """Return how wide a text is, in the unit of `size`; a sign that the font lacks counts as a square."""
    widths = _WIDTHS[bold]
    return size * sum(widths.get(sign, _USUAL if ord(sign) < 0x1100 else 1000) for sign in text) / 1000


def runs_of(words: TextLine) -> Iterator[TextLine]:
    """Yield a line in pieces one behind the other, those of wide signs apart from the others between them."""
    runs = _WIDE_RUN.findall(words.text)
    if len(runs) < 2:
        yield words
        return
    widths = [text_width(run, words.height, words.bold) for run in runs]
    turn = cmath.rect(1.0, words.angle)
    at = complex(*words.at) - turn * words.anchor * sum(widths)
    for run, width in zip(runs, widths, strict=True):
        yield replace(words, text=run, at=(at.real, at.imag), anchor=0.0)
        at += turn * width


def wrapped(text: str, size: float, room: float, bold: bool = False) -> list[str]:
    """Return a text as lines no wider than `room`, broken at blanks, between signs of Japanese, and within words
    that are too long.
    """
    lines, line = [], ""
    for blank, word in _PIECE.findall(text):
        tried = f"{line} {word}" if line and blank else line + word
        if text_width(tried, size, bold) <= room:
            line = tried
            continue
        if line:
            lines.append(line)
        line = word
        while text_width(line, size, bold) > room and len(line) > 1:
            fits = next(k for k in range(len(line) - 1, 0, -1) if k == 1 or text_width(line[:k], size, bold) <= room)
            lines.append(line[:fits])
            line = line[fits:]
    return [*lines, line] if line or not lines else lines


def pdf_string(text: str) -> str:
    """Return a text as a string of a PDF's content, all in ASCII."""
    return f"<{text.encode('cp1252', 'replace').hex()}>"
