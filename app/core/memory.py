"""How much memory a job may take: every place that takes what its input asks for asks here, before it takes it.

A budget belongs to a context (`contextvars`), not to the process: a command runs in one of its own, so does each job of
the window, and a test states its own with `within`. The threads of `app.core.pool` work in the context of whoever gives
them work.
"""

from __future__ import annotations

import ctypes
import math
import os
import re
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

from .errors import InputError, ParameterError
from .options import option

LEAST = 1_000_000
"""Bytes; with less nothing can be done."""

_SMALL = 4_000_000
"""Bytes; so little is not refused, whatever is left."""

_MUCH = 500_000_000
"""Bytes; a process that holds less is not asked to give back what is free of it."""

_UNITS = {"": 1, "K": 10**3, "M": 10**6, "G": 10**9, "T": 10**12}
_SIZE = re.compile(r"\s*(\d{1,15}(?:\.\d{1,9})?)\s*([KMGT]?)(?:I?B)?\s*", re.IGNORECASE)
_ITSELF = 100 * 10**6
"""Bytes of the program's own code and tables that are loaded as they are wanted, most of them after a command has
begun.
"""

_UNKNOWN = 4 * 10**9
"""Bytes that are taken to be there where the system does not tell."""


class MemoryRemedy(NamedTuple):
    """What may be changed so that less memory is taken, or a part of that sentence.

    Attributes:
        words: such as "use fewer cells". option, value: what says so on the command line; "" = nothing does.
    """

    words: str
    option: str = ""
    value: object = ""

    def with_option(self) -> str:
        """Return the words, and the option in brackets behind them."""
        return f"{self.words} ({option(self.option, self.value)})" if self.option else self.words


class MemoryShortError(ParameterError):
    """A piece of work would take more memory than it may; nothing of it was taken.

    Attributes:
        what: would take it, as the subject of a sentence. remedies: what to change, one behind the other.
        needed, room: bytes.
    """

    def __init__(self, what: str, remedies: tuple[MemoryRemedy, ...], needed: float, room: float) -> None:
        self.what, self.remedies, self.needed, self.room = what, remedies, needed, room
        advice = "".join(remedy.with_option() for remedy in remedies)
        super().__init__(self._sentence(advice, f" with {option('memory', _asked(self.limit))}"))

    @property
    def limit(self) -> int:
        """What would have to be allowed, bytes; 0 where the machine has not as much."""
        needed = math.ceil((self.needed + _BUDGET.get().taken()) * 1.05)
        return needed if needed <= 0.9 * machine_memory() else 0

    def in_window(self) -> str:
        """Return the sentence for somebody who has menus instead of options."""
        advice = "".join(remedy.words for remedy in self.remedies)
        return self._sentence(advice, " in the menu Compute, Memory of a job")

    def _sentence(self, advice: str, how: str) -> str:
        more = f", or allow more{how}" if self.limit else ""
        return (
            f"{self.what} would take {in_words(self.needed)} of memory, and {in_words(self.room)} may be taken; "
            f"{advice}{more}."
        )


@dataclass(frozen=True)
class Budget:
    """What a job may take.

    Attributes:
        limit: bytes, for the data of the job: the program itself, its libraries among it, is not counted.
        before: bytes that the process had when the job began, or at least what the program itself takes once it is
            loaded.
    """

    limit: int
    before: int = field(default_factory=lambda: max(_ITSELF, resident()))

    def taken(self) -> int:
        """Return the bytes that the process has taken since."""
        return max(0, resident() - self.before)


def budget_limit() -> int:
    """Return the bytes that this context's job may take in all."""
    return _BUDGET.get().limit


def room() -> int:
    """Return the bytes that may still be taken: of the job's budget, and of what the machine has free."""
    budget = _BUDGET.get()
    free = free_memory()
    return max(0, min(budget.limit - budget.taken(), budget.limit if free is None else free))


def ask(needed: float, what: str, *remedies: MemoryRemedy) -> None:
    """Ask for memory before it is taken.

    Args:
        needed: bytes, of all that is there at a time.
        what: takes it, as the subject of a sentence, such as "A grid of 20000 x 10000 cells".
        remedies: what to change, one or several that are read as one: "use a larger tool", " or stepover".

    Raises:
        MemoryShortError: there is not as much.
    """
    there = room()
    if needed > max(there, _SMALL):
        raise MemoryShortError(what, remedies, needed, there)


def portion(each: float, least: int = 4096) -> int:
    """Return how many things may be worked on at a time: half of what may be taken is for them, but a few are worked on
    in any case.

    Args:
        each: bytes that one takes.
        least: that are worth working on.
    """
    return max(least, int(room() / 2 / each))


@contextmanager
def within(limit: int | None) -> Iterator[None]:
    """Give what is done in this context a budget of its own.

    Args:
        limit: bytes; None = half of what the machine has.
    """
    token = _BUDGET.set(Budget(half_of_machine() if limit is None else limit))
    try:
        yield
    finally:
        _BUDGET.reset(token)


def allow(limit: int) -> None:
    """Give what this context does from now on a budget, and what is begun in copies of it.

    Args:
        limit: bytes.
    """
    _BUDGET.set(Budget(limit))


