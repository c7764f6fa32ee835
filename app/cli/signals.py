"""Ctrl+C, TERM and HUP: stop a command anywhere but while its files take their places.

The interpreter hears a signal between two of its own steps, and a compiled loop or a library's call may take long. So a
thread beside the job hears it at once, from the pipe that the system's own handler writes to, and ends the process
where the job does not.
"""

from __future__ import annotations

import atexit
import os
import select
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any, NoReturn

from .output import say


class Stopped(KeyboardInterrupt):
    """The user pressed Ctrl+C, or somebody ended the command.

    A kind of its own, since the interpreter remembers a plain KeyboardInterrupt that meets an `exec` of some import
    and ends itself by signal, although it was caught.

    Attributes:
        status: that the command ends with, 128 and the signal's number, as a shell tells it.
    """

    def __init__(self, number: int = signal.SIGINT) -> None:
        super().__init__()
        self.status = 128 + number


class StopFlag(threading.Event):
    """Is set when the user wants a command to stop.

    Attributes:
        stage: what the command has told last of what it does; "" = nothing yet.
        number: the signal that asked for it.
        tick: is called about once a second, on the thread that listens beside the job.
        waited: when the command was told last that it waits, s, `time.monotonic`; 0 = never.
        kept: what becomes of what was done, as people are told.
    """

    stage, number = "", int(signal.SIGINT)
    tick: Callable[[], None] | None = None
    waited = 0.0
    kept = "no file was written"


GRACE_S = 1.0
"""Seconds in which a command that was stopped may come to its end by itself."""

_ENDS = tuple(getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name))


@contextmanager
def stoppable(flag: StopFlag | None = None) -> Iterator[StopFlag]:
    """Let a signal raise Stopped, and set the event, for the case that a library swallows the exception; end what hears
    neither.

    Args:
        flag: the event; None = a new one.
    """
    stopped = StopFlag() if flag is None else flag

    def stop(number: int, frame: FrameType | None) -> NoReturn:
        stopped.number = number
        stopped.set()
        raise Stopped(number)

    with _on_interrupt(stop), _silent_where_unheard(), _ended_where_deaf(stopped):
        yield stopped


class _Watch:
    """A thread that hears signals while the interpreter does not."""

    def __init__(self, stopped: StopFlag) -> None:
        self._stopped = stopped
        self._hears, self._told = os.pipe()
        os.set_blocking(self._told, False)
        self._over = threading.Event()
        self._ending = threading.Lock()
        self._before = signal.set_wakeup_fd(self._told, warn_on_full_buffer=False)
        self._thread = threading.Thread(target=self._listen, name="signals", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """Leave the command to itself: it is over."""
        signal.set_wakeup_fd(self._before)
        self._over.set()
        with self._ending:
            os.close(self._told)  # which ends the reading
        self._thread.join()
        os.close(self._hears)

    def _listen(self) -> None:
        while True:
            if not select.select([self._hears], [], [], _TICK_S)[0]:
                if self._stopped.tick is not None:
                    self._stopped.tick()
                continue
            heard = os.read(self._hears, 1)
            if not heard:
                return
            if heard[0] in _ENDS and not self._over.wait(GRACE_S):
                self._end(heard[0])

    def _end(self, number: int) -> None:
        """End the process, but not while its files take their places."""
        with self._ending:
            while signal.getsignal(number) == signal.SIG_IGN:
                if self._over.wait(_LOOK_S):
                    return
            if self._over.is_set():
                return
            say(f"hitofude: cancelled; {self._stopped.kept}")
            last = threading.Timer(GRACE_S / 2, os._exit, [128 + number])
            last.daemon = True
            last.start()
            atexit._run_exitfuncs()
            os._exit(128 + number)


_LOOK_S, _TICK_S = 0.02, 1.0
"""Seconds from one look to the next: at whether files have taken their places, and at whether the command has ended."""


@contextmanager
def _ended_where_deaf(stopped: StopFlag) -> Iterator[None]:
    if threading.current_thread() is not threading.main_thread() or sys.platform == "win32":
        yield
        return
    watch = _Watch(stopped)
    try:
        yield
    finally:
        watch.close()


@contextmanager
def _silent_where_unheard() -> Iterator[None]:
    """Let the interpreter say nothing of a Stopped that it cannot raise, as in the callbacks of an import: the event is
    set.
    """
    before = sys.unraisablehook

    def hook(reported: Any) -> None:
        if reported.exc_type is not Stopped:
            before(reported)

    sys.unraisablehook = hook
    try:
        yield
    finally:
        sys.unraisablehook = before


@contextmanager
def undisturbed() -> Iterator[None]:
    """Let Ctrl+C and its like go unheard."""
    with _on_interrupt(signal.SIG_IGN):
        yield


@contextmanager
def ended_at_once() -> Iterator[None]:
    """Let Ctrl+C and its like end the process where it stands: while modules are imported, when nothing is written yet,
    and when some libraries print what is raised in them.
    """

    def end(number: int, frame: FrameType | None) -> NoReturn:
        say("hitofude: cancelled; no file was written")
        os._exit(128 + number)

    with _on_interrupt(end):
        yield


@contextmanager
def _on_interrupt(action: Callable[[int, FrameType | None], Any] | signal.Handlers) -> Iterator[None]:
    """Let Ctrl+C and its like do something else for a while; without effect outside the main thread, which alone hears
    them.

    HUP and TERM that are ignored stay so: nohup asks for it.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    heard = [number for number in _ENDS if number == signal.SIGINT or signal.getsignal(number) is not signal.SIG_IGN]
    before = [(number, signal.signal(number, action)) for number in heard]
    try:
        yield
    finally:
        for number, old in before:
            signal.signal(number, old)
