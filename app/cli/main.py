"""The command line: which command, what exit status, one line for every error. Needs neither Qt nor a display."""

from __future__ import annotations

import os
import sys
import time
import traceback
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from functools import partial

from .. import __version__
from ..core.atomic import sweep
from ..core.errors import Cancelled, HitofudeError, InputError, shortened
from ..core.memory import budget_limit, half_of_machine, in_words, read_size, within
from ..core.progress import waits_reported_to
from ..core.settings import config_folder, state_folder
from .output import WaitLine, say, tell
from .program import SUMMARIES, listed, run_command
from .signals import StopFlag, Stopped, stoppable

DONE, WITH_FINDINGS, BAD_INPUT, CANCELLED = 0, 1, 2, 130
"""Exit statuses, which scripts ask; a command that was stopped has that of a shell for Ctrl+C."""

HELP = f"""\
Hitofude: from a line drawing to tool paths that can be trusted on a real machine.

  hitofude [open] [FILE]              the window, with FILE or the last ones to choose from
{listed()}
  hitofude --version                  this version
  hitofude --help                     this text

Exit status: 0 done and clean; 1 done, with findings (gouge, reachable material left, rapid in material, a region
skipped whole, an open contour); 2 bad input or usage, told in one line; 130 cancelled (143 by TERM,
129 by HUP).
"""


def main(argv: Sequence[str]) -> int:
    """Run one command and return its exit status.

    Args:
        argv: the arguments behind the program's name.
    """
    stopped = StopFlag()
    try:
        sweep(state_folder(), config_folder())
        with (
            budgeted(argv),
            stoppable(stopped),
            WaitLine("--quiet" in argv) as line,
            waits_reported_to(partial(_wait, stopped, line), everywhere=True),
        ):
            try:
                return _command(list(argv), stopped)
            except MemoryError:
                where = f", at: {stopped.stage}" if stopped.stage else ""
                raise out_of_memory(where) from None  # what the frames of the error hold is let go of
            except Exception as error:
                if stopped.is_set():  # a compiled loop's door makes a SystemError of what is raised while it closes
                    raise Stopped(stopped.number) from error
                raise
    except Stopped as stop:
        _say(f"cancelled; {stopped.kept}")
        return stop.status
    except (KeyboardInterrupt, Cancelled):
        _say(f"cancelled; {stopped.kept}")
        return CANCELLED
    except HitofudeError as error:
        _say(str(error))
        return BAD_INPUT
    except Exception as error:
        if os.environ.get("HITOFUDE_DEBUG") == "1":
            say(traceback.format_exc())
        _say(
            f"this should not have happened ({type(error).__name__}: {error}); "
            "please report it with the drawing; HITOFUDE_DEBUG=1 shows where"
        )
        return BAD_INPUT


def _wait(stopped: StopFlag, line: WaitLine, text: str) -> None:
    stopped.waited = time.monotonic()
    line.show(text)


def _command(argv: list[str], stopped: StopFlag) -> int:
    name = argv[0] if argv else ""
    if name in ("", "-h", "--help", "help"):
        tell(HELP.rstrip())
        return DONE
    if name in ("-V", "--version"):
        tell(f"hitofude {__version__}")
        return DONE
    if name not in SUMMARIES:
        known = ", ".join(f"'{each}'" for each in SUMMARIES)
        _say(f"there is no command '{name}'; use {known} or 'open', see hitofude --help")
        return BAD_INPUT
    return run_command(argv, stopped)


def _say(text: str) -> None:
    say("hitofude: " + shortened(" ".join(text.split())))


# The memory of a command: what `--memory` allows, and a net beneath what is asked for, so that nobody is killed
# without a word.


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
