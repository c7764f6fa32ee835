"""What LinuxCNC's own interpreter makes of a program, and whether that is the motion the moves mean.

Two doors to the same interpreter: `rs274` says whether a program is accepted and in which order things happen, with
positions to 4 decimals; the `gcode` module of the system's Python gives every motion in full precision with its line
(it knows no tool table and T and H words crash it, so these are taken out for it, line by line).
"""

from __future__ import annotations

import cmath
import json
import math
import os
import re
import shutil
import subprocess
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType

import numpy as np
import pytest

from app.gcode.writer.write import NcText
from app.model.job import Job
from app.model.moves import MoveKind, Moves
from app.model.part import Units

RS274 = shutil.which("rs274")
SYSTEM_PYTHON = "/usr/bin/python3"
UM = 1e-3
CALL = re.compile(r"^\s*\d+ N\S*\s+(\w+)\((.*)\)\s*$")
KINDS = {"STRAIGHT_TRAVERSE": MoveKind.RAPID, "STRAIGHT_FEED": MoveKind.LINE}

READER = """
import gcode, json, sys
class Canon:
    parameter_file = sys.argv[2]
    line, motions = 0, []
    def next_line(self, state): self.line = state.sequence_number
    def straight_traverse(self, *a): self.motions.append([self.line, 0, *a[:3]])
    def straight_feed(self, *a): self.motions.append([self.line, 1, *a[:3]])
    def arc_feed(self, x, y, cx, cy, turn, z, *rest):
        self.motions.append([self.line, 3 if turn > 0 else 2, x, y, z, cx, cy, turn])
    def set_feed_rate(self, f): self.motions.append([self.line, -1, f])
    def get_external_angular_units(self): return 1.0
    def get_external_length_units(self): return 1.0
    def get_axis_mask(self): return 7
    def get_block_delete(self): return 0
    def check_abort(self): return False
    def get_tool(self, number): return (number, *[0.0] * 9, 0.2, 0.0, 0.0, 0)
    def __getattr__(self, name):
        if name.startswith("__"): raise AttributeError(name)
        return lambda *a: None
canon = Canon()
result, line = gcode.parse(sys.argv[1], canon, "", "", "")
json.dump([result, line, canon.motions], open(sys.argv[3], "w"))
"""


@dataclass(frozen=True)
class Motion:
    """One motion of the control, mm in work coordinates; `line` is that of the text, `turn` an arc's signed turns."""

    line: int
    kind: MoveKind
    start: tuple[float, float, float]
    end: tuple[float, float, float]
    centre: complex | None
    turn: int
    feed: float

    def sweep(self) -> float:
        """The arc's angle, counter-clockwise positive."""
        first, last = complex(*self.start[:2]) - self.centre, complex(*self.end[:2]) - self.centre
        angle = (cmath.phase(last) - cmath.phase(first)) % math.tau
        return (angle or math.tau) if self.turn > 0 else angle - math.tau

    def points(self, count: int = 33) -> np.ndarray:
        """(count, 3) points of the motion, as the control moves: an arc's radius changes evenly from start to end."""
        t = np.linspace(0, 1, count)
        start, end = np.array(self.start), np.array(self.end)
        points = start + t[:, None] * (end - start)
        if self.centre is not None:
            first, last = complex(*start[:2]) - self.centre, complex(*end[:2]) - self.centre
            radius = abs(first) + t * (abs(last) - abs(first))
            flat = self.centre + radius * np.exp(1j * (cmath.phase(first) + t * self.sweep()))
            points[:, 0], points[:, 1] = flat.real, flat.imag
        return points


def needs_rs274() -> None:
    """Skip where the interpreter is not installed."""
    if RS274 is None:
        pytest.skip("rs274 is not installed (Debian package linuxcnc-uspace)")


def own_home(folder: str) -> dict[str, str]:
    """The environment for an interpreter that runs beside others: it keeps its tools in a file of the home folder."""
    return os.environ | {"HOME": folder}


