"""The grammar of the shape language, and reading a text by it.

A blank outside brackets ends an argument, so `10,10 -5,3` is two points and `(w + 2)` one number; `;` ends a statement
as a line does, a backslash at the end of a line takes the next one along, `#` begins a remark.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache
from typing import Any, ClassVar

from lark import Lark, Token, Transformer, v_args
from lark.exceptions import UnexpectedCharacters, UnexpectedInput, UnexpectedToken, VisitError

from . import syntax as s
from .errors import CommandError
from .units import ALL_UNITS, LENGTH_UNITS

_GRAMMAR = r"""
script: block
block: (_END_OF_LINE | statement _END_OF_LINE)*
?statement: let | repeat | choose | units | define | command

let: LET NAME "=" value
repeat: REPEAT sum (_AS NAME)? _END_OF_LINE block _END
choose: IF sum comparison sum _END_OF_LINE block otherwise* (_ELSE _END_OF_LINE block)? _END
otherwise: _ELSE IF sum comparison sum _END_OF_LINE block
!comparison: "<" | ">" | "<=" | ">=" | "==" | "!="
units: UNITS (UNIT | NAME) _END_OF_LINE block _END
define: DEFINE NAME "(" (NAME ("," NAME)*)? ")" _END_OF_LINE block _END
command: NAME (_BLANK (text | value))* (_BLANK label)?
label: _AS _BLANK NAME
text: TEXT

?value: sum
      | sum "," sum      -> xy
      | sum "<" sum      -> polar
      | "@" sum "," sum  -> from_last
      | "@" sum "<" sum  -> polar_from_last
?sum: product | product ((PLUS | MINUS) product)+      -> chain
?product: factor | factor ((TIMES | OVER) factor)+      -> chain
?factor: MINUS factor                                   -> negative
       | PLUS factor                                    -> positive
       | atom
       | atom POWER factor                              -> chain
?atom: NUMBER UNIT?                    -> quantity
     | NAME                            -> name
     | NAME "(" (sum ("," sum)*)? ")"  -> call
     | "(" sum ("," sum)? ")" UNIT?    -> group

