"""The unit that lengths are shown and typed in; whatever is kept or written is in mm."""

from __future__ import annotations


class _DisplayUnit:
    """The unit of the whole window."""

    size = 1.0


def set_display_unit(size: float) -> None:
    """Show lengths from now on in a unit of so many mm: 1 or 25.4."""
    _DisplayUnit.size = size


def display_unit_size() -> float:
    """Return the size of the unit that is shown, mm."""
    return _DisplayUnit.size


def display_unit_name(unit: str) -> str:
    """Return the name of what stands in the place of mm or mm/min; other units stay."""
    return unit.replace("mm", "in") if _DisplayUnit.size != 1.0 and unit in ("mm", "mm/min") else unit


def clean(length: float) -> float:
    """Return a length that was typed in inches without the last digits that its conversion to mm leaves."""
    return length if _DisplayUnit.size == 1.0 else round(length, 9)
