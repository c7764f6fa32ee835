"""How long a job will take, reckoned from a few counts before it is begun, and said at once where its user would
wonder.
"""

from __future__ import annotations

from dataclasses import dataclass

from .progress import Progress

LONG_S = 20.0
"""Seconds from which a job is announced. A reckoning may be wrong by a factor of three, and a minute must never pass
without a word.
"""

_MINUTE, _HOUR, _DAY = 60.0, 3600.0, 86400.0
"""In seconds."""


@dataclass(frozen=True, slots=True)
class Reckoning:
    """What a job will take, about: right within a factor of three on a machine of two usual cores.

    Attributes:
        seconds: of work, >= 0.
        about: what it is so much of, in words.
        remedy: what would make it less, in words that follow "For less,".
    """

    seconds: float
    about: str
    remedy: str

    def sentence(self) -> str:
        """Return what to say of it."""
        return f"This will take about {_spoken(self.seconds)}: {self.about}. For less, {self.remedy}."


def announce(effort: Reckoning, progress: Progress) -> None:
    """Say how long a job will take, if it is long."""
    if effort.seconds >= LONG_S:
        progress.remark(effort.sentence())


def _spoken(seconds: float) -> str:
    """Return a time in words, with no more digits than a reckoning has."""
    if seconds < 1.5 * _MINUTE:
        return f"{max(10 * round(seconds / 10), 10)} seconds"
    for unit, most, word in ((_MINUTE, 1.5 * _HOUR, "minutes"), (_HOUR, 2 * _DAY, "hours")):
        if seconds < most:
            return f"{_rounded(seconds / unit):,.0f} {word}"
    return f"{_rounded(seconds / _DAY):,.0f} days"


def _rounded(count: float) -> float:
    return round(count) if count < 10 else float(f"{count:.1e}")
