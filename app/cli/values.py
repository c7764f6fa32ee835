"""How values of options are read, and what range they have."""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable

from ..core.errors import InputError, ParameterError
from ..drafting.expressions.errors import CommandError
from ..drafting.expressions.numbers import length
from ..model.job import LARGEST_JOIN
from ..model.machine import Machine

MACHINE_HELP = (
    "the machine that the program has to fit and is timed on: router, bench_mill, vmc, one of your own in the "
    "settings' folder machines, or a TOML file (default: timed on a router, held against none)"
)

TOOLS_HELP = (
    ".toml, .csv, LinuxCNC's .tbl, Fusion's .tools or .json, Vectric's .vtdb, FreeCAD's .fctb, .fctl or folder of bits"
)


def number(what: str, *, least: float | None = None, unit: str = "mm") -> Callable[[str], float]:
    """Return a reader of numbers from `least`, or greater than 0 where there is none, to below 1e5, for argparse."""

    def read(text: str) -> float:
        try:
            value = length(text) if unit == "mm" else float(text)
        except CommandError as error:
            raise argparse.ArgumentTypeError(f"is wrong: {error.reason}") from error
        except ValueError as error:
            raise argparse.ArgumentTypeError(f"is wrong: '{text}' is no number; write the {what} in {unit}") from error
        if not math.isfinite(value) or value >= 1e5 or (value <= 0 if least is None else value < least):
            bound = f"greater than 0 {unit}" if least is None else f"{least:g} {unit} or more" if least else "0 or more"
            raise argparse.ArgumentTypeError(
                f"is {value:g} {unit}; the {what} must be {bound} and less than 100000 {unit}"
            )
        return value

    return read


def join_tolerance(text: str) -> float:
    """Return a join tolerance in mm, for argparse."""
    value = number("join tolerance", least=0.0)(text)
    if value > LARGEST_JOIN:
        raise argparse.ArgumentTypeError(f"is wrong: join tolerance is {value:g} mm; use 0 to {LARGEST_JOIN:g} mm")
    return value


def machine_named(name: str) -> Machine:
    """Return a machine by its name or file, for argparse."""
    from ..formats.machine_toml import load_machine

    return load_machine(name)


def typed(read: Callable[[str], object]) -> Callable[[str], object]:
    """Return a reader whose InputError or ParameterError argparse shows."""

    def wrapped(text: str) -> object:
        try:
            return read(text)
        except (InputError, ParameterError) as error:
            raise argparse.ArgumentTypeError(f"is wrong: {error}") from error

    return wrapped
