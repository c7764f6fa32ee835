"""Rows that have fewer parts where there is less room."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtWidgets import QLayout, QWidget


def give_way(row: QLayout, parts: Sequence[QWidget], room: int) -> None:
    """Hide as many of a row's parts as it takes for the others not to lie over one another.

    Args:
        row: what the parts stand in. parts: what can be missed, what is missed least first. room: px.
    """
    for part in parts:
        part.show()
    for part in parts:
        row.invalidate()
        if row.minimumSize().width() <= room:
            return
        part.hide()
