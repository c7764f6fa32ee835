"""The report of a make job: every number in it is measured on the moves, or says how it was computed."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core import tolerances
from ...core.wording import counted, minutes_words
from ...gcode.timing.duration import TIME_METHOD
from ...gcode.timing.extent import Extent
from ...gcode.writer.write import blend_mm, writing_tolerance
from ...model.fields import ParameterPlace, Unit, parameters_of
from ...model.finding import Finding, FindingKind
from ...model.job import Job
from ...model.motion import MotionKind
from ...model.moves import MoveKind, Moves, Program, Purpose
from ...model.operation import Operation
from ...model.stock_box import extent, program_origin
from ...model.tool import Tool
from ...toolpath.coverage.coverage import STRIP, Coverage, UncutPlace
from ...toolpath.coverage.floor_target import CHORD
from ...verify.judgement import SpotKind
from ...verify.verdict import Gouge, RapidInMaterial, in_stock
from ..cutting.cut import CutProgram
from .proofs.proofs import ProgramProofs
from .written import WrittenProgram

ENGINE = "exact lines and arcs; pocket rings are levels of one distance field"

BITMAP_ENGINE = "pixels alone, smoothed into lines and arcs that keep clear of the pixels' squares"

COVERAGE_METHOD = (
    f"polygons of the emitted moves, arcs as chords within {CHORD:g} mm; strips narrower than {STRIP:g} mm are not "
    "counted"
)

GOUGE_METHOD = "closed-form distance of every move below Z 0 from every wall, less tool radius and stock to leave"

MOVES_METHOD = (
    "motions of the control, as the NC text was read back: arcs split and flattened as they are written, cycles step "
    "by step; where the tool is at the start nobody knows, so the first approach is counted from the clearance "
    "position above the first XY, and after a tool change from where the tool before was lifted to safe Z"
)

CHECK_METHOD = (
    "the written bytes read back and compared with the moves: a bound both ways, all along; kinds, feeds, tools, "
    "spindle alike"
)

CUT_METHOD = (
    "the files, read back, cut out of the stock on a grid of heights, exactly at the cells' centres, and compared "
    "with the drawing; the bounds hold between the centres too"
)

Json = dict[str, Any]


@dataclass(frozen=True)
class ReportData:
    """What the report is made of.

    Attributes:
        written: the files, read back.
        findings: all of them: of the drawing, the path, the verdict, the floor.
        cut: the files, cut out of the stock; None without files.
        proofs: of single operations.
    """

    program: Program
    job: Job
    written: WrittenProgram
    gouge: Gouge
    rapids: tuple[RapidInMaterial, ...]
    coverage: Coverage
    findings: tuple[Finding, ...]
    cut: CutProgram | None
    proofs: ProgramProofs


@dataclass(frozen=True)
class MakeReport:
    """A report as plain values.

    Attributes:
        data: by the keys of the command line's report; units are in the names, positions in part coordinates.
    """

    data: Json

    def text(self) -> str:
        """Return it as JSON text."""
        return json.dumps(self.data, indent=2, ensure_ascii=False, allow_nan=False) + "\n"

    def with_timings(self, seconds: Mapping[str, float]) -> MakeReport:
        """Return it with the wall time of each stage of the job, s, in their order."""
        return MakeReport({**self.data, "timings_s": dict(seconds)})

    def with_proposal(self, proposal: Json) -> MakeReport:
        """Return it with what was proposed, and why."""
        return MakeReport({**self.data, "proposal": proposal})

    def with_depths(self, depths: Json) -> MakeReport:
        """Return it with the depths that were read of the drawing."""
        return MakeReport({**self.data, "depths": depths})

    def with_feeds(self, feeds: Json) -> MakeReport:
        """Return it with the speeds and feeds that were proposed, and why."""
        return MakeReport({**self.data, "feeds": feeds})

    def summary(self, output: str) -> str:
        """Return it in one line for people."""
        data = self.data
        beyond = out_of_reach(data["left"])
        length = sum(data["length_mm"].values())
        rapids, strokes = counted(len(data["rapids_in_material"]), "rapid"), counted(data["strokes"], "pocket stroke")
        return (
            f"{output}: {data['gouge']['max_mm']:.4f} mm gouge, {data['left']['reachable_mm2']:.3f} mm2 left within "
            f"reach, {beyond}{rapids} in material; {strokes}, {counted(data['retracts'], 'retract')}, {length:.0f} mm, "
            f"{minutes_words(data['time_s'])} min; read back within {data['check']['largest_distance_mm']:.4f} mm"
        )


def out_of_reach(left: Json) -> str:
    """Return how many places are out of reach of every tool, with a comma behind; nothing where there is none."""
    count = left["out_of_reach_places"]
    return f"{counted(count, 'place')} out of reach, " if count else ""


def make_report(measured: ReportData) -> MakeReport:
    """Return the report of what was made and measured."""
    program, job, moves, written = measured.program, measured.job, measured.program.moves, measured.written
    top = -_origin(measured)[2]
    return MakeReport(
        {
            "gouge": _gouge(measured),
            "left": _left(measured.coverage, program.given_up_mm is not None),
            "rapids_in_material": [
                {"x": hit.x, "y": hit.y, "z": hit.z, **_line(measured, hit.move)} for hit in measured.rapids
            ],
            "strokes": measured.program.strokes,
            "retracts": retracts(moves),
            "length_mm": path_lengths(moves, written, top),
            "length_method": LENGTHS_METHOD,
            **_times(written),
            "moves": {f"G{kind.value}": int(np.sum(written.kind == kind)) for kind in MoveKind},
            "moves_method": MOVES_METHOD,
            "extent_mm": {
                "cut": _box(written.box(cuts=True)),
                "all": _box(written.box(cuts=False)),
                "coordinates": "of the program",
            },
            "check": _check(written),
            "cut": _cut(measured.cut),
            "skipped": [
                as_values(each)
                for each in _of(measured, FindingKind.REGION_TOO_SMALL, FindingKind.LEFT_OUT, FindingKind.TINY_ENTITY)
            ],
            "open_contours": [as_values(each) for each in _of(measured, FindingKind.OPEN_CONTOUR)],
            "engine": _engine(program),
            "polyline_rings": program.polyline_rings,
            "tolerance": _tolerance(measured),
            "findings": [as_values(each) for each in measured.findings],
            "regions": _regions(program),
            "area_check_mm2": {
                "exact": program.exact_area_mm2,
                "bitmap": program.bitmap_area_mm2,
                "pitch_mm": program.pitch_mm,
            },
            "tools": [_tool(tool, measured) for tool in job.tools],
            "operations": [
                operation_values(job, index, program, written, top) | measured.proofs.values(index)
                for index in range(len(job.operations))
            ],
            **_setup(measured),
            "post": job.post,
            "out_units": "in" if job.out_units.value == 25.4 else "mm",
        }
    )


_MOST_PLACES = 100
"""Places where something is left that are listed; all of them are counted."""


def _left(coverage: Coverage, on_pixels: bool) -> Json:
    """Return what is left on the floor; on pixels also what was given up there."""
    places = coverage.places
    return {
        "reachable_mm2": coverage.reachable_left_mm2,
        "unreachable_mm2": coverage.unreachable_mm2,
        "largest_disc_mm": coverage.largest_disc_mm,
        "floor_mm2": coverage.area_mm2,
        "floor_depth_mm": coverage.floor_mm,
        "method": COVERAGE_METHOD,
        "places": [_place(place) for place in places[:_MOST_PLACES]],
        "places_count": len(places),
        "out_of_reach_places": sum(not place.reachable for place in places),
        **({"given_up_mm2": coverage.given_up_mm2} if on_pixels else {}),
    }


def _of(measured: ReportData, *kinds: FindingKind) -> list[Finding]:
    return [finding for finding in measured.findings if finding.kind in kinds]


def _line(measured: ReportData, move: int) -> Json:
    """Return the line of a move, and which file it is in."""
    files = [k for k, file in enumerate(measured.written.files) if 0 <= file.first <= move]
    line = int(measured.program.moves.line[move]) if files else None
    return {"line": line} | ({"file": files[-1] + 1} if len(measured.written.files) > 1 and files else {})


def _check(written: WrittenProgram) -> Json:
    checks = written.checks
    return {
        "largest_distance_mm": written.largest_distance_mm,
        "tolerance_mm": max((each.tolerance_mm for each in checks), default=0.0),
        "differences": sum(len(each.problems) for each in checks),
        "motions": len(written.kind),
        "files": [file.suffix for file in written.files],
        "method": CHECK_METHOD,
    }


def _cut(result: CutProgram | None) -> Json | None:
    """Return what cutting the files has shown."""
    if result is None or result.judgement is None or result.judgement.certificate is None:
        return None
    judgement, certificate, grid = result.judgement, result.judgement.certificate, result.cut.before.grid
    return {
        "removed_mm3": result.cut.removed_volume,
        "rows": grid.rows,
        "cols": grid.cols,
        "pitch_mm": grid.pitch,
        "no_point_gouged_deeper_than_mm": certificate.gouge_mm,
        "no_metal_within_reach_higher_than_mm": certificate.left_mm,
        "gouged_places": sum(spot.kind is SpotKind.GOUGE for spot in judgement.spots),
        "method": CUT_METHOD,
    }


def _box(box: Extent) -> Json:
    """Return a box by its corners; null along an axis that no motion goes."""
    return {end: [value if np.isfinite(value) else None for value in getattr(box, end)] for end in ("low", "high")}


def _times(written: WrittenProgram) -> Json:
    parts = [each.parts for each in written.durations]
    waits = written.changes_s + sum(part["wait"] for part in parts)
    return {
        "time_s": written.changes_s + sum(each.total for each in written.durations),
        "time_parts_s": {
            "cut": sum(part["cut"] for part in parts),
            "rapid": sum(part["rapid"] for part in parts),
            "wait": waits,
        },
        "tool_changes": {
            "count": sum(each.changes for each in written.durations)
            + (len(written.files) if written.post.file_per_tool else 0),
            "time_s": written.changes_s + sum(each.changing for each in written.durations),
        },
        "time_method": TIME_METHOD.format(written.machine.title),
    }


def _tool(tool: Tool, measured: ReportData) -> Json:
    """Return a tool, how thick its chips are where it is in full cut, and how long its motions take."""
    mine = measured.program.moves.tool[measured.written.move] == tool.number
    return {
        "number": tool.number,
        "kind": tool.kind.value,
        "diameter_mm": tool.diameter,
        "flutes": tool.flutes,
        "spindle_rpm": tool.spindle_speed,
        "feed_mm_min": tool.feed_rate,
        "plunge_mm_min": tool.plunge_rate,
        "chip_load_mm": tool.feed_rate / (tool.spindle_speed * tool.flutes),
        "time_s": float(np.sum(measured.written.moving[mine])),
    }


def _origin(measured: ReportData) -> tuple[float, float, float]:
    """Return the work origin in part coordinates; the drawing's zero where nothing is machined."""
    program = measured.program
    return program_origin(measured.job, program) if len(program.moves) else (0.0, 0.0, 0.0)


