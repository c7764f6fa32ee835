"""Bytes that a control takes otherwise than a reader of texts does: marks of encodings, carriage returns alone, NUL."""

from __future__ import annotations

import codecs
import re
from collections.abc import Iterator

from .control import Control
from .dialect import Dialect

_UTF16 = (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)
_SAVE = "save it as plain text, ASCII or UTF-8 without a mark, with line feeds."
_OF_LINUXCNC: tuple[tuple[re.Pattern[bytes], str], ...] = (
    (
        re.compile(rb"\r(?!\r*(?:\n|\Z))"),
        "a carriage return alone ends no line for LinuxCNC, which obeys what stands on both sides of it as one line",
    ),
    (
        re.compile(rb"\0(?![ \t\r\0]*(?:\n|\Z))"),
        "LinuxCNC reads a line as far as its first NUL byte, and leaves out what stands behind it",
    ),
    (re.compile(rb"[\v\f]"), "LinuxCNC refuses form feeds and vertical tabs"),
)


def warn_of_bytes(control: Control, file: bytes) -> None:
    """Tell what in a file's bytes the control refuses, or obeys otherwise than it is read here.

    Args:
        file: as it lies on the disk.
    """
    for at, what in _odd(file, control.options.dialect):
        before = file[:at].replace(b"\r\n", b"\n").replace(b"\r", b"\n")
        control.line = before.count(b"\n") + 1
        control.warn(f"{what}; {_SAVE}")


def _odd(file: bytes, dialect: Dialect) -> Iterator[tuple[int, str]]:
    if file in (*_UTF16, codecs.BOM_UTF8):  # a mark and no line that it could be told of
        return
    if file.startswith(_UTF16):
        yield 0, "the file is written in UTF-16, two bytes a letter, which controls do not read"
        return
    if file.startswith(codecs.BOM_UTF8) and dialect in (Dialect.LINUXCNC, Dialect.GRBL):
        yield 0, "the file begins with a byte order mark, which the control refuses"
    if dialect is Dialect.LINUXCNC:
        found = ((pattern.search(file), what) for pattern, what in _OF_LINUXCNC)
        yield from ((match.start(), what) for match, what in found if match)
