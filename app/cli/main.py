"""The command line: which command, what exit status, one line for every error. Needs neither Qt nor a display."""

from __future__ import annotations

import os
import time
import traceback
from collections.abc import Sequence
from functools import partial

from .. import __version__
from ..core.atomic import sweep
from ..core.errors import Cancelled, HitofudeError, shortened
from ..core.progress import waits_reported_to
from ..core.settings import config_folder, state_folder
from .memory import budgeted, out_of_memory
from .output import WaitLine, say, tell
from .program import SUMMARIES, listed, run_command
from .signals import StopFlag, Stopped, stoppable

DONE, WITH_FINDINGS, BAD_INPUT, CANCELLED = 0, 1, 2, 130
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
