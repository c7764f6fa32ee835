"""What a text repeats, counted as work: a few lines within one another must not keep a reader busy for minutes.

The work is told from what is done, never from a clock, so that the same text ends alike on every machine. Lines that
stand in no repeat and no command of the user's own count nothing: they cost as much as their text is long.
"""

from __future__ import annotations

from collections.abc import Iterable

from ...model.curves import Arc, Circle, Curve, Line, Spline
from . import syntax as s
from .values import wrong

MOST_WORK = 2_000_000
"""Of what is repeated; a unit is about a millionth of a second, and a text is to be read within five, on a busy machine
too.
"""
_BLOCK, _VALUE, _COMMAND, _LETTER = 5.0, 3.0, 30.0, 1.0
"""A turn of a block, an expression that stands alone, a command, and each letter of either."""
_SPLINE = 250.0
"""To lay a spline through points."""
_EASY, _STEEP = 3, 10.0
"""A spline of a higher degree than this costs so much times its degree squared."""
_MADE, _CHANGED, _KEPT, _PASSED = 10.0, 3.0, 1 / 200, 0.5
"""To add curves, each one that is changed, that stays while others are added, and that a command looks over."""


class Effort:
    """The work that a text has repeated so far."""

    def __init__(self) -> None:
        """Begin outside all blocks."""
        self._inside, self._done = 0, 0.0

    def begin(self) -> None:
        """Go into a block that is repeated."""
        self._inside += 1

    def end(self) -> None:
        """Leave it."""
        self._inside -= 1

    def turn(self, place: s.TextSpan) -> None:
        """Count a turn of a block.

        Raises:
            CommandError: as for all counts: it is too much; the place is told.
        """
        self._count(_BLOCK, place)

    def value(self, place: s.TextSpan) -> None:
        """Count an expression that stands alone: one that gets a name, is compared, or says how often."""
        self._count(_VALUE + _LETTER * (place.end - place.start), place)

    def command(self, place: s.TextSpan, word: str) -> None:
        """Count what a command costs before it touches curves."""
        self._count(
            _COMMAND + _LETTER * (place.end - place.start) + (_SPLINE if word in ("spline", "sp") else 0.0), place
        )

    def added(self, curves: Iterable[Curve], kept: int, place: s.TextSpan) -> None:
        """Count curves that were added to others."""
        if self._inside:
            steep = sum(
                _STEEP * curve.degree**2 for curve in curves if isinstance(curve, Spline) and curve.degree > _EASY
            )
            self._count(_MADE + steep + _KEPT * kept, place)

    def changed(self, count: int, passed: int, place: s.TextSpan) -> None:
        """Count curves that were changed among those that were looked over."""
        self._count(_CHANGED * count + _PASSED * passed, place)

    def taken(self, curves: Iterable[Curve], share: float, place: s.TextSpan) -> None:
        """Count curves that a command takes apart, to measure, join, offset, explode or heal them; or a share of
        that.
        """
        if self._inside:
            self._count(share * sum(map(_taken_apart, curves)), place)

    def _count(self, work: float, place: s.TextSpan) -> None:
        if not self._inside:
            return
        self._done += work
        if self._done > MOST_WORK:
            raise wrong("What this text repeats is too much work; repeat fewer times, or with fewer curves.", place)


def _taken_apart(curve: Curve) -> float:
    if isinstance(curve, Line | Arc):
        return 20.0
    return 200.0 if isinstance(curve, Circle) else 600.0
