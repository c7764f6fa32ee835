"""Ctrl+C, TERM and HUP: stop a command anywhere but while its files take their places."""

from __future__ import annotations

import signal
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any, NoReturn


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


_ENDS = tuple(getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name))


@contextmanager
def stoppable() -> Iterator[threading.Event]:
    """Let a signal raise Stopped, and set the event, for the case that a library swallows the exception."""
    stopped = threading.Event()

    def stop(number: int, frame: FrameType | None) -> NoReturn:
        stopped.set()
        raise Stopped(number)

    with _on_interrupt(stop), _silent_where_unheard():
        yield stopped


@contextmanager
def _silent_where_unheard() -> Iterator[None]:
    """Let the interpreter say nothing of a Stopped that it cannot raise, as in the callbacks of an import: the event is set."""
    before = sys.unraisablehook

    def hook(told: Any) -> None:
        if told.exc_type is not Stopped:
            before(told)

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
def _on_interrupt(action: Callable[[int, FrameType | None], Any] | signal.Handlers) -> Iterator[None]:
    """Let Ctrl+C and its like do something else for a while; without effect outside the main thread, which alone hears them.

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
