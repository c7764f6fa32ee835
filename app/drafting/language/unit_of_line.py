"""A line typed in another unit than mm, written so that it means the same wherever it is read."""

from __future__ import annotations

from ..expressions.errors import CommandError
from ..expressions.grammar import read_script
from ..expressions.syntax import Command, Coordinates, Statement, UnitsBlock
from .language import command_word

_NO_LENGTHS = frozenset(
    {
        "select",
        "delete",
        "reverse",
        "explode",
        "layer",
        "hide",
        "show",
        "lock",
        "unlock",
        "colour",
        "rename",
        "remove",
        "measure",
        "undo",
        "redo",
        "clear",
    }
)
"""Commands in which only points are lengths."""


def in_unit(line: str, unit: str) -> str:
    """Return a line, or a block of lines, with `units` about it where it states lengths.

    Args:
        unit: what lengths without a unit are meant in, as `units` names it.
    """
    try:
        statements = read_script(line)
    except CommandError:
        return line
    if all(isinstance(statement, UnitsBlock) or _is_lengthless(statement) for statement in statements):
        return line
    return f"units {unit}\n{line}\nend" if "\n" in line or "#" in line else f"units {unit}; {line}; end"


def _is_lengthless(statement: Statement) -> bool:
    return (
        isinstance(statement, Command)
        and command_word(statement.word.text) in _NO_LENGTHS
        and not any(isinstance(argument, Coordinates) for argument in statement.arguments)
    )
