"""`hitofude licences`: whose work is inside, as it is installed here."""

from __future__ import annotations

import argparse

from ...core.licences import installed_licences
from ...core.progress import NO_PROGRESS
from ..command import CliCommand, OptionParser
from ..outcome import CommandOutcome
from ..signals import StopFlag


def _add_options(parser: OptionParser) -> None:
    parser.add_argument("--texts", action="store_true", help="the licences' own texts, too")
    parser.add_argument("--quiet", action="store_true", help="say nothing but errors")


def _run(arguments: argparse.Namespace, stopped: StopFlag) -> int:
    """Print the list and return the exit status, 0."""
    packages = installed_licences()
    wide = max(len(f"{each.name} {each.version}") for each in packages) if packages else 0
    lines = [f"{f'{each.name} {each.version}':<{wide}}  {each.licence}" for each in packages]
    if arguments.texts:
        for each in packages:
            for name, text in each.files.items():
                lines += ["", f"===== {each.name}: {name}", *text.rstrip().splitlines()]
    return CommandOutcome({}, lines).delivered(arguments, NO_PROGRESS)


COMMAND = CliCommand(
    "licences",
    about="List this program and every package that it runs with here, with their licences.",
    epilog="The list is what the packages that are installed say of themselves. Exit status 0.",
    add_options=_add_options,
    run=_run,
    examples=("hitofude licences --texts",),
)
