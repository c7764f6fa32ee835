"""The options of `tools`, and what they ask for."""

from __future__ import annotations

import argparse
from pathlib import Path

from ..formats.job.toml import read_units
from ..formats.readers import offered_suffixes
from ..formats.tools.at_path import tools_at
from ..model.operation import LEAST_LENGTH
from ..toolpath.advice.advise import CuttingPlan
from ..usecases.advice import AdviceOptions
from .command import OptionParser
from .reading_options import add_reading_options, reading
from .values import TOOLS_HELP, join_tolerance, number, typed

EPILOG = """\
Prints for each area the narrowest passage, the largest disc, the smallest inner radius and the largest tool that
leaves nothing but sharp inner corners; then what each tool reaches and leaves, and which two to take. Times are
estimates with each tool's feeds. Exit status 0: done; 1: with findings about the drawing; 2: something cannot be used.
"""


def add_tools_options(parser: OptionParser) -> None:
    """Add the options of `hitofude tools`."""
    parser.add_argument(
        "drawing", metavar="DRAWING", type=Path, help=f"the drawing or project, {' '.join(offered_suffixes())}"
    )
    parser.add_argument(
        "--tools",
        metavar="FILE",
        type=Path,
        help=f"tools to choose from: {TOOLS_HELP} (default: end mills from 1 to 25 mm as they are sold)",
    )
    parser.add_argument(
        "--depth", metavar="Z", type=number("depth", least=LEAST_LENGTH), default=2.0, help="of the floor (default 2)"
    )
    parser.add_argument(
        "--stepdown",
        metavar="MM",
        type=number("stepdown", least=LEAST_LENGTH),
        default=2.0,
        help="of one pass (default 2)",
    )
    parser.add_argument(
        "--units", metavar="mm|in", type=typed(read_units), help="units of a drawing that names none (default mm)"
    )
    parser.add_argument("--layer", metavar="NAME", action="append", default=[], help="only this layer; may be repeated")
    add_reading_options(parser)
    parser.add_argument(
        "--join-tolerance", metavar="MM", type=join_tolerance, help="join loose ends nearer than this (default 0.01)"
    )
    parser.add_argument("--report", metavar="R.json", type=Path, help="everything that was found, as JSON")
    parser.add_argument("--quiet", action="store_true", help="say nothing but errors")


def advice_options(arguments: argparse.Namespace) -> AdviceOptions:
    """Return what was asked for, the tools to choose from read."""
    tools = () if arguments.tools is None else tools_at(arguments.tools).library.tools
    plan = CuttingPlan(depth=arguments.depth, stepdown=min(arguments.stepdown, arguments.depth))
    return AdviceOptions(
        tuple(tools), plan, arguments.units, tuple(arguments.layer), arguments.join_tolerance, reading(arguments)
    )
