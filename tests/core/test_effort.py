"""What is said of a job that takes long: before it begins, with the time and what would make it less."""

from __future__ import annotations

import pytest

from app.core.effort import LONG_S, Reckoning, announce
from app.core.progress import NO_PROGRESS, Progress


def heard(seconds: float) -> list[str]:
    said: list[str] = []
    announce(
        Reckoning(seconds, "9 rings", "use a larger tool"), Progress(remarks=said.append).part(0.2, 0.4).part(0, 1)
    )
    return said


@pytest.mark.parametrize(
    ("seconds", "words"),
    [
        (34, "30 seconds"),
        (130, "2 minutes"),
        (1234, "21 minutes"),
        (7300, "2 hours"),
        (123_000, "34 hours"),
        (1e7, "120 days"),
    ],
)
def test_a_long_job_is_announced_with_its_time(seconds: float, words: str) -> None:
    assert heard(seconds) == [f"This will take about {words}: 9 rings. For less, use a larger tool."]


def test_a_short_job_says_nothing() -> None:
    assert heard(0.99 * LONG_S) == [] and len(heard(LONG_S)) == 1


def test_a_minute_is_never_without_a_word() -> None:
    """A reckoning that is three times too short still announces it."""
    assert 3 * LONG_S <= 60


def test_nobody_need_listen() -> None:
    announce(Reckoning(1e9, "all", "stop"), NO_PROGRESS)
