"""A command of the program: what it reads, its options, its work; and the parser that they have in common."""

from __future__ import annotations

import argparse
import itertools
import math
import re
import textwrap
from collections.abc import Callable, Sequence
from dataclasses import KW_ONLY, dataclass
from pathlib import Path
from typing import Any, NoReturn

from ..core.errors import InputError, ParameterError
from ..core.memory import read_size
from ..drafting.expressions.errors import CommandError
from ..drafting.expressions.numbers import length
from ..model.job import LARGEST_JOIN
from ..model.machine import Machine
from .signals import StopFlag

MEMORY_HELP = (
    "memory that the job may take beside the program itself, such as 4G or 512M: what would not fit is done in parts, "
    "or refused before it is begun (default half of the machine's)"
)


@dataclass(frozen=True)
class CliCommand:
    """A command.

    Attributes:
        name: what is typed.
        reads: what it reads one of, in words; "" = it may be given any number, or none.
        needs: what it cannot do without, in words; "" = it can do without all.
        about, epilog: above and below the list of its options.
        add_options: adds them to a parser.
        run: does the work of arguments that are read and in their ranges and returns the exit status; it raises
            HitofudeError, and Cancelled by Ctrl+C, and then has written nothing.
        intermixed: whether files may stand between options.
        check: refuses arguments that do not go with one another.
        examples: as they are typed, the plainest first.
    """

    name: str
    _: KW_ONLY
    reads: str = ""
    needs: str = ""
    about: str
    epilog: str
    add_options: Callable[[OptionParser], None]
    run: Callable[[argparse.Namespace, StopFlag], int]
    intermixed: bool = False
    check: Callable[[argparse.Namespace], None] = lambda arguments: None
    examples: tuple[str, ...] = ()

    @property
    def below(self) -> str:
        """What stands below the list of its options."""
        return "\n".join((self.epilog.rstrip(), "", "Examples:", *(f"  {example}" for example in self.examples)))

    def parser(self) -> OptionParser:
        """Return what reads the words behind its name, and says its help."""
        return OptionParser(prog=f"hitofude {self.name}", load=lambda: self)

    def arguments(self, argv: Sequence[str]) -> argparse.Namespace:
        """Return the arguments behind the command, each value read and in its range.

        Raises:
            InputError: one line that names the option, its value and what it must be.
        """
        return self.parser().parse_args(argv)


