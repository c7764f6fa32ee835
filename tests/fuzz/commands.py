"""Whole commands called as the shell calls them, in this process, and what is wrong with how they end."""

from __future__ import annotations

import io
import random
import shutil
import signal
import time
import unicodedata
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from dataclasses import dataclass
from pathlib import Path
from types import FrameType

from app.cli.main import main
from app.cli.program import load_command
from tests import raster_program
from tests.fuzz import seeds
from tests.fuzz.mutations import mutated

REFUSED_S, ENDLESS_S, LETTERS = 5.0, 60.0, 400
"""Processor seconds for refusing, and for anything; letters of a sentence."""

VALUES = (
    "0",
    "-0",
    "-1",
    "1",
    "nan",
    "inf",
    "-inf",
    "1e300",
    "-1e300",
    "1e-300",
    "",
    " ",
    "1e999",
    "0x10",
    "1,5",
    "9" * 5000,
    "a" * 5000,
)
"""What a numeric option may be given."""

PROGRAM = b"G21 G90\nT1 M6\nS1000 M3\nG0 X2 Y2 Z5\nG1 Z-1 F100\nG1 X8 F300\nG3 X10 Y4 I0 J2\nG1 Y8\nG0 Z5\nM5\nM30\n"
DRAWING = b"rectangle 0,0 12,8\ncircle 6,4 2\n"
SCENE = b"""name = "s"
stock = { box = [0, 0, -2, 8, 6, 1] }
[[tool]]
number = 1
kind = "ball"
diameter = 2.0
feed_rate = 900
plunge_rate = 300
[[surface]]
name = "p"
shape = { kind = "plane", corner = [0, 0, 0], along = [8, 0, 0], across = [0, 6, -1] }
[[surface]]
name = "b"
shape = { kind = "sphere", centre = [4, 3, -1], radius = 1.5 }
[[passes]]
tool = 1
pitch = 1.5
"""


@dataclass(frozen=True)
class Command:
    """A command that works, to be spoilt.

    Attributes:
        argv: with the placeholders IN and OUT for the input's path and the folder of outputs.
        name, data: of the input. others: more inputs to mutate.
    """

    argv: tuple[str, ...]
    name: str
    data: bytes
    others: tuple[bytes, ...] = ()


def commands() -> dict[str, Command]:
    """Return every command by its name."""
    small = tuple(text for text in seeds.programs() if len(text) < 2000)
    cut = ("cut", "IN", "--stock=0,0,-3,14,12,0", "--tool=1=flat:2", "--grid=64", "--report=OUT/r.json", "--quiet")
    return {
        "make": Command(("make", "IN", "-o", "OUT/o.ngc", "--quiet"), "d.draw", DRAWING),
        "cut": Command(cut, "p.ngc", PROGRAM, small),
        "smooth": Command(("smooth", "IN", "-o", "OUT/o.ngc", "--quiet"), "p.ngc", PROGRAM, small),
        "better": Command(
            ("better", "IN", "-o", "OUT/o.ngc", "--quiet"),
            "p.ngc",
            raster_program.text(raster_program.rows(wide=8.0, deep=4.0)).encode(),
        ),
        "check": Command(("check", "IN", "--report=OUT/r.json", "--quiet"), "p.ngc", PROGRAM, small),
        "surface": Command(("surface", "IN", "-o", "OUT/o.ngc", "--quiet"), "s.toml", SCENE),
        "tools": Command(("tools", "IN", "--report=OUT/r.json", "--quiet"), "d.draw", DRAWING),
        "stages": Command(("stages", "IN", "-o", "OUT/s", "--bitmap=64", "--quiet"), "d.draw", DRAWING),
    }


def numeric_options(command: Command) -> list[str]:
    """Return the options of a command that read a value with a function of their own: numbers, lengths, angles, boxes,
    tools.
    """
    parser = load_command(command.argv[0]).parser()
    assert parser.command
    return [
        action.option_strings[-1]
        for action in parser._actions
        if action.option_strings and action.type is not None and action.type is not Path
    ]


def spoilt(command: Command, number: int) -> bytes:
    """Return the number-th mutation of a command's input."""
    return mutated((command.data, command.data, *command.others), random.Random(number))


@contextmanager
def _limited() -> Iterator[None]:
    """End what takes too much of the processor."""

    def stop(number: int, frame: FrameType | None) -> None:
        raise TimeoutError(f"no end within {ENDLESS_S:g} s")

    old = signal.signal(signal.SIGPROF, stop)
    signal.setitimer(signal.ITIMER_PROF, ENDLESS_S)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, old)


def fault(command: Command, folder: Path, data: bytes, options: Sequence[str] = ()) -> str:
    """Run a command in a folder, and return what is wrong with how it ended; "" = nothing."""
    out = folder / "out"
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir(parents=True)
    path = folder / command.name
    path.write_bytes(data)
    argv = [
        each.replace("IN", str(path), 1) if each == "IN" else each.replace("OUT", str(out)) for each in command.argv
    ]
    said, begun = io.StringIO(), time.process_time()
    with redirect_stderr(said), redirect_stdout(io.StringIO()), _limited():
        status = main([*argv, *options])
    return _wrong(status, said.getvalue(), out, time.process_time() - begun)


def _wrong(status: int, said: str, out: Path, spent: float) -> str:
    """Return what is wrong with an end: its status, what it said, what it left, and how long it took."""
    lines = [line for line in said.splitlines() if line.strip()]
    left = sorted(path.name for path in out.rglob("*"))
    if "should not have happened" in said or "Traceback" in said:
        return said[:400]
    if status not in (0, 1, 2):
        return f"status {status}"
    if any(name.endswith((".part", ".old")) for name in left):
        return f"leaves {left}"
    if status != 2:
        return ""
    if left:
        return f"refuses and leaves {left}"
    if spent > REFUSED_S:
        return f"takes {spent:.1f} s to refuse"
    own = [line for line in lines if line.startswith("hitofude: ")]
    if not own or len(own[-1]) > LETTERS:
        return f"says {said[:600]!r}"
    signs = "".join(lines)
    return (
        f"signs that cannot be printed: {said[:200]!r}"
        if any(unicodedata.category(sign) in ("Cc", "Cs") for sign in signs)
        else ""
    )
