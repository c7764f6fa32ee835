"""Programs of canned cycles, through our reader and through LinuxCNC's own interpreter."""

from __future__ import annotations

import re
import subprocess
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

from app.gcode.interpreter.cycles import Point
from app.gcode.interpreter.reader import read_program
from app.model.motion import MotionKind
from tests.gcode.rs274_oracle import KINDS, RS274, needs_rs274, own_home

CALL = re.compile(r"^\s*\d+ N(\d+|\.+)\s+(\w+)\((.*)\)\s*$", re.M)
START = (1.0, 2.0, 3.0)
HEAD_LINES = 2
Motion = tuple[int, MotionKind, Point]


@dataclass(frozen=True)
class Block:
    """A block: cycle code ("" = the one in force), G words of other groups, words by letter."""

    code: str = ""
    modes: tuple[str, ...] = ()
    words: dict[str, float] = field(default_factory=dict)

    def text(self, number: int) -> str:
        words = [f"{letter}{value:.4f}" if letter != "L" else f"L{value:.0f}" for letter, value in self.words.items()]
        return " ".join([f"N{number}", *self.modes, self.code, *words])


@dataclass(frozen=True)
class Run:
    """What a program did: motions of the blocks before `refused`, the number of the block that was refused."""

    motions: list[Motion]
    refused: int | None = None


def program(blocks: list[Block], spindle: int = 1, units: str = "G21") -> str:
    """Return the text: a start that is known, the blocks numbered from 1."""
    turn = {1: "M3 S100", -1: "M4 S100", 0: "M5"}[spindle]
    head = f"{units} G17 G90 G98 F100 {turn}\nN0 G0 X{START[0]} Y{START[1]} Z{START[2]}\n"
    return head + "\n".join(block.text(k) for k, block in enumerate(blocks, 1)) + "\nM2\n"


def interpreted(text: str) -> Run:
    """Return what `rs274` makes of a program."""
    needs_rs274()
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "in.ngc").write_text(text, "utf-8")
        (Path(folder) / "tool.tbl").write_text("T1 P1 Z0.0 D0.1\n")
        command = [str(RS274), "-g", "-t", "tool.tbl", "-v", "scratch.var", "in.ngc"]
        run = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=60, env=own_home(folder))
    calls = [(number, name, arguments.split(",")) for number, name, arguments in CALL.findall(run.stdout)]
    motions = [_motion(int(number), name, arguments) for number, name, arguments in calls if name in KINDS]
    place = re.search(r"^N(\d+)", run.stderr, re.M)
    assert (place is not None) == (run.returncode != 0), (run.returncode, run.stderr, run.stdout[-300:])
    refused = int(place[1]) if place else None
    return Run([m for m in motions if m[0] and (refused is None or m[0] < refused)], refused)


def _motion(number: int, name: str, arguments: list[str]) -> Motion:
    x, y, z = (float(a) + 0.0 for a in arguments[:3])
    return number, MotionKind(int(KINDS[name])), (x, y, z)


def read(text: str) -> Run:
    """Return what our reader makes of a program, in its units."""
    done = read_program(text.encode())
    unit = 25.4 if text.startswith("G20") else 1.0
    numbers = done.motions.line - HEAD_LINES
    refused = None if done.error is None else done.error.line - HEAD_LINES
    ends = (done.motions.end / unit).round(4) + 0.0
    motions = [
        (int(n), MotionKind(k), (x, y, z))
        for n, k, (x, y, z) in zip(numbers, done.motions.kind, ends.tolist(), strict=True)
    ]
    return Run([m for m in motions if m[0] > 0 and (refused is None or m[0] < refused)], refused)


def assert_same(blocks: list[Block], spindle: int = 1, units: str = "G21") -> Run:
    """Assert that both do the same: count, kinds and ends of motions to 4 decimals, and the block refused, if one
    is.
    """
    return assert_same_text(program(blocks, spindle, units))


def assert_same_text(text: str) -> Run:
    """Assert the same of a text whose lines behind the head are numbered from 1; positions are in the units of the
    head.
    """
    theirs, mine = interpreted(text), read(text)
    assert mine.refused == theirs.refused, text
    assert [m[:2] for m in mine.motions] == [m[:2] for m in theirs.motions], text
    for a, b in zip(mine.motions, theirs.motions, strict=True):
        assert all(abs(p - q) < 1.001e-4 for p, q in zip(a[2], b[2], strict=True)), (text, a, b)
    return mine