class OptionParser(argparse.ArgumentParser):
    """The parser of a command, whose options are loaded when they are asked for, and whose errors are InputErrors of
    one line.
    """

    def __init__(self, *, load: Callable[[], CliCommand], **more: Any) -> None:
        """Make the parser of a command.

        Args:
            load: returns the command. more: as argparse takes it.
        """
        super().__init__(allow_abbrev=False, formatter_class=HelpFormatter, exit_on_error=False, **more)
        self._load, self._nested = load, False
        self._command: CliCommand | None = None

    @property
    def command(self) -> CliCommand:
        """The command, its options added."""
        if self._command is None:
            command = self._command = self._load()
            self.description, self.epilog = command.about, command.below
            self.add_argument("--memory", metavar="SIZE", type=typed(read_size), help=MEMORY_HELP)
            command.add_options(self)
        return self._command

    def format_help(self) -> str:
        """Return the help, with all options."""
        assert self.command
        return super().format_help()

    def parse_known_args(  # type: ignore[override]  # argparse's own overloads say the same
        self, args: Sequence[str] | None = None, namespace: argparse.Namespace | None = None
    ) -> tuple[argparse.Namespace, list[str]]:
        """Return the arguments; none is left unknown.

        Raises:
            InputError: one is unknown, missing or wrong.
        """
        given = argparse.Namespace() if namespace is None else namespace
        if self._nested:
            return super().parse_known_args(args, given)
        command, argv = self.command, with_equals(args or ())
        parse = self.parse_known_intermixed_args if command.intermixed else super().parse_known_args
        self._nested = True
        try:
            found, unknown = parse(argv, given)
        except argparse.ArgumentError as error:
            raise self._input_error(self._words(error, argv)) from error
        except _MissingError as error:
            missing = self._missing(given)
            verb = "is" if len(missing) == 1 else "are"
            raise self._input_error(f"{', '.join(missing)} {verb} missing; name {command.needs}") from error
        finally:
            self._nested = False
        if unknown:
            second = f" and no second {command.reads} can be named" if command.reads else ""
            raise self._input_error(f"{' '.join(unknown)} is no option of {command.name}{second}; take it away")
        command.check(found)
        found.run = command.run
        return found, []

    def error(self, message: str) -> NoReturn:
        """Raise what argparse would print: it says so only that a required argument is missing."""
        raise _MissingError(message)

    def _missing(self, given: argparse.Namespace) -> list[str]:
        """Return the names of what has to be given and is not: options, and sets of which one has to be."""
        alone = [_name(each) for each in self._actions if each.required and not getattr(given, each.dest, None)]
        sets = (group._group_actions for group in self._mutually_exclusive_groups if group.required)
        return alone + [
            " or ".join(map(_name, each)) for each in sets if not any(getattr(given, one.dest, None) for one in each)
        ]

    def _input_error(self, text: str) -> InputError:
        return InputError(f"{text.rstrip('.')}; see {self.prog} --help")

    def _words(self, error: argparse.ArgumentError, argv: Sequence[str]) -> str:
        """Return what is wrong with an argument: two that exclude one another are no fault of its value."""
        name = (error.argument_name or "").split("/")[-1]
        rival = None if isinstance(error, _ValueError) else self._rival(name, argv)
        if rival is not None and error.__context__ is None:
            return f"{name} and {rival} exclude one another; give one of them"
        return f"{name} {error.message}"

    def _rival(self, name: str, argv: Sequence[str]) -> str | None:
        """Return the option beside one of a name that excludes it."""
        typed_names = {argument.partition("=")[0] for argument in argv}
        for group in self._mutually_exclusive_groups:
            strings = [each.option_strings for each in group._group_actions]
            if any(name in each for each in strings):
                return next(("/".join(each) for each in strings if name not in each and typed_names & {*each}), None)
        return None

    def _get_value(self, action: argparse.Action, arg_string: str) -> Any:
        if action.type is Path and arg_string == "-":
            raise _ValueError(
                action, "is '-', and no pipe is read or written; name a file, or ./- for one of that name"
            )
        return super()._get_value(action, arg_string)

    def _check_value(self, action: argparse.Action, value: Any) -> None:
        if action.choices is not None and value not in action.choices:
            raise _ValueError(action, f"is {value!r}; choose one of {', '.join(map(repr, action.choices))}")

    def _match_argument(self, action: argparse.Action, arg_strings_pattern: str) -> int:
        try:
            count: int = super()._match_argument(action, arg_strings_pattern)
            return count
        except argparse.ArgumentError as error:
            if action.nargs is not None:
                raise
            raise _ValueError(action, "has no value; write one behind it") from error


class _MissingError(Exception):
    """A required argument is missing."""


class _ValueError(argparse.ArgumentError):
    """A value is missing, or none of those that there are."""


class HelpFormatter(argparse.RawDescriptionHelpFormatter):
    """Keeps words such as lower-left whole, and lines that are set in as they are; all else is as wide as a screen."""

    def _fill_text(self, text: str, width: int, indent: str) -> str:
        blocks = itertools.groupby(text.splitlines(), lambda line: line[:1] in ("", " "))
        filled = (
            "\n".join(lines) if kept else "\n".join(self._split_lines(" ".join(lines), width)) for kept, lines in blocks
        )
        return textwrap.indent("\n".join(filled), indent)

    def _split_lines(self, text: str, width: int) -> list[str]:
        return textwrap.wrap(" ".join(text.split()), width, break_on_hyphens=False)


def _name(action: argparse.Action) -> str:
    """Return what an argument is called."""
    return "/".join(action.option_strings) or str(action.metavar or action.dest)


def with_equals(argv: Sequence[str]) -> list[str]:
    """Write `--safe-z -1mm` as `--safe-z=-1mm`, so that a negative value is read as a value."""
    joined: list[str] = []
    for argument in argv:
        if re.match(r"-[\d.]", argument) and joined and re.fullmatch(r"--[a-z-]+", joined[-1]):
            joined[-1] += f"={argument}"
        else:
            joined.append(argument)
    return joined


# How values of options are read, and what range they have.


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
            kind = text.partition(":")[0].isalpha() and ":" in text
            reason = "its kind is not asked for here" if kind else error.reason.partition(";")[0]
            raise argparse.ArgumentTypeError(
                f"is wrong: '{text}' is no {what} ({reason}); write a length in mm, such as 6, or 1/4in"
            ) from error
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
