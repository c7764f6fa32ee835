"""How numbers are written for people: thin spaces for thousands, time as m:ss. No Qt."""

from __future__ import annotations

THIN_SPACE = "\u2009"
TIMES = "\u00d7"
_MANY = 10_000


def grouped(value: float, decimals: int = 3) -> str:
    """Return a number with thin spaces between thousands, such as 12 000.5."""
    return f"{value:,.{decimals}f}".replace(",", THIN_SPACE)


def clock(seconds: float) -> str:
    """Return a duration as m:ss, or h:mm:ss from one hour on."""
    whole = round(seconds)
    hours, rest = divmod(whole, 3600)
    minutes, secs = divmod(rest, 60)
    return f"{hours}:{minutes:02d}:{secs:02d}" if hours else f"{minutes}:{secs:02d}"


def counted(count: int, one: str, many: str | None = None) -> str:
    """Return "1 stroke", "2 strokes" or "12 000 strokes"."""
    return f"{grouped(count, 0) if count >= _MANY else count} {one if count == 1 else many or one + 's'}"
