"""Subprograms that a text holds and nothing calls: they are no part of what the program does."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from ..interpreter.block import BlockStep
from ..interpreter.dialect import DIALECT_RULES
from ..interpreter.text import code_of
from .translatable import TranslationSource

NUMBER = re.compile(r"(?:/|n[0-9.]+)*[o:]([0-9]+)$")
"""The number of a program or of a subprogram, alone in its line."""
_SUB = re.compile(r"(?:/|n[0-9.]+)*(o(?:[0-9]+|<[^>]*>))(sub|endsub)")
_NAMED = 5
"""So many subprograms are named; of more their count is told."""


@dataclass(frozen=True, slots=True)
class Subprogram:
    """A stretch of a text that a call would run.

    Attributes:
        name: as it is called: "O7", "o<corner>". lines: 1-based.
    """

    name: str
    lines: range


def uncalled(source: TranslationSource, steps: tuple[BlockStep, ...]) -> tuple[Subprogram, ...]:
    """Return the subprograms of which no line is done.

    Args:
        source: the text. steps: every block that is done.
    """
    rules = DIALECT_RULES[source.dialect]
    if not rules.fanuc_flow and not rules.ngc_flow:
        return ()
    done = {step.line for step in steps}
    heads = [(line, code(text)) for line, text in enumerate(source.lines, 1) if "o" in text.lower() or ":" in text]
    found = [*_numbered(source, heads), *(_named(heads) if rules.ngc_flow else ())]
    return tuple(each for each in found if done.isdisjoint(each.lines))


def _numbered(source: TranslationSource, heads: list[tuple[int, str]]) -> Iterator[Subprogram]:
    """Yield what stands between one number and the next, or the end; a number alone is a program's name."""
    numbers = [(line, match[1]) for line, text in heads if (match := NUMBER.match(text))]
    for k, (line, number) in enumerate(numbers):
        stop = numbers[k + 1][0] if k + 1 < len(numbers) else _end(source, line)
        inside = [code(text) for text in source.lines[line : stop - 1]]
        if any(each and not each.startswith("%") for each in inside):
            yield Subprogram(f"O{number}", range(line, stop))


def _end(source: TranslationSource, line: int) -> int:
    """Return the line behind the last M99 that follows a line, or behind the text."""
    last = [k for k in range(line, len(source.lines)) if "m99" in source.lines[k].lower().replace(" ", "")]
    return last[-1] + 2 if last else len(source.lines) + 1


def _named(heads: list[tuple[int, str]]) -> Iterator[Subprogram]:
    """Yield what stands between O… sub and its endsub."""
    begun: dict[str, int] = {}
    for line, text in heads:
        match = _SUB.match(text)
        if match and match[2] == "sub":
            begun[match[1]] = line
        elif match and match[1] in begun:
            yield Subprogram(match[1], range(begun.pop(match[1]), line + 1))


def uncalled_remarks(never: tuple[Subprogram, ...]) -> list[str]:
    """Return what to say of subprograms that nothing calls, as no or one sentence without its end."""
    if not never:
        return []
    names = [each.name for each in never]
    if len(names) == 1:
        return [f"{names[0]} is not called, so it is not written"]
    shown = f"{len(names)} subprograms" if len(names) > _NAMED else f"{', '.join(names[:-1])} and {names[-1]}"
    return [f"{shown} are not called, so they are not written"]


def code(line: str) -> str:
    """Return what a control obeys of a line; of one whose comment has no end the whole line."""
    return code_of(line, nested=True) if "(" not in line or ")" in line else line.lower()