def _setup(measured: ReportData) -> Json:
    """Return copies, clamps, and what stands or is cut on purpose."""
    job, program = measured.job, measured.program
    return {
        "copies": {
            "columns": job.copies.columns,
            "rows": job.copies.rows,
            "dx_mm": job.copies.dx,
            "dy_mm": job.copies.dy,
        },
        "keep_out": {
            "layers": list(job.keep_out_layers),
            "height_mm": job.keep_out_height,
            "travel_z_mm": job.travel_z,
        },
        "tabs": [{"x": tab.x, "y": tab.y, "width_mm": tab.width, "top_mm": tab.top} for tab in program.tabs],
        "dog_bones": len(program.dog_bones),
    }


def _gouge(measured: ReportData) -> Json:
    gouge = measured.gouge
    return {
        "max_mm": gouge.max_mm,
        "x": gouge.x,
        "y": gouge.y,
        "z": gouge.z,
        **_line(measured, gouge.move),
        "count": gouge.count,
        "counts_from_mm": tolerances.LEVEL,
        "path": "as computed",
        "written_within_mm": measured.written.largest_distance_mm,
        "method": GOUGE_METHOD,
    }


def _place(place: UncutPlace) -> Json:
    return {
        "x": place.x,
        "y": place.y,
        "area_mm2": place.area_mm2,
        "disc_mm": place.disc_mm,
        "reachable": place.reachable,
    }


