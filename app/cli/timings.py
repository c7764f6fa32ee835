"""How long each stage of a job took, by what it tells of itself."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace

from ..core.progress import Progress


class StageTimes:
    """Charges the time of a job to the stage that it told last.

    Stages whose texts differ but in numbers and names of files count as one.
    """

    def __init__(self, clock: Callable[[], float] = time.perf_counter) -> None:
        """Begin.

        Args:
            clock: tells seconds: of the wall, or of the processor.
        """
        self._seconds: dict[str, float] = {}
        self._clock = clock
        self._stage, self._since = "Start", clock()
        self._told = ""

    def watch(self, progress: Progress) -> Progress:
        """Return a progress that tells its listener what it is told, and notes when."""
        listener = progress.listener

        def told(fraction: float, text: str) -> None:
            if text and text != self._told:  # where it is the same, its time goes on
                self._told = text
                self._charge(text)
            if listener is not None:
                listener(fraction, text)

        return replace(progress, listener=told)

    def seconds(self) -> dict[str, float]:
        """Return the time of each stage so far, s, in the order in which they came first."""
        self._charge("")
        return {stage: round(spent, 4) for stage, spent in self._seconds.items()}

    def lines(self) -> list[str]:
        """Return a line a stage, the longest first, and their sum."""
        found = self.seconds()
        longest = sorted(found.items(), key=lambda item: -item[1])
        return [f"  {spent:8.2f} s  {stage}" for stage, spent in [*longest, ("all", sum(found.values()))]]

    def _charge(self, text: str) -> None:
        now = self._clock()
        self._seconds[self._stage] = self._seconds.get(self._stage, 0.0) + now - self._since
        self._stage, self._since = _stage(text) if text else self._stage, now


def _stage(text: str) -> str:
    """Return a text with an ellipsis for each word that holds a digit or a point inside."""
    words = ["…" if any(c.isdigit() for c in word) or "." in word[:-1] else word for word in text.split()]
    return " ".join(words)
