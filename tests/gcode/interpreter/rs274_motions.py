"""The motions that LinuxCNC's interpreter prints for a program, and that ours are the same."""

from __future__ import annotations

import math
import re
import subprocess
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from subprocess import DEVNULL

import numpy as np

from app.gcode.interpreter.options import ReadOptions, ToolOffset
from app.gcode.interpreter.program import NcProgram
from app.gcode.interpreter.reader import read_program
from app.model.motion import MotionKind, Motions, Plane
from app.model.part import Units
from tests.gcode.rs274_oracle import RS274, needs_rs274, own_home

CALL = re.compile(r"^\s*\d+ N(?:\.+|\d+)\s*([A-Z][A-Z_0-9]*)\((.*)\)\s*$")
LINES = {"STRAIGHT_TRAVERSE": MotionKind.RAPID, "STRAIGHT_FEED": MotionKind.LINE}
PLANES = {"CANON_PLANE_XY": Plane.XY, "CANON_PLANE_XZ": Plane.ZX, "CANON_PLANE_YZ": Plane.YZ}
HALF_A_DIGIT = 0.51e-4
MM_PER_INCH = 25.4

TOOLS = {n: ToolOffset((0.0, 0.0, 10.0 * n), 6.0 + n) for n in (1, 2, 3, 6, 8)}
OPTIONS = ReadOptions(tool_table=TOOLS, block_delete=False)  # as rs274 reads


@dataclass(frozen=True)
class Printed:
    """A motion as it is printed: program coordinates in the units of the moment, arcs in their plane."""

    kind: MotionKind
    unit: float
    end: tuple[float, float, float]
    centre: tuple[float, float] | None = None
    plane: Plane = Plane.XY
    turns: int = 0


def tool_table(tools: Mapping[int, ToolOffset]) -> str:
    """Return a tool table as rs274 reads it: in inch, whatever the program says."""
    rows = [[value / MM_PER_INCH for value in (*tool.offset, tool.diameter)] for tool in tools.values()]
    return "".join(
        f"T{n} P{n} X{x:.9f} Y{y:.9f} Z{z:.9f} D{d:.9f}\n" for n, (x, y, z, d) in zip(tools, rows, strict=True)
    )


def rs274(data: bytes, tools: Mapping[int, ToolOffset] = TOOLS) -> tuple[list[Printed], str]:
    """Run LinuxCNC's interpreter; return its motions, and its complaint or ""."""
    needs_rs274()
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "in.ngc").write_bytes(data)
        (Path(folder) / "tool.tbl").write_text(tool_table(tools))
        command = [RS274, "-g", "-t", "tool.tbl", "-v", "scratch.var", "in.ngc"]
        run = subprocess.run(
            command,
            cwd=folder,
            env=own_home(folder),
            stdin=DEVNULL,
            capture_output=True,
            text=True,
            errors="replace",
            timeout=60,
        )
    return _motions(run.stdout), "" if run.returncode == 0 else run.stderr.strip()


def _motions(output: str) -> list[Printed]:
    unit, plane, motions = 1.0, Plane.XY, []
    for line in output.splitlines():
        match = CALL.match(line)
        name, arguments = (match[1], match[2]) if match else ("", "")
        if name == "USE_LENGTH_UNITS":
            unit = (Units.INCH if "INCH" in arguments else Units.MM).value
        elif name == "SELECT_PLANE":
            plane = PLANES[arguments]
        elif name == "ARC_FEED":
            motions.append(_arc([float(a) for a in arguments.split(",")], plane, unit))
        elif name == "NURBS_FEED":
            motions.append(Printed(MotionKind.SPLINE, unit, (math.nan,) * 3))
        elif name in LINES:
            x, y, z = (float(a) for a in arguments.split(",")[:3])
            motions.append(Printed(LINES[name], unit, (x, y, z)))
    return motions


def _arc(numbers: list[float], plane: Plane, unit: float) -> Printed:
    u, v, w = plane.axes
    end = [0.0] * 3
    end[u], end[v], end[w] = numbers[0], numbers[1], numbers[5]
    kind = MotionKind.ARC_CCW if numbers[4] > 0 else MotionKind.ARC_CW
    return Printed(kind, unit, (end[0], end[1], end[2]), (numbers[2], numbers[3]), plane, abs(int(numbers[4])))


def in_program(program: NcProgram, row: int, place: np.ndarray) -> np.ndarray:
    """Return table coordinates as those of the program, by the state of a motion, mm."""
    state = program.states[program.motions.state[row]]
    x, y, z = place - np.array(state.shift)
    c, s = math.cos(state.rotation), math.sin(state.rotation)
    return np.array([c * x + s * y, c * y - s * x, z])


def assert_same(program: NcProgram, printed: list[Printed]) -> None:
    """Assert the same number of motions, of the same kinds, ends and centres to the digits that are printed."""
    motions = program.motions
    for row, other in enumerate(printed[: len(motions)]):
        where = f"motion {row}, line {motions.line[row]}: {_told(motions, row)} for {other}"
        assert motions.kind[row] == other.kind, where
        if other.kind is MotionKind.SPLINE:
            continue
        assert np.allclose(
            in_program(program, row, motions.end[row]) / other.unit, other.end, rtol=0, atol=HALF_A_DIGIT
        ), where
        if other.centre is not None:
            u, v, _ = other.plane.axes
            centre = in_program(program, row, motions.centre[row])[[u, v]] / other.unit
            assert motions.plane[row] == other.plane and motions.turns[row] == other.turns, where
            assert np.allclose(centre, other.centre, rtol=0, atol=HALF_A_DIGIT), where
    assert len(motions) == len(printed), (len(motions), printed[len(motions) :][:1], program.problems)


def _told(motions: Motions, row: int) -> str:
    kind, end, centre = MotionKind(motions.kind[row]).name, motions.end[row].tolist(), motions.centre[row].tolist()
    return f"{kind} to {end} about {centre} x {motions.turns[row]}"


def assert_as_rs274(data: bytes | str, options: ReadOptions = OPTIONS) -> NcProgram:
    """Read a program that rs274 accepts, with both, and assert that the motions are the same."""
    text = data.encode() if isinstance(data, str) else data
    printed, complaint = rs274(text, options.tool_table)
    assert not complaint, complaint
    program = read_program(text, options)
    assert program.error is None, program.error
    assert_same(program, printed)
    return program