def as_values(finding: Finding) -> Json:
    """Return a finding as a report lists it."""
    return {
        "kind": finding.kind.value,
        "text": finding.text,
        "x": finding.x,
        "y": finding.y,
        "counts": finding.counts,
        "amount": finding.amount,
    }


def _engine(program: Program) -> str:
    polylines = [rings_in_words(program.polyline_rings)] if program.polyline_rings else []
    return "; ".join([ENGINE if program.given_up_mm is None else BITMAP_ENGINE, *polylines])


def _path_tolerance(program: Program) -> Json:
    if program.given_up_mm is None:
        return {"path_mm": tolerances.LEVEL, "path": "checked"}
    return {"path_mm": program.given_up_mm, "path": "measured along the walls; never nearer to them than asked"}


def _tolerance(measured: ReportData) -> Json:
    contours = [contour for region in measured.program.regions for contour in region.contours]
    return {
        **_path_tolerance(measured.program),
        "curves_mm": max((contour.deviation for contour in contours), default=0.0),
        "curves": "measured",
        "join_mm": measured.job.join_tolerance,
        "writing_mm": writing_tolerance(measured.job, measured.written.post),
        "writing": "bound",
        "blend_mm": blend_mm(measured.job, measured.written.post),
        "blend": "proven on the path; the control may blend by up to this",
        "floor_strip_mm": STRIP,
    }


