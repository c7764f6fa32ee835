"""Work beside a job: same result either way, progress on the job's own thread, ended when the job ends."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable

import pytest

from app.core.beside import beside
from app.core.errors import Cancelled, ParameterError
from app.core.memory import budget_limit, within
from app.core.progress import Progress, report_wait

BRIEF_S = 5.0
"""Seconds by which everything here has long ended."""


@pytest.mark.parametrize("at_once", [True, False])
def test_the_work_is_done_once_however_often_its_result_is_asked_for(at_once: bool) -> None:
    threads: list[int] = []
    with beside(lambda progress: threads.append(threading.get_ident()), Progress(), at_once) as work:
        work.result()
        work.result()
    assert len(threads) == 1
    assert (threads[0] != threading.get_ident()) is at_once


def test_both_go_on_at_a_time() -> None:
    meeting = threading.Barrier(2, timeout=BRIEF_S)
    with beside(lambda progress: meeting.wait(), Progress()) as work:
        meeting.wait()
        assert work.result() in (0, 1)


def test_what_the_work_tells_is_told_by_who_waits_in_its_part_of_the_job() -> None:
    told: list[tuple[float, str, int]] = []
    go_on = threading.Event()

    def work(progress: Progress) -> None:
        progress.part(0.0, 0.5).step(1.0, "Half")
        go_on.wait(BRIEF_S)

    def listener(fraction: float, text: str) -> None:
        told.append((fraction, text, threading.get_ident()))
        go_on.set()

    with beside(work, Progress(listener).part(0.6, 0.8)) as begun:
        begun.result()
    fraction, text, thread = told[0]
    assert (round(fraction, 9), text, thread) == (0.7, "Half", threading.get_ident())


def test_what_it_waits_for_is_told_too() -> None:
    told: list[str] = []
    go_on = threading.Event()

    def work(progress: Progress) -> None:
        report_wait("Compiling")
        go_on.wait(BRIEF_S)

    with beside(work, Progress(lambda fraction, text: (told.append(text), go_on.set())[0])) as begun:
        begun.result()
    assert told[0] == "Compiling"


def _steps_until_stopped(ended: threading.Event) -> Callable[[Progress], None]:
    def work(progress: Progress) -> None:
        try:
            until = time.monotonic() + BRIEF_S
            while time.monotonic() < until:
                progress.step(0.5, "Going on")
                time.sleep(0.001)
        except Cancelled:
            ended.set()
            raise

    return work


def test_cancelling_the_job_ends_the_work() -> None:
    cancelled, ended = threading.Event(), threading.Event()
    with (
        pytest.raises(Cancelled),
        beside(_steps_until_stopped(ended), Progress(cancelled=cancelled)) as begun,
    ):
        cancelled.set()
        begun.result()
    assert ended.is_set()


def test_an_error_of_the_job_ends_the_work_and_is_the_one_that_is_raised() -> None:
    ended = threading.Event()
    with pytest.raises(ParameterError, match="own"), beside(_steps_until_stopped(ended), Progress()):
        raise ParameterError("its own")
    assert ended.is_set()


def test_an_error_of_the_work_is_raised_where_its_result_is_asked_for() -> None:
    def work(progress: Progress) -> None:
        raise ParameterError("of the work")

    with beside(work, Progress()) as begun, pytest.raises(ParameterError, match="of the work"):
        begun.result()


def test_it_works_within_the_budget_of_memory_of_who_began_it() -> None:
    with within(123_456_789), beside(lambda progress: budget_limit(), Progress()) as begun:
        assert begun.result() == 123_456_789
