"""Which motions go along a contour: a program that Hitofude wrote says in a comment where each operation begins."""

from __future__ import annotations

import re
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from ...model.operation_kinds import OPERATION_KINDS
from .program import EventKind, NcProgram
from .text import ProgramBuffer

_NUMBER = re.compile(rb"\d{1,9}:")
_OPENS = (b"(", b";")
_BEFORE = 8
"""Bytes before the words in which the line and the comment begin."""


def contour_motions(data: bytes, program: NcProgram) -> NDArray[np.bool_]:
    """Return (n,) which motions follow a comment such as "(Contour T2: depth ...)", up to the next operation or tool
    change.

    Args:
        data: the bytes that the program was read from.
        program: what was read.
    """
    if not len(program.motions):
        return np.zeros(0, bool)
    begins = {event.line: False for event in program.events if event.kind is EventKind.TOOL_CHANGE}
    begins |= _operations(ProgramBuffer(data).data)
    if not any(begins.values()):
        return np.zeros(len(program.motions), bool)
    lines = sorted(begins)
    at = np.searchsorted(lines, program.motions.line, side="right")
    return np.array([False, *(begins[line] for line in lines)])[at]


def _operations(data: bytes) -> dict[int, bool]:
    """Return, by 1-based line, whether the operation that begins there is a contour."""
    words = ((f"{word.capitalize()} T", kind.FOLLOWS_WALLS) for word, kind in OPERATION_KINDS.items())
    found = sorted(
        (at, contour)
        for text, contour in words
        for each in (text, text.upper())
        for at in _comments(data, each.encode())
    )
    begins, line, last = {}, 1, 0
    for at, contour in found:
        line, last = line + data.count(b"\n", last, at), at
        begins[line] = contour
    return begins


def _comments(data: bytes, words: bytes) -> Iterator[int]:
    """Yield where the words begin a comment at the beginning of a line."""
    at = data.find(words)
    while at >= 0:
        _, line, before = (data[at - _BEFORE : at] if at > _BEFORE else b"\n" + data[:at]).rpartition(b"\n")
        if line and before.strip() in _OPENS and _NUMBER.match(data, at + len(words)):
            yield at
        at = data.find(words, at + len(words))
