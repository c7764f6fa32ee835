"""How the time of `check`, `cut` and `smooth` grows with the lines of a program: no faster than n log n.

Times are the processor's, of the whole command in this process; the exponent is that of the line through the
logarithms, from the size on at which what a command takes once is the smaller part.
"""

from __future__ import annotations

import io
import math
import time
from contextlib import redirect_stdout
from pathlib import Path

import numpy as np
import pytest

from app.cli.main import main

pytestmark = pytest.mark.benchmark
SIZES = (1_000, 10_000, 100_000, 1_000_000)
MOST = 1.15
"""Exponent that a command may have."""
PER_ROUND = 1_000
"""Lines of one outline."""
COMMANDS = {
    "check": ["check", "{program}"],
    "cut": [
        "cut",
        "{program}",
        "--report",
        "{folder}/cut.json",
        "--grid",
        "256",
        "--tool",
        "1=flat:2",
        "--quiet",
        "--stock=-12,-12,-3,{far},{far},0",
    ],
    "smooth": ["smooth", "{program}", "-o", "{folder}/smooth.ngc", "--tolerance", "0.05", "--quiet"],
}


def program(count: int) -> bytes:
    """Outlines of one shape beside one another, each a stretch of its own, until there are so many feed moves."""
    angles = 2 * math.pi * np.arange(PER_ROUND) / PER_ROUND
    radius = 8 + 1.2 * np.sin(5 * angles) + 0.3 * np.sin(23 * angles)
    x, y = (radius * np.cos(angles)).tolist(), (radius * np.sin(angles)).tolist()
    lines, rounds = (
        ["(T1 D=2 CR=0 - ZMIN=-1 - flat end mill)", "G21 G90 G17", "T1 M6", "S1000 M3", "G0 Z5"],
        count // PER_ROUND,
    )
    side = math.ceil(math.sqrt(rounds))
    for k in range(rounds):
        left, low = 20 * (k % side), 20 * (k // side)
        lines += [f"G0 X{left + x[0]:.4f} Y{low + y[0]:.4f}", "G1 Z-1 F300", "F1000"]
        lines += [f"G1 X{left + a:.4f} Y{low + b:.4f}" for a, b in zip(x, y, strict=True)]
        lines.append("G0 Z5")
    return ("\n".join([*lines, "M2"]) + "\n").encode()


def seconds(command: str, count: int, folder: Path) -> float:
    """Of the processor, for one command and a program of so many lines."""
    path = folder / f"{count}.ngc"
    if not path.exists():
        path.write_bytes(program(count))
    far = 20 * math.ceil(math.sqrt(count // PER_ROUND)) + 12
    arguments = [word.format(program=path, folder=folder, far=far) for word in COMMANDS[command]]
    begun = time.process_time()
    with redirect_stdout(io.StringIO()):
        assert main(arguments) in (0, 1)
    return time.process_time() - begun


@pytest.mark.parametrize(
    ("command", "sizes"),
    [
        ("check", SIZES),
        ("cut", SIZES),
        ("smooth", SIZES[:3]),
        pytest.param("smooth", SIZES, marks=pytest.mark.exhaustive),
    ],
)
def test_no_command_grows_faster_than_n_log_n(
    command: str, sizes: tuple[int, ...], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    seconds(command, sizes[0], tmp_path)  # so that no kernel is loaded on the way
    spent = [seconds(command, size, tmp_path) for size in sizes]
    judged = [k for k in range(len(sizes)) if spent[k] > 2 * spent[0] or k >= len(sizes) - 2]
    exponent = float(np.polyfit(np.log([sizes[k] for k in judged]), np.log([spent[k] for k in judged]), 1)[0])
    with capsys.disabled():
        print(f"\n  {command:8s}" + "".join(f"{each:9.2f}" for each in spent) + f"{exponent:8.2f}")
    assert exponent <= MOST
