"""Numbers and names as any control takes them in a comment, and names back again."""

from __future__ import annotations

import re

ALLOWED = frozenset("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789 _.,+-/")
_SPELLED = re.compile(r"\+([0-9A-F]{1,6})\+", re.IGNORECASE)


def plain_numbers(*values: float, decimals: int = 6) -> str:
    """Return numbers with at most so many decimals, in 0 ... 9, and no zeros behind, joined by commas."""
    return ",".join(f"{round(value, decimals) + 0.0:.{decimals}f}".rstrip("0").rstrip(".") for value in values)


def spelled(text: str, allowed: frozenset[str] = ALLOWED) -> str:
    """Return a text in allowed characters from which it can be read again: others become their code point, "+DF+"."""
    return "".join(c if c in allowed and c != "+" else f"+{ord(c):X}+" for c in text)


def unspelled(text: str) -> str:
    """Return a text as it was before it was spelled."""
    return _SPELLED.sub(lambda match: chr(min(int(match[1], 16), 0x10FFFF)), text)
