"""Options for the parameters of operations, made from their declarations: name, help, how a value is read, range."""

from __future__ import annotations

import argparse
import math
import re
from collections.abc import Callable
from typing import Any

from ..core.catalogue import LANGUAGES
from ..core.errors import HitofudeError, InputError
from ..drafting.expressions.errors import CommandError
from ..drafting.expressions.numbers import angle, length
from ..model.curve_selectors import HELP, Selector, read_selector
from ..model.fields import Parameter, ParameterPlace, Unit
from ..model.job import Copies
from ..model.operation_kinds import parameters
from ..usecases.job.machining import MachiningOptions, option_of
from .command import number

_METAVARS = {Unit.LENGTH: "MM", Unit.ANGLE: "DEG", Unit.SHARE: "SHARE|%", Unit.COUNT: "N", Unit.TIME: "S"}

_MANY = 12
"""Choices; more are not listed in the line of usage."""


def add_parameter_options(group: argparse._ArgumentGroup, groups: tuple[str, ...]) -> None:
    """Add an option for every parameter that has one and stands in one of the groups of forms."""
    for key, (placed, _) in parameters().items():
        if placed.parameter.option and placed.parameter.group in groups:
            _add(group, key, placed)


def _add(group: argparse._ArgumentGroup, key: str, placed: ParameterPlace) -> None:
    declared, option = placed.parameter, f"--{placed.parameter.option}"
    if declared.unit is Unit.FLAG:
        group.add_argument(option, dest=key, action="store_true", default=None, help=declared.help.replace("%", "%%"))
    elif declared.unit is Unit.CURVES:
        group.add_argument(
            option,
            dest=key,
            metavar="WHICH",
            type=_selector,
            action="append",
            help=f"{declared.help}: {HELP.replace('%', '%%')}; may be repeated",
        )
    elif placed.enum is not None:
        group.add_argument(
            option,
            dest=key,
            choices=[each.value for each in placed.enum],
            metavar=key.upper() if len(placed.enum) > _MANY else None,
            help=f"{declared.help} (default {placed.default.value})",
        )
    else:
        group.add_argument(
            option, dest=key, metavar=_METAVARS[declared.unit], type=reader_of(declared), help=_help(placed)
        )


def _help(placed: ParameterPlace) -> str:
    declared = placed.parameter
    usual = (
        declared.auto
        if placed.default is None
        else f"{declared.shown(placed.default):g}{'%' * (declared.unit is Unit.SHARE)}"
    )
    bounds = declared.range_words() if declared.high < 1000 else f"{declared.low:g} mm or more" if declared.low else ""
    return ", ".join(filter(None, (declared.help, bounds))).replace("%", "%%") + f" (default {usual})".replace(
        "%", "%%"
    )


def requested_values(arguments: argparse.Namespace) -> dict[str, Any]:
    """Return the values of parameters that were asked for, by key."""
    given = {
        key: (placed, getattr(arguments, key, None))
        for key, (placed, _) in parameters().items()
        if placed.parameter.option
    }
    return {
        key: placed.enum(value) if placed.enum is not None else tuple(value) if isinstance(value, list) else value
        for key, (placed, value) in given.items()
        if value is not None
    }


def reader_of(declared: Parameter) -> Callable[[str], Any]:
    """Return what reads a parameter's value from a text, for argparse."""

    def read(text: str) -> Any:
        value = _READERS[declared.unit](text, declared)
        try:
            declared.check(value)
        except HitofudeError as error:
            raise argparse.ArgumentTypeError(
                f"is {declared.shown(value):g}{declared.sign}; the {declared.label.lower()} must be "
                f"{declared.range_words()}"
            ) from error
        return value

    return read


def _selector(text: str) -> Selector:
    try:
        return read_selector(text)
    except HitofudeError as error:
        raise argparse.ArgumentTypeError(f"is wrong: {error}") from error


def _length(text: str, declared: Parameter) -> float:
    try:
        return length(text)
    except CommandError as error:
        raise argparse.ArgumentTypeError(f"is wrong: {error.reason}") from error


def _angle(text: str, declared: Parameter) -> float:
    try:
        return math.radians(angle(text))
    except CommandError as error:
        raise argparse.ArgumentTypeError(f"is wrong: {error.reason}") from error


def _share(text: str, declared: Parameter) -> float:
    match = re.fullmatch(r"\s*(\d{1,3}(?:\.\d{0,9})?|\.\d{1,9})\s*(%?)\s*", text)
    value = float(match[1]) / (100 if match[2] else 1) if match else math.nan
    if not declared.low <= value <= declared.high:
        raise argparse.ArgumentTypeError(
            f"is '{text}'; write a share of the diameter from {100 * declared.low:g}% to "
            f"{100 * declared.high:g}%, such as 40% or 0.4"
        )
    return value


def _count(text: str, declared: Parameter) -> int:
    if not re.fullmatch(r"\s*\d{1,9}\s*", text) or not declared.low <= int(text) <= declared.high:
        raise argparse.ArgumentTypeError(
            f"is '{text}'; the {declared.label.lower()} must be a whole number from {declared.low:g} to "
            f"{declared.high:g}"
        )
    return int(text)


def _seconds(text: str, declared: Parameter) -> float:
    if not re.fullmatch(r"\s*\d{1,9}(\.\d{0,9})?\s*", text):
        raise argparse.ArgumentTypeError(f"is '{text}'; write seconds, such as 0.5")
    return float(text)


_READERS: dict[Unit, Callable[[str, Parameter], Any]] = {
    Unit.LENGTH: _length,
    Unit.ANGLE: _angle,
    Unit.SHARE: _share,
    Unit.COUNT: _count,
    Unit.TIME: _seconds,
}


def _drill(text: str) -> float:
    """Return the diameter of a drill, mm, for argparse."""
    kind, _, diameter = text.partition(":")
    if kind == "circles":
        raise argparse.ArgumentTypeError(
            f"is wrong: it takes the diameter of the drill alone, such as {diameter}, and drills the circles that are "
            f'as wide; a drill of another width is an operation of a job file, with curves = ["{text}"]'
        )
    return number("diameter")(text)


# The options of `make` that say how operations are done: sides, entries, leads, tabs, drilling, copies, clamps.


def add_machining_options(group: argparse._ArgumentGroup, holding: argparse._ArgumentGroup) -> None:
    """Add the options to two groups: how it is cut, and how the part is held."""
    add_parameter_options(group, ("", "Floor", "Entry", "Walls", "Lead in and out", "Feed and layers"))
    group.add_argument(
        "--drill",
        metavar="D",
        type=_drill,
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
    group.add_argument(
        "--language",
        choices=LANGUAGES,
        default=LANGUAGES[0],
        help="of the sheet: English (en, the default) or Japanese (ja)",
    )


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
