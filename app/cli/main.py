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
from ..core.progress import told_waits
from ..core.settings import config_folder, state_folder
from .memory import budgeted, out_of_memory
from .output import WaitLine, say, tell
from .signals import Stopped, Stopping, stoppable

DONE, WITH_FINDINGS, BAD_INPUT, CANCELLED = 0, 1, 2, 130
HELP = """\
Hitofude: from a line drawing to tool paths that can be trusted on a real machine.

  hitofude [open] [FILE]              the window, with FILE or the sample part
  hitofude make DRAWING -o OUT.ngc    a drawing into tool paths for pockets, contours and holes (make --help)
  hitofude tools DRAWING              which tools a drawing wants: what passes, what clears, how long (tools --help)
  hitofude cut PROGRAM.ngc            any NC program cut out of its stock: what is left, gouges, rapids (cut --help)
  hitofude check PROGRAM.ngc          any NC program: what is wrong, how far it goes, how long it takes (check --help)
  hitofude smooth PROGRAM.ngc -o OUT  any NC program's chords into lines, arcs or splines, proven (smooth --help)
  hitofude surface SCENE.toml -o OUT  tool paths over compound surfaces, each move proven (surface --help)
  hitofude stages DRAWING -o DIR      the bitmap way of 1986, step by step, as pictures and codes (stages --help)
  hitofude figure11                   how long software and depth buffer take for the cuts of 1999 (figure11 --help)
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
    try:
        sweep(state_folder(), config_folder())
        with (
            budgeted(argv),
            stoppable() as stopped,
            WaitLine("--quiet" in argv) as line,
            told_waits(partial(_wait, stopped, line), everywhere=True),
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
        _say("cancelled; no file was written")
        return stop.status
    except (KeyboardInterrupt, Cancelled):
        _say("cancelled; no file was written")
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


def _wait(stopped: Stopping, line: WaitLine, text: str) -> None:
    stopped.waited = time.monotonic()
    line.show(text)


def _command(argv: list[str], stopped: Stopping) -> int:
    name, rest = (argv[0], argv[1:]) if argv else ("", [])
    if name in ("", "-h", "--help", "help"):
        tell(HELP.rstrip())
        return DONE
    if name in ("-V", "--version"):
        tell(f"hitofude {__version__}")
        return DONE
    if name == "make":
        from .commands.make import make_command

        return make_command(rest, stopped)
    if name == "cut":
        from .commands.cut import cut_command

        return cut_command(rest, stopped)
    if name == "check":
        from .commands.check import check_command

        return check_command(rest, stopped)
    if name == "stages":
        from .commands.stages import stages_command

        return stages_command(rest, stopped)
    if name == "tools":
        from .commands.tools import tools_command

        return tools_command(rest, stopped)
    if name == "smooth":
        from .commands.smooth import smooth_command

        return smooth_command(rest, stopped)
    if name == "surface":
        from .commands.surface import surface_command

        return surface_command(rest, stopped)
    if name == "figure11":
        from .commands.figure11 import figure11_command

        return figure11_command(rest, stopped)
    _say(
        f"there is no command '{name}'; use 'make', 'tools', 'cut', 'check', 'smooth', 'surface', 'stages', "
        "'figure11' or 'open', see hitofude --help"
    )
    return BAD_INPUT


def _say(text: str) -> None:
    say("hitofude: " + shortened(" ".join(text.split())))
