"""What `check` prints: of a program, and of how another one differs."""

from __future__ import annotations

from typing import Any

from ..core.wording import counted, minutes_words
from ..gcode.interpreter.program import ProgramProblem, Severity
from ..gcode.rework.compare import ProgramDifferences
from ..usecases.examine import CONTROLS, ExaminedProgram

LEAST_TOLD_S = 0.5
"""Seconds; a shorter time is told as 0:00."""

TOLD = 20
"""Problems and differences that are printed; the report has all."""

UNNAMED_UNITS = "  units: the program names none (G20, G21) and is read in mm; say --units in if it is in inches"
"""The line about a program whose units nobody has said."""


def examined_lines(examined: ExaminedProgram) -> list[str]:
    """Return the problems, and what was measured, for people."""
    lines = [f"  ! {_problem_words(problem, examined.name)}" for problem in examined.problems[:TOLD]]
    if len(examined.problems) > TOLD:
        lines.append(f"  - {len(examined.problems) - TOLD} more; --report R.json lists them all")
    report = examined.report()
    length, parts = report["length_mm"], report["time_parts_s"]
    count, motions = len(examined.problems), counted(sum(report["moves"].values()), "motion")
    what = counted(count, "problem") if count else "no problem"
    lines.insert(
        0,
        f"{examined.name}: {what} as {CONTROLS[report['control']]} reads it; {motions} "
        f"in {counted(report['lines'], 'line')}, {length['cut']:.1f} mm cut, {length['rapid']:.1f} mm rapid",
    )
    if examined.unnamed:
        lines.append(UNNAMED_UNITS)
    for title, box in (("cuts", examined.cut_box), ("all", examined.box)):
        sides = (
            f"{axis} {low:.3f} to {high:.3f}"
            for axis, low, high in zip("XYZ", box.low, box.high, strict=True)
            if low == low
        )
        reached = ", ".join(sides)
        lines.append(f"  {title}: {f'{reached} mm' if reached else 'nothing'}")
    cut, rapid, wait = (minutes_words(parts[name]) for name in ("cut", "rapid", "wait"))
    lines.append(
        f"  time: {minutes_words(report['time_s'])} min (cut {cut}, rapid {rapid}, dwells and tool changes {wait}), "
        f"machine: {examined.machine.title}"
    )
    lines += [
        f"  {_tool_words(tool)}: {minutes_words(tool['time_s'])} min" for tool in report["tools"] if _counts(tool)
    ]
    return lines


def _counts(tool: dict[str, Any]) -> bool:
    """Whether a tool's time is worth a line: not what a program does before its first tool, where that is no time."""
    return bool(tool["number"]) or tool["time_s"] >= LEAST_TOLD_S


def _problem_words(problem: ProgramProblem, file: str) -> str:
    return f"{problem.message(file)}{' (a warning)' if problem.severity is Severity.WARNING else ''}"


def _tool_words(tool: dict[str, object]) -> str:
    if not tool["number"]:
        return "a tool without a number"
    diameter = f" {tool['diameter_mm']:g} mm" if tool["diameter_mm"] else ""
    return f"T{tool['number']}{' ' if tool['kind'] else ''}{tool['kind']}{diameter}"


def difference_lines(name: str, differences: ProgramDifferences) -> list[str]:
    """Return what differs in another program, and whether its motion is the same."""
    lines = [
        f"  {'-' if differences.same_motion else '!'} line {item.a.first_line} and {name}:{item.b.first_line}: "
        f"{item.kind.value}{': ' if item.text else ''}{item.text}"
        for item in differences.items[:TOLD]
    ]
    more = [f"  - {len(differences.items) - TOLD} more differences"] if len(differences.items) > TOLD else []
    return [f"{name}: {'the same motion' if differences.same_motion else 'other motion'}", *lines, *more]
