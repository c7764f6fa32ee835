"""What a command says on stderr, apart from the lines that come by the clock."""

from __future__ import annotations

import re

_HOW_FAR = re.compile(r"^hitofude: \d{1,3}% ?[^\n]*\n", re.MULTILINE)


def without_how_far(stderr: str) -> str:
    """Return what a command says, without the lines that tell every few seconds how far it is: on a busy machine any
    command lasts so long.
    """
    return _HOW_FAR.sub("", stderr)
