"""Which control a program looks like it was written for."""

from __future__ import annotations

import re

from .dialect import DIALECT_RULES, Dialect

_LOOKED_AT = 50_000
"""Bytes from the beginning; what tells a control's language stands there, or in none of the program."""

_NAMED = r"(?:hitofude for|post|control|machine)[^)\n]{0,60}\b"
"""A control's name in a comment counts where the comment says that the program is for it: a vise may be called Haas
too.
"""

_OLD_UNITS = r"^[ \t]*(?:n\d+\s*)?(?:g[\d.]+\s*)*g7[01](?![\d.])\s*(?:g[\d.]+\s*)*(?:[(;]|\r?$)"
"""G70 and G71 among codes that set modes: units to Mach3 alone; the cycles that others have by them want words."""

_SAFETY = r"^[^(;\n]*\bg64\s*g50\s"
"""How posts for Mach3 and for Tormach's first controls end scaling in their safety line: LinuxCNC knows no G50. Fanuc
and Haas know both words, so that what names them is asked before.
"""

_BEFORE = r"^(?:[^(;\n]|\([^)\n]*\))*(?<![a-z])"
"""What may stand before a word of code in its line: no comment that is still open ("; Drawing 120")."""

_CODE = r"^[ \t]*(?:/\s*)?(?:n\s*\d+\s*)?[gmtsxyz]\s*-?[\d.]"
_NUMBERED = r"^[ \t]*(?:[o:]\s*\d{1,5}|<[^<>\n]{1,32}>)\s*(?:\(|\r?$)"
_FIRST = rf"\A(?:(?!{_CODE})[^\n]*\n)*?(?:{_NUMBERED})"
"""A program's number, or the name that newer controls take, before any code. To Fanuc and Haas every program begins so;
where O numbers but a subroutine behind the program, as in Mach3, a length without a point is no count of microns.
"""

_ARC_MODE = re.compile(r"^[^(;\n]*\bg9[01]\.1(?![\d.])", re.IGNORECASE | re.MULTILINE)
"""How centres of arcs count is said to LinuxCNC, grbl and Mach3 alone; of these the last has numbers of programs."""

_OWN = re.compile(
    r"\(hitofude for (" + "|".join(rules.title.lower() for rules in DIALECT_RULES.values()) + r")\b", re.IGNORECASE
)
"""Who wrote the program says what for, whatever other controls its comments name."""

_TELLING: tuple[tuple[Dialect, re.Pattern[str]], ...] = tuple(
    (dialect, re.compile(words, re.IGNORECASE | re.MULTILINE))
    for dialect, words in (
        (Dialect.GRBL, r"\bgrbl|^[ \t]*\$[a-z0-9]"),
        (Dialect.MACH3, r"\bmach\s?(?:2\s?/\s?)?3|" + _OLD_UNITS),
        (
            Dialect.LINUXCNC,
            r"linuxcnc|^[ \t]*(n\d+\s*)?o\s*<|#\s*<|^[ \t]*(n\d+\s*)?o\s*\d+\s*(sub|if|while|do|repeat|call)\b"
            r"|g5\.[23]|g5\.1\s*[xyij]|g64\s*p",
        ),
        (Dialect.HAAS, _NAMED + rf"haas|{_BEFORE}g\s*(187|154\s*p|103\s*p|11[014-9](?![\d.])|12\d(?![\d.]))"),
        (
            Dialect.FANUC,
            _NAMED + r"fanuc|" + _FIRST + r"|\bif\s*\[.*goto|while\s*\[.*\]\s*do\s*\d"
            r"|g54\.1|g6\.2|g0?5\s*p1\d{4}|g0?5\.1\s*q|g10\.6",
        ),
        (Dialect.MACH3, _SAFETY),
    )
)


def guess_dialect(data: bytes) -> Dialect:
    """Return the control that a program looks like, LinuxCNC when nothing tells.

    What a program of our own says it is for; else the first of these that speaks: a name in a comment or a word that
    only this control has, in the order grbl, Mach3, LinuxCNC, Haas, Fanuc, and a safety line of
    Mach3 last.

    Args:
        data: the file's bytes.
    """
    text = data[:_LOOKED_AT].decode("latin-1")
    own = _OWN.search(text)
    if own is not None:
        return next(dialect for dialect, rules in DIALECT_RULES.items() if rules.title.lower() == own[1].lower())
    found = next((dialect for dialect, words in _TELLING if words.search(text)), Dialect.LINUXCNC)
    return Dialect.MACH3 if found is Dialect.FANUC and _ARC_MODE.search(text) else found
