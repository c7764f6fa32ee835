"""The memory of a command: what `--memory` allows, and a net beneath what is asked for, so that nobody is killed
without a word.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress

from ..core.errors import HitofudeError, InputError
from ..core.memory import budget_limit, half_of_machine, in_words, read_size, within

OPTION = "--memory"

SPARE = 1 << 30
"""Bytes by which the net hangs beneath the budget: what libraries and their threads reserve and hardly use, and what
estimates err by.
"""


@contextmanager
def budgeted(argv: Sequence[str]) -> Iterator[None]:
    """Let a command take no more memory than its arguments say.

    Where the system can bound a process's data, work that was not asked for ends in MemoryError rather than with the
    process.

    Raises:
        InputError: the size is none.
    """
    limit = memory_given(argv)
    with within(limit), _net(half_of_machine() if limit is None else limit):
        yield


def memory_given(argv: Sequence[str]) -> int | None:
    """Return the size that the arguments name, the last one where there are several; None where there is none, or it is
    missing.

    Raises:
        InputError: it is none.
    """
    found: str | None = None
    for argument, value in zip(argv, [*argv[1:], None], strict=True):
        if argument == OPTION:
            found = value
        elif argument.startswith(f"{OPTION}="):
            found = argument.partition("=")[2]
    try:
        return None if found is None else read_size(found)
    except InputError as error:
        raise InputError(f"{OPTION} is wrong: {error}; see hitofude {argv[0]} --help") from error


def out_of_memory(where: str = "") -> HitofudeError:
    """Return the error of a job whose memory ran out although it was asked for.

    Args:
        where: words behind "ran out".
    """
    return HitofudeError(
        f"the memory that the job may take, {in_words(budget_limit())}, ran out{where}; allow more with {OPTION}, "
        "or ask for less: a larger tool, a coarser grid, bitmap or tolerance, a part of the drawing."
    )


@contextmanager
def _net(limit: int) -> Iterator[None]:
    """Bound the data of this process for a while, where the system can do that."""
    data = _data_bytes()
    if data is None:
        yield
        return
    import resource

    before = resource.getrlimit(resource.RLIMIT_DATA)
    bound = data + limit + SPARE + (64 << 20) * (os.cpu_count() or 1)
    lower = bound if before[0] == resource.RLIM_INFINITY else min(before[0], bound)
    with suppress(OSError, ValueError):
        resource.setrlimit(resource.RLIMIT_DATA, (lower, before[1]))
    try:
        yield
    finally:
        with suppress(OSError, ValueError):
            resource.setrlimit(resource.RLIMIT_DATA, before)


def _data_bytes() -> int | None:
    """Return the bytes of memory for data that this process has reserved, as the bound counts them; None where nobody
    knows.
    """
    if not sys.platform.startswith("linux"):
        return None
    try:
        with open("/proc/self/status", encoding="ascii") as lines:
            return next(int(line.split()[1]) * 1024 for line in lines if line.startswith("VmData"))
    except (OSError, StopIteration, ValueError):
        return None
