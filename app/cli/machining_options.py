"""The options of `make` that say how operations are done: sides, entries, leads, tabs, drilling, copies, clamps."""

from __future__ import annotations

import argparse
import re

from ..core.errors import HitofudeError, InputError
from ..drafting.expressions.errors import CommandError
from ..drafting.expressions.numbers import length
from ..model.job import Copies
from ..model.operation_kinds import parameters
from ..usecases.job.machining import MachiningOptions, option_of
from .parameter_options import add_parameter_options, requested_values
from .values import number


def add_machining_options(group: argparse._ArgumentGroup, holding: argparse._ArgumentGroup) -> None:
    """Add the options to two groups: how it is cut, and how the part is held."""
    add_parameter_options(group, ("", "Floor", "Entry", "Walls", "Lead in and out", "Feed and layers"))
    group.add_argument(
        "--drill",
        metavar="D",
        type=number("diameter"),
        action="append",
        default=[],
        help="drill the circles of this diameter first, down to the depth; may be repeated",
    )
    add_parameter_options(holding, ("Tabs",))
    holding.add_argument(
        "--copies",
        metavar="CxR@DX,DY",
        type=_copies,
        help="the part in a grid, such as 3x2@40,30: three along X 40 mm apart, two along Y 30 mm apart",
    )
    holding.add_argument(
        "--keep-out",
        metavar="NAME",
        action="append",
        default=[],
        help="a layer of clamps: no tool comes over its closed outlines below their height; they stay where they are "
        "drawn and are not copied with the part; may be repeated",
    )
    holding.add_argument(
        "--keep-out-height",
        metavar="MM",
        type=number("height", least=0.0),
        help="of the clamps above the stock (default 0)",
    )
    add_note_options(holding)


def add_note_options(group: argparse._ArgumentGroup | argparse.ArgumentParser) -> None:
    """Add the options that write a line of one's own on the sheet."""
    group.add_argument("--clamping", metavar="TEXT", help="how the stock is held, for the sheet")
    group.add_argument("--zero", metavar="TEXT", help="how the zero is set, for the sheet")


def machining(arguments: argparse.Namespace, on_pixels: bool) -> MachiningOptions:
    """Return what was asked for.

    Args:
        on_pixels: paths are made from pixels, which take few of these options.

    Raises:
        InputError: an option does not go with pixels.
    """
    direction = {"direction": arguments.direction} if arguments.direction else {}
    requested = MachiningOptions(
        requested_values(arguments) | direction,
        tuple(arguments.drill),
        arguments.copies,
        tuple(arguments.keep_out),
        arguments.keep_out_height,
        arguments.clamping,
        arguments.zero,
    )
    on_bitmap = {
        "copies",
        "clamping",
        "zero",
        *(option_of(key) for key, (placed, _) in parameters().items() if placed.parameter.on_pixels),
    }
    beyond = [option for option in requested.requested if on_pixels and option not in on_bitmap]
    if beyond:
        raise InputError(
            f"--{beyond[0]} has no effect on pixels, where only pockets and the contours inside the walls are cut; "
            "leave the option away, or compute a drawing exactly, without --bitmap"
        )
    return requested


def _copies(text: str) -> Copies:
    """Return a grid by a text such as 3x2@40,30 or 4x1@1in, for argparse."""
    match = re.fullmatch(r"\s*(\d{1,6})\s*x\s*(\d{1,6})\s*@([^,]+)(?:,([^,]+))?", text, re.IGNORECASE)
    if match is None:
        raise argparse.ArgumentTypeError(
            f"is '{text}'; write columns x rows @ distances, such as 3x2@40,30 (or 3x1@40)"
        )
    columns, rows = int(match[1]), int(match[2])
    try:
        first, second = length(match[3]), length(match[4]) if match[4] else 0.0
        if columns == rows == 1:
            raise argparse.ArgumentTypeError(
                f"is '{text}', which is the part alone; leave the option away, or write more than 1x1"
            )
        dx, dy = (0.0, first) if columns == 1 and match[4] is None else (first, second)
        for count, step, axis, what in ((columns, dx, "X", "column"), (rows, dy, "Y", "row")):
            if count == 1 and step:
                raise argparse.ArgumentTypeError(
                    f"is '{text}', where {step:g} mm along {axis} have no effect on one {what}; "
                    f"write more {what}s, or one distance such as {columns}x{rows}@{dx + dy - step:g}"
                )
        return Copies(columns, rows, dx, dy)
    except CommandError as error:
        raise argparse.ArgumentTypeError(f"is wrong: {error.reason}") from error
    except HitofudeError as error:
        raise argparse.ArgumentTypeError(f"is wrong: {error}") from error
