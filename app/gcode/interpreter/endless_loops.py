"""Loops that surely never end: what their condition reads nothing in them sets, and nothing in them leaves them."""

from __future__ import annotations

import re
from collections.abc import Iterable

from .expression import PLAIN

_PARAMETER = re.compile(r"#(<[^_<>#][^<>#]*>|[0-9]+(?![.0-9]))")

_SET = re.compile(r"(?<!#)#(<[^<>#]*>|[0-9]+)=")

_LEAVES = re.compile(
    r"break|continue|return|sub|call|goto|[:%]|g[0.]*6[56]|m(?![0-9]+(?![.0-9]))|m0*(?:2|30|9[6-9]|[1-9][0-9]{2,})(?![0-9])"
)
"""What may leave a loop, or go where parameters are set that the loop does not name."""

_NESTED = re.compile(
    r"(?:n[0-9.]+)?(?:o(?P<label><[^<>]*>|[0-9]+)(?P<word>if|elseif|else|endif|while|endwhile|repeat|endrepeat|do)(?![a-z])"
    r"|while\[.*\]do(?P<begun>[0-9])$|end(?P<ended>[0-9])$)"
)

_FLOW = re.compile(r"(?:n[0-9.]+)?(?:o|while|end)")


def never_ends(condition: str, body: Iterable[str]) -> bool:
    """Tell whether a loop whose condition holds now surely holds it for ever.

    Args:
        condition: the line with the condition, as `text.code_of` gives it.
        body: the lines between the loop's first and its last.

    Returns:
        False also where that cannot be told: a parameter with a computed number, one that is the control's own, a call,
        jumps that are not nested.
    """
    read = [_parameter_key(found[1]) for found in _PARAMETER.finditer(condition)]
    if len(read) < condition.count("#") or any(key.isdigit() and int(key) > PLAIN for key in read):
        return False
    opened: list[tuple[str, str]] = []
    for line in body:
        keys = [_parameter_key(found[1]) for found in _SET.finditer(line)]
        if len(keys) < line.count("=") or not set(read).isdisjoint(keys) or _LEAVES.search(line) is not None:
            return False
        if _FLOW.match(line) is not None and not _nests(line, opened):
            return False
    return not opened


def _nests(line: str, opened: list[tuple[str, str]]) -> bool:
    """Follow a jump into or out of what it encloses; False where it is not nested in what is open."""
    found = _NESTED.match(line)
    if found is None:
        return False
    if found["begun"] is not None or found["ended"] is not None:
        label, word = found["begun"] or found["ended"], "while" if found["begun"] else "endwhile"
    else:
        label, word = found["label"], found["word"]
    inner = opened[-1] if opened else ("", "")
    if word in ("if", "repeat", "do") or (word == "while" and inner != (label, "do")):
        opened.append((label, word))
        return True
    if inner[0] != label or inner[1] not in _OPENED_BY[word]:
        return False
    if word not in ("else", "elseif"):
        opened.pop()
    return True


_OPENED_BY = {
    "else": ("if",),
    "elseif": ("if",),
    "endif": ("if",),
    "while": ("do",),
    "endwhile": ("while",),
    "endrepeat": ("repeat",),
}


def _parameter_key(written: str) -> str:
    """Return a parameter's name, or its number in one spelling."""
    return written if written.startswith("<") else str(int(written))
