"""What a text of the shape language is made of, as frozen values: statements, arguments, expressions."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum


@dataclass(frozen=True, slots=True)
class TextSpan:
    """Where something stands in a text; line and column count from 1, `start` and `end` from 0 over the whole text."""

    line: int
    column: int
    start: int
    end: int


@dataclass(frozen=True, slots=True)
class Quantity:
    """A number, with its unit or ""."""

    value: float
    unit: str
    place: TextSpan


@dataclass(frozen=True, slots=True)
class Name:
    """A word: a variable, or a word of a command such as close."""

    text: str
    place: TextSpan


@dataclass(frozen=True, slots=True)
class QuotedText:
    """What stands between double quotes."""

    text: str
    place: TextSpan


@dataclass(frozen=True, slots=True)
class Call:
    """A function of some values."""

    function: Name
    arguments: tuple[Expression, ...]
    place: TextSpan


@dataclass(frozen=True, slots=True)
class Negation:
    """A value with a minus before it."""

    operand: Expression
    place: TextSpan


@dataclass(frozen=True, slots=True)
class OperatorChain:
    """Operands with an operator between each two, of one rank: + -, or * /, or ^ (which binds from the right)."""

    operators: tuple[str, ...]
    operands: tuple[Expression, ...]
    place: TextSpan


@dataclass(frozen=True, slots=True)
class Bracketed:
    """What stands in brackets: one value, or two that are a point; with a unit behind the bracket or ""."""

    items: tuple[Expression, ...]
    unit: str
    place: TextSpan


class CoordinateMode(Enum):
    """What the two numbers of a point mean."""

    XY = "x,y"
    POLAR = "r<angle"
    FROM_LAST = "@dx,dy"
    POLAR_FROM_LAST = "@r<angle"


@dataclass(frozen=True, slots=True)
class Coordinates:
    """A point written as two numbers."""

    frame: CoordinateMode
    first: Expression
    second: Expression
    place: TextSpan


Expression = Quantity | Name | QuotedText | Call | Negation | OperatorChain | Bracketed | Coordinates


@dataclass(frozen=True, slots=True)
class Command:
    """One command with its arguments.

    Attributes:
        label: what the curves are called from here on, or None.
        text: as it was written.
    """

    word: Name
    arguments: tuple[Expression, ...]
    label: Name | None
    text: str
    place: TextSpan


@dataclass(frozen=True, slots=True)
class Assignment:
    """A name for a value."""

    name: Name
    value: Expression
    place: TextSpan


@dataclass(frozen=True, slots=True)
class Repeat:
    """Statements that are carried out several times; `index` counts them from 0."""

    times: Expression
    index: Name | None
    body: tuple[Statement, ...]
    place: TextSpan


@dataclass(frozen=True, slots=True)
class Conditional:
    """Statements of which one list is carried out."""

    left: Expression
    comparison: str
    right: Expression
    body: tuple[Statement, ...]
    other: tuple[Statement, ...]
    place: TextSpan


@dataclass(frozen=True, slots=True)
class UnitsBlock:
    """Statements in which a length without a unit counts in this one."""

    unit: Name
    body: tuple[Statement, ...]
    place: TextSpan


@dataclass(frozen=True, slots=True)
class CommandDefinition:
    """A command of the user's own.

    Attributes:
        source: as it was written.
    """

    name: Name
    parameters: tuple[Name, ...]
    body: tuple[Statement, ...] = field(repr=False)
    place: TextSpan
    source: str = field(repr=False)


Statement = Command | Assignment | Repeat | Conditional | UnitsBlock | CommandDefinition
