"""The options of `check`, and what they ask for."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from pathlib import Path

from ..core.errors import InputError
from ..core.input_file import read_input
from ..gcode.interpreter.dialect import Dialect
from ..gcode.interpreter.foreign_codes import names_units
from ..gcode.interpreter.options import ToolOffset
from ..model.part import Units
from ..usecases.examine import CONTROLS, ExamineOptions
from .check_lines import UNNAMED_UNITS
from .command import MACHINE_HELP, OptionParser, machine_named, typed
from .files import check_outputs, named_files

EPILOG = """\
Prints each problem with its place, then extent, length and time. Exit status 0: nothing is wrong; 1: there are
problems, or --compare found other motion; 2: a file cannot be used. Coordinates are those of the program, tool lengths
taken off.
"""


_UNITS = {"mm": Units.MM, "in": Units.INCH}


def add_program_units(parser: OptionParser) -> None:
    """Add `--units`, of a program that names none."""
    parser.add_argument(
        "--units", choices=list(_UNITS), help="of the lengths in a program that names none, by G20 or G21 (default mm)"
    )


def program_units(arguments: argparse.Namespace) -> Units | None:
    """Return what `--units` says; None where it is not given."""
    return _UNITS.get(arguments.units)


def units_taken(arguments: argparse.Namespace, data: bytes) -> list[str]:
    """Return a line about the units of a program, where neither it nor anybody says them."""
    if arguments.units or names_units(data):
        return []
    return [UNNAMED_UNITS]


def add_check_options(parser: OptionParser) -> None:
    """Add the options of `hitofude check`."""
    parser.add_argument("program", metavar="PROGRAM.ngc", type=Path, help="the NC program")
    parser.add_argument("--dialect", choices=list(CONTROLS), help="the control's language (default: as the text looks)")
    parser.add_argument("--tools", metavar="FILE", type=Path, help="tools: LinuxCNC's .tbl, or a library .toml or .csv")
    parser.add_argument(
        "--tool-units", choices=list(_UNITS), default="mm", help="of the lengths in a .tbl (default mm)"
    )
    parser.add_argument(
        "--block-delete",
        choices=["on", "off"],
        default="on",
        help="leave out the blocks that begin with a slash, or do them (default on)",
    )
    add_program_units(parser)
    parser.add_argument("--machine", metavar="NAME|FILE", type=typed(machine_named), help=MACHINE_HELP)
    parser.add_argument("--compare", metavar="OTHER.ngc", type=Path, help="another program: where its motion differs")
    parser.add_argument(
        "--frame",
        metavar="OUT.ngc",
        type=Path,
        help="write a program round the box of the cuts, by rapids, spindle off",
    )
    parser.add_argument(
        "--restart-at",
        metavar="LINE",
        type=int,
        help="write, to -o, a program that leads in and goes on from this line",
    )
    parser.add_argument("-o", "--output", metavar="OUT.ngc", type=Path, help="of --restart-at")
    parser.add_argument("--report", metavar="R.json", type=Path, help="everything that was found, as JSON")
    parser.add_argument("--quiet", action="store_true", help="say nothing but errors")


def check_files(arguments: argparse.Namespace) -> dict[str, Path]:
    """Return the files to write by their option, checked before any work is done.

    Raises:
        InputError: one cannot be written, or an option lacks the one that it goes with.
    """
    if (arguments.restart_at is None) != (arguments.output is None):
        raise InputError("--restart-at LINE and -o OUT.ngc go together; give both or none")
    outputs = named_files(arguments, "frame", "output", "report")
    check_outputs(outputs, [*named_files(arguments, "program", "tools", "compare").values()])
    return outputs


def examine_options(arguments: argparse.Namespace) -> ExamineOptions:
    """Return how the program is to be looked at, the control's tool table read."""
    dialect = Dialect(arguments.dialect) if arguments.dialect else None
    offsets = _offsets(arguments.tools, arguments.tool_units)
    return ExamineOptions(dialect, offsets, arguments.machine, arguments.block_delete == "on", program_units(arguments))


def _offsets(path: Path | None, units: str) -> Mapping[int, ToolOffset]:
    if path is None:
        return {}
    from ..formats.tools.files import read_rows
    from ..gcode.tool_offsets import tool_offsets

    return tool_offsets(read_rows(path.name, read_input(path), _UNITS[units]))
