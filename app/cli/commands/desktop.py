"""`hitofude desktop`: puts the program into the desktop's menu, for one user, and takes it out again."""

from __future__ import annotations

import argparse
import sys
from contextlib import suppress

from ...core.atomic import write_together
from ...core.desktop import data_folder, desktop_files, refresh
from ...core.errors import InputError
from ..command import CliCommand, OptionParser
from ..output import tell_lines
from ..signals import StopFlag

EPILOG = """\
Writes below ~/.local/share, or XDG_DATA_HOME: the entry, the icon, the kinds of files .hito, .draw and .ngc, the manual
page. For systems with such desktops, as Linux and BSD; Windows and macOS have their own ways. Exit status 0: done; 2:
it could not be written.
"""


def _add_options(parser: OptionParser) -> None:
    parser.add_argument("--remove", action="store_true", help="take all of it away again")
    parser.add_argument("--quiet", action="store_true", help="say nothing but errors")


def _run(arguments: argparse.Namespace, stopped: StopFlag) -> int:
    """Write or take away the files and return the exit status, 0."""
    if sys.platform in ("win32", "darwin"):
        raise InputError("desktop is for desktops that read ~/.local/share; make a shortcut to hitofude instead")
    folder = data_folder()
    files = desktop_files(folder)
    if arguments.remove:
        for path in files:
            with suppress(FileNotFoundError):
                path.unlink()
    else:
        for path in files:
            path.parent.mkdir(parents=True, exist_ok=True)
        write_together(files)
    refresh(folder)
    if not arguments.quiet:
        tell_lines([f"{path}{': taken away' if arguments.remove else ''}" for path in files])
    return 0


COMMAND = CliCommand(
    "desktop",
    about="Put the program into the desktop's menu for this user, with its icon and its kinds of files.",
    epilog=EPILOG,
    add_options=_add_options,
    run=_run,
    examples=(
        "hitofude desktop",
        "hitofude desktop --remove",
    ),
)
