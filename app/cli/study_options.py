"""The options of `study`, and the combinations that they ask for."""

from __future__ import annotations

import argparse
import re
from collections.abc import Sequence
from decimal import Decimal, InvalidOperation
from pathlib import Path

from ..core.errors import InputError
from ..core.input_file import read_input
from ..core.progress import Progress
from ..formats.tools.at_path import tools_at
from ..usecases.advice import AdviceOptions, advice_for
from ..usecases.batch.study import MOST_CHOICES, StudyAxis, StudyChoice, choices_of, tool_choices
from ..usecases.batch.task import BatchKind
from .batch_list import PROGRAMS, ListedPart
from .batch_options import actions_of, add_passed
from .command import TOOLS_HELP, OptionParser
from .lanes import add_lane_options

EPILOG = """\
Makes the program of one drawing, or smooths one NC program, once for every combination of values, by processes or on a
cluster, and writes study.csv and study.html, the table of time, length and findings, the shortest first. Values are
V1,V2,… or FROM..TO:STEP. --which-tool takes every pair of a pocket tool and a contour tool that fits into the drawing.
What is done is not done again; Ctrl+C keeps it, and the same command goes on. Other options are those of make, or of
smooth, for all combinations. Exit status 0: a combination is clean; 1: none is; 2: nothing was begun.
"""

_RANGE = re.compile(r"([-+.\d]+)\.\.([-+.\d]+):([-+.\d]+)")


def add_study_options(parser: OptionParser) -> None:
    """Add the options of `hitofude study`."""
    parser.add_argument("file", metavar="DRAWING|PROGRAM.ngc", type=Path, help="the drawing, or the NC program")
    parser.add_argument(
        "--vary",
        metavar="OPTION=VALUES",
        action="append",
        default=[],
        help="an option, without its dashes, and its values: stepover=30%%,40%%,50%% or tolerance=0.01..0.1:0.01; may "
        "be repeated",
    )
    parser.add_argument(
        "--which-tool", action="store_true", help="of a drawing: vary pocket tool and contour tool, as far as they fit"
    )
    parser.add_argument(
        "--choose-from",
        metavar="FILE",
        type=Path,
        help=f"with --which-tool: tools to choose from: {TOOLS_HELP} (default: end mills from 1 to 25 mm)",
    )
    add_lane_options(parser, "combinations")
    add_passed(parser, (BatchKind.MAKE, BatchKind.SMOOTH))


def kind_of(path: Path) -> BatchKind:
    """Return what is done with a file: NC programs are smoothed, programs of drawings made."""
    return BatchKind.SMOOTH if path.suffix.lower() in PROGRAMS else BatchKind.MAKE


def studied(arguments: argparse.Namespace, progress: Progress) -> tuple[StudyChoice, ...]:
    """Return the combinations.

    Raises:
        HitofudeError: an option is none, or there is nothing to vary. Cancelled: by progress.
    """
    kind = kind_of(arguments.file)
    axes = tuple(_axis(text, kind) for text in arguments.vary)
    if not arguments.which_tool:
        if arguments.choose_from is not None:
            raise InputError("--choose-from has no effect without --which-tool; add it, or leave --choose-from away")
        return choices_of(axes)
    if kind is not BatchKind.MAKE:
        raise InputError(f"--which-tool: {arguments.file} is a program, and has its tools; name a drawing")
    tools = () if arguments.choose_from is None else tuple(tools_at(arguments.choose_from).library.tools)
    advised = advice_for(arguments.file.name, read_input(arguments.file), AdviceOptions(tools), progress)
    return tool_choices(advised.advice, axes)


def listed(choices: Sequence[StudyChoice], path: Path) -> list[ListedPart]:
    """Return a part of a batch for each combination."""
    digits = len(str(len(choices)))
    return [
        ListedPart(choice.name, path, f"{number:0{digits}}_{choice.stem}.ngc", choice.options)
        for number, choice in enumerate(choices, 1)
    ]


def _axis(text: str, kind: BatchKind) -> StudyAxis:
    option, _, values = text.partition("=")
    option = option.removeprefix("--").replace("_", "-")
    action = next((each for each in actions_of(kind) if f"--{option}" in each.option_strings), None)
    if action is None or action.nargs == 0:
        raise InputError(f"--vary {option}: that is no option of {kind.value} with a value; see hitofude study --help")
    return StudyAxis(option, _values(option, values))


def _values(option: str, text: str) -> tuple[str, ...]:
    found = _RANGE.fullmatch(text)
    if found is None:
        return tuple(value.strip() for value in text.split(","))
    try:
        first, last, step = (Decimal(number) for number in found.groups())
        count = int((last - first) / step) + 1
    except (InvalidOperation, ArithmeticError, ValueError) as error:
        raise InputError(
            f"--vary {option}: '{text}' is no range; write FROM..TO:STEP, such as 0.01..0.1:0.01"
        ) from error
    if not 1 <= count <= MOST_CHOICES:
        raise InputError(f"--vary {option}: '{text}' has {count} values; use 1 to {MOST_CHOICES}")
    return tuple(f"{(first + number * step).normalize():f}" for number in range(count))
