"""Stage two: a line's words, and the block that they make with the values of this moment."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import dataclass, field
from enum import Enum
from functools import lru_cache
from typing import NamedTuple

from .codes import AXES, GROUP_OF, ROTARY, TAKES, ModalGroup
from .dialect import DialectRules
from .expression import NUMBER, Key, Parameters, Value, ValueReader, evaluated
from .program import BlockFault, ModalState

Setting = Key | Callable[[Parameters], Key]
"""Which parameter is set."""

POLAR = "@^"
"""Distance from the zero, and angle, in LinuxCNC's words."""

_MACRO = 65.0
"""Behind this G word M is an argument, as all letters but G, L, N, O and P are."""

ALWAYS = AXES + ROTARY + POLAR + "fstn"
"""Words that need no code in their block to take them."""

_ALWAYS = frozenset(ALWAYS)

_NUMBERED = re.compile(rf"([a-z])({NUMBER.pattern})")
"""A word as most are: a letter and a number."""


class Word(NamedTuple):
    """A letter and its value.

    Attributes:
        letter: lower case.
        begin, end: where it stands in the line's code.
        whole: written as a number without a decimal point.
    """

    letter: str
    value: Value
    begin: int
    end: int
    whole: bool


class ParameterSetting(NamedTuple):
    """A parameter that a line sets, and to what."""

    key: Setting
    value: Value


@dataclass(frozen=True, slots=True)
class ParsedLine:
    """A line that was understood.

    Attributes:
        settings: parameters that it sets, in order.
        words: the others, in order.
    """

    code: str
    settings: tuple[ParameterSetting, ...]
    words: tuple[Word, ...]


LONGEST_KEPT = 100
"""Characters of a line whose words are worth their room."""

SLASH = re.compile(r"(?:n[0-9.]+)?/[0-9]?")
"""What marks a block that the control leaves out when it is told to."""


class Grammar(Enum):
    """How a line's words are written.

    Attributes:
        NGC: @ and ^ are words. PLAIN: as in NGC without them.
        FREE: what a parameter is set to needs no brackets. MACRO_B: likewise, with operators of its own.
    """

    NGC = "ngc"
    PLAIN = "plain"
    FREE = "free"
    MACRO_B = "macro b"

    @classmethod
    def of(cls, rules: DialectRules) -> Grammar:
        """Return that of a control."""
        if rules.fanuc_flow:
            return cls.MACRO_B if rules.macro_b else cls.FREE
        return cls.NGC if rules.ngc_flow else cls.PLAIN


def parse(code: str, nesting: int, grammar: Grammar, begin: int = 0) -> ParsedLine:
    """Return the words of a line; programs say many lines again and again, so the last ones are kept, but for long
    ones.

    Args:
        code: as `text.code_of` gives it.
        nesting: how deep brackets may go.
        grammar: how its words are written.
        begin: index of the code where its words begin, behind a condition for instance.

    Raises:
        Fault: something in it is no word.
    """
    return (_parsed_once if len(code) <= LONGEST_KEPT else _parsed)(code, nesting, grammar, begin)


def _parsed(code: str, nesting: int, grammar: Grammar, begin: int) -> ParsedLine:
    values = ValueReader(code, nesting, grammar is Grammar.MACRO_B)
    values.at = begin
    free, polar = grammar in (Grammar.FREE, Grammar.MACRO_B), grammar is Grammar.NGC
    slash = SLASH.match(code, begin)
    if slash is not None:
        values.at = slash.end()
    settings: list[ParameterSetting] = []
    words: list[Word] = []
    while values.at < len(code):
        numbered = _NUMBERED.match(code, values.at)
        if numbered is not None:
            words.append(_numbered(numbered, values))
            continue
        letter, at = code[values.at], values.at
        values.at += 1
        if letter == "#":
            key = values.key()
            if code[values.at : values.at + 1] != "=":
                raise BlockFault("expected = behind the parameter that is set.", column=-1 - values.at)
            values.at += 1
            settings.append(ParameterSetting(key, values.expression() if free else values.value()))
        elif "a" <= letter <= "z" or (polar and letter in POLAR):
            values.letter = letter
            words.append(Word(letter, values.value(), at, values.at, whole=False))
            values.letter = ""
        else:
            raise BlockFault(f"{letter!r} begins no word; {_instead(code, at)}.", column=-1 - at, word=letter)
    return ParsedLine(code, tuple(settings), tuple(words))


def _instead(code: str, at: int) -> str:
    """Return what is expected in the place of a letter that begins no word."""
    if code[at] == "," and code[at + 1 : at + 2] in ("c", "r", "a"):
        return "corners by ,C and ,R and angles by ,A are not followed: write them as moves"
    if code[at] == "<":
        return "programs that are called by names are not followed: give them numbers"
    return f"expected {'a decimal point in numbers' if code[at] == ',' else 'a letter with a number'}"


_parsed_once = lru_cache(2048)(_parsed)