def canonical_calls(text: str, lengths: Mapping[int, float] = MappingProxyType({})) -> list[tuple[str, list[str]]]:
    """Run `rs274` on a program; fail if it refuses it. Return its canonical calls with their arguments.

    Args:
        text: the program.
        lengths: of its tools, mm; 0 for those that are not there.
    """
    needs_rs274()
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "in.ngc").write_text(text, "ascii")
        tools = sorted({int(number) for number in re.findall(r"\bT(\d+) M6", text, re.M)})
        (Path(folder) / "tool.tbl").write_text(
            "".join(f"T{n} P{n} Z{lengths.get(n, 0.0) / 25.4:.8f} D0.1\n" for n in tools)
        )
        command = [RS274, "-g", "-t", "tool.tbl", "-v", "scratch.var", "in.ngc"]
        run = subprocess.run(command, cwd=folder, capture_output=True, text=True, env=own_home(folder))
    assert run.returncode == 0, run.stderr
    found = (CALL.match(line) for line in run.stdout.splitlines())
    return [(match[1], [item.strip() for item in match[2].split(",")]) for match in found if match]


def exact_motions(text: str) -> list[Motion]:
    """Return every motion in full precision, mm. Skips where the system's Python has no `gcode` module."""
    needs_rs274()
    with tempfile.TemporaryDirectory() as folder:
        names = [str(Path(folder) / name) for name in ("in.ngc", "scratch.var", "out.json")]
        Path(names[0]).write_text(
            re.sub(r"(?<=G43) H\d+$", "", re.sub(r"\bT\d+ M6$", "M1", text, flags=re.M), flags=re.M), "ascii"
        )
        run = subprocess.run(
            [SYSTEM_PYTHON, "-c", READER, *names], capture_output=True, text=True, env=own_home(folder)
        )
        if "No module named 'gcode'" in run.stderr:
            pytest.skip("the system's Python has no gcode module (Debian package linuxcnc-uspace)")
        assert run.returncode == 0, run.stderr
        result, line, rows = json.loads(Path(names[2]).read_text())
    assert result in (0, 1), f"refused at line {line}"
    return _motions(rows)


def _motions(rows: list[list[float]]) -> list[Motion]:
    position, feed, motions = (0.0, 0.0, 0.0), 0.0, []
    for line, kind, *numbers in rows:
        numbers = [number * 25.4 for number in numbers[:5]] + numbers[5:]
        if kind == -1:
            feed = numbers[0]
            continue
        end = tuple(numbers[:3])
        centre = complex(*numbers[3:5]) if kind >= 2 else None
        motions.append(Motion(line, MoveKind(kind), position, end, centre, int(numbers[5]) if kind >= 2 else 0, feed))
        position = end
    return motions


def assert_same_motion(
    moves: Moves, nc: NcText, job: Job, origin: tuple[float, float, float] = (0.0, 0.0, 0.0)
) -> None:
    """Assert that the control's motion is the moves' own to 1 um, with their sense, feed, tool and line."""
    calls, motions = canonical_calls(nc.text), exact_motions(nc.text)
    _assert_both_doors_agree(calls, motions, job.out_units)
    tools = [int(arguments[0]) for name, arguments in calls if name == "CHANGE_TOOL"]
    assert tools == [int(tool) for i, tool in enumerate(moves.tool) if i == 0 or tool != moves.tool[i - 1]]
    assert np.all(np.diff(nc.lines) >= 0)
    start, end, centre = moves.start - origin, moves.end - origin, moves.centre - origin[:2]
    sweeps = moves.sweeps()
    before, position = 0, (0.0, 0.0, 0.0)
    by_line: dict[int, list[Motion]] = {}
    for motion in motions:
        by_line.setdefault(motion.line, []).append(motion)
    for i in range(len(moves)):
        mine = [motion for line in range(before + 1, nc.lines[i] + 1) for motion in by_line.get(line, [])]
        mine = mine if i and moves.tool[i] == moves.tool[i - 1] else [m for m in mine if m.line == nc.lines[i]]
        meant = Meant(
            start[i],
            end[i],
            complex(*centre[i]),
            MoveKind(moves.kind[i]),
            float(sweeps[i]),
            float(moves.feed[i]),
        )
        meant.assert_moved(mine, position, job.out_units)
        position = mine[-1].end if mine else position
        before = nc.lines[i]
    assert all(m.kind is MoveKind.RAPID and m.start[:2] == m.end[:2] for m in motions if m.line > before)