def _regions(program: Program) -> list[Json]:
    moves = program.moves
    cuts = moves.kind != MoveKind.RAPID
    most = max((region.number for region in program.regions), default=0)
    cut = np.bincount(np.clip(moves.region[cuts], 0, most + 1), moves.lengths()[cuts], most + 2)
    found = []
    for region in program.regions:
        x0, y0, x1, y1 = extent(region.contours) or (0.0, 0.0, 0.0, 0.0)
        found.append(
            {
                "number": region.number,
                "islands": len(region.islands),
                "layer": region.boundary.layer,
                "x0": x0,
                "y0": y0,
                "x1": x1,
                "y1": y1,
                "cut_mm": float(cut[region.number]),
            }
        )
    return found


def rings_in_words(count: int) -> str:
    """Return what rings are that no lines and arcs fit, without a full stop.

    Args:
        count: how many, > 0.
    """
    rings = "1 ring is a fine polyline" if count == 1 else f"{count} rings are fine polylines"
    return f"{rings} within {tolerances.LEVEL * 1000:g} um instead of lines and arcs"


# What a report says of the path: lengths by what they are for, strokes, operations one by one.


LENGTHS_METHOD = (
    "cut: in metal or where it was; link: between rings; lead: to walls and away from them; entry: ways down below the "
    "stock's top; air: at feed above the stock's top; rapid"
)

_WAYS = {"link": Purpose.LINK, "lead": Purpose.LEAD, "entry": Purpose.PLUNGE}

Mask = NDArray[np.bool_]


def path_lengths(moves: Moves, written: WrittenProgram, top: float, operation: int | None = None) -> dict[str, float]:
    """Return lengths of what was written, mm: cut, link, lead, entry, air, rapid; they add up to the whole.

    Args:
        top: height of the stock's top, mm, program coordinates.
        operation: its index; None = all.
    """
    move, rapid = written.move, written.kind == MoveKind.RAPID
    mine = np.ones(len(rapid), bool) if operation is None else moves.operation[move] == operation
    above = _share_above(written, top)
    purpose = moves.purpose[move]
    below = np.where(rapid, 0.0, 1.0 - above) * written.length
    found = {name: float(np.sum(below[mine & (purpose == way)])) for name, way in _WAYS.items()}
    cut = float(np.sum(below[mine & ~np.isin(purpose, list(_WAYS.values()))]))
    air = float(np.sum((above * written.length)[mine & ~rapid]))
    return {"cut": cut, **found, "air": air, "rapid": float(np.sum(written.length[mine & rapid]))}


