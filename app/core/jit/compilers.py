"""As many compiling processes as there are cores: what somebody waits for first, then what a job usually wants, then
what else the imported modules may want.

They are processes and not threads since compiling holds the interpreter, which would freeze the window. A kernel is
given out once the kernels that it calls are in the store, so that none is compiled twice.
"""

from __future__ import annotations

import atexit
import os
import subprocess
import sys
import threading
from collections.abc import Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from functools import cache
from importlib import import_module
from pathlib import Path

from ..progress import report_wait
from ..resources import PACKAGE, resource
from . import numba_loader
from .compiled import REGISTERED, Kernel
from .compiler_process import DONE
from .store import FOLDER_VARIABLE, Store, store

_LOOK_EVERY_S = 0.1
"""How often compiling processes are looked after while somebody waits."""
_ROOT = Path(__file__).resolve().parents[3]
_MAIN = f"{__package__}.compiler_process"
_PROGRAM = f"import sys; sys.path.insert(0, {str(_ROOT)!r}); from {_MAIN} import main; main()"


@dataclass
class _Plan:
    """What is compiled in which order.

    Attributes:
        requested: entries to compile, by name in the order of their turn: a kernel behind all that it calls.
        done: entries that are in the store, or that cannot be; given: that a process has.
        failed: why, by entry.
        awaited: entries that somebody waits for, or waited.
        rooms: modules of which something was waited for: more of these is likely to be wanted next.
    """

    requested: dict[str, Kernel] = field(default_factory=dict)
    done: set[str] = field(default_factory=set)
    given: set[str] = field(default_factory=set)
    failed: dict[str, str] = field(default_factory=dict)
    awaited: set[str] = field(default_factory=set)
    rooms: set[str] = field(default_factory=set)

    def ask(self, kernels: Iterable[Kernel], kept: Store, first: bool) -> None:
        """Add kernels and what they call, before all others or behind them."""
        requested: dict[str, Kernel] = {}
        for kernel in kernels:
            if first:
                self.rooms.add(kernel.__module__)
            for each in _with_callees(kernel, set()):
                if each.entry not in self.done and (first or each.entry not in self.requested):
                    if kept.has(each.entry):
                        self.done.add(each.entry)
                    else:
                        requested[each.entry] = each
        if first:
            self.awaited.update(requested)
        self.requested = requested | self.requested if first else self.requested | requested

    def next(self) -> Kernel | None:
        """Take one whose callees are there, the likeliest to be wanted soon; None where all wait for others, nothing is
        left, or nobody waits and none is usual.
        """
        left = (
            kernel for entry, kernel in self.requested.items() if entry not in self.done and entry not in self.given
        )
        ready = [kernel for kernel in left if all(each.entry in self.done for each in kernel.callees)]
        if not ready:
            return None
        chosen = min(ready, key=self._turn)
        if self._turn(chosen) > 1 and self.awaited <= self.done:
            return None  # the cores are for what the program computes
        self.given.add(chosen.entry)
        return chosen

    def _turn(self, kernel: Kernel) -> int:
        """Return how likely a kernel is to be wanted soon, 0 = the likeliest."""
        if kernel.entry in self.awaited:
            return 0
        if kernel.name.partition(".")[2] in usual_kernels():
            return 1
        return 2 if kernel.__module__ in self.rooms else 3

    @property
    def over(self) -> bool:
        """Whether everything that was wanted is done."""
        return self.done.issuperset(self.requested)


def _with_callees(kernel: Kernel, seen: set[str]) -> Iterator[Kernel]:
    if kernel.entry in seen:
        return
    seen.add(kernel.entry)
    for each in kernel.callees:
        yield from _with_callees(each, seen)
    yield kernel


@cache
def usual_kernels() -> frozenset[str]:
    """Return the names, without the package's, of the kernels that the sample part's program takes: while one process
    compiles what somebody waits for, the others are best at what will be waited for next.
    """
    return frozenset(resource("usual_kernels.txt").read_text(encoding="utf-8").split())


