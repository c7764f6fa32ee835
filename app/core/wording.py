"""Numbers in sentences: counts with their nouns, places."""

from __future__ import annotations


def counted(count: int, one: str, many: str = "", thousands: str = "") -> str:
    """Return a count with its noun, such as "1 curve" or "1600 curves".

    Args:
        one, many: the noun for one and for any other count; the plural is made by an s where it is not given.
        thousands: what stands between groups of three digits.
    """
    return f"{count:,}".replace(",", thousands) + f" {one if count == 1 else many or one + 's'}"


def place_mm(value: float) -> str:
    """Return a coordinate, mm: in micrometres, and in six digits where it is so far away that these say nothing."""
    return f"{value:.3f}" if abs(value) < 1e12 else f"{value:.6g}"


# How durations are written in reports and on the command line.


def minutes_words(seconds: float) -> str:
    """Return a duration as minutes and seconds, such as 75:04."""
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes}:{rest:02d}"
