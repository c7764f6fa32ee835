"""The worker: answers by signal, drops what nobody waits for, leaves a cancelled job at once."""

import gc
import threading
import time
import weakref

import numpy as np
import pytest
from PySide6.QtCore import QObject
from shiboken6 import delete

from app.core.errors import InputError
from app.core.memory import MemoryRemedy, ask, within
from app.core.progress import Progress
from app.ui.framework.worker import Worker


@pytest.fixture
def worker(qtbot):
    made = Worker()
    yield made
    made.finish()


def test_answer_comes_back_with_id_and_revision(qtbot, worker):
    with qtbot.waitSignal(worker.done) as caught:
        job_id = worker.start(lambda progress: threading.get_ident(), revision=7)
    answer = caught.args[0]
    assert (answer.job_id, answer.revision) == (job_id, 7)
    assert answer.value != threading.get_ident(), "the job ran on the window's own thread"
    assert not worker.busy


def test_sentence_of_an_error_arrives(qtbot, worker):
    def fail(progress: Progress) -> object:
        raise InputError("gear.dxf is empty; choose another file.")

    with qtbot.waitSignal(worker.failed) as caught:
        worker.start(fail, 1)
    assert caught.args[0].error == "gear.dxf is empty; choose another file."
    assert not caught.args[0].again, "it will be empty the next time"


def test_mistake_of_the_program_is_told_as_one(qtbot, worker, capsys):
    with qtbot.waitSignal(worker.failed) as caught:
        worker.start(lambda progress: 1 / 0, 1)
    assert "Your drawing is safe" in caught.args[0].error and caught.args[0].again
    assert "ZeroDivisionError" in capsys.readouterr().err


def test_progress_is_told_on_the_window_thread(qtbot, worker):
    def work(progress: Progress) -> object:
        for i in range(20):
            progress.step(i / 20, "rings")
            time.sleep(0.01)
        return None

    seen: list[tuple[float, str, int]] = []
    worker.progress.connect(lambda f, t: seen.append((f, t, threading.get_ident())))
    with qtbot.waitSignal(worker.done):
        worker.start(work, 1)
    assert len(seen) >= 3
    assert [f for f, _, _ in seen] == sorted(f for f, _, _ in seen)
    assert {ident for _, _, ident in seen} == {threading.get_ident()}


def test_cancel_answers_within_0_2_s_even_when_the_job_cannot_stop(qtbot, worker):
    release = threading.Event()
    answers: list[object] = []
    worker.done.connect(answers.append)
    worker.start(lambda progress: release.wait(5), 1)
    begun = time.monotonic()
    with qtbot.waitSignal(worker.cancelled):
        worker.cancel()
    assert time.monotonic() - begun < 0.2
    assert not worker.busy
    release.set()
    qtbot.wait(100)
    assert answers == [], "the answer of a cancelled job was not dropped"


def test_job_that_listens_stops(qtbot, worker):
    started, stopped = threading.Event(), threading.Event()

    def work(progress: Progress) -> object:
        started.set()
        try:
            while True:
                progress.step(0.5)
                time.sleep(0.002)
        finally:
            stopped.set()

    worker.start(work, 1)
    assert started.wait(1)
    worker.cancel()
    assert stopped.wait(0.2)


def test_job_that_is_cancelled_at_once_never_starts(qtbot, worker):
    started = threading.Event()
    worker.start(lambda progress: started.set(), 1)
    worker.cancel()
    assert not started.wait(0.2)


def test_newer_job_replaces_the_older(qtbot, worker):
    release = threading.Event()
    worker.start(lambda progress: (release.wait(5), "old")[1], 1)
    values: list[object] = []
    worker.done.connect(lambda answer: values.append(answer.value))
    with qtbot.waitSignal(worker.done):
        worker.start(lambda progress: "new", 2)
    release.set()
    qtbot.wait(100)
    assert values == ["new"]


