"""Numbers in sentences, counts with their nouns, places; words one behind the other.

The catalogue of another language knows lists by these joints, and has its own (`[lists]` in its file).
"""

from __future__ import annotations

from collections.abc import Iterable


def counted(count: int, one: str, many: str = "", thousands: str = "") -> str:
    """Return a count with its noun, such as "1 curve" or "1600 curves".

    Args:
        one, many: the noun for one and for any other count; the plural is made by an s where it is not given.
        thousands: what stands between groups of three digits.
    """
    return f"{count:,}".replace(",", thousands) + f" {one if count == 1 else many or one + 's'}"


def either(words: Iterable[str]) -> str:
    """Return words of which one is meant: "a, b or c"."""
    return _listed(words, "or")


def together(words: Iterable[str]) -> str:
    """Return words that are all meant: "a, b and c"."""
    return _listed(words, "and")


def _listed(words: Iterable[str], last: str) -> str:
    *before, final = [*words] or [""]
    return f"{', '.join(before)} {last} {final}" if before else final


def place_mm(value: float) -> str:
    """Return a coordinate, mm: in micrometres, and in six digits where it is so far away that these say nothing."""
    text = f"{value:.3f}" if abs(value) < 1e12 else f"{value:.6g}"
    return "0.000" if text == "-0.000" else text


def in_plane(x: float, y: float) -> str:
    """Return a place in the plane, mm: "(12.500, -3.000)"."""
    return f"({place_mm(x)}, {place_mm(y)})"


def trimmed(value: float, digits: int) -> str:
    """Return a number with so many decimals at most: no zeros at its end, never with an exponent, never -0."""
    text = f"{value:.{digits}f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


# How durations are written in reports and on the command line.


def minutes_words(seconds: float) -> str:
    """Return a duration as minutes and seconds, such as 75:04."""
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes}:{rest:02d}"
