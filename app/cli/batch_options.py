"""The options of `batch`: its own, and those of the command that it does with every part, which are passed on to it."""

from __future__ import annotations

import argparse
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from ..core.catalogue import LANGUAGES
from ..usecases.batch.task import BatchKind
from .command import OptionParser
from .lanes import add_lane_options
from .program import load_command

EPILOG = """\
Writes each part's program below OUT, and results.csv and results.html, the table of verdict, time, length and
findings. What is done is not done again: it is known by the content of file, options and program version, kept in
OUT/.hitofude. So Ctrl+C, a fault of the power or another option costs only what it concerns: type the command again.
LIST.toml names parts, each with options of its own: [[part]], file = "plate.dxf", depth = 3; a table [options] is for
all. Options are those of make, or with --check or --smooth those of check or smooth. Exit status 0: all parts are
clean; 1: some are not, the table tells which; 2: nothing was begun.
"""

NOT_PASSED = frozenset(
    {"help", "memory", "output", "report", "image", "write_job", "timings", "quiet", "frame", "restart_at", "compare"}
    | {"sheet", "language"}
)
"""What the commands have for one part alone."""


def add_batch_options(parser: OptionParser) -> None:
    """Add the options of `hitofude batch`."""
    parser.add_argument("parts", metavar="FOLDER|LIST.toml", type=Path, help="the parts: all in a folder, or a list")
    kind = parser.add_mutually_exclusive_group()
    kind.add_argument("--check", action="store_true", help="check NC programs instead of making them of drawings")
    kind.add_argument("--smooth", action="store_true", help="smooth NC programs instead")
    add_lane_options(parser, "parts")
    parser.add_argument("--reports", action="store_true", help="everything that was measured of each part, as JSON")
    parser.add_argument(
        "--images", choices=["svg", "png"], help="of make: a picture of part and paths beside each program"
    )
    parser.add_argument(
        "--sheets", choices=["pdf", "html"], help="of make: the sheet for the machine beside each program"
    )
    parser.add_argument("--language", choices=LANGUAGES, default=LANGUAGES[0], help="of the sheets (default en)")
    add_passed(parser, BatchKind)


class _Passed(argparse.Action):
    """Keeps an option and its value as they were typed, for the command that reads them."""

    def __call__(
        self,
        parser: argparse.ArgumentParser,
        namespace: argparse.Namespace,
        values: str | Sequence[Any] | None,
        option_string: str | None = None,
    ) -> None:
        kept = getattr(namespace, "passed", None) or []
        own = f"{option_string}={values}" if isinstance(values, str) else str(option_string)
        namespace.passed = [*kept, own]


def add_passed(parser: OptionParser, kinds: Iterable[BatchKind]) -> None:
    """Add the options of commands, each under the first command that has it."""
    taken = {name for action in parser._actions for name in action.option_strings}
    for kind in kinds:
        group = parser.add_argument_group(f"options of {kind.value}")
        for action in actions_of(kind):
            names = [name for name in action.option_strings if name not in taken]
            if names:
                taken.update(names)
                shown = f"{{{','.join(map(str, action.choices))}}}" if action.choices else action.dest.upper()
                group.add_argument(
                    *names,
                    action=_Passed,
                    dest="passed",
                    nargs=0 if action.nargs == 0 else None,
                    metavar=action.metavar or (None if action.nargs == 0 else shown),
                    help=action.help,
                )


def actions_of(kind: BatchKind) -> list[argparse.Action]:
    """Return the options of a command that are for any number of parts."""
    parser = load_command(kind.value).parser()
    assert parser.command
    return [each for each in parser._actions if each.option_strings and each.dest not in NOT_PASSED]


def kind_of(arguments: argparse.Namespace) -> BatchKind:
    """Return what is done with every part."""
    return BatchKind.CHECK if arguments.check else BatchKind.SMOOTH if arguments.smooth else BatchKind.MAKE
