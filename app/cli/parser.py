"""What the options of all commands share: how a value is read, what range it has, and errors of one line."""

from __future__ import annotations

import argparse
import math
import re
import textwrap
from collections.abc import Callable, Sequence
from typing import NoReturn

from ..core.errors import InputError
from ..core.memory import read_size
from ..drafting.expressions.errors import CommandError
from ..drafting.expressions.numbers import length
from ..model.job import LARGEST_JOIN
from ..model.machine import Machine

MACHINE_HELP = (
    "the machine that the program has to fit and is timed on: router, bench_mill, vmc, one of your own in the "
    "settings' folder machines, or a TOML file (default: timed on a router, held against none)"
)

MEMORY_HELP = (
    "memory that the job may take beside the program itself, such as 4G or 512M: what would not fit is done in parts, "
    "or refused before it is begun (default half of the machine's)"
)

PHRASES = (
    (r"^argument ([^:]*/)?([^:]*): ", r"\2 "),
    (r" expected one argument$", " has no value; write one behind it"),
    (r" not allowed with argument (\S+)$", r" and \1 exclude one another; give one of them"),
    (r" invalid choice: ('.*') \(choose from (.*)\)$", r" is \1; choose one of \2"),
    (r"^the following arguments are required: (.*)$", r"\1 is missing; name {inputs}"),
    (r"^unrecognized arguments: (.*)$", r"\1 is no option of {name} and no second {input} can be named; take it away"),
)
"""What argparse says, and how it is said here."""


class OptionParser(argparse.ArgumentParser):
    """An argument parser whose errors are InputErrors of one line."""

    def __init__(self, name: str, inputs: tuple[str, str], description: str, epilog: str) -> None:
        """Make the parser of a command.

        Args:
            name: of the command. inputs: what it reads, and what it cannot do without, in words.
            description, epilog: above and below the list of options.
        """
        super().__init__(
            prog=f"hitofude {name}",
            allow_abbrev=False,
            description=description,
            epilog=epilog,
            formatter_class=HelpFormatter,
        )
        self._words = {"name": name, "input": inputs[0], "inputs": inputs[1]}
        self.add_argument("--memory", metavar="SIZE", type=typed(read_size), help=MEMORY_HELP)

    def error(self, message: str) -> NoReturn:
        """Raise the error instead of printing the usage."""
        for said, better in PHRASES:
            message = re.sub(said, better.format(**self._words), message)
        raise InputError(f"{message.rstrip('.')}; see {self.prog} --help")


class HelpFormatter(argparse.RawDescriptionHelpFormatter):
    """Keeps words such as lower-left whole."""

    def _split_lines(self, text: str, width: int) -> list[str]:
        return textwrap.wrap(" ".join(text.split()), width, break_on_hyphens=False)


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
    """Return a reader whose InputError argparse shows."""

    def wrapped(text: str) -> object:
        try:
            return read(text)
        except InputError as error:
            raise argparse.ArgumentTypeError(f"is wrong: {error}") from error

    return wrapped


def with_equals(argv: Sequence[str]) -> list[str]:
    """Write `--safe-z -1mm` as `--safe-z=-1mm`, so that a negative value is read as a value."""
    joined: list[str] = []
    for argument in argv:
        if re.match(r"-[\d.]", argument) and joined and re.fullmatch(r"--[a-z-]+", joined[-1]):
            joined[-1] += f"={argument}"
        else:
            joined.append(argument)
    return joined
