"""Total length and extent of many curves, added up a little at a time so that the window never waits."""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping

from PySide6.QtCore import QObject, QTimer, Signal

from ...drafting.curves.shapes import curve_length
from ...geometry.sample import Box, bounds, union
from ...model.curves import Curve

SLICE_S = 0.006
"""So long the window may be kept from answering."""


class TotalsCalculator(QObject):
    """Adds up curves; those that it knows from last time cost next to nothing.

    Signals:
        done(length, box): of all of them, mm; before `start` returns where there are few.
    """

    done = Signal(float, object)

    def __init__(self) -> None:
        super().__init__()
        self._known: dict[int, tuple[Curve, float, Box]] = {}
        self._left: Iterator[tuple[int, Curve]] = iter(())
        self._next: dict[int, tuple[Curve, float, Box]] = {}
        self._timer = QTimer(self)
        self._timer.timeout.connect(self._go_on)

    def start(self, curves: Mapping[int, Curve]) -> None:
        """Begin with curves by their numbers; what was not finished is given up."""
        self._known.update(self._next)
        self._left, self._next = iter(curves.items()), {}
        self._timer.start(0)
        self._go_on()

    def _go_on(self) -> None:
        end = time.perf_counter() + SLICE_S
        for number, curve in self._left:
            known = self._known.get(number)
            self._next[number] = (
                known if known is not None and known[0] is curve else (curve, curve_length(curve), bounds(curve))
            )
            if time.perf_counter() > end:
                return
        self._timer.stop()
        self._known, self._next = self._next, {}
        box = union([each[2] for each in self._known.values()])
        if box is not None:
            self.done.emit(sum(each[1] for each in self._known.values()), box)
