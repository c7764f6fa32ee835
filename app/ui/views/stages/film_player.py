"""The bar under the stages: play, step, slide, and how fast."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QElapsedTimer, QSignalBlocker, Qt, QTimer, Signal
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QComboBox, QHBoxLayout, QSlider, QWidget

from ...framework.boxes import give_ground
from ...framework.give_way import give_way
from ...framework.icons import IconButton
from ...framework.labels import muted

HEIGHT = 44
SPEEDS = (1, 2, 5, 10, 30, 60)
"""Stages a second that can be chosen."""

_START = 2


class FilmPlayer(QWidget):
    """Where one is among the stages; tells where the user wants to be.

    Signals:
        requested(at): show this stage. part_requested(way): the next (+1) or an earlier (-1) phase or region.

    Attributes:
        at, count: the stage that is shown, and how many there are.
    """

    requested = Signal(int)
    part_requested = Signal(int)

    def __init__(self) -> None:
        super().__init__()
        give_ground(self, "ncPlaces")
        self.setFixedHeight(HEIGHT)
        self.at, self.count = 0, 0
        self._timer, self._clock = QTimer(self), QElapsedTimer()
        self._timer.setTimerType(Qt.TimerType.PreciseTimer)
        self._began, self._done = 0, 0
        self.play = IconButton("play", "Play (Space)")
        self.first, self.last = (
            IconButton("first", "An earlier part (Page up)"),
            IconButton("last", "The next part (Page down)"),
        )
        self.back, self.forward = (
            IconButton("back", "One stage back (Left)"),
            IconButton("forward", "One stage on (Right)"),
        )
        self.slider, self.place, self.speed = QSlider(Qt.Orientation.Horizontal), muted(), QComboBox()
        self._lay_out()
        self._connect()
        self.show_place(0, 0)

    def _lay_out(self) -> None:
        row = self._row = QHBoxLayout(self)
        row.setContentsMargins(12, 0, 12, 0)
        row.setSpacing(4)
        for button in (self.first, self.back, self.play, self.forward, self.last):
            button.setFixedSize(30, 30)
            button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
            row.addWidget(button)
        row.addSpacing(8)
        row.addWidget(self.slider, 1)
        row.addSpacing(8)
        row.addWidget(self.place)
        row.addSpacing(8)
        row.addWidget(self.speed)
        self.slider.setAccessibleName("Stage")
        self.slider.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.place.setMinimumWidth(self.place.fontMetrics().horizontalAdvance("1 000 of 1 000"))
        self.place.setAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        self.speed.setFixedHeight(24)
        self.speed.setAccessibleName("Stages a second")
        self.speed.setToolTip("How many stages are shown in a second")
        self.speed.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        for speed in SPEEDS:
            self.speed.addItem(f"{speed} a second", speed)
        self.speed.setCurrentIndex(_START)

    def _connect(self) -> None:
        self.play.clicked.connect(self.switch)
        self.back.clicked.connect(lambda: self.step(-1))
        self.forward.clicked.connect(lambda: self.step(1))
        self.first.clicked.connect(lambda: self._go_part(-1))
        self.last.clicked.connect(lambda: self._go_part(1))
        self._keys: dict[int, Callable[[], None]] = {
            Qt.Key.Key_Space: self.switch,
            Qt.Key.Key_Right: lambda: self.step(1),
            Qt.Key.Key_Left: lambda: self.step(-1),
            Qt.Key.Key_Home: lambda: self.step(-self.count),
            Qt.Key.Key_End: lambda: self.step(self.count),
            Qt.Key.Key_PageDown: self.last.click,
            Qt.Key.Key_PageUp: self.first.click,
        }
        self.slider.valueChanged.connect(self._slide)
        self.speed.currentIndexChanged.connect(lambda _: self._restart())
        self._timer.timeout.connect(self._tick)

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 (Qt's name)
        """Let what can be missed go where there is no room."""
        give_way(self._row, (self.place, self.speed, self.first, self.last), event.size().width())

    @property
    def playing(self) -> bool:
        """Whether stages follow one another by themselves."""
        return self._timer.isActive()

    def show_place(self, at: int, count: int) -> None:
        """Show which stage of how many is shown; none of 0."""
        self.at, self.count = at, count
        with QSignalBlocker(self.slider):
            self.slider.setRange(0, max(count - 1, 0))
            self.slider.setValue(at)
        self.place.setText(f"{at + 1} of {count}" if count else "")
        for widget in (self.play, self.first, self.last, self.back, self.forward, self.slider):
            widget.setEnabled(count > 1)
        if count < 2:
            self.pause()

    def takes_key(self, key: int) -> bool:
        """Do what a key stands for; return whether it stands for something."""
        act = self._keys.get(key)
        if act is not None:
            act()
        return act is not None

    def step(self, way: int) -> None:
        """Go so many stages on, or back, and stay there."""
        self.pause()
        self.go(self.at + way)

    def go(self, at: int) -> None:
        """Go to a stage, or as far as there are some."""
        at = min(max(at, 0), self.count - 1)
        if self.count and at != self.at:
            self.requested.emit(at)

    def switch(self) -> None:
        """Play, from the beginning when the end was reached; or pause."""
        if self.playing:
            self.pause()
        elif self.count > 1:
            if self.at == self.count - 1:
                self.requested.emit(0)
            self.play.show_icon("pause", "Pause (Space)")
            self._restart(force=True)

    def pause(self) -> None:
        """Stay at the stage that is shown."""
        self._timer.stop()
        self.play.show_icon("play", "Play (Space)")

    def _restart(self, force: bool = False) -> None:
        """Count time anew from the stage that is shown."""
        if self.playing or force:
            self._began, self._done = self.at, 0
            self._clock.start()
            self._timer.start(round(1000 / self.speed.currentData()))

    def _tick(self) -> None:
        """Go where the clock says one should be; no stage is left out that there is time for."""
        due = self._clock.elapsed() * int(self.speed.currentData()) // 1000
        if due > self._done:
            self._done = due
            self.go(self._began + due)
        if self.at >= self.count - 1:
            self.pause()

    def _go_part(self, way: int) -> None:
        self.pause()
        self.part_requested.emit(way)

    def _slide(self, at: int) -> None:
        self.pause()
        self.go(at)
