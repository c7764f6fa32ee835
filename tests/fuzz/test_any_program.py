"""Random valid programs in the habits of others: motions are those of LinuxCNC's own interpreter, and `check`'s extents
those of the motions that it prints.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from app.gcode.interpreter.reader import read_program
from app.model.motion import MotionKind
from app.usecases.examine import ExamineOptions, examine
from tests.fuzz.any_program import ProgramWriter
from tests.gcode.interpreter.rs274_motions import OPTIONS, Printed, assert_same, rs274


def sampled(start: tuple[float, float, float], printed: Printed) -> np.ndarray:
    """Return points (n, 3) of a printed motion, in its own units."""
    if printed.centre is None:
        return np.array([start, printed.end])
    u, v, w = printed.plane.axes
    cu, cv = printed.centre
    first = math.atan2(start[v] - cv, start[u] - cu)
    last = math.atan2(printed.end[v] - cv, printed.end[u] - cu)
    way = 1 if printed.kind is MotionKind.ARC_CCW else -1
    sweep = (way * (last - first)) % math.tau
    sweep = math.tau if sweep < 1e-4 else sweep  # whole circles, whose ends the last digit may part
    sweep += math.tau * (printed.turns - 1)
    share = np.linspace(0, 1, 4001)
    radius = math.hypot(start[u] - cu, start[v] - cv)
    radius = radius + share * (math.hypot(printed.end[u] - cu, printed.end[v] - cv) - radius)
    made = np.zeros((len(share), 3))
    made[:, u] = cu + radius * np.cos(first + way * share * sweep)
    made[:, v] = cv + radius * np.sin(first + way * share * sweep)
    made[:, w] = start[w] + share * (printed.end[w] - start[w])
    return made


def extents(printed: list[Printed]) -> tuple[np.ndarray, np.ndarray]:
    """Return least and greatest coordinates of what is cut, mm."""
    at, points = (math.nan,) * 3, []
    for each in printed:
        here = tuple(value / each.unit for value in at)
        if each.kind is not MotionKind.RAPID:
            points.append(sampled(here, each) * each.unit)  # type: ignore[arg-type]
        at = tuple(value * each.unit for value in each.end)
    everything = np.concatenate(points)
    return everything.min(axis=0), everything.max(axis=0)


def fault(seed: int, offsets: bool) -> str:
    """Return what is wrong with how a random program is read."""
    text = ProgramWriter(seed, offsets).text()
    printed, complaint = rs274(text.encode())
    program = read_program(text.encode(), OPTIONS)
    if complaint:
        return "" if program.error is not None else f"LinuxCNC refuses it: {complaint}"
    if program.error is not None:
        return f"refused: {program.error}"
    try:
        assert_same(program, printed)
    except AssertionError as error:
        return str(error)[:400]
    if offsets or not any(each.kind is not MotionKind.RAPID for each in printed):
        return ""
    low, high = extents(printed)
    told = examine("p.ngc", text.encode(), ExamineOptions()).report()["extent_mm"]["cut"]
    near = np.allclose(low, told["low"], atol=6e-3) and np.allclose(high, told["high"], atol=6e-3)  # inches, 4 digits
    return "" if near else f"extents {told} where {low} to {high} are cut"


def test_a_height_that_rounding_parts_from_itself_is_no_move() -> None:
    """R as a sum, [1.68+1], and the height that the tool is at, 2.68."""
    text = "F300\nG1 X[-2.51+1] Z[0.33+1]\nG0 Z30\nG89 P0.1 X[16.21+1] Y-17.2 Z[-4.03+1] R[1.68+1]\nY13.6\nM2\n"
    assert len(read_program(text.encode(), OPTIONS).motions) == len(rs274(text.encode())[0]) == 9


@pytest.mark.parametrize("offsets", [False, True])
def test_some_programs(offsets: bool) -> None:
    assert {seed: found for seed in range(10) if (found := fault(seed, offsets))} == {}


@pytest.mark.exhaustive
@pytest.mark.parametrize("offsets", [False, True])
def test_hundreds_of_programs(offsets: bool) -> None:
    assert {seed: found for seed in range(10, 110) if (found := fault(seed, offsets))} == {}