@dataclass(frozen=True)
class Meant:
    """One move of the program in work coordinates."""

    start: np.ndarray
    end: np.ndarray
    centre: complex
    kind: MoveKind
    sweep: float
    feed: float

    def assert_moved(self, motions: list[Motion], position: tuple[float, float, float], units: Units) -> None:
        """Assert that the control's motions, from its position, are this move."""
        reached = motions[-1].end if motions else position
        assert np.max(np.abs(reached - self.end)) <= UM, (self, motions)
        allowed = {self.kind, MoveKind.LINE} if self.kind >= MoveKind.ARC_CW else {self.kind}
        assert {motion.kind for motion in motions} <= allowed, (self, motions)
        if self.kind is MoveKind.RAPID:
            return
        step = 0.1 if units is Units.MM else 0.254
        assert all(abs(motion.feed - self.feed) <= step / 2 + 1e-9 for motion in motions), (self, motions)
        if self.kind is MoveKind.LINE:
            assert len(motions) == 1 or (not motions and math.dist(position, self.end) <= UM)
            return
        self._assert_arc(motions, position)

    def _assert_arc(self, motions: list[Motion], position: tuple[float, float, float]) -> None:
        """Points of the control's path lie on the meant arc, and run along all of it in its sense."""
        points = np.vstack([np.array([position]), *(motion.points() for motion in motions)])
        from_centre = points[:, 0] + 1j * points[:, 1] - self.centre
        first = complex(*self.start[:2]) - self.centre
        radius = abs(first)
        assert np.max(np.abs(np.abs(from_centre) - radius)) <= UM, (self, motions)
        rise = self.end[2] - self.start[2]
        if abs(rise) > radius * abs(self.sweep):  # steep: the height tells how far round it must be
            done = (points[:, 2] - self.start[2]) / rise
            meant = first * np.exp(1j * self.sweep * done)
            assert np.max(np.abs(from_centre - meant)) <= 2 * UM, (self, motions)
        elif radius > UM:
            angles = np.angle(from_centre[1:] / from_centre[:-1])
            assert abs(angles.sum() - self.sweep) * radius <= 3 * UM, (self, motions)
            done = np.concatenate([[0.0], np.cumsum(angles)]) / self.sweep
            assert np.max(np.abs(points[:, 2] - self.start[2] - done * rise)) <= 3 * UM, (self, motions)
        if abs(self.sweep) > math.pi / 2 and radius > 0.01:
            assert all(
                abs(m.centre - self.centre) <= UM
                for m in motions
                if m.centre is not None and abs(m.sweep()) > math.pi / 2
            )


def _assert_both_doors_agree(calls: list[tuple[str, list[str]]], motions: list[Motion], units: Units) -> None:
    """rs274's own motion is that of the exact reading, to its 4 decimals."""
    printed = [
        (name, [float(a) for a in arguments]) for name, arguments in calls if name in KINDS or name == "ARC_FEED"
    ]
    assert len(printed) == len(motions)
    for (name, numbers), motion in zip(printed, motions, strict=True):
        if name == "ARC_FEED":
            x, y, cx, cy, turn, z = numbers[:6]
            assert motion.centre is not None and turn == motion.turn
            assert abs(complex(cx, cy) * units.value - motion.centre) <= 0.0001 * units.value
        else:
            x, y, z = numbers[:3]
            assert KINDS[name] is motion.kind
        assert math.dist([c * units.value for c in (x, y, z)], motion.end) <= 0.0001 * units.value