PLUS: "+"
MINUS: "-"
TIMES: "*"
OVER: "/"
POWER: "^"
LET: "let"
REPEAT: "repeat"
IF: "if"
DEFINE: "define"
UNITS: "units"
_ELSE: "else"
_END: "end"
_AS: "as"
NUMBER: /(\d+\.?\d*|\.\d+)([eE][+-]?\d+(?!\w))?/
UNIT.2: /(EVERY)(?!\w)|["°]/
NAME: /[^\W\d]\w*/
TEXT: /"[^"\n]*"/
_BLANK: /([ \t\u00a0]|\\\r?\n)+(?![ \t\u00a0\r\n;#\\])/
_END_OF_LINE: /\r?\n|;/
_REMARK: /[ \t\u00a0]*#[^\n]*/
_TRAILING: /[ \t\u00a0]+(?=\r?\n|;)/
%ignore _REMARK
%ignore _TRAILING
"""

_DEEPEST = 40
"""Brackets, signs or blocks within one another: each is a call within a call."""
_MOST_TERMS = 1000
"""Of one expression."""
_OPERATORS = frozenset({"PLUS", "MINUS", "TIMES", "OVER"})
_LONGEST = 20_000_000
"""Letters of a text."""
_LOOSE = frozenset({"LET", "REPEAT", "IF", "DEFINE", "UNITS", "_ELSE"})
_OPENING = frozenset({"REPEAT", "IF", "DEFINE", "UNITS"})
_VALUE_ENDS = frozenset({"NUMBER", "UNIT", "NAME", "RPAR", "TEXT"})
_VALUE_BEFORE = "let x="


class _Blanks:
    """Drops the blanks that count for nothing: in brackets, in statements that are no commands, and at the ends of a
    line.

    On the way it refuses what is nested too deeply to be meant.
    """

    always_accept: ClassVar[tuple[str, ...]] = ("_BLANK",)

    def process(self, stream: Iterator[Token]) -> Iterator[Token]:
        """Yield the tokens that the grammar sees."""
        brackets = signs = blocks = terms = 0
        loose, before = False, "_END_OF_LINE"
        for token in stream:
            kind = token.type
            if kind == "_BLANK" and (before == "_END_OF_LINE" or loose or brackets):
                continue
            brackets = 0 if kind == "_END_OF_LINE" else brackets + (kind == "LPAR") - (kind == "RPAR")
            if kind in ("_END_OF_LINE", "_BLANK", "COMMA"):
                signs = 0
            terms = 0 if kind in ("_END_OF_LINE", "_BLANK", "COMMA") else terms + (kind in _OPERATORS)
            if terms > _MOST_TERMS:
                raise _error(f"The expression has more than {_MOST_TERMS} terms; name parts of it with let.", token)
            signs += kind == "POWER" or (kind in ("MINUS", "PLUS") and before not in _VALUE_ENDS)
            blocks += (kind in _OPENING and before != "_ELSE") - (kind == "_END")
            if before == "_END_OF_LINE":
                loose = kind in _LOOSE
            if max(brackets, signs, blocks) > _DEEPEST:
                raise _error("Too many brackets, signs or blocks within one another; write it more simply.", token)
            before = kind
            yield token


@cache
def _parser() -> Lark:
    units = "|".join(sorted((u for u in ALL_UNITS if u.isalpha()), key=len, reverse=True))
    return Lark(
        _GRAMMAR.replace("EVERY", units), start="script", parser="lalr", postlex=_Blanks(), propagate_positions=True
    )


def read_script(text: str) -> tuple[s.Statement, ...]:
    """Return the statements of a text.

    Raises:
        CommandError: with the line and column of the first thing that is wrong, and what was expected.
    """
    return _read(text.removeprefix("\ufeff"))


def read_value(text: str) -> s.Expression:
    """Return the one number or point that a text is; blanks count for nothing in it.

    Raises:
        CommandError: with the column of the first thing that is wrong, and what was expected.
    """
    stray = next((at for at, letter in enumerate(text) if letter in ";\n\r#\\"), None)
    if stray is not None:
        raise CommandError(
            f"'{text[stray]}' is no part of a number; write a number such as 12.5 or 1in+8mm.", stray + 1
        )
    (statement,) = _read(_VALUE_BEFORE + text, len(_VALUE_BEFORE))
    assert isinstance(statement, s.Assignment)
    return statement.value


def _read(text: str, before: int = 0) -> tuple[s.Statement, ...]:
    """Read a text whose first `before` columns are not the user's."""
    if len(text) > _LONGEST:
        raise CommandError(f"The text has {len(text)} letters; at most {_LONGEST} are read.")
    source = text + "\n"
    try:
        tree = _parser().parse(source)
        statements: tuple[s.Statement, ...] = _Builder(source, before).transform(tree)
    except UnexpectedInput as wrong:
        raise _shifted(_explained(wrong, source), before) from None
    except CommandError as wrong:
        raise _shifted(wrong, before) from None
    except VisitError as wrong:
        raise wrong.orig_exc from None
    return statements


def _shifted(wrong: CommandError, before: int) -> CommandError:
    return CommandError(wrong.reason, wrong.column - before if wrong.line == 1 else wrong.column, wrong.line)


@dataclass(frozen=True, slots=True)
class _Label:
    name: s.Name


def _error(reason: str, token: Token) -> CommandError:
    return CommandError(reason, token.column or 1, token.line or 1)


@v_args(meta=True)
class _Builder(Transformer[Token, Any]):
    """Makes the values of `syntax` from the grammar's tree; every rule has a method of its name."""

    def __init__(self, source: str, before: int) -> None:
        super().__init__()
        self._source, self._before = source, before

    def _place(self, at: Any) -> s.TextSpan:
        """Return where a token or a rule stands."""
        return s.TextSpan(at.line, at.column - (self._before if at.line == 1 else 0), at.start_pos, at.end_pos)

    def _named(self, token: Token) -> s.Name:
        return s.Name(str(token), self._place(token))

    def script(self, meta: Any, parts: list[Any]) -> Any:
        return parts[0]

    def block(self, meta: Any, parts: list[Any]) -> tuple[s.Statement, ...]:
        return tuple(parts)

    def let(self, meta: Any, parts: list[Any]) -> s.Assignment:
        return s.Assignment(self._named(parts[1]), parts[2], self._place(meta))

    def repeat(self, meta: Any, parts: list[Any]) -> s.Repeat:
        index = self._named(parts[2]) if len(parts) == 4 else None
        return s.Repeat(parts[1], index, parts[-1], self._place(meta))

    def choose(self, meta: Any, parts: list[Any]) -> s.Conditional:
        *others, last = parts[5:] if len(parts) > 5 and isinstance(parts[-1], tuple) else (*parts[5:], ())
        for other in reversed(others):
            last = (replace(other, other=last),)
        return s.Conditional(parts[1], parts[2], parts[3], parts[4], last, self._place(meta))

    def otherwise(self, meta: Any, parts: list[Any]) -> s.Conditional:
        return s.Conditional(parts[1], parts[2], parts[3], parts[4], (), self._place(meta))

    def units(self, meta: Any, parts: list[Any]) -> s.UnitsBlock:
        unit = self._named(parts[1])
        if unit.text not in LENGTH_UNITS:
            raise _error(f"'{unit.text}' is no unit of length; use one of {', '.join(LENGTH_UNITS)}.", parts[1])
        return s.UnitsBlock(unit, parts[2], self._place(meta))

    def comparison(self, meta: Any, parts: list[Any]) -> str:
        return str(parts[0])

    def define(self, meta: Any, parts: list[Any]) -> s.CommandDefinition:
        place = self._place(meta)
        source = self._source[place.start : place.end]
        return s.CommandDefinition(
            self._named(parts[1]), tuple(map(self._named, parts[2:-1])), parts[-1], place, source
        )

    def command(self, meta: Any, parts: list[Any]) -> s.Command:
        named = len(parts) > 2 and isinstance(parts[-1], _Label)
        place = self._place(meta)
        text = self._source[place.start : place.end]
        label = parts[-1].name if named else None
        return s.Command(self._named(parts[0]), tuple(parts[1:-1] if named else parts[1:]), label, text, place)

    def label(self, meta: Any, parts: list[Any]) -> _Label:
        return _Label(self._named(parts[0]))

    def text(self, meta: Any, parts: list[Any]) -> s.QuotedText:
        return s.QuotedText(str(parts[0])[1:-1], self._place(meta))

    def xy(self, meta: Any, parts: list[Any]) -> s.Coordinates:
        return s.Coordinates(s.CoordinateMode.XY, parts[0], parts[1], self._place(meta))

    def polar(self, meta: Any, parts: list[Any]) -> s.Coordinates:
        return s.Coordinates(s.CoordinateMode.POLAR, parts[0], parts[1], self._place(meta))

    def from_last(self, meta: Any, parts: list[Any]) -> s.Coordinates:
        return s.Coordinates(s.CoordinateMode.FROM_LAST, parts[0], parts[1], self._place(meta))

    def polar_from_last(self, meta: Any, parts: list[Any]) -> s.Coordinates:
        return s.Coordinates(s.CoordinateMode.POLAR_FROM_LAST, parts[0], parts[1], self._place(meta))

    def chain(self, meta: Any, parts: list[Any]) -> s.OperatorChain:
        return s.OperatorChain(tuple(map(str, parts[1::2])), tuple(parts[::2]), self._place(meta))

    def negative(self, meta: Any, parts: list[Any]) -> s.Negation:
        return s.Negation(parts[1], self._place(meta))

    def positive(self, meta: Any, parts: list[Any]) -> Any:
        return parts[1]

    def quantity(self, meta: Any, parts: list[Any]) -> s.Quantity:
        return s.Quantity(float(parts[0]), str(parts[1]) if len(parts) > 1 else "", self._place(meta))

    def name(self, meta: Any, parts: list[Any]) -> s.Name:
        return self._named(parts[0])

    def call(self, meta: Any, parts: list[Any]) -> s.Call:
        return s.Call(self._named(parts[0]), tuple(parts[1:]), self._place(meta))

    def group(self, meta: Any, parts: list[Any]) -> s.Bracketed:
        unit = str(parts[-1]) if isinstance(parts[-1], Token) else ""
        return s.Bracketed(tuple(p for p in parts if not isinstance(p, Token)), unit, self._place(meta))


_EXPECTED = (
    ("NUMBER", "a number, a point or a name"),
    ("NAME", "a name"),
    ("EQUAL", "'='"),
    ("LPAR", "'('"),
    ("RPAR", "')'"),
    ("_END", "end"),
)


def _explained(wrong: UnexpectedInput, source: str) -> CommandError:
    """Return what a person can do about the first thing that is wrong."""
    expected = set(getattr(wrong, "expected", None) or getattr(wrong, "allowed", None) or ())
    if isinstance(wrong, UnexpectedToken):
        token = wrong.token
        line, column, found, ends = (
            token.line or 1,
            token.column or 1,
            str(token),
            token.type in ("_END_OF_LINE", "$END"),
        )
        if token.type == "$END":
            example = "repeat 3 as k; circle 10*k,0 2; end"
            return CommandError(
                f"The text ends within a block; add end, or write it in one line: {example}.", column, line
            )
    else:
        assert isinstance(wrong, UnexpectedCharacters)
        line, column, found, ends = wrong.line, wrong.column, source[wrong.pos_in_stream or 0], False
    before = source.split("\n")[line - 1][: column - 1]
    if before.count("(") <= before.count(")"):
        expected.discard("RPAR")  # the parser's tables look no farther than one word
    requested = next((words for name, words in _EXPECTED if name in expected), "the end of the line")
    if ends and "RPAR" in expected:
        return CommandError("A closing bracket is missing; add ')'.", column, line)
    if ends:
        missing = requested if any(name in expected for name, _ in _EXPECTED) else "a name"
        return CommandError(f"The line ends too early; {missing} is expected.", column, line)
    if "UNIT" in expected and found[0].isalpha():
        word = _word_at(source, wrong.pos_in_stream or 0)
        return CommandError(f"'{word}' is no unit; use one of {', '.join(ALL_UNITS)}.", column, line)
    return CommandError(f"'{found}' is not expected here; {requested} is.", column, line)


def _word_at(source: str, at: int) -> str:
    end = at
    while end < len(source) and source[end].isalpha():
        end += 1
    return source[at:end]
