"""LinuxCNC's tool table, `tool.tbl`: one tool a line, `T1 P1 X0 Z+50.0 D6 I0 J0 Q0 ;remark`, words in any order.

What a line means was settled by asking LinuxCNC's own interpreter (2.9): words are parted by spaces alone and may be in
small letters; of a word that comes twice the last counts, of a tool that comes twice the first; a line with anything
else in it is passed over, in part or whole, without a word. Such lines are told here.
"""

from __future__ import annotations

import re
from collections.abc import Iterable

from ...core.errors import InputError
from ...model.part import Units
from ...model.tool_table import TableRow, ToolTable

WORD = re.compile(r"([A-Za-z])([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)")
LETTERS = "TPXYZABCUVWDIJQ"
WHOLE = "TPQ"
LENGTHS = "XYZUVWD"
DIGITS = {Units.MM: 6, Units.INCH: 8}
LONGEST_LINE = 200
"""Bytes; LinuxCNC takes what is beyond 256 as another line, so a long remark could become a tool."""
MOST_ROWS = 1000
"""Places of LinuxCNC's table."""


def read_tool_table(name: str, data: bytes, units: Units = Units.MM) -> ToolTable:
    """Return the table in a file.

    Args:
        name: of the file, for sentences.
        data: its bytes, UTF-8 or Latin-1.
        units: of its lengths: the machine's, MM or INCH (LinuxCNC's stand-alone interpreter reads INCH).

    Raises:
        InputError: no line holds a tool.
    """
    rows, problems = [], []
    for number, line in enumerate(_text(data).split("\n"), 1):
        words, _, remark = line.partition(";")
        if not words.strip():
            continue
        try:
            rows.append(_row(words, remark.strip(), number, units))
        except InputError as error:
            problems.append(f"{name}:{number}: {error}")
    if not rows:
        raise InputError(
            problems[0]
            if problems
            else f"{name}: there is no tool in this file; write a line for each, such as T1 P1 Z50 D6 ;end mill."
        )
    return ToolTable(tuple(rows), tuple(problems))


def _text(data: bytes) -> str:
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError:
        return data.decode("latin-1")


def _row(text: str, remark: str, line: int, units: Units) -> TableRow:
    """Return the row that the words of a line are."""
    words = dict(_word(word) for word in text.strip(" \r\n").split(" ") if word)
    if "T" not in words:
        raise InputError(
            "the line has no T word, so LinuxCNC passes over it; begin it with the tool's number, such as T1."
        )
    values = {letter: words.get(letter, 0.0) * (units.value if letter in LENGTHS else 1.0) for letter in LETTERS}

    def three(letters: str) -> tuple[float, float, float]:
        first, second, third = (values[letter] for letter in letters)
        return first, second, third

    return TableRow(
        number=int(values["T"]),
        pocket=int(values["P"]),
        offset=three("XYZ"),
        second_offset=three("UVW"),
        rotary_offset=three("ABC"),
        diameter=values["D"],
        front_angle=values["I"],
        back_angle=values["J"],
        orientation=int(values["Q"]),
        remark=remark,
        line=line,
    )


def _word(word: str) -> tuple[str, float]:
    """Return letter and value of a word."""
    match = WORD.fullmatch(word)
    letter = match[1].upper() if match else ""
    if match is None or letter not in LETTERS:
        raise InputError(
            f"'{word}' is no word of LinuxCNC's tool table; use {' '.join(LETTERS)}, each with its number, "
            "parted by spaces, and a semicolon before the remark."
        )
    value = float(match[2])
    if not abs(value) < 1e6 or (letter in WHOLE and value < 0):
        raise InputError(f"'{word}' is out of range; correct it.")
    return letter, value


def write_tool_table(rows: Iterable[TableRow], units: Units = Units.MM) -> bytes:
    """Return the text of a table that LinuxCNC reads.

    Args:
        rows: each number once; remarks are cut to what fits on a line.
        units: of the lengths written, MM or INCH; 6 decimals in mm, 8 in inch.

    Raises:
        InputError: there are more rows than LinuxCNC's table has places, or a number comes twice.
    """
    lines: dict[int, bytes] = {}
    for row in rows:
        if row.number in lines:
            raise InputError(
                f"T{row.number} is there twice; LinuxCNC would take the first of them, so give one another number."
            )
        lines[row.number] = _line(row, units)
    if len(lines) > MOST_ROWS:
        raise InputError(f"There are {len(lines)} tools; LinuxCNC's tool table has places for {MOST_ROWS}.")
    return b"".join(line + b"\n" for line in lines.values())


def _line(row: TableRow, units: Units) -> bytes:
    """Return one line; words that are 0 are left out, but for Z and D."""
    digits, value = DIGITS[units], units.value
    words = [f"T{row.number}", f"P{row.pocket or row.number}"]
    lengths = {
        **dict(zip("XYZ", row.offset, strict=True)),
        **dict(zip("UVW", row.second_offset, strict=True)),
        "D": row.diameter,
    }
    angles = {**dict(zip("ABC", row.rotary_offset, strict=True)), "I": row.front_angle, "J": row.back_angle}
    for letter in LETTERS[2:-1]:
        if letter in lengths and (lengths[letter] or letter in "ZD"):
            words.append(f"{letter}{lengths[letter] / value:{'' if letter == 'D' else '+'}.{digits}f}")
        elif angles.get(letter):
            words.append(f"{letter}{angles[letter]:+.6f}")
    words += [f"Q{row.orientation}"] * bool(row.orientation)
    remark = " ".join(row.remark.split())
    line = " ".join([*words, f";{remark}"] if remark else words).encode()
    return line[:LONGEST_LINE].decode(errors="ignore").encode()
