"""Plays a cut: forward and backward, by time, by moves, by tools; anywhere at once. What is shown is computed on
another thread.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QObject, Qt, QTimer, Signal

from ....core.progress import Progress
from ...framework.worker import JobOutcome, Worker
from .cut_picture import CutPicture
from .findings import CutFinding, FindingColour
from .live_cells import FrameRequest, LiveCells, LiveFrame, live_copy
from .view import CutView

if TYPE_CHECKING:
    from ....usecases.cutting.timeline import Timeline, TimelinePlace
    from .shown_cut import ShownCut

TICK_MS = 16

LONGEST_WAIT_S = 0.5
"""A dwell, or a change of tool, takes no longer than this to watch, at any speed."""

_LONGEST_S = 0.25
"""A tick that comes later counts as no more: a window that was held up does not jump."""

_FEW = 1e-9


class PlaybackPace(Enum):
    """What goes on evenly while a cut is played; the value is its name for people."""

    TIME = "Time"
    MOVES = "Moves"
    TOOLS = "Tools"


RANGES = {PlaybackPace.TIME: (0.25, 1000.0), PlaybackPace.MOVES: (1.0, 10_000.0), PlaybackPace.TOOLS: (0.1, 5.0)}
"""The slowest and the fastest: times real time, moves a second, tools a second."""

USUAL = {PlaybackPace.TIME: 10.0, PlaybackPace.MOVES: 50.0, PlaybackPace.TOOLS: 0.5}


class PlaybackStep(Enum):
    """Where one may step to."""

    MOVE = "move"
    LINE = "NC line"
    TOOL = "tool"
    FINDING = "finding"


@dataclass(frozen=True, slots=True)
class TimelineMark:
    """Something wrong on the way: how many motions are done behind it, and its colour."""

    motion: int
    colour: FindingColour


class CutPlayer(QObject):
    """Where a cut stands, and how it goes on.

    Signals:
        moved(): another moment is shown. ticked(): time goes on, whether anything changes or not.
        state_changed(): it plays or not, is ready or not, or follows another cut. failed(sentence).

    Attributes:
        shown: the cut that is played; None = none.
        timeline: of it; None until it is ready. marks: what is wrong on the way.
        at: the moment that is shown; None until it is ready.
        pace, speed: what goes on evenly, and how fast. speeds: the last one of each pace.
        failure: why it cannot be played, or "".
    """

    moved = Signal()
    ticked = Signal()
    state_changed = Signal()
    failed = Signal(str)

    def __init__(self, view: CutView, parent: QObject) -> None:
        super().__init__(parent)
        self._view, self._model = view, view.model
        self.shown: ShownCut | None = None
        self.timeline: Timeline | None = None
        self.marks: tuple[TimelineMark, ...] = ()
        self.at: TimelinePlace | None = None
        self.pace, self.speed, self.speeds = PlaybackPace.TIME, USUAL[PlaybackPace.TIME], dict(USUAL)
        self.failure = ""
        self._cells: LiveCells | None = None
        self._live: CutPicture | None = None
        self._wanted: FrameRequest | None = None
        self._running: FrameRequest | None = None
        self._way, self._last_tick = 0, 0.0
        self._place = self._now = 0.0
        self.worker = Worker(self, head_start_s=0.0)
        self.worker.failed.connect(self._on_failed)
        self._timer = QTimer(self, interval=TICK_MS)
        self._timer.setTimerType(Qt.TimerType.PreciseTimer)
        self._timer.timeout.connect(self._tick)
        view.colours.known.connect(self._on_colours)
        view.legend.wedges_switched.connect(self._on_wedges)

    @property
    def playing(self) -> int:
        """1 while it plays, -1 while it plays backward, 0 at rest."""
        return self._way if self._timer.isActive() else 0

    @property
    def preparing(self) -> bool:
        """Whether it is being made ready."""
        return self.shown is not None and self.timeline is None and self.worker.busy

    @property
    def at_end(self) -> bool:
        """Whether everything is done, as before anything is played."""
        return self.timeline is None or self.at is None or self.at == self.timeline.last

    @property
    def length(self) -> int:
        """How many motions there are; 0 until it is ready."""
        return len(self.timeline) if self.timeline is not None else 0

    @property
    def time(self) -> float:
        """When it is, s; while the control waits it goes on, though nothing else does."""
        return self._now

    def follow(self, shown: ShownCut | None, entries: tuple[CutFinding, ...]) -> None:
        """Play another cut from now on, or none; it stands at its end."""
        self.pause()
        self.worker.cancel()
        self.shown, self.timeline, self.at, self.failure = shown, None, None, ""
        self._cells = self._live = self._wanted = None
        self.marks = tuple(
            sorted(
                {TimelineMark(each.motion + 1, each.colour) for each in entries if each.counts and each.motion >= 0},
                key=lambda mark: (mark.motion, mark.colour.value),
            )
        )
        self._view.playback.show_tool(None, None)
        self._view.playback.show_wedges(None)
        self.state_changed.emit()

    def prepare(self) -> None:
        """Make ready what is needed to go anywhere, on another thread, once."""
        shown = self.shown
        if shown is None or self.timeline is not None or self.worker.busy or self.failure:
            return
        self.worker.start(lambda progress: prepared(shown, progress), 0, self._on_prepared)
        self.state_changed.emit()

    def toggle(self, way: int = 1) -> None:
        """Play, or stay where it is; at the end of the way it begins at its other end."""
        if self.playing == way:
            self.pause()
            return
        goal = self._goal()
        if self.timeline is None or goal is None or not len(self.timeline):
            return
        if way > 0 and goal == self.timeline.last:
            self.go(0)
        elif way < 0 and goal.motion == 0 and goal.fraction == 0:
            self.go(len(self.timeline))
        self._way, self._last_tick = way, time.perf_counter()
        self._start_from()
        self._timer.start()
        self.state_changed.emit()

    def pause(self) -> None:
        """Stay at the moment that is shown."""
        if self._timer.isActive():
            self._timer.stop()
            self.state_changed.emit()

    def set_pace(self, pace: PlaybackPace, speed: float) -> None:
        """Let something else go on evenly, and so fast."""
        self.pace, self.speed = pace, speed
        self.speeds[pace] = speed
        self._start_from()
        self.state_changed.emit()

    def seek(self, seconds: float) -> None:
        """Go to a time; playing goes on from there."""
        if self.timeline is not None:
            self._now = min(max(seconds, 0.0), self.timeline.total)
            self._ask(self.timeline.at(self._now))
            self._start_from()
            self.moved.emit()

    def go(self, motion: int) -> None:
        """Go to where so many motions are done; playing goes on from there."""
        from ....usecases.cutting.timeline import TimelinePlace

        if self.timeline is not None:
            moment = TimelinePlace(min(max(motion, 0), len(self.timeline)))
            self._now = self.timeline.time(moment)
            self._ask(moment)
            self._start_from()

    def step(self, what: PlaybackStep, way: int) -> None:
        """Go to the next such place (1) or the one before (-1), and stay there; where there is none, to the end of the
        way.
        """
        if self.timeline is None or self.at is None:
            return
        self.pause()
        goal = self._goal()
        places = self.places(what)
        here = goal.motion if goal is not None else 0
        if way > 0:
            beyond = places[places > here]
            self.go(int(beyond[0]) if len(beyond) else len(self.timeline))
        else:
            whole = goal is None or goal.fraction == 0
            before = places[places < here] if whole else places[places <= here]
            self.go(int(before[-1]) if len(before) else 0)

    def places(self, what: PlaybackStep) -> NDArray[np.int64]:
        """Return the numbers of motions that are done at each place that one may step to, rising."""
        timeline = self.timeline
        if timeline is None:
            return np.zeros(0, np.int64)
        if what is PlaybackStep.MOVE:
            return np.arange(len(timeline) + 1)
        if what is PlaybackStep.LINE:
            return timeline.line_ends
        if what is PlaybackStep.TOOL:
            return timeline.tool_changes
        return np.unique([mark.motion for mark in self.marks]).astype(np.int64)

    def _goal(self) -> TimelinePlace | None:
        """Return the moment that is on its way, or is shown."""
        return self._wanted.moment if self._wanted is not None else self.at

    def _start_from(self) -> None:
        """Go on from where it is: the time, or how many moves are done."""
        goal = self._goal()
        if goal is not None:
            self._place = self._now if self.pace is PlaybackPace.TIME else goal.motion + goal.fraction

    def _tick(self) -> None:
        """Go where the clock says one should be; what cannot be shown in time is left out."""
        timeline, now = self.timeline, time.perf_counter()
        if timeline is None:
            return
        passed, self._last_tick = min(now - self._last_tick, _LONGEST_S), now
        self._place += self._way * max(passed * self.speed * self._evenness(timeline), passed * self._hurry(timeline))
        end = timeline.total if self.pace is PlaybackPace.TIME else float(len(timeline))
        over = self._place >= end if self._way > 0 else self._place <= 0
        self._place = min(max(self._place, 0.0), end)
        moment = self._moment(timeline)
        self._now = self._place if self.pace is PlaybackPace.TIME else timeline.time(moment)
        self._ask(moment)
        self.ticked.emit()
        if over:
            self.pause()

    def _evenness(self, timeline: Timeline) -> float:
        """Return how much of the place goes by in a second at speed 1."""
        if self.pace is not PlaybackPace.TOOLS:
            return 1.0
        ends = np.concatenate([[0], timeline.tool_changes, [len(timeline)]])
        run = int(np.searchsorted(ends, self._place + (0 if self._way > 0 else -_FEW), "right"))
        run = min(max(run, 1), len(ends) - 1)
        return float(ends[run] - ends[run - 1])

    def _hurry(self, timeline: Timeline) -> float:
        """Return how many seconds go by in one at least: while the control waits, so many that the wait is soon
        over.
        """
        return timeline.wait_at(self._place) / LONGEST_WAIT_S if self.pace is PlaybackPace.TIME else 0.0

    def _moment(self, timeline: Timeline) -> TimelinePlace:
        from ....usecases.cutting.timeline import TimelinePlace

        if self.pace is PlaybackPace.TIME:
            return timeline.at(self._place) if self._place < timeline.total else timeline.last
        whole = int(self._place)
        slow = self.pace is PlaybackPace.MOVES and self.speed < 1000 / TICK_MS
        return TimelinePlace(whole, self._place - whole if slow and whole < len(timeline) else 0.0)

    def _ask(self, moment: TimelinePlace, all_cells: bool = False) -> None:
        """Have a moment shown as soon as the one that is being made ready is."""
        view = self._view
        all_cells = all_cells or (self._wanted is not None and self._wanted.all_cells)
        self._wanted = FrameRequest(moment, self._model.colour_shown, view.playback.wedges_on, all_cells)
        if not self.worker.busy:
            self._begin()

    def _begin(self) -> None:
        cells, wish = self._cells, self._wanted
        if cells is None or wish is None or (wish.moment == self.at and not wish.all_cells and not wish.wedges):
            self._wanted = None
            return
        self._running = wish
        self._view.show_detail(None)
        self.worker.start(lambda progress: cells.frame(wish, progress), 0, self._on_frame)

    def _on_prepared(self, cells: LiveCells) -> None:
        if self.shown is not None:
            self._cells, self.timeline = cells, cells.playback.timeline
            self.at, self._now = self.timeline.last, self.timeline.total
            self.state_changed.emit()
            self.moved.emit()

    def _on_frame(self, frame: LiveFrame) -> None:
        if self._wanted is self._running:
            self._wanted = None
        self._show(frame)
        if self._wanted is not None:
            self._begin()

    def _show(self, frame: LiveFrame) -> None:
        """Let the view show a moment."""
        view, shown = self._view, self.shown
        if shown is None or self._model.picture is None:
            return
        if self._live is None:
            self._live = self._model.picture = live_copy(shown.picture)
            if self._model.colour_shown in self._live.values:
                view.render_scheduler.adopt(self._live.values[self._model.colour_shown])
        if frame.colour is not self._model.colour_shown and self._wanted is None:
            self._wanted = FrameRequest(frame.moment, self._model.colour_shown, view.playback.wedges_on, True)
        if frame.cells is not None and frame.patch is not None and frame.colour is self._model.colour_shown:
            frame.cells.write_to(self._live)
            view.render_scheduler.patch(frame.patch)
        self.at = frame.moment
        view.playback.show_tool(None if self.at_end else frame.tool, frame.tip)
        view.playback.show_wedges(frame.wedges)
        view.metal_changed()
        self.moved.emit()

    def _on_failed(self, answer: JobOutcome) -> None:
        """Say so, and do not try again until there is another cut."""
        self.failure = answer.error or ""
        self.failed.emit(self.failure)
        self.state_changed.emit()

    def _on_colours(self) -> None:
        """Colours that were worked out while cells changed may be those of before."""
        if self._live is not None and self.at is not None:
            self._ask(self._goal() or self.at, all_cells=True)

    def _on_wedges(self, on: bool) -> None:
        if on and self.at is not None:
            self._ask(self._goal() or self.at)


def prepared(shown: ShownCut, progress: Progress) -> LiveCells:
    """Return what is needed to play a cut; runs on the worker's thread.

    Raises:
        HitofudeError: it does not fit into memory. Cancelled: another cut is shown.
    """
    from ....usecases.cutting.playback import Playback

    playback = Playback(shown.cut, progress=progress)
    return LiveCells(playback, shown.picture, shown.cut.setup.tools)