def test_a_job_that_is_done_holds_nothing(qtbot):
    class Heavy:
        pass

    worker, heavy = Worker(), Heavy()
    gone = weakref.ref(heavy)

    def job(progress: Progress, held: Heavy = heavy) -> int:
        return len(repr(held))

    with qtbot.waitSignal(worker.done):
        worker.start(job, 0)
    worker.finish()
    del heavy, job
    gc.collect()
    assert gone() is None


def test_garbage_is_collected_on_the_windows_thread_alone(qtbot, worker):
    """A QObject that a job's thread freed, as the collector ran there when the job had ended, ended the program."""
    threads = set()

    def seen(phase: str, info: dict[str, int]) -> None:
        threads.add(threading.current_thread())

    gc.callbacks.append(seen)
    try:
        for k in range(3):
            with qtbot.waitSignal(worker.done):
                worker.start(lambda progress: [[k] for k in range(50_000)], k)
        qtbot.waitUntil(gc.isenabled)
        worker.finish()
    finally:
        gc.callbacks.remove(seen)
    assert threads <= {threading.main_thread()}


def test_what_only_a_job_holds_dies_on_the_windows_thread(qtbot, worker):
    died_on, begun, left = [], threading.Event(), threading.Event()

    class Held(QObject):
        def __del__(self) -> None:
            died_on.append(threading.current_thread())

    def start() -> None:
        held = Held()
        worker.start(lambda progress: (begun.set(), left.wait(10), repr(held)), 0)

    start()
    assert begun.wait(10)
    worker.cancel()  # from here on nobody else holds what the job works on
    left.set()
    qtbot.waitUntil(lambda: bool(died_on))
    assert died_on == [threading.main_thread()]


def test_what_is_too_much_memory_is_a_sentence_without_options(qtbot, worker):
    with within(50_000_000), qtbot.waitSignal(worker.failed) as caught:
        worker.start(lambda progress: ask(2e9, "A grid of 9 x 9 cells", MemoryRemedy("use fewer cells", "grid", 4)), 1)
    error = caught.args[0].error
    assert error.startswith("A grid of 9 x 9 cells would take 2 GB of memory, and 50 MB may be taken; use fewer cells")
    assert "--" not in error and "\n" not in error
    assert caught.args[0].again, "there may be more of it, or more may be allowed"


def test_memory_that_runs_out_is_no_mistake_of_the_program(qtbot, worker, capsys):
    with qtbot.waitSignal(worker.failed) as caught:
        worker.start(lambda progress: np.empty(1 << 55), 1)
    assert "ran out" in caught.args[0].error and "menu Compute" in caught.args[0].error
    assert capsys.readouterr().err == ""


def test_what_a_job_returns_is_taken_on_the_window_thread(qtbot, worker):
    taken: list[object] = []
    with qtbot.waitSignal(worker.done):
        worker.start(lambda progress: time.sleep(0.2) or "older", 1, lambda answer: taken.append("older"))
        worker.start(lambda progress: 42, 1, lambda answer: taken.append((answer, threading.get_ident())))
    assert taken == [(42, threading.get_ident())], "of a job that a newer one replaced nobody takes anything"
    with qtbot.waitSignal(worker.failed):
        worker.start(lambda progress: 1 / 0, 1, taken.append)
    assert len(taken) == 1


@pytest.mark.parametrize("remarks", [False, True])
def test_a_job_whose_window_has_gone_ends_without_a_word(qtbot, capfd, remarks):
    going, gone, threads = threading.Event(), threading.Event(), []

    def work(progress: Progress) -> object:
        threads.append(threading.current_thread())
        going.set()
        gone.wait(10.0)
        for step in range(3):
            time.sleep(0.05)
            progress.step(step / 3, "rings")
            if remarks:
                progress.remark("a large part")
        return None

    worker = Worker(head_start_s=0.0)
    worker.start(work, 1)
    assert going.wait(10.0)
    delete(worker)
    gone.set()
    threads[0].join(10.0)
    assert not threads[0].is_alive() and capfd.readouterr().err == ""
