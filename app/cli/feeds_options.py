"""The options of `feeds`, and what they ask for."""

from __future__ import annotations

import argparse
import math
from dataclasses import replace
from pathlib import Path

from ..core.errors import InputError
from ..drafting.expressions.numbers import angle
from ..formats.tools.at_path import tools_at
from ..formats.tools.library import ToolLibrary
from ..formats.tools.materials import stock_material, stock_materials
from ..model.operation import LEAST_LENGTH
from ..model.tool import Tool, ToolMaterial
from ..toolpath.feeds.proposal import CutEngagement
from ..usecases.job.feeds import FeedsOptions, engagement_at
from .command import MACHINE_HELP, TOOLS_HELP, OptionParser, machine_named, number, typed
from .cut_options import shape_given

EPILOG = """\
Prints speed and feeds of each tool, and below them a line for each number: where it comes from, and which limit of
material, tool or machine held it. A row of feeds that a tool has for the material goes before the material's own
figures, which stand in resources/materials.toml; a file materials.toml beside your settings replaces or adds some. Exit
status 0: done; 1: a limit leaves chips so thin that the edges rub; 2: something cannot be used.
"""


def add_feeds_options(parser: OptionParser) -> None:
    """Add the options of `hitofude feeds`."""
    parser.add_argument(
        "--material", metavar="NAME", type=typed(stock_material), required=True, help=f"of the stock: {_known()}"
    )
    which = parser.add_mutually_exclusive_group(required=True)
    which.add_argument(
        "--tool", metavar="SHAPE", type=typed(shape_given), help="a tool, such as flat:6 or ball:3 (kind:diameter)"
    )
    which.add_argument(
        "--tools",
        metavar="FILE",
        type=Path,
        help=f"all tools of a file: {TOOLS_HELP}",
    )
    parser.add_argument("--flutes", metavar="N", type=typed(_flutes), help="of --tool (default 2)")
    parser.add_argument("--edges", choices=["hss", "carbide"], help="what the edges of --tool are made of")
    parser.add_argument("--stick-out", metavar="MM", type=number("stick-out"), help="of --tool, from the tip up")
    parser.add_argument(
        "--depth", metavar="MM", type=number("depth", least=LEAST_LENGTH), help="of one pass (default: the diameter)"
    )
    parser.add_argument(
        "--engaged",
        metavar="DEG",
        type=typed(_engaged),
        help="greatest angle of the rim in metal, up to 180 (default 180, a slot)",
    )
    parser.add_argument("--machine", metavar="NAME|FILE", type=typed(machine_named), help=MACHINE_HELP)
    parser.add_argument(
        "--write", metavar="TOOLS.toml", type=Path, help="a tool library with these speeds and feeds, and their row"
    )
    parser.add_argument("--report", metavar="R.json", type=Path, help="every number with its reason, as JSON")
    parser.add_argument("--quiet", action="store_true", help="say nothing but errors")


def _known() -> str:
    return ", ".join(each.word for each in stock_materials())


def _flutes(text: str) -> int:
    if not text.strip().isdecimal() or not 1 <= int(text) <= 100:
        raise InputError(f"'{text}' is no number of flutes; use 1 to 100")
    return int(text)


def _engaged(text: str) -> float:
    value = angle(text)
    if not 1 <= value <= 180:
        raise InputError(f"{value:g} degrees cannot be engaged; use 1 to 180")
    return math.radians(value)


def check_feeds_options(arguments: argparse.Namespace) -> None:
    """Refuse what shapes a tool where tools come from a file.

    Raises:
        InputError: something does.
    """
    for name in ("flutes", "edges", "stick_out"):
        if arguments.tools is not None and getattr(arguments, name) is not None:
            raise InputError(f"--{name.replace('_', '-')} has no effect with --tools, which tells it of each tool")


def requested_tools(arguments: argparse.Namespace) -> ToolLibrary:
    """Return the tools that feeds are asked for.

    Raises:
        InputError: a file cannot be read, or there is no tool in it.
    """
    if arguments.tools is not None:
        return tools_at(arguments.tools).library
    tool: Tool = arguments.tool
    made = replace(
        tool,
        flutes=arguments.flutes or tool.flutes,
        stick_out=arguments.stick_out or tool.stick_out,
        tool_material=ToolMaterial(arguments.edges) if arguments.edges else tool.tool_material,
    )
    return ToolLibrary("", (made,))


def feeds_options(arguments: argparse.Namespace) -> FeedsOptions:
    """Return what is asked for beside the tools."""
    return FeedsOptions(arguments.material.word, arguments.machine)


def requested_engagement(arguments: argparse.Namespace) -> CutEngagement:
    """Return how much of the tools is in metal."""
    return engagement_at(arguments.engaged, arguments.depth or 0.0)
