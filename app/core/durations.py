"""How durations are written in reports and on the command line."""

from __future__ import annotations


def minutes_words(seconds: float) -> str:
    """Return a duration as minutes and seconds, such as 75:04."""
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes}:{rest:02d}"
