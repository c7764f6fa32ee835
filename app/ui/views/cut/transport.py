"""The bar under the cut: play it, step through it, go anywhere in it, and how fast."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from functools import partial

from PySide6.QtCore import QSignalBlocker, Qt, Signal
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QComboBox, QHBoxLayout, QSlider, QWidget

from ...framework.boxes import give_ground, v_box
from ...framework.figures import TIMES, grouped
from ...framework.give_way import give_way
from ...framework.icons import IconButton
from ...framework.labels import Elided, muted
from .cut_player import RANGES, CutPlayer, PlaybackPace, PlaybackStep
from .time_plot import TimePlot, exact_clock

_NOTCHES = 100
_SPEED_PX, _BUTTON_PX, _PLACE_PX = 96, 28, 110
_WORDS = {PlaybackPace.TIME: f"{TIMES} {{}}", PlaybackPace.MOVES: "{} a second", PlaybackPace.TOOLS: "{} a second"}

Stepped = tuple[str, str, PlaybackStep, int]
_BEFORE: tuple[Stepped, ...] = (
    ("previous-finding", "The finding before (Shift+N)", PlaybackStep.FINDING, -1),
    ("previous-tool", "Back to the change of tool ([)", PlaybackStep.TOOL, -1),
    ("back", "One NC line back (,)", PlaybackStep.LINE, -1),
)
_AFTER: tuple[Stepped, ...] = (
    ("forward", "One NC line on (.)", PlaybackStep.LINE, 1),
    ("next-tool", "On to the next tool (])", PlaybackStep.TOOL, 1),
    ("next-finding", "The next finding (N)", PlaybackStep.FINDING, 1),
)


class Transport(QWidget):
    """Shows where a cut stands, and asks the player for everything else.

    Signals:
        record_requested(): the user wants to keep what is played.

    Attributes:
        plot: the way along time. play, play_back, record, steps: buttons. pace, speed: how it goes on.
    """

    record_requested = Signal()

    def __init__(self, player: CutPlayer) -> None:
        super().__init__()
        give_ground(self, "ncPlaces")
        self._player = player
        self.plot = TimePlot()
        self.play, self.play_back = (
            IconButton("play", "Play (Space)"),
            IconButton("play-back", "Play backward (Shift+Space)"),
        )
        self.record = IconButton("record", "Record to a GIF or to pictures…")
        self.steps: list[IconButton] = []
        self._finding_steps: list[IconButton] = []
        self.clock, self.place = muted(), Elided(role="muted")
        self.pace, self.speed, self.rate = QComboBox(), QSlider(Qt.Orientation.Horizontal), muted()
        self._lay_out()
        self._connect()
        self.show_state()

    def _lay_out(self) -> None:
        row = self._row = QHBoxLayout()
        row.setContentsMargins(12, 4, 12, 0)
        row.setSpacing(2)
        before, after = ([self._step_button(each) for each in some] for some in (_BEFORE, _AFTER))
        for button in (*before, self.play_back, self.play, *after):
            button.setFixedSize(_BUTTON_PX, _BUTTON_PX)
            button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
            row.addWidget(button)
        row.addSpacing(10)
        row.addWidget(self.clock)
        row.addSpacing(12)
        row.addWidget(self.place, 1)
        row.addSpacing(12)
        for widget in (self.pace, self.speed, self.rate, self.record):
            row.addWidget(widget)
            row.addSpacing(6)
        self.place.setMinimumWidth(_PLACE_PX)
        self.clock.setMinimumWidth(self.clock.fontMetrics().horizontalAdvance("0:00:00.0 / 0:00:00"))
        self.rate.setMinimumWidth(self.rate.fontMetrics().horizontalAdvance("10 000 a second"))
        for pace in PlaybackPace:
            self.pace.addItem(pace.value, pace)
        self.pace.setFixedHeight(24)
        self.pace.setToolTip("What goes on evenly: time at the programmed feeds and rapids, moves, or tools")
        self.pace.setAccessibleName("What goes on evenly")
        self.speed.setRange(0, _NOTCHES)
        self.speed.setFixedWidth(_SPEED_PX)
        self.speed.setToolTip("How fast")
        self.speed.setAccessibleName("Speed")
        self.record.setFixedSize(_BUTTON_PX, _BUTTON_PX)
        for widget in (self.pace, self.speed, self.record):
            widget.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        column = v_box(self, (0, 0, 0, 4), 2)
        column.addLayout(row)
        column.addWidget(self.plot)

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 (Qt's name)
        """Let what can be missed go where there is no room."""
        self._give_way()

    def _give_way(self) -> None:
        give_way(self._row, (self.rate, self.place, self.pace), self.width())

    def _step_button(self, stepped: Stepped) -> IconButton:
        name, tip, what, way = stepped
        button = IconButton(name, tip)
        button.clicked.connect(lambda: self._player.step(what, way))
        self.steps.append(button)
        if what is PlaybackStep.FINDING:
            self._finding_steps.append(button)
        return button

    def _connect(self) -> None:
        player = self._player
        self.play.clicked.connect(lambda: player.toggle(1))
        self.play_back.clicked.connect(lambda: player.toggle(-1))
        self.record.clicked.connect(self.record_requested)
        self.plot.requested.connect(player.seek)
        self.pace.currentIndexChanged.connect(lambda _: self._choose(player.speeds[self.pace.currentData()]))
        self.speed.valueChanged.connect(lambda notch: self._choose(speed_of(self.pace.currentData(), notch)))
        for signal in (player.moved, player.ticked):
            signal.connect(self.show_place)
        player.state_changed.connect(self.show_state)

    def keys(self) -> dict[tuple[Qt.Key, Qt.KeyboardModifier], Callable[[], None]]:
        """Return what keys do in the view."""
        player, plain, shift = self._player, Qt.KeyboardModifier.NoModifier, Qt.KeyboardModifier.ShiftModifier
        keys: dict[tuple[Qt.Key, Qt.KeyboardModifier], Callable[[], None]] = {
            (Qt.Key.Key_Space, plain): lambda: player.toggle(1),
            (Qt.Key.Key_Space, shift): lambda: player.toggle(-1),
            (Qt.Key.Key_Home, plain): lambda: player.go(0),
            (Qt.Key.Key_End, plain): lambda: player.go(player.length),
        }
        return keys | {(key, held): partial(player.step, what, way) for key, held, what, way in _stepping(plain, shift)}

    def show_state(self) -> None:
        """Show whether it plays, and whether it can."""
        player, timeline = self._player, self._player.timeline
        way = player.playing
        self.play.show_icon(*(("pause", "Pause (Space)") if way > 0 else ("play", "Play (Space)")))
        self.play_back.show_icon(
            *(("pause", "Pause (Shift+Space)") if way < 0 else ("play-back", "Play backward (Shift+Space)"))
        )
        ready = timeline is not None and len(timeline) > 0
        for widget in (self.play, self.play_back, self.record, self.pace, self.speed, *self.steps):
            widget.setEnabled(ready)
        for button in self._finding_steps:
            button.setVisible(bool(player.marks))
        moves = player.shown.picture.moves if player.shown is not None else None
        self.plot.show_timeline(timeline, player.marks, moves)
        self._show_speed()
        self.show_place()

    def show_place(self) -> None:
        """Show the moment that the cut is at."""
        player, timeline = self._player, self._player.timeline
        told = timeline is not None and player.at is not None
        if told is self.clock.isHidden():
            self.clock.setVisible(told)
            self._give_way()
        if timeline is None or player.at is None:
            self.clock.setText("")
            self._say(player.failure or ("Preparing playback…" if player.preparing else ""))
            return
        seconds = player.time
        self.plot.show_time(seconds)
        self.clock.setText(f"{exact_clock(seconds)} / {exact_clock(timeline.total)}")
        shown = player.shown
        if not len(timeline) or shown is None:
            self._say("")
            return
        row = timeline.current(player.at)
        line, tool = int(timeline.line[row]), shown.cut.setup.tools.get(int(timeline.tool[row]))
        self._say(
            f"line {line}",
            f"T{timeline.tool[row]}{f' {tool.label}' if tool is not None else ''}",
            f"{grouped(timeline.removed_at(player.at), 0)} mm³",
            shown.texts[shown.file_of(row)].line(line - 1).strip(),
        )

    def _say(self, *parts: str) -> None:
        """Say where the cut is, or fewer of the parts of it where there is no room for all; the tool tip has them."""
        self.place.setText(" · ".join(parts))
        self.place.shorter = tuple(" · ".join(parts[:count]) for count in range(len(parts) - 1, 0, -1))
        self.place.setToolTip(self.place.text())

    def _choose(self, speed: float) -> None:
        self._player.set_pace(self.pace.currentData(), speed)

    def _show_speed(self) -> None:
        pace, speed = self._player.pace, self._player.speed
        with QSignalBlocker(self.pace), QSignalBlocker(self.speed):
            self.pace.setCurrentIndex(self.pace.findData(pace))
            self.speed.setValue(notch_of(pace, speed))
        figure = grouped(speed, 0) if speed >= 10 else f"{speed:.2g}"
        self.rate.setText(_WORDS[pace].format(figure))


def _stepping(
    plain: Qt.KeyboardModifier, shift: Qt.KeyboardModifier
) -> Iterator[tuple[Qt.Key, Qt.KeyboardModifier, PlaybackStep, int]]:
    """Yield which keys step where."""
    key = Qt.Key
    yield from ((key.Key_Comma, plain, PlaybackStep.LINE, -1), (key.Key_Period, plain, PlaybackStep.LINE, 1))
    # as layouts tell the same two keys with Shift
    for back, on in (
        (key.Key_Comma, key.Key_Period),
        (key.Key_Less, key.Key_Greater),
    ):
        yield from ((back, shift, PlaybackStep.MOVE, -1), (on, shift, PlaybackStep.MOVE, 1))
    yield from ((key.Key_Semicolon, shift, PlaybackStep.MOVE, -1), (key.Key_Colon, shift, PlaybackStep.MOVE, 1))
    for back, on in ((key.Key_BracketLeft, key.Key_BracketRight), (key.Key_PageUp, key.Key_PageDown)):
        yield from ((back, plain, PlaybackStep.TOOL, -1), (on, plain, PlaybackStep.TOOL, 1))
    yield from ((key.Key_N, shift, PlaybackStep.FINDING, -1), (key.Key_N, plain, PlaybackStep.FINDING, 1))


def speed_of(pace: PlaybackPace, notch: int) -> float:
    """Return the speed at a notch of the slider: each notch is as much faster as the one before, rounded to two
    figures.
    """
    low, high = RANGES[pace]
    speed = low * (high / low) ** (notch / _NOTCHES)
    return float(f"{speed:.2g}")


def notch_of(pace: PlaybackPace, speed: float) -> int:
    """Return the notch that is nearest to a speed."""
    low, high = RANGES[pace]
    return round(_NOTCHES * math.log(min(max(speed, low), high) / low) / math.log(high / low))