def _share_above(written: WrittenProgram, top: float) -> NDArray[np.float64]:
    """Return (m,) which share of each motion lies above the stock's top; along each, Z changes evenly."""
    if not written.programs:
        return np.zeros(0)
    start, end = (
        np.concatenate([getattr(each.motions, name)[:, 2] for each in written.programs]) - top
        for name in ("start", "end")
    )
    high, low = np.maximum(start, end), np.minimum(start, end)
    span = np.where(high > low, high - low, 1.0)
    share: NDArray[np.float64] = (
        np.where(high > low, np.clip(high, 0.0, None) - np.clip(low, 0.0, None), low > 0) / span
    )
    return share


def retracts(moves: Moves) -> int:
    """Return how often the tool leaves the stock."""
    below = in_stock(moves)
    return int(np.sum(below & (moves.end[:, 2] >= 0)))


def strokes_of(moves: Moves, operation: int) -> int:
    """Return how many unbroken runs of feed moves hold moves of an operation that cut."""
    ways = (Purpose.RAPID, *_WAYS.values())
    return _runs(moves, (moves.operation == operation) & ~np.isin(moves.purpose, ways))


def _runs(moves: Moves, chosen: Mask) -> int:
    feed = moves.kind != MoveKind.RAPID
    return len(np.unique(np.cumsum(~feed)[feed & chosen]))


def operation_values(job: Job, index: int, program: Program, written: WrittenProgram, top: float) -> Json:
    """Return an operation as a report lists it.

    Args:
        top: height of the stock's top, mm, program coordinates.
    """
    operation, moves = job.operations[index], program.moves
    mine = moves.operation[written.move] == index
    return {
        "kind": operation.WORD,
        **_parameters(operation),
        **_stepover(job, index, program),
        "strokes": strokes_of(moves, index),
        "length_mm": path_lengths(moves, written, top, index),
        "time_s": float(np.sum(written.moving[mine])),
        "rapid_time_s": float(np.sum(written.moving[mine & (written.kind == MotionKind.RAPID)])),
    }


def _stepover(job: Job, index: int, program: Program) -> Json:
    """Return the stepover that was asked for, or what the program has chosen, of rest runs the most; None where a
    pocket makes no rings.
    """
    operation = job.operations[index]
    if "stepover" not in parameters_of(type(operation)):
        return {}
    requested = _parameters(operation)["stepover_mm"]
    usual = None if operation.COARSE else requested or job.tool(operation.cut.tool).diameter
    return {"stepover_mm": program.stepovers.get(index, requested or usual)}


def _parameters(operation: Operation) -> Json:
    """Return what was asked of an operation, with the unit behind the name; None where nothing was."""
    return {
        f"{key.removesuffix(_suffix(placed))}{_suffix(placed)}": _plain(placed, placed.of(operation))
        for key, placed in parameters_of(type(operation)).items()
    }


def _suffix(placed: ParameterPlace) -> str:
    return _SUFFIXES.get(placed.parameter.unit, "")


def _plain(placed: ParameterPlace, value: Any) -> Any:
    if isinstance(value, Enum):
        return value.value
    if placed.parameter.unit is Unit.CURVES:
        return [each.text for each in value]
    if isinstance(value, tuple):
        return [list(each) if isinstance(each, tuple) else each for each in value]
    return placed.parameter.shown(value) if placed.parameter.unit is Unit.ANGLE and value is not None else value


_SUFFIXES = {Unit.LENGTH: "_mm", Unit.ANGLE: "_deg", Unit.TIME: "_s"}
