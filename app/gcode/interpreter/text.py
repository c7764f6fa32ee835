"""A program's bytes as lines: one kind of line end, one encoding, and where a character stands."""

from __future__ import annotations

import codecs
import re

from .program import BlockFault

_BLANKS = {ord(c): None for c in " \t\v\f\x00\ufeff"}
"""What a control skips everywhere; NUL was the leader of paper tapes."""

_NOT_CODE = re.compile(r"\([^()]*\)|;.*|[ \t\v\f\x00\ufeff]+")


class ProgramBuffer:
    """A program in memory.

    Attributes:
        data: the bytes with line feeds for all line ends; the last line has one too.
        encoding: "ascii", "utf-8" or "latin-1".
        dropped: bytes of each line end that are not there any more.
    """

    def __init__(self, data: bytes) -> None:
        """Take a file's bytes."""
        if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
            data = data.decode("utf-16", "replace").encode()
        data = data.removeprefix(codecs.BOM_UTF8)
        self.dropped = int(b"\r\n" in data)
        if b"\r" in data:
            data = data.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
        self.data = data if data.endswith(b"\n") or not data else data + b"\n"
        self.encoding = _encoding(self.data)

    @property
    def line_count(self) -> int:
        """How many lines there are."""
        return self.data.count(b"\n")

    def line_end(self, offset: int) -> int:
        """Return the offset of the line feed that ends the line at an offset."""
        end = self.data.find(b"\n", offset)
        return len(self.data) if end < 0 else end

    def line(self, offset: int) -> str:
        """Return the line that begins at an offset, without its end."""
        return self.data[offset : self.line_end(offset)].decode(self.encoding)


def _encoding(data: bytes) -> str:
    if data.isascii():
        return "ascii"
    try:
        data.decode("utf-8")
    except UnicodeDecodeError:
        return "latin-1"
    return "utf-8"


def code_of(line: str, nested: bool) -> str:
    """Return what the control obeys of a line: without comments and blanks, in lower case.

    Args:
        line: as it is written.
        nested: brackets within comments pair up; else one within a comment is a fault, as LinuxCNC has it.

    Raises:
        Fault: a comment has no end, or begins within another.
    """
    if "(" in line:
        line = _without_brackets(line, nested)
    at = line.find(";")
    if at >= 0:
        line = line[:at]
    return line.translate(_BLANKS).lower()


def _without_brackets(line: str, nested: bool) -> str:
    """Return a line with blanks for its comments in brackets."""
    kept, depth, begun = list(line), 0, 0
    for i, c in enumerate(line):
        if c == ";" and not depth:
            break
        if c == "(":
            if depth and not nested:
                raise BlockFault(
                    "a comment begins within another; close the first with ) before.", column=i + 1, word="("
                )
            begun = begun if depth else i
            depth += 1
        if depth:
            kept[i] = " "
        if c == ")" and depth:
            depth -= 1
    if depth:
        raise BlockFault("the comment has no end; close it with ).", column=begun + 1, word="(")
    return "".join(kept)


def column_of(line: str, index: int) -> int:
    """Return the 1-based column in a line of the character at an index of its `code_of`."""
    at = 0
    for found in _NOT_CODE.finditer(line):
        code = found.start() - at
        if index < code:
            break
        index -= code
        at = found.end()
    return at + index + 1
