"""The parser of the program: its commands, each loaded when it is asked for."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from importlib import import_module
from typing import TYPE_CHECKING

from .output import tell
from .signals import StopFlag, ended_at_once

if TYPE_CHECKING:
    from .command import CliCommand


@dataclass(frozen=True)
class CommandSummary:
    """A command as the list of all has it.

    Attributes:
        usage: the command and what it cannot do without.
        words: what it does; its own help tells all.
    """

    usage: str
    words: str


SUMMARIES = {
    "make": CommandSummary("make DRAWING -o OUT.ngc", "a drawing into tool paths for pockets, contours and holes"),
    "inlay": CommandSummary("inlay DRAWING --job J.toml -o OUT", "a V-carved pocket and the plug that fits into it"),
    "tools": CommandSummary("tools DRAWING", "which tools a drawing wants: what passes, what clears, how long"),
    "feeds": CommandSummary("feeds --material M", "how fast a tool may turn and feed in a material, and why"),
    "cut": CommandSummary("cut PROGRAM.ngc", "any NC program cut out of its stock: what is left, gouges, rapids"),
    "check": CommandSummary("check PROGRAM.ngc", "any NC program: what is wrong, how far it goes, how long it takes"),
    "sheet": CommandSummary("sheet PROGRAM.ngc -o OUT", "the paper for the machine: set-up, tools, times, certificate"),
    "smooth": CommandSummary(
        "smooth PROGRAM.ngc -o OUT", "any NC program's chords into lines, arcs or splines, proven"
    ),
    "better": CommandSummary(
        "better PROGRAM.ngc -o OUT", "passes over a surface made anew, smooth; cut again, compared"
    ),
    "surface": CommandSummary("surface SCENE.toml -o OUT", "tool paths over compound surfaces, each move proven"),
    "batch": CommandSummary("batch FOLDER -o OUT", "many parts made, checked or smoothed, and a table of them"),
    "study": CommandSummary(
        "study FILE -o OUT --vary O=V,V", "one file many ways: which tool, which tolerance, least time"
    ),
    "stages": CommandSummary("stages [FILE] -o DIR", "each of the five published methods, step by step, as pictures"),
    "desktop": CommandSummary("desktop", "the entry of the desktop's menu, icon and kinds of files, for this user"),
    "manual": CommandSummary("manual -o OUT", "the manual as pages for browsers, with search, in both languages"),
    "licences": CommandSummary("licences", "whose work is inside, and under which licence"),
    "figure11": CommandSummary("figure11", "how long software and depth buffer take for the cuts of 1999"),
}
"""In the order of the help. A command is the `COMMAND` of the module of its name in `commands`."""


def program_parser() -> argparse.ArgumentParser:
    """Return the parser of the program, with a sub-parser a command."""
    from .command import OptionParser  # not before signals are heard: it brings the model along

    parser = argparse.ArgumentParser(prog="hitofude", add_help=False, exit_on_error=False)
    commands = parser.add_subparsers(dest="command", parser_class=OptionParser)
    for name in SUMMARIES:
        commands.add_parser(name, load=partial(load_command, name))
    return parser


def run_command(argv: Sequence[str], stopped: StopFlag) -> int:
    """Run the command that arguments begin with, or print its help where they ask for it; return the exit status.

    Args:
        argv: the command and what is behind it.
        stopped: set when the user wants it to stop.

    Raises:
        HitofudeError: bad usage or input; nothing was written.
        Cancelled: by Ctrl+C.
    """
    if any(argument in ("-h", "--help") for argument in argv):
        tell(load_command(argv[0]).parser().format_help().rstrip())
        return 0
    arguments = program_parser().parse_args(argv)
    status: int = arguments.run(arguments, stopped)
    return status


def load_command(name: str) -> CliCommand:
    """Return a command by its name."""
    with ended_at_once():
        command: CliCommand = import_module(f".commands.{name}", __package__).COMMAND
    return command


def listed() -> str:
    """Return a line a command for the help; behind a long usage the words stand in a line of their own."""
    return "\n".join(
        f"  hitofude {each.usage:<{_COLUMN}}{'' if len(each.usage) <= _COLUMN else _NEXT} {each.words} ({name} --help)"
        for name, each in SUMMARIES.items()
    )


_COLUMN = 26
_NEXT = "\n" + " " * (len("  hitofude ") + _COLUMN)
