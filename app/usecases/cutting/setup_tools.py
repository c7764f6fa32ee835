"""Which cutter each T number of a program is: by what was asked, the job, a tool table, or the program's own
comments.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ...core.errors import HitofudeError, InputError
from ...core.options import option
from ...gcode.interpreter.program import NcProgram, ToolNote
from ...gcode.timing.duration import duration
from ...model.finding import Finding, FindingKind
from ...model.motion import MotionKind
from ...model.tool import HolderPoint, Tool
from ...model.tool_kind import ToolKind, shape_keys
from ..examine import ExaminedProgram

NAMELESS = 0
"""Number of the tool of a program that names none."""


@dataclass(frozen=True, slots=True)
class KnownTool:
    """A tool, and who tells of it.

    Attributes:
        source: in words, such as "the job file".
        assumed: what of its shape was not told, a sentence, or "".
    """

    tool: Tool
    source: str
    assumed: str = ""


@dataclass(frozen=True, slots=True)
class ToolSource:
    """Tools that somebody has given, best first.

    Attributes:
        source: in words.
        tools: by T number; 0 = the tool of programs that name none.
        shapeless: kinds are not told, so all are flat.
    """

    source: str
    tools: Mapping[int, Tool] = field(default_factory=dict)
    shapeless: bool = False


@dataclass(frozen=True)
class ProgramsWithTools:
    """Programs that name all their tools.

    Attributes:
        tools: what each is that cuts, by T number.
        findings: what was assumed.
    """

    programs: tuple[ExaminedProgram, ...]
    tools: dict[int, KnownTool]
    findings: tuple[Finding, ...]


def with_tools(programs: tuple[ExaminedProgram, ...], noted: tuple[ToolSource, ...]) -> ProgramsWithTools:
    """Return the programs with what each tool is.

    A program that cuts without naming a tool gets the number of the one that its comments tell of, else that of the
    only tool that is given, else one that is free.

    Raises:
        InputError: nobody tells what a tool is; it names the line from which on it cuts.
    """
    known: dict[int, KnownTool] = {}
    taken = {number for examined in programs for number in _cutting(examined.program)} - {NAMELESS}
    named: list[ExaminedProgram] = []
    for examined in programs:
        if NAMELESS in _cutting(examined.program):
            examined = _with_name(examined, noted, known, taken)
        named.append(examined)
    for examined in named:
        for number, line in _cutting(examined.program).items():
            if number not in known:
                known[number] = _known(examined, number, line, noted, [each.program for each in named])
    findings = tuple(
        Finding(FindingKind.ASSUMED, each.assumed, counts=False) for each in known.values() if each.assumed
    )
    return ProgramsWithTools(tuple(named), dict(sorted(known.items())), findings)


@dataclass(frozen=True, slots=True)
class ToolHolding:
    """How a tool is held: how far it sticks out, mm, and the outline of its holder, as `Tool` has them."""

    stick_out: float
    holder: tuple[HolderPoint, ...]


def with_holders(tools: Mapping[int, KnownTool], held: Mapping[int, ToolHolding]) -> dict[int, KnownTool]:
    """Return tools held as was said, whoever tells of them.

    Args:
        held: by T number.

    Raises:
        InputError: a number is of no tool that cuts, or the tool cannot be held so.
    """
    made = dict(tools)
    for number, each in held.items():
        if number not in made:
            raise InputError(
                f"T{number} does not cut, so its holder says nothing; the tools that do are "
                f"{', '.join(f'T{known}' for known in made)}."
            )
        try:
            tool = replace(made[number].tool, stick_out=each.stick_out, holder=each.holder)
        except HitofudeError as error:
            raise InputError(f"The holder of T{number} does not fit: {error}") from error
        made[number] = replace(made[number], tool=tool)
    return made


def other_tools(
    numbers: Iterable[int], noted: tuple[ToolSource, ...], programs: tuple[ExaminedProgram, ...]
) -> Iterator[Tool]:
    """Yield, of tools that do not cut, those that somebody tells of."""
    for number in numbers:
        found = _told(number, noted, [each.program for each in programs])
        if found is not None:
            yield found.tool


def _cutting(program: NcProgram) -> dict[int, int]:
    """Return the T numbers that cut, and the line where each begins to."""
    motions = program.motions
    cuts = np.flatnonzero(motions.kind != MotionKind.RAPID)
    tools = np.array([state.tool for state in program.states])[motions.state[cuts]]
    numbers, first = np.unique(tools, return_index=True)
    return {int(number): int(motions.line[cuts[k]]) for number, k in zip(numbers, first, strict=True)}


def _with_name(
    examined: ExaminedProgram, noted: tuple[ToolSource, ...], known: dict[int, KnownTool], taken: set[int]
) -> ExaminedProgram:
    """Return a program with a number for the tool that it does not name; the number is taken, the tool known."""
    own = dict.fromkeys(note.number for note in examined.program.tools)
    # our own header tells first of the tool that cuts
    sure = len(own) == 1 or (own and examined.program.header is not None)
    if sure and NAMELESS not in own and not own.keys() & _cutting(examined.program).keys():
        number = next(iter(own))
        known[number] = _known(examined, number, 0, noted, [examined.program])
    else:
        found = _only(examined, noted)
        alike = (number for number, each in known.items() if replace(each.tool, number=found.tool.number) == found.tool)
        free = found.tool.number if found.tool.number not in taken else min(set(range(1, 9999)) - taken)
        number = next(alike, free)
        known[number] = replace(found, tool=replace(found.tool, number=number))
    taken.add(number)
    states = tuple(replace(state, tool=state.tool or number) for state in examined.program.states)
    program = replace(examined.program, states=states)
    return replace(examined, program=program, time=duration(program, examined.machine))


def _only(examined: ExaminedProgram, noted: tuple[ToolSource, ...]) -> KnownTool:
    """Return the tool of a program that names none: the one for it, or the only one that somebody tells of."""
    cutting = _cutting(examined.program)
    for each in noted:
        others = {number: tool for number, tool in each.tools.items() if number not in cutting}
        number = NAMELESS if NAMELESS in each.tools else next(iter(others), NAMELESS) if len(others) == 1 else NAMELESS
        if number in each.tools:
            return _by(each, number)
    notes = [note for note in examined.program.tools if note.number == NAMELESS]
    if len(notes) == 1:
        return _noted(replace(notes[0], number=1), f"{examined.name}:{notes[0].line}")
    line = cutting[NAMELESS]
    raise InputError(
        f"{examined.name}:{line}: a tool that the program does not name cuts from here on, and nobody says what it is; "
        f"give its shape, such as {option('tool', '0=flat:6')} (0 = the tool without a name, then kind:diameter)."
    )


def _known(
    examined: ExaminedProgram, number: int, line: int, noted: tuple[ToolSource, ...], programs: list[NcProgram]
) -> KnownTool:
    found = _told(number, noted, programs)
    if found is None:
        raise InputError(
            f"{examined.name}:{line}: T{number} cuts from here on, and nobody says what it is; give its shape, "
            f"such as {option('tool', f'{number}=flat:6')} (number=kind:diameter), or a job file or tool table that "
            "has it."
        )
    return found


def _told(number: int, noted: tuple[ToolSource, ...], programs: list[NcProgram]) -> KnownTool | None:
    """Return what the first one says who knows a tool."""
    for each in noted:
        if number in each.tools:
            return _by(each, number)
    for program in programs:
        for note in program.tools:
            if note.number == number:
                return _noted(note, f"the comment in line {note.line}")
    return None


def _by(noted: ToolSource, number: int) -> KnownTool:
    tool = noted.tools[number]
    assumed = ""
    if noted.shapeless:
        assumed = (
            f"T{number}: {noted.source} tells no shapes, so it is taken to be flat, {tool.diameter:g} mm; "
            f"{option('tool')} says otherwise."
        )
    elif tool.kind.assumed_angle and not tool.tip_angle:
        shaped = option("tool", f"{number}={tool.kind.spelled(f'{tool.diameter:g}')}")
        assumed = (
            f"T{number}: {noted.source} tells a {tool.kind.value} of {tool.diameter:g} mm but no angle; "
            f"it is taken to have {np.degrees(tool.kind.assumed_angle):g} degrees; {shaped} says "
            "otherwise."
        )
    return KnownTool(tool, noted.source, assumed)


def _noted(note: ToolNote, place: str) -> KnownTool:
    """Return the tool that a comment tells of.

    Raises:
        InputError: it lacks what its shape needs, or is none.
    """
    kind = _kind(note)
    if kind.conical and not kind.assumed_angle and not note.angle:
        shaped = option("tool", f"{note.number}={kind.spelled('DIAMETER')}")
        raise InputError(
            f"T{note.number}: {place} tells of a {kind.value} tool of {note.diameter:g} mm but not of its angle; "
            f"give it: {shaped}."
        )
    noted = {"corner_radius": note.corner_radius, "tip_angle": note.angle, "tip_diameter": note.tip_diameter}
    shape: dict[str, Any] = {key: value for key, value in noted.items() if key in shape_keys(kind)}
    try:
        tool = Tool(note.number, note.diameter, kind, **shape)
    except HitofudeError as error:
        raise InputError(f"{place} tells of a tool that is none: {error}") from error
    return KnownTool(tool, place, _assumed(note, kind, place))


def _kind(note: ToolNote) -> ToolKind:
    """Return the kind that a comment names, or that its corner radius makes it; flat where there is neither."""
    if 0 < note.diameter <= 2 * note.corner_radius:
        return ToolKind.BALL
    return ToolKind.words().get(note.kind) or (ToolKind.BULL if note.corner_radius else ToolKind.FLAT)


def _assumed(note: ToolNote, kind: ToolKind, place: str) -> str:
    """Return what a comment leaves open, as a sentence."""
    said = f"T{note.number}: {place} tells {note.diameter:g} mm but no"
    example = f"{option('tool', f'{note.number}=KIND:DIAMETER')} says otherwise"
    if not note.kind and kind is ToolKind.FLAT:
        return f"{said} shape; it is taken to be flat; {example}."
    if kind.assumed_angle and not note.angle:
        return f"{said} angle; the {kind.value} is taken to have {np.degrees(kind.assumed_angle):g} degrees; {example}."
    if kind is ToolKind.BULL and not note.corner_radius:
        return f"{said} corner radius; the bull-nose mill is taken to have a square corner; {example}."
    return ""
