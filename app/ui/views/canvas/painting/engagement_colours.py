"""Steps of engagement and their colours, from little to a full slot."""

from __future__ import annotations

from PySide6.QtGui import QColor

from ....framework.theme import Theme

STEPS = (0.25, 0.5, 0.75, 0.95)
"""Shares of the diameter between the steps."""


def colours(theme: Theme) -> tuple[QColor, ...]:
    """Return a colour a step, cool to hot, safe for colour-blind eyes."""
    return (theme.regions[4], theme.pocket, theme.contour, theme.plunge, theme.gouge)
