"""Ctrl+C: stops a command anywhere but while its files take their places."""

from __future__ import annotations

import signal
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any, NoReturn


class Stopped(KeyboardInterrupt):
    """The user pressed Ctrl+C.

    A kind of its own, since the interpreter remembers a plain KeyboardInterrupt that meets an `exec` of some import
    and ends itself by signal, although it was caught.
    """


@contextmanager
def stoppable() -> Iterator[threading.Event]:
    """Let Ctrl+C raise Stopped, and set the event, for the case that a library swallows the exception."""
    stopped = threading.Event()

    def stop(number: int, frame: FrameType | None) -> NoReturn:
        stopped.set()
        raise Stopped

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
    """Let Ctrl+C go unheard."""
    with _on_interrupt(signal.SIG_IGN):
        yield


@contextmanager
def _on_interrupt(action: Callable[[int, FrameType | None], Any] | signal.Handlers) -> Iterator[None]:
    """Let Ctrl+C do something else for a while; without effect outside the main thread, which alone hears it."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGINT, action)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
