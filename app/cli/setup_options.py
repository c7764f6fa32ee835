"""What a program is cut out of and by which tools, where it does not tell of them: the options of commands that cut
programs of one's own.
"""

from __future__ import annotations

import argparse

from ..usecases.cutting.ready_setup import SetupRequest
from ..usecases.cutting.setup_tools import ToolSource
from .command import typed
from .cut_options import stock_given, tool_given
from .cut_request import with_stock


def add_setup_options(holder: argparse._ActionsContainer, of_text: str = "") -> None:
    """Add `--stock` and `--tool`.

    Args:
        of_text: what stands before their help, where they belong to a part of what the command does.
    """
    holder.add_argument(
        "--stock",
        metavar="BOX|FILE",
        type=typed(stock_given),
        help=f"{of_text}as for cut: X0,Y0,Z0,X1,Y1,Z1, a solid, or heights that other tools have left",
    )
    holder.add_argument(
        "--tool",
        metavar="NUMBER=KIND:DIAMETER",
        type=typed(tool_given),
        action="append",
        help=f"{of_text}a tool, where the program does not tell of it",
    )


def setup_request(arguments: argparse.Namespace) -> SetupRequest:
    """Return tools and stock as they are told.

    Raises:
        InputError: a file cannot be read.
    """
    return with_stock(SetupRequest((ToolSource("--tool", dict(arguments.tool or ())),)), arguments.stock)