def read_size(text: str) -> int:
    """Return bytes by a text such as 4G or 512M; a letter counts thousands.

    Raises:
        InputError: it is no size, less than `LEAST`, or more than any machine has.
    """
    match = _SIZE.fullmatch(text)
    if match is None:
        raise InputError(f"'{text}' is no size; write one such as 4G or 512M")
    size = float(match[1]) * _UNITS[match[2].upper()]
    if not LEAST <= size <= 1e15:
        raise InputError(f"'{text}' is {in_words(size)}; use 1M to 1000T")
    return int(size)


def in_words(size: float) -> str:
    """Return bytes for people, in three figures or so."""
    unit = next((unit for unit in ("T", "G", "M") if size >= _UNITS[unit]), "M")
    count = size / _UNITS[unit]
    return f"{count:.0f} {unit}B" if count >= 100 or size < _UNITS["M"] else f"{count:.3g} {unit}B"


def _asked(size: int) -> str:
    """Return a size as the option takes it, rounded up to two figures."""
    unit = next(unit for unit in ("T", "G", "M") if size >= _UNITS[unit] or unit == "M")
    count = size / _UNITS[unit]
    return f"{math.ceil(count * 10) / 10:g}{unit}" if count < 10 else f"{math.ceil(count):d}{unit}"


def fitting(needed: float) -> float:
    """Return the share of a piece of work for which the budget is enough where a job is begun anew, in (0, 1].

    Args:
        needed: bytes that it would take beside what is taken already.
    """
    taken, free = _BUDGET.get().taken(), free_memory()
    whole = _BUDGET.get().limit if free is None else min(_BUDGET.get().limit, taken + free)
    return min(1.0, max(whole, 1) / max(needed + taken, 1.0))


def fewer(count: int, needed: float, power: float = 1.0) -> int:
    """Return how many of things would fit of which `count` would take `needed` bytes, rounded down to two figures; at
    least one.

    Args:
        power: memory grows with the count's power: 2 for the cells along one side of a square.
    """
    fits = count * fitting(needed) ** (1 / power)
    step = int(10.0 ** max(0, math.floor(math.log10(max(fits, 1))) - 1))
    return max(1, int(fits // step) * step)


def half_of_machine() -> int:
    """Return half of the machine's memory, bytes: what a job may take where nobody says."""
    return machine_memory() // 2


def machine_memory(proc: Path = Path("/proc"), groups: Path = Path("/sys/fs/cgroup")) -> int:
    """Return the bytes of memory that the machine has, or that the group of processes may take which this one is in.

    Args:
        proc, groups: where the system tells of itself.
    """
    try:
        physical = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    except (AttributeError, OSError, ValueError):
        physical = _UNKNOWN
    return min([physical, *_group_limits(proc, groups)])


def _group_limits(proc: Path, groups: Path) -> Iterator[int]:
    """Yield the limits of this process's group and of those that it is in, of either version of control groups."""
    try:
        lines = (proc / "self/cgroup").read_text("ascii", "replace").splitlines()
    except OSError:
        return
    for line in lines:
        _, kinds, path = line.split(":", 2) if line.count(":") >= 2 else ("", "-", "")
        if kinds and "memory" not in kinds.split(","):
            continue
        base, name = (groups / "memory", "memory.limit_in_bytes") if kinds else (groups, "memory.max")
        parts = [part for part in path.split("/") if part not in ("", ".", "..")]
        for count in range(len(parts) + 1):
            try:
                text = base.joinpath(*parts[:count], name).read_text("ascii").strip()
            except (OSError, ValueError):
                continue
            if text.isdigit():
                yield int(text)


def resident() -> int:
    """Return the bytes of memory that this process holds for its data, without pages of files; 0 where the system does
    not tell.
    """
    try:
        with open("/proc/self/statm", encoding="ascii") as file:
            _, pages, of_files = map(int, file.read().split()[:3])
            return (pages - of_files) * os.sysconf("SC_PAGE_SIZE")
    except (OSError, IndexError, ValueError):
        return 0


def free_memory() -> int | None:
    """Return the bytes of memory that the system can give; None where it does not tell."""
    try:
        with open("/proc/meminfo", encoding="ascii") as lines:
            kilobytes = next(line.split()[1] for line in lines if line.startswith("MemAvailable"))
        return int(kilobytes) * 1024
    except (OSError, StopIteration, ValueError):
        pass
    try:
        return os.sysconf("SC_AVPHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    except (AttributeError, OSError, ValueError):
        return None


_USUAL = Budget(half_of_machine(), _ITSELF)
_BUDGET = ContextVar("budget", default=_USUAL)


def give_back() -> None:
    """Give memory that is free back to the system, of a process that holds much.

    The allocator keeps what many small things leave free for small things to come; a job that goes on with large ones
    would hold both. Where it cannot be asked to, nothing is done.
    """
    if not sys.platform.startswith("linux") or resident() < _MUCH:
        return
    with suppress(OSError, AttributeError):  # a library without that call
        ctypes.CDLL(None).malloc_trim(0)
