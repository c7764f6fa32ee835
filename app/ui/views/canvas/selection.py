"""Selecting by mouse: what lies under it in turn, and the lines that select it."""

from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtCore import QPointF

from ....drafting.expressions.words import point_text
from ....model.curves import Point
from ....model.notes import Note
from ....model.part import Entity

SAME_PX = 3.0
"""Clicks no farther apart than this are at the same place."""


@dataclass
class SelectionCycle:
    """Which of several things under the mouse is meant: clicks at one place and Tab go from one to the next.

    Attributes:
        place: on the screen, where the turns are counted. turn: how often it went on there.
        clicked: True when something has been clicked there.
    """

    place: QPointF | None = None
    turn: int = 0
    clicked: bool = False

    def at(self, position: QPointF) -> int:
        """Return the turn at a screen position; it begins afresh elsewhere."""
        if self.place is None or (position - self.place).manhattanLength() > SAME_PX:
            self.place, self.turn, self.clicked = position, 0, False
        return self.turn

    def on(self, position: QPointF) -> None:
        """Go on to the next thing at a screen position."""
        self.turn = self.at(position) + 1

    def click(self, position: QPointF) -> int:
        """Return the turn that a click at a screen position means: one at the same place means the next thing."""
        self.at(position)
        self.turn += self.clicked
        self.clicked = True
        return self.turn


def click_line(candidates: list[Entity | Note], turn: int, selection: frozenset[int], adding: bool) -> str:
    """Return the line that selects what was clicked, or "".

    Args:
        candidates: what lies under the mouse, nearest first.
        adding: the selection is changed and not replaced.
    """
    if not candidates:
        return "select none" if selection and not adding else ""
    number = candidates[turn % len(candidates)].id
    how = ("remove " if number in selection else "add ") if adding else ""
    return f"select {how}{number}"


def band_line(corners: tuple[Point, Point], adding: bool) -> str:
    """Return the line that selects by a window: dragged to the right what is inside, to the left also what it
    crosses.
    """
    kind = "window" if corners[1][0] >= corners[0][0] else "crossing"
    return f"select {'add ' if adding else ''}{kind} {point_text(corners[0])} {point_text(corners[1])}"
