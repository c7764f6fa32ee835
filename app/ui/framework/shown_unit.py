"""The unit that lengths are shown and typed in; whatever is kept or written is in mm."""

from __future__ import annotations


class _Shown:
    """The unit of the whole window."""

    size = 1.0


def show_in(size: float) -> None:
    """Show lengths from now on in a unit of so many mm: 1 or 25.4."""
    _Shown.size = size


def shown_size() -> float:
    """Return the size of the unit that is shown, mm."""
    return _Shown.size


def shown_name(unit: str) -> str:
    """Return the name of what stands in the place of mm or mm/min; other units stay."""
    return unit.replace("mm", "in") if _Shown.size != 1.0 and unit in ("mm", "mm/min") else unit


def clean(length: float) -> float:
    """Return a length that was typed in inches without the last digits that its conversion to mm leaves."""
    return length if _Shown.size == 1.0 else round(length, 9)