def _numbered(found: re.Match[str], values: ValueReader) -> Word:
    """Return a word that is a letter and a number, and go on behind it."""
    values.at, number = found.end(), found[2]
    return Word(found[1], values.finite(float(number)), found.start(), found.end(), "." not in number)


@dataclass(slots=True)
class Block:
    """A line's words with their values of this moment.

    Attributes:
        values: of every letter but G, M and N.
        whole: letters whose number has no decimal point.
        codes: G and M codes by group; coolant may be two. unknown: codes of no group.
    """

    values: dict[str, float] = field(default_factory=dict)
    whole: set[str] = field(default_factory=set)
    codes: dict[ModalGroup, str] = field(default_factory=dict)
    coolant: list[str] = field(default_factory=list)
    unknown: list[str] = field(default_factory=list)

    def copy(self) -> Block:
        """Return the block as it is now: carrying it out takes words away."""
        return Block(dict(self.values), set(self.whole), dict(self.codes), list(self.coolant), list(self.unknown))

    def has(self, letters: str) -> bool:
        """Tell whether any of the letters is there."""
        return not self.values.keys().isdisjoint(letters)

    def get(self, letter: str) -> float | None:
        """Return a word's value, None without the word."""
        return self.values.get(letter)

    def need(self, letter: str, code: str) -> float:
        """Return the value of a word that a code cannot do without.

        Raises:
            Fault: it is not there.
        """
        if letter not in self.values:
            raise BlockFault(f"{code} needs a word {letter.upper()}.", letter=_letter(code))
        return self.values[letter]

    def unused(self) -> str:
        """Return the first letter that no code of the block takes, or ""."""
        if _ALWAYS.issuperset(self.values):
            return ""
        taken = _ALWAYS.union(*(TAKES.get(code, "") for code in [*self.codes.values(), *self.coolant]))
        return next((letter for letter in self.values if letter not in taken), "")


def _letter(code: str) -> str:
    return code[:1].lower()


@lru_cache(1024)
def _code(letter: str, number: float) -> str:
    """Return a code as it is usually written: G1, G5.1."""
    return f"{letter.upper()}{round(number, 2):g}"


def block_of(parsed: ParsedLine, parameters: Parameters) -> Block:
    """Return a line's block, and set the parameters that the line sets: after all its values are known.

    Raises:
        Fault: two words of one letter or two codes of one group; a value that is no number.
    """
    block, numbered = Block(), False
    coded = "g" if any(word.letter == "g" and word.value == _MACRO for word in parsed.words) else "gm"
    for word in parsed.words:
        value = evaluated(word.value, parameters)
        if math.isnan(value):  # of a parameter that is vacant: the control passes over the word
            continue
        if word.letter in coded:
            _add_code(block, _code(word.letter, value), word)
        elif word.letter in block.values:
            raise BlockFault(f"a block takes one word {word.letter.upper()} only.", column=-1 - word.begin)
        elif word.letter == "n":
            if numbered or not parsed.code[word.begin + 1].isdigit():
                raise BlockFault("a block has one number N, and that begins with a digit.", column=-1 - word.begin)
            numbered = True
        else:
            block.values[word.letter] = value
            if word.whole:
                block.whole.add(word.letter)
    settings = [
        (key(parameters) if callable(key) else key, evaluated(value, parameters)) for key, value in parsed.settings
    ]
    for key, value in settings:
        parameters.set(key, value)
    return block


def _add_code(block: Block, code: str, word: Word) -> None:
    group = GROUP_OF.get(code)
    if group is None:
        block.unknown.append(code)
        return
    before = block.codes.get(group)
    if group is ModalGroup.MOTION and before is not None and "G80" in (before, code):
        code, before = (before if code == "G80" else code), None  # any other motion ends a cycle as G80 does
    both = {before, code} == {"M7", "M8"}
    if before is not None and not both and before != "G53" and code != "G53":
        raise BlockFault(
            f"{before} and {code} in one block contradict one another ({group.value}); write them in two.",
            column=-1 - word.begin,
        )
    if group is ModalGroup.COOLANT:
        block.coolant.append(code)
    block.codes[group] = code


# A program block by block, as the control has done each: for who writes the same program in other words.


@dataclass(frozen=True, eq=False)
class BlockStep:
    """A block that was done.

    Attributes:
        line: 1-based. parsed: what stands there.
        block: its words with the values that they had.
        states: what was in force before and behind it.
        motion: the G word that bare axis words obey behind it.
        feed: behind it, mm/min, mm a revolution or 1/min, by the feed mode; NaN = not said.
        rows: the first motion that it made, and the one behind its last.
        requested: parameters whose values the machine tells, and the lines that read them, since the block before.
    """

    line: int
    parsed: ParsedLine
    block: Block
    states: tuple[ModalState, ModalState]
    motion: str
    feed: float
    rows: tuple[int, int]
    requested: tuple[tuple[Key, int], ...] = ()


Watch = Callable[[BlockStep], None]
"""Told of each block when it is done."""
