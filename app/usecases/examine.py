"""Any NC program, read as its control would: what is wrong with it, how far it reaches, how long it takes, on which
machine.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import PurePath
from typing import Any

import numpy as np

from ..core.errors import InputError
from ..core.progress import NO_PROGRESS, Progress
from ..formats.machine_toml import DEFAULT_MACHINE, load_machine
from ..gcode.checks.dwells import doubtful_dwells
from ..gcode.interpreter.dialect import DIALECT_RULES, Dialect
from ..gcode.interpreter.dialect_guess import guess_dialect
from ..gcode.interpreter.foreign_codes import names_units
from ..gcode.interpreter.options import ReadOptions, ToolOffset
from ..gcode.interpreter.program import EventKind, NcProgram, ProgramProblem, Severity
from ..gcode.interpreter.reader import read_program
from ..gcode.rework.compare import ProgramDifferences, compare
from ..gcode.timing.duration import TIME_METHOD, Duration, duration
from ..gcode.timing.extent import Extent, extent, misfits
from ..model.job import Job
from ..model.machine import Machine
from ..model.motion import MotionKind
from ..model.motion_path import anchored, lengths
from ..model.part import Part, Units
from .kind_of_file import ensure_program

Json = dict[str, Any]
COORDINATES = "from the zero of the table of work offsets, tool length compensated"
KINDS = {
    "G0": MotionKind.RAPID,
    "G1": MotionKind.LINE,
    "G2": MotionKind.ARC_CW,
    "G3": MotionKind.ARC_CCW,
    "spline": MotionKind.SPLINE,
}


@dataclass(frozen=True)
class ExamineOptions:
    """How to look at a program.

    Attributes:
        dialect: the control's; None = as the text looks.
        tools: the control's tool table.
        machine: that the program has to fit; None = timed on a usual one.
        block_delete: blocks that begin with a slash are left out, as the control does with its switch on.
        units: of a program that names none; None = mm, which is told.
    """

    dialect: Dialect | None = None
    tools: Mapping[int, ToolOffset] = field(default_factory=dict)
    machine: Machine | None = None
    block_delete: bool = True
    units: Units | None = None


@dataclass(frozen=True, eq=False)
class ExaminedProgram:
    """What there is to know about a program.

    Attributes:
        name: of its file.
        read: options it was read with.
        program: as it was read; its motions begin where the program first sends each axis.
        problems: of the text, and what the machine cannot do.
        machine: on which it is timed.
        time: how long it takes there.
        unnamed: it moves, and names no units, nor has anybody said them.
    """

    name: str
    read: ReadOptions
    program: NcProgram
    problems: tuple[ProgramProblem, ...]
    machine: Machine
    time: Duration
    unnamed: bool = False

    @property
    def box(self) -> Extent:
        """Round all motions, mm."""
        return extent(self.program)

    @property
    def cut_box(self) -> Extent:
        """Round the motions that cut, mm."""
        return extent(self.program, self.program.motions.kind != MotionKind.RAPID)

    @property
    def tools(self) -> tuple[int, ...]:
        """T numbers in the order of use; 0 = a tool that the program does not name."""
        return tuple(dict.fromkeys(self.time.tool[: len(self.program.motions)].tolist()))

    def frame(self) -> str:
        """Return the program that goes round the cuts at the greatest height of this one, spindle off.

        Raises:
            InputError: nothing is cut, or it is cut in more than one place of the work.
        """
        from ..gcode.posts import load_post
        from ..gcode.rework.frame import JobFrame, frame_text

        used = [self.program.states[k] for k in np.unique(self.program.motions.state).tolist()]
        if any(any(state.shift) or state.rotation or state.work_offset != "G54" for state in used):
            raise InputError(
                f"{self.name}: the frame is made for programs that cut under plain G54; this one shifts its zero."
            )
        if not all(map(math.isfinite, (*self.cut_box.low[:2], self.box.high[2]))):
            raise InputError(f"{self.name}: nothing is cut, or no height is said, so there is no box to go round.")
        job = Job(Part(name=PurePath(self.name).stem), out_units=used[0].units)
        tool = next((number for number in self.tools if number), 0)
        return frame_text(JobFrame(self.cut_box, self.box.high[2], tool), job, load_post(self.read.dialect.value))

    def report(self) -> Json:
        """Return everything as plain values, by keys with their units."""
        motions, time = self.program.motions, self.time
        long, rapid = lengths(motions), motions.kind == MotionKind.RAPID
        stops = sum(event.kind in (EventKind.STOP, EventKind.OPTIONAL_STOP) for event in self.program.events)
        return {
            "file": self.name,
            "control": self.read.dialect.value,
            "block_delete": self.read.block_delete,
            "units_assumed": self.unnamed,
            "lines": self.program.line_count,
            "problems": [
                {
                    "line": each.line,
                    "column": each.column,
                    "word": each.word,
                    "text": each.text,
                    "severity": each.severity.value,
                }
                for each in self.problems
            ],
            "moves": {name: int(np.sum(motions.kind == kind)) for name, kind in KINDS.items()},
            "length_mm": {"cut": float(np.sum(long[~rapid])), "rapid": float(np.sum(long[rapid]))},
            "extent_mm": {"cut": _box(self.cut_box), "all": _box(self.box), "coordinates": COORDINATES},
            "time_s": time.total,
            "time_parts_s": time.parts,
            "time_method": TIME_METHOD.format(self.machine.title),
            "tools": [self._tool(number) for number in self.tools],
            "stops": stops,
            "feedless": time.feedless,
        }

    def _tool(self, number: int) -> Json:
        """Return what is known of a tool: from the program's comments, or else from the table."""
        note = next((note for note in self.program.tools if note.number == number), None)
        row = self.read.tool_table.get(number)
        diameter = note.diameter if note else row.diameter if row else 0.0
        return {
            "number": number,
            "kind": note.kind if note else "",
            "diameter_mm": diameter or None,
            "time_s": self.time.by_tool.get(number, 0.0),
        }

    def text(self, differences: ProgramDifferences | None = None) -> str:
        """Return the report as JSON text, with the differences from another program where there is one."""
        found = {} if differences is None else {"compare": _told(differences)}
        return json.dumps(self.report() | found, indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def examine(name: str, data: bytes, options: ExamineOptions, progress: Progress = NO_PROGRESS) -> ExaminedProgram:
    """Return what there is to know about a program.

    Args:
        name: of its file.
        data: its bytes.
        options: control, tools, machine.
        progress: told of how much is read.

    Raises:
        InputError: its name is that of a drawing, a picture, a solid or a scene.
        Cancelled: the job was asked to stop.
    """
    ensure_program(name)
    read = ReadOptions(
        dialect=options.dialect or guess_dialect(data),
        tool_table=options.tools,
        block_delete=options.block_delete,
        units=options.units,
    )
    program = read_program(data, read, progress)
    program = replace(program, motions=anchored(program.motions))
    machine = options.machine or load_machine(DEFAULT_MACHINE)
    time = duration(program, machine)
    fits = misfits(program, machine) if options.machine else ()
    problems = (
        *program.problems,
        *doubtful_dwells(program, data, read.dialect),
        *_feedless(program, time),
        *fits,
    )
    unnamed = options.units is None and len(program.motions) > 0 and not names_units(data)
    return ExaminedProgram(name, read, program, problems, machine, time, unnamed)


def compared(first: ExaminedProgram, name: str, data: bytes, progress: Progress = NO_PROGRESS) -> ProgramDifferences:
    """Return what differs in another program, read for the same control with the same tools.

    Raises:
        InputError: that program cannot be read to its end.
        Cancelled: the job was asked to stop.
    """
    other = read_program(data, first.read, progress.part(0.0, 0.5))
    for file, program in ((first.name, first.program), (name, other)):
        if program.error is not None:
            raise InputError(f"{program.error.message(file)} It cannot be compared beyond that line.")
    return compare(first.program, replace(other, motions=anchored(other.motions)), progress=progress.part(0.5, 1.0))


def _feedless(program: NcProgram, time: Duration) -> tuple[ProgramProblem, ...]:
    if not time.feedless:
        return ()
    motions = program.motions
    row = int(np.argmax((motions.kind != MotionKind.RAPID) & ~(motions.feed > 0)))
    return (
        ProgramProblem(int(motions.line[row]), 0, "F", f"{time.feedless} motions have no feed rate.", Severity.WARNING),
    )


def _told(differences: ProgramDifferences) -> Json:
    items = [
        {
            "kind": item.kind.value,
            "line": item.a.first_line,
            "other_line": item.b.first_line,
            "distance_mm": item.distance,
            "text": item.text,
        }
        for item in differences.items
    ]
    return {
        "same_motion": differences.same_motion,
        "largest_distance_mm": differences.largest_distance,
        "differences": items,
    }


def _box(box: Extent) -> Json:
    return {end: [value if math.isfinite(value) else None for value in getattr(box, end)] for end in ("low", "high")}


CONTROLS = {dialect.value: DIALECT_RULES[dialect].title for dialect in Dialect}
"""Every control that can be read for: its name in options, and its title."""
