"""The options of `figure11`."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

from ..core.errors import InputError
from ..exhibits.die_programs import PROGRAMS
from ..exhibits.figure_eleven import FigureOptions
from .command import OptionParser, number, typed
from .setup_options import add_setup_options

LEAST_CELLS, MOST_CELLS, MOST_RUNS = 16, 4096, 100
_USUAL = FigureOptions()
EPILOG = """\
Cuts zigzags over a curved die of 100 mm, A and B with the moves and radii that were printed, C with more and finer
ones, in every way there is, one after the other in one process, and prints how long the best run of each took. Other
work on the machine shows in the times; ratios between the columns suffer less. Exit status 0: done; 2: something
cannot be used; 130: cancelled.
"""


def add_figure_options(parser: OptionParser) -> None:
    """Add the options of `hitofude figure11`."""
    parser.add_argument(
        "own",
        metavar="PROGRAM.ngc",
        type=Path,
        nargs="*",
        help="NC programs to measure by, as `make` and `surface` write",
    )
    add_setup_options(parser, "own programs: ")
    parser.add_argument(
        "--programs",
        metavar="A,B,C",
        type=typed(_programs),
        help="which of the zigzags over the die (default all, none beside own programs)",
    )
    parser.add_argument(
        "--facet",
        metavar="D,...",
        type=_facets,
        default=(),
        help="sizes of facets (mm) that the published way is tried with beside two cells, to compare",
    )
    parser.add_argument(
        "--grid",
        metavar="N",
        type=typed(_whole("cells", LEAST_CELLS, MOST_CELLS)),
        default=_USUAL.cells,
        help=f"cells along each side, {LEAST_CELLS} to {MOST_CELLS} (default {_USUAL.cells})",
    )
    parser.add_argument(
        "--repeat",
        metavar="N",
        type=typed(_whole("runs", 1, MOST_RUNS)),
        default=_USUAL.repeat,
        help=f"runs, of which the best one counts, 1 to {MOST_RUNS} (default {_USUAL.repeat})",
    )
    parser.add_argument("--report", metavar="R.json", type=Path, help="everything that was measured, as JSON")
    parser.add_argument("--quiet", action="store_true", help="say nothing but errors")


def _facets(text: str) -> tuple[float, ...]:
    return tuple(number("facet")(part) for part in text.split(","))


def _programs(text: str) -> tuple[str, ...]:
    names = tuple(name.strip().upper() for name in text.split(","))
    wrong = next((name for name in names if name not in PROGRAMS), None)
    if wrong is not None or len(set(names)) < len(names):
        raise InputError(f"'{text}' names no programs; write some of {','.join(PROGRAMS)}, each once")
    return names


def _whole(what: str, least: int, most: int) -> Callable[[str], int]:
    def read(text: str) -> int:
        if not re.fullmatch(r"\d{1,6}", text.strip()) or not least <= int(text) <= most:
            raise InputError(f"'{text}' is no number of {what}; write a whole number from {least} to {most}")
        return int(text)

    return read
