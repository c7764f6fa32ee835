"""Errors that reach the user as one sentence: what is wrong, where, and what to do."""

import os
import re
import unicodedata

MOST_QUOTED = 60
"""Letters of a bad word that are quoted."""

_LONG = re.compile(
    rf"(?<!\w)(['\"])(?P<said>[^'\"]{{{MOST_QUOTED + 1},}})(?=\1(?!\w))|(?P<word>[^\s'\"]{{{MOST_QUOTED + 1},}})"
)


def shortened(text: str) -> str:
    """Return a sentence with what it quotes cut off after `MOST_QUOTED` letters; names of files that are there stay
    whole.

    Args:
        text: quoted is what stands between quotation marks, or has no blank in it.
    """
    return _LONG.sub(_short, text)


def _short(found: re.Match[str]) -> str:
    name = "said" if found["said"] else "word"
    long = found[name]
    begin = found[0][: found.start(name) - found.start()]
    return begin + (long if _is_path(long) else long[:MOST_QUOTED] + "...")


def _is_path(text: str) -> bool:
    """Tell whether a word names a file, or one in a folder that is there."""
    folder = os.path.dirname(text.rstrip(":;,.")) if os.sep in text else ""
    return bool(folder) and len(text) < 4096 and os.path.isdir(folder)


_UNSEEN = ("Cc", "Cf", "Cs", "Zl", "Zp")
"""Categories of signs that a terminal obeys, that turn a line about, or that are no text: no file may have its own in a
sentence.
"""


def printable(text: str, kept: str = "") -> str:
    """Return a text as one line whose signs can all be seen: others are spelled out, as \\x1b, and ends of lines are
    blanks.

    Args:
        text: may quote names and words of any file.
        kept: signs that stay as they are, such as the ends of lines.
    """
    if text.isprintable():
        return text
    return "".join(sign if sign in kept or sign.isprintable() else _spelled(sign) for sign in text)


def _spelled(sign: str) -> str:
    if sign in "\n\r\t":
        return " "
    return sign.encode("unicode_escape").decode() if unicodedata.category(sign) in _UNSEEN else sign


class HitofudeError(Exception):
    """Base of every error that the program raises on purpose; its text is shown to the user as it is."""

    def __str__(self) -> str:
        return printable(super().__str__())


class ParameterError(HitofudeError, ValueError):
    """A parameter is out of its range. The text names the parameter, its value with unit, and the range."""


class InputError(HitofudeError):
    """A file or a typed text cannot be used. The text names the place (file:line, entity, coordinates)."""


class GeometryError(HitofudeError):
    """A shape cannot be worked on as it is drawn. The text names the contour and coordinates."""


class Cancelled(HitofudeError):
    """The user asked a job to stop; nothing it was computing is kept."""

    def __init__(self) -> None:
        super().__init__("Cancelled.")
