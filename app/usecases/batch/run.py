"""All parts of a batch through its lanes: what dies is tried again, what hangs is ended, what is done is handed on."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
from concurrent.futures import FIRST_COMPLETED, CancelledError, Future, wait
from dataclasses import dataclass
from time import monotonic

from ...core.options import option
from ...core.progress import NO_PROGRESS, Progress
from ...core.wording import minutes_words
from .lanes import Lane
from .task import BatchResult, BatchRow, BatchVerdict, NamedTask

TRIES = 4
"""So often a part is begun whose process is killed: whoever kills at random seldom meets the same part again."""

LIMIT_S = 3600.0
"""Seconds that a part may take where nobody says otherwise; then it counts as hanging."""
_TICK_S = 0.1
"""How long a look at what is running waits for something to be done."""
_NAMED = 4
"""Parts that are named while they are worked on."""

Finished = Callable[[int, BatchResult], None]


@dataclass
class _Running:
    """A part on a lane: its place in the list, its outcome to come, since when it is worked on."""

    place: int
    future: Future[BatchResult]
    since: float


class BatchRun:
    """The parts of a batch on their way through the lanes."""

    def __init__(
        self, tasks: Sequence[NamedTask], lanes: Sequence[Lane], finished: Finished, limit_s: float = LIMIT_S
    ) -> None:
        """Make ready.

        Args:
            tasks: the parts.
            lanes: at least one.
            finished: called with a part's place and what became of it, on this thread, in the order in which they end.
            limit_s: a part that takes longer is ended, s.
        """
        self._tasks, self._lanes, self._finished, self._limit_s = tasks, lanes, finished, limit_s
        self._waiting = deque(range(len(tasks)))
        self._tries = [0] * len(tasks)
        self._running: dict[int, _Running] = {}
        self._ended = 0

    def run(self, progress: Progress = NO_PROGRESS) -> None:
        """Do all parts.

        Raises:
            Cancelled: by progress; parts that were begun are given up.
        """
        try:
            while self._waiting or self._running:
                self._fill()
                wait([each.future for each in self._running.values()], _TICK_S, FIRST_COMPLETED)
                for number, running in list(self._running.items()):
                    self._look(number, running)
                progress.step(*self._far())
        finally:
            for lane in self._lanes:
                lane.close()

    def _fill(self) -> None:
        for number, lane in enumerate(self._lanes):
            if number not in self._running and self._waiting:
                place = self._waiting.popleft()
                self._tries[place] += 1
                self._running[number] = _Running(place, lane.submit(self._tasks[place]), monotonic())

    def _look(self, number: int, running: _Running) -> None:
        """Take what a lane has done, or end what it takes too long for."""
        if running.future.done():
            del self._running[number]
            self._settle(number, running)
        elif not self._lanes[number].ready:
            running.since = monotonic()
        elif monotonic() - running.since > self._limit_s:
            del self._running[number]
            self._lanes[number].renew(running.future)
            more = f"give it more with {option('limit')}."
            text = f"It took longer than {minutes_words(self._limit_s)} min and was ended; {more}"
            self._end(running.place, BatchVerdict.OVERDUE, text)

    def _settle(self, number: int, running: _Running) -> None:
        try:
            result = running.future.result()
        except (Exception, CancelledError) as error:  # work() itself raises nothing: its process has died
            self._lanes[number].renew(running.future)
            if self._tries[running.place] < TRIES:
                self._waiting.appendleft(running.place)
                return
            enough = f"is the memory enough for {option('jobs')}?"
            why = f"Its process was killed {TRIES} times ({type(error).__name__}); {enough}"
            self._end(running.place, BatchVerdict.KILLED, why)
            return
        self._ended += 1
        self._finished(running.place, result)

    def _end(self, place: int, verdict: BatchVerdict, sentence: str) -> None:
        self._ended += 1
        row = BatchRow(self._tasks[place].name, verdict, findings=(sentence,), counting=1)
        self._finished(place, BatchResult(row, {}))

    def _far(self) -> tuple[float, str]:
        """Return how far all is, and each that is worked on."""
        told = [(self._tasks[each.place].name, self._lanes[number].news()) for number, each in self._running.items()]
        share = (self._ended + sum(news.fraction for _, news in told)) / max(len(self._tasks), 1)
        named = [f"{name} {news.fraction:.0%} {news.text}".rstrip() for name, news in told[:_NAMED]]
        more = [f"{len(told) - _NAMED} more"] if len(told) > _NAMED else []
        return share, "; ".join([f"{self._ended} of {len(self._tasks)} done", *named, *more])