@cache
def _import_usual() -> None:
    """Import the modules of the usual kernels, so that these can be compiled ahead of the stage that imports them."""
    for module in sorted({name.partition(":")[0] for name in usual_kernels()}):
        import_module(f"{PACKAGE}.{module}")


class Compilers:
    """The processes that compile for this one. They start when something is missing and end when nothing is."""

    def __init__(self, kept: Store) -> None:
        self._kept = kept
        self._plan = _Plan()
        self._changed = threading.Condition()
        self._processes: list[subprocess.Popen[str]] = []
        self._ended = False
        atexit.register(self.close)

    def demand(self, *kernels: Kernel) -> None:
        """Have kernels compiled, and wait for it; where there can be no processes, nothing is done, and the caller
        compiles.

        Raises:
            Cancelled: what waits was told to stop, see `app.core.progress.waits_reported_to`.
        """
        if self._kept.folder is None:
            return
        _import_usual()
        with self._changed:
            self._plan.ask(kernels, self._kept, first=True)
            self._plan.ask(REGISTERED, self._kept, first=False)
            self._start()
            self._changed.notify_all()
            while self._processes and any(kernel.entry not in self._plan.done for kernel in kernels):
                self._tell()
                self._changed.wait(_LOOK_EVERY_S)

    def why(self, kernel: Kernel) -> str | None:
        """Return why a kernel could not be compiled, or None."""
        return self._plan.failed.get(kernel.entry)

    def close(self) -> None:
        """End all processes; what they have finished is kept."""
        with self._changed:
            self._ended = True
            for process in self._processes:
                process.kill()
            self._changed.notify_all()

    @property
    def share(self) -> float:
        """How much of what is wanted is done, in [0, 1]."""
        return 1.0 - len(self._plan.requested.keys() - self._plan.done) / max(1, len(self._plan.requested))

    def _tell(self) -> None:
        missing = self._plan.awaited
        done = len(missing & self._plan.done)
        self._changed.release()
        try:
            report_wait(f"Compiling inner loops, this first time only: {done} of {len(missing)}")
        finally:
            self._changed.acquire()

    def _start(self) -> None:
        missing = sum(entry not in self._plan.done for entry in self._plan.requested)
        while not self._ended and len(self._processes) < min(os.cpu_count() or 1, missing):
            try:
                process = self._process()
            except OSError:
                return
            self._processes.append(process)
            threading.Thread(target=self._feed, args=(process,), name="compiling", daemon=True).start()

    def _process(self) -> subprocess.Popen[str]:
        environment = os.environ | {FOLDER_VARIABLE: str(self._kept.folder)}
        command = [sys.executable, "-P", "-c", _PROGRAM]
        return subprocess.Popen(
            command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            env=environment,
            text=True,
            encoding="utf-8",
        )

    def _feed(self, process: subprocess.Popen[str]) -> None:
        """Give one process kernel after kernel until nothing is left, or it is gone."""
        while (kernel := self._take()) is not None:
            answer = _asked(process, kernel.name)
            with self._changed:
                self._plan.given.discard(kernel.entry)
                if answer is None:
                    break
                self._plan.done.add(kernel.entry)
                if answer != DONE:
                    self._plan.failed[kernel.entry] = answer
                self._changed.notify_all()
        with self._changed:
            self._processes.remove(process)
            if not self._processes and not self._ended:
                self._kept.sweep()
            self._changed.notify_all()
        if process.stdin is not None:
            with suppress(OSError):
                process.stdin.close()
        process.wait()

    def _take(self) -> Kernel | None:
        with self._changed:
            while not self._ended and not self._plan.over:
                kernel = self._plan.next()
                if kernel is not None:
                    return kernel
                self._changed.wait()
            return None


def _asked(process: subprocess.Popen[str], name: str) -> str | None:
    """Return what a process answers, or None where it is gone."""
    assert process.stdin is not None and process.stdout is not None
    try:
        process.stdin.write(name + "\n")
        process.stdin.flush()
        return process.stdout.readline().strip() or None
    except OSError:
        return None


@cache
def compilers() -> Compilers:
    """Return the one that works for this process."""
    return Compilers(store(numba_loader.versions()))
