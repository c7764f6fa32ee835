"""What runs on the display by itself: the stills of the steps, and the program's listing."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QObject, QTimer, Signal

from .glyphs import wrapped
from .screen import COLUMNS, TerminalScreen
from .stills import ScreenStill

LINE_MS = 40
"""From one line of the listing to the next."""

LONGEST_S = 8.0
"""No listing scrolls longer: of a long one several lines come at a time."""

LONGEST_PLAY_MS, LEAST_MS = 25_000, 16
"""Stills of many areas and peels go by quicker, so that all together take no longer, but none quicker than the
screen.
"""


class StillPlayer(QObject):
    """Shows stills one after the other.

    Signals:
        changed(): another one is shown. finished(): the last one was.

    Attributes:
        at: number of the one that is shown. held: it stays until the operator goes on.
    """

    changed = Signal()
    finished = Signal()

    def __init__(self, screen: TerminalScreen, parent: QObject) -> None:
        super().__init__(parent)
        self._screen = screen
        self._stills: tuple[ScreenStill, ...] = ()
        self.at, self.held, self._haste = 0, False, 1.0
        self._clock = QTimer(self, singleShot=True)
        self._clock.timeout.connect(self._next)

    def start(self, stills: Sequence[ScreenStill]) -> None:
        """Show these."""
        self._stills, self.held = tuple(stills), False
        self._haste = max(sum(still.hold_ms for still in stills) / LONGEST_PLAY_MS, 1.0)
        self._show(0)

    def stop(self) -> None:
        """Leave the display as it is."""
        self._clock.stop()

    def skip(self) -> None:
        """Show the last one, and be done."""
        self.held = False
        self._show(len(self._stills) - 1)
        self._next()

    def hold(self) -> None:
        """Hold the still, or go on."""
        self.held = not self.held
        self._show(self.at)

    def step(self, way: int) -> None:
        """Hold the next still, or the one before."""
        self.held = True
        self._show(min(max(self.at + way, 0), len(self._stills) - 1))

    def _next(self) -> None:
        self._clock.stop()
        if self.at + 1 < len(self._stills):
            self._show(self.at + 1)
        else:
            self.finished.emit()

    def _show(self, at: int) -> None:
        self.at, still = at, self._stills[at]
        self._screen.picture = still.picture
        self._screen.head = (
            f"{still.number} {still.name}",
            f"{'HELD  ' if self.held else ''}{at + 1}/{len(self._stills)}",
        )
        if self.held:
            self._clock.stop()
        else:
            self._clock.start(max(round(still.hold_ms / self._haste), LEAST_MS))
        self.changed.emit()


class ListingPlayer(QObject):
    """Scrolls a program over the display.

    Signals:
        changed(): more of it is shown. finished(): all of it is.

    Attributes:
        held: it stays until the operator goes on.
    """

    changed = Signal()
    finished = Signal()

    def __init__(self, screen: TerminalScreen, parent: QObject) -> None:
        super().__init__(parent)
        self._screen = screen
        self._left: list[str] = []
        self._at_once, self.held = 1, False
        self._clock = QTimer(self, interval=LINE_MS)
        self._clock.timeout.connect(self._next)

    def start(self, lines: Sequence[str]) -> None:
        """Show these from the first."""
        self._left = [part for line in lines for part in wrapped(line, COLUMNS)]
        self._at_once = 1 + int(len(self._left) * LINE_MS / 1000 / LONGEST_S)
        self._screen.page, self._screen.up, self.held = [], 0, False
        self._screen.head = ("PROGRAM", "")
        self._clock.start()

    def stop(self) -> None:
        """Leave the display as it is."""
        self._clock.stop()

    def skip(self) -> None:
        """Show all of it."""
        self._at_once = len(self._left) + 1
        self._next()
        self._next()

    def hold(self) -> None:
        """Hold the listing, or go on."""
        self.held = not self.held
        self._screen.head = ("PROGRAM", "HELD" if self.held else "")
        if self.held:
            self._clock.stop()
        else:
            self._clock.start()
        self.changed.emit()

    def _next(self) -> None:
        if not self._left:
            self._clock.stop()
            self.finished.emit()
            return
        page = self._screen.page
        if page is not None:
            page += self._left[: self._at_once]
        del self._left[: self._at_once]
        self.changed.emit()
