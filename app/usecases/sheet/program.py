"""The sheet of any NC program: read as its control would, and cut out of its stock where tools and stock are known."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core.options import option
from ...core.wording import counted, minutes_words
from ...formats.plot.page import TracedPolyline
from ...formats.plot.picture import POCKET, RAPID
from ...formats.sheet.content import SetupPicture, SetupSheet, SheetColumn, SheetFact, SheetProof, SheetTable
from ...gcode.interpreter.program import Severity
from ...model.finding import FindingKind
from ...model.motion import MotionKind, Motions
from ...model.motion_path import motion_rows, spline_points
from ..cutting.cut import CutProgram
from ..cutting.ready_setup import ReadySetup
from ..cutting.report import CutReport
from ..examine import CONTROLS, ExaminedProgram
from .common import (
    MADE_BY,
    PENS,
    ToolUse,
    corner_words,
    hashed,
    legend,
    offset_fact,
    own_words,
    span_words,
    tool_table,
    traced,
    zero_note,
)

Json = dict[str, Any]


@dataclass(frozen=True)
class SheetNotes:
    """What somebody has written for the sheet: how the stock is held, and how the zero is set."""

    clamping: str = ""
    zero: str = ""


@dataclass(frozen=True, eq=False)
class SheetCut:
    """A program that was cut out of its stock, for its sheet."""

    ready: ReadySetup
    done: CutProgram
    report: CutReport


def program_sheet(
    programs: tuple[ExaminedProgram, ...],
    files: Mapping[str, bytes],
    cut: SheetCut | None,
    why: str = "",
    notes: SheetNotes = SheetNotes(),
) -> SetupSheet:
    """Return the sheet of programs that are run one after the other in one set-up.

    Args:
        programs: at least one.
        files: bytes of each file that the certificate is about, by what it is.
        cut: what became of the stock; None where that could not be found out.
        why: it could not.
        notes: in somebody's own words.
    """
    problems = [problem.message(each.name) for each in programs for problem in each.problems]
    errors = any(problem.severity is Severity.ERROR for each in programs for problem in each.problems)
    found = cut.report.findings if cut else ()
    counting = (*problems, *(finding.text for finding in found if finding.counts))
    control = CONTROLS[programs[0].read.dialect.value]
    texts = [data.decode("latin-1") for what, data in files.items() if what.startswith(_PROGRAM)]
    known = cut is not None and cut.done.judgement is not None
    return SetupSheet(
        title=programs[0].name,
        program=f"{', '.join(each.name for each in programs)} · as {control} reads it",
        verdict=_verdict(len(counting), cut),
        good=False if counting else True if known else None,
        picture=_picture(programs, cut),
        facts=tuple(_facts(programs, texts, cut, notes)),
        tables=(*([_tools(cut)] if cut else []), _runs(programs)),
        proofs=tuple(_proofs(programs, cut, why, errors)),
        findings=counting[:_COUNTING],
        remarks=tuple(finding.text for finding in found if not finding.counts)[:_REMARKS],
        hashes=hashed(*files.items()),
        made_by=MADE_BY,
    )


_COUNTING, _REMARKS = 12, 6
"""Findings that count, and remarks, that have room on the page."""
_PROGRAM = "Program: "
"""What the names of files that are programs begin with."""


def _verdict(count: int, cut: SheetCut | None) -> str:
    if count:
        counts = "1 finding counts" if count == 1 else f"{count} findings count"
        return f"{counts}: do not run this program before it is cleared"
    if cut is None:
        return "Not proven: the program was read, but not cut"
    if cut.done.judgement is None:
        return "Cut without harm; compared with no part"
    return "Proven: no gouge, no rapid in metal, nothing left within reach"


def _picture(programs: tuple[ExaminedProgram, ...], cut: SheetCut | None) -> SetupPicture:
    cuts = [line for each in programs for line in _lines(each.program.motions, rapid=False)]
    rapids = [line for each in programs for line in _lines(each.program.motions, rapid=True)]
    lines = (*rapids, *cuts)
    box = None if cut is None else cut.done.setup.stock.box
    words = legend({POCKET: "Cut", RAPID: RAPID.name}, lines)
    return SetupPicture(None if box is None else (box[0], box[1], box[2], box[3]), (0.0, 0.0), lines, words)


def _lines(motions: Motions, rapid: bool) -> Iterator[TracedPolyline]:
    """Yield the path of rapids, or of all else, seen from above."""
    pen = PENS[RAPID if rapid else POCKET]
    rows = motion_rows(motions)
    moving = np.all(np.isfinite(rows), axis=1) & (np.any(rows[:, :2] != rows[:, 2:4], axis=1) | (rows[:, 7] != 0))
    shown = moving & ((motions.kind == MotionKind.RAPID) == rapid) & (motions.kind != MotionKind.SPLINE)
    yield from traced(rows[shown], pen)
    if not rapid:
        for spline in motions.splines.values():
            yield TracedPolyline(pen, spline_points(spline)[:, :2])


def _facts(
    programs: tuple[ExaminedProgram, ...], texts: list[str], cut: SheetCut | None, notes: SheetNotes
) -> Iterator[SheetFact]:
    boxes = [each.cut_box for each in programs]
    low = np.fmin.reduce([box.low for box in boxes])
    high = np.fmax.reduce([box.high for box in boxes])
    own, held = own_words(notes.clamping), ""
    if cut is None:
        yield SheetFact("Stock", "not known")
    else:
        data = cut.report.data["stock"]
        size = np.array(data["high"]) - np.array(data["low"])
        yield SheetFact("Stock", f"{size[0]:.4g} x {size[1]:.4g} x {size[2]:.4g} mm ({data['from']})")
        top = data["high"][2]
        yield SheetFact("Zero X Y", corner_words(-data["low"][0], -data["low"][1]))
        height = "top of the stock" if top == 0 else f"{abs(top):.4g} mm {'below' if top > 0 else 'above'} its top"
        yield SheetFact("Zero Z", height)
        held = _clamping(low[2], data["low"][2], bool(own))
    yield from zero_note(notes.zero)
    yield offset_fact(texts)
    if own or held:
        yield SheetFact("Clamping", held, own)
    sides = zip("XYZ", low, high, strict=True)
    yield SheetFact("Cuts", ", ".join(f"{axis} {a:.3f} to {b:.3f}" for axis, a, b in sides if a == a))
    yield SheetFact("Highest motion", f"Z {max(each.box.high[2] for each in programs):.3f}")
    total = sum(each.time.total for each in programs)
    yield SheetFact("Total time", f"{minutes_words(total)} min on {programs[0].machine.title}")


def _clamping(lowest: float, underside: float, noted: bool) -> str:
    """Return what the way that the stock is held has to allow."""
    if lowest < underside:
        return f"Cuts go {underside - lowest:.4g} mm below the underside: put waste at least as thick under it."
    unknown = "" if noted else " Nobody has said where clamps are."
    return f"The lowest cut is {lowest - underside:.4g} mm above the underside.{unknown}"


def _tools(cut: SheetCut) -> SheetTable:
    """Return the table of tools: shapes as they are known, speeds and feeds as the programs say them."""
    number, programs = cut.done.setup.numbers(), [each.program for each in cut.ready.programs]
    ends, feeds = (np.concatenate([getattr(each.motions, name) for each in programs]) for name in ("end", "feed"))
    rapid = np.concatenate([each.motions.kind for each in programs]) == MotionKind.RAPID
    speeds = np.concatenate([np.array([state.speed for state in each.states])[each.motions.state] for each in programs])
    uses = []
    for told in cut.report.data["tools"]:
        mine = number == told["number"]
        depth = cut.done.top - float(np.nanmin(ends[mine, 2], initial=cut.done.top))
        tool = replace(cut.ready.tools[told["number"]].tool, number=max(told["number"], 1))
        uses.append(ToolUse(tool, told["time_s"], depth, speeds[mine], feeds[mine & ~rapid], flutes_known=False))
    return tool_table(uses)


_RUNS = (
    SheetColumn("#", 0.06, number=True),
    SheetColumn("File", 0.28),
    SheetColumn("T", 0.06, number=True),
    SheetColumn("Lines", 0.17, number=True),
    SheetColumn("Lowest Z", 0.13, number=True),
    SheetColumn("Feeds mm/min", 0.18, number=True),
    SheetColumn("Min", 0.12, number=True),
)


def _runs(programs: tuple[ExaminedProgram, ...]) -> SheetTable:
    """Return the table of what the programs do, tool by tool."""
    rows: list[tuple[str, ...]] = []
    for each in programs:
        motions, time = each.program.motions, each.time
        tools = time.tool[: len(motions)]
        cuts = np.flatnonzero(tools[1:] != tools[:-1]) + 1
        for run in np.split(np.arange(len(motions)), cuts):
            if len(run):
                seconds = float(np.sum(time.moving[run]) + np.sum(time.waiting[run]))
                rows.append((str(len(rows) + 1), each.name, *_run_cells(motions, run, int(tools[run[0]]), seconds)))
    total = ("", "Total, all included", *[""] * 4, minutes_words(sum(each.time.total for each in programs)))
    return SheetTable("Program, tool by tool", _RUNS, tuple(rows), total)


def _run_cells(motions: Motions, run: NDArray[np.intp], tool: int, seconds: float) -> tuple[str, ...]:
    words = span_words(motions.feed[run][motions.kind[run] != MotionKind.RAPID])
    lines = f"{motions.line[run].min()} to {motions.line[run].max()}"
    return (str(tool or "-"), lines, f"{np.nanmin(motions.end[run, 2]):.3f}", words, minutes_words(seconds))


_BY_THEN = "against the metal as it is by then"


def _proofs(
    programs: tuple[ExaminedProgram, ...], cut: SheetCut | None, why: str, errors: bool
) -> Iterator[SheetProof]:
    count = sum(len(each.problems) for each in programs)
    lines = counted(sum(each.program.line_count for each in programs), "line")
    yield SheetProof("Its control takes it", f"{counted(count, 'problem')} in {lines}", not errors and not count)
    if cut is None:
        yield SheetProof("No gouge, no rapid in metal", why, None)
        return
    data, kinds = cut.report.data, {finding.kind for finding in cut.report.findings if finding.counts}
    rapids, moves = len(data["rapids_in_material"]), data["moves"]["G0"]
    yield SheetProof("No rapid in metal", f"{rapids} of {moves} rapids, each {_BY_THEN}", not rapids)
    yield from _part_proofs(data, kinds)
    meets = bool(kinds & {FindingKind.HOLDER_CONTACT, FindingKind.SHANK_CONTACT})
    unknown = [f"T{each['number']}" for each in data["tools"] if each["least_stick_out_mm"] is None]
    told = f"no holder is given for {', '.join(unknown)}" if unknown else f"every motion {_BY_THEN}"
    yield SheetProof("Shank and holder keep clear", told, False if meets else None if unknown else True)


def _part_proofs(data: Json, kinds: set[FindingKind]) -> Iterator[SheetProof]:
    gouge, left, certificate = data["gouge"], data["left"], data["certificate"]
    if gouge is None:
        yield SheetProof("No gouge, nothing left", f"no part was given to compare with: {option('against')}", None)
        return
    between = f"; nowhere more than {certificate['gouge_mm']:.4f} mm" if telling(certificate) else ""
    yield SheetProof("No gouge", f"deepest {gouge['max_mm']:.4f} mm{between}", FindingKind.GOUGE not in kinds)
    yield SheetProof(
        "Nothing left within reach",
        f"{left['reachable_mm2']:.3f} mm² left, {left['unreachable_mm2']:.3f} mm² are out of reach of every tool",
        FindingKind.LEFT_REACHABLE not in kinds,
    )


def telling(certificate: Json | None) -> bool:
    """Tell whether the bound between the cells says something that a person could use."""
    return certificate is not None and bool(certificate["gouge_mm"] < 10 * certificate["pitch_mm"])
