"""Numbers, points, names and entity lists as the shape language writes them: each reads back as exactly what it was."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches
from itertools import groupby

from ...core.wording import either
from ...model.curves import Point


def number_text(value: float) -> str:
    """Return the shortest text that reads back as exactly this number."""
    text = repr(float(value))
    return text.removesuffix(".0") if text != "-0.0" else "0"


def point_text(point: Point) -> str:
    """Return the text that reads back as exactly this point."""
    return f"{number_text(point[0])},{number_text(point[1])}"


def nearest_words(word: str, known: Iterable[str]) -> str:
    """Return the one to three words that a mistyped one may stand for, as "line or spline"; "" when none is like it."""
    return either(get_close_matches(word.lower(), known, n=3, cutoff=0.6))


def ids_text(ids: Iterable[int]) -> str:
    """Return entity numbers, neighbours as ranges."""
    ordered = sorted(ids)
    runs = [[i for _, i in run] for _, run in groupby(enumerate(ordered), key=lambda pair: pair[1] - pair[0])]
    return " ".join(str(run[0]) if len(run) == 1 else f"{run[0]}-{run[-1]}" for run in runs)


def name_text(name: str) -> str:
    """Return a name in double quotes; quotes within it become single ones."""
    return '"' + name.replace('"', "'").replace("\n", " ") + '"'
