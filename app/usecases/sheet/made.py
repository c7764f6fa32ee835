"""The sheet of a program that was made: everything on it is what was computed, or measured on what was written."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ...core import tolerances
from ...core.options import option
from ...core.wording import counted, minutes_words
from ...formats.job.write import job_lines
from ...formats.plot.picture import CONTOUR, PART, POCKET
from ...formats.sheet.content import (
    SetupPicture,
    SetupSheet,
    SheetColumn,
    SheetFact,
    SheetProof,
    SheetTable,
)
from ...gcode.posts import load_post
from ...geometry.primitives import contour_rows
from ...model.finding import FindingKind
from ...model.job import Job, OriginXY, OriginZ
from ...model.moves import MoveKind, Moves
from ...model.part import Units
from ...model.stock_box import StockBox, stock_box, work_origin
from ..making.make import MakeResult
from ..making.picture import picture_of
from .common import (
    CLAMP_PEN,
    MADE_BY,
    PENS,
    ToolUse,
    corner_words,
    hashed,
    legend,
    offset_fact,
    own_words,
    span_words,
    styled,
    tool_table,
    traced,
    zero_note,
)

Json = dict[str, Any]


def made_sheet(made: MakeResult, program: Path, sources: Mapping[str, bytes]) -> SetupSheet:
    """Return the sheet of a program that was made.

    Args:
        program: its file, without what tells several files apart.
        sources: what it was made of, by a word for it.
    """
    job, report = made.job, made.report.data
    box = stock_box(job, made.program.regions, made.program.lines)
    counting = tuple(finding.text for finding in made.findings if finding.counts)
    names = [file.named(program).name for file in made.files]
    as_file = (f"Job as {option('write-job')} writes it", ("\n".join(job_lines(job)) + "\n").encode())
    texts = [(f"Program: {name}", file.nc.text.encode("ascii")) for name, file in zip(names, made.files, strict=True)]
    post = load_post(job.post)
    units = "inches" if job.out_units is Units.INCH else "millimetres"
    return SetupSheet(
        title=job.part.name or program.stem,
        program=f"{', '.join(names)} · {post.title} · {units}",
        verdict=_verdict(len(counting)),
        good=not counting,
        picture=_picture(made, box),
        facts=tuple(_facts(made, box, report)),
        tables=(_tools(made), _operations(made)),
        proofs=tuple(_proofs(made, report)),
        findings=counting,
        remarks=tuple(finding.text for finding in made.findings if not finding.counts)[:_REMARKS],
        hashes=hashed(*sources.items(), as_file, *texts),
        made_by=MADE_BY,
    )


_REMARKS = 6
"""Remarks that are on the sheet; the report has all."""


def _verdict(count: int) -> str:
    if not count:
        return "Proven: no gouge, no rapid in metal, nothing left within reach"
    counts = "1 finding counts" if count == 1 else f"{count} findings count"
    return f"{counts}: do not run this program before it is cleared"


def _picture(made: MakeResult, box: StockBox) -> SetupPicture:
    program = made.program
    drawn = picture_of(made.job.part.name, program, made.coverage)
    part = [line for rows in drawn.contours for line in traced(rows, PENS[PART])]
    part += [line for contour in program.lines for line in traced(contour_rows(contour), PENS[PART])]
    paths = styled([path for path in drawn.paths if path.style in (POCKET, CONTOUR)])
    clamps = [
        line for region in program.clamps for each in region.contours for line in traced(contour_rows(each), CLAMP_PEN)
    ]
    x, y, _ = work_origin(made.job, box)
    words = legend({PART: PART.name, POCKET: "Clearing", CONTOUR: "Along walls"}, [*paths, *part])
    words += (("Keep-out", clamps[0]),) if clamps else ()
    return SetupPicture((box.x0, box.y0, box.x1, box.y1), (x, y), (*paths, *part, *clamps), words)


def _facts(made: MakeResult, box: StockBox, report: Json) -> list[SheetFact]:
    job = made.job
    wide, high, thick = box.size
    above = f", {job.stock.above:g} mm of it to be faced off above Z 0" if job.stock.above else ""
    of = f", {job.stock.material}" if job.stock.material else ""
    parts = report["time_parts_s"]
    changes = report["tool_changes"]["count"]
    total = (
        f"{minutes_words(report['time_s'])} min: cutting {minutes_words(parts['cut'])}, rapids "
        f"{minutes_words(parts['rapid'])}, {changes} tool change{'' if changes == 1 else 's'} and dwells "
        f"{minutes_words(parts['wait'])}"
    )
    return [
        SheetFact("Stock", f"{wide:.4g} x {high:.4g} x {thick:.4g} mm{of}{above}"),
        SheetFact("Zero X Y", _zero_words(job, box)),
        SheetFact("Zero Z", _zero_z_words(job)),
        *zero_note(job.zero_note),
        offset_fact(file.nc.text for file in made.files),
        SheetFact("Clamping", _clamping(made), own_words(job.clamping_note)),
        SheetFact("Clearance height", f"{job.travel_z:g} mm above the stock's top"),
        SheetFact("Total time", total),
    ]


def _zero_words(job: Job, box: StockBox) -> str:
    x, y, _ = work_origin(job, box)
    if job.origin_xy is OriginXY.LOWER_LEFT:
        return "lower left corner of the stock"
    where = "centre of the stock" if job.origin_xy is OriginXY.CENTRE else "the drawing's zero"
    return f"{where}: {corner_words(x - box.x0, y - box.y0)}"


def _zero_z_words(job: Job) -> str:
    if job.origin_z is OriginZ.BOTTOM:
        return "underside of the stock"
    if job.stock.above:
        return f"{job.stock.above:g} mm below the raw top, where facing leaves it"
    return "top of the stock"


def deepest_cut(moves: Moves) -> float:
    """Return how far below Z 0 of the part feed moves go, mm, >= 0."""
    cuts = moves.end[moves.kind != MoveKind.RAPID, 2]
    return max(0.0, -float(cuts.min(initial=0.0)))


def _clamping(made: MakeResult) -> str:
    """Return what the way that the stock is held has to allow, as far as the paths tell."""
    job, deep = made.job, deepest_cut(made.program.moves)
    through = deep - job.stock.thickness
    told = []
    if made.program.clamps:
        layers = ", ".join(job.keep_out_layers)
        told.append(
            f"Clamps as drawn on {layers}, up to {job.keep_out_height:g} mm above the top; no move comes near them."
        )
    else:
        told.append("No clamp is drawn: keep the top free of clamps.")
    if through > 0:
        told.append(f"Cuts go {through:.4g} mm below the underside: put waste at least as thick under it.")
    elif through > -tolerances.LEVEL:
        told.append("Cuts reach the underside: put waste under it.")
    else:
        told.append(f"Deepest cut {deep:.4g} mm below Z 0; jaws may reach up to {-through:.4g} mm above the underside.")
    if made.program.tabs:
        count = len(made.program.tabs)
        told.append(f"{'1 tab holds' if count == 1 else f'{count} tabs hold'} the part.")
    elif any(each.WORD == "contour" and each.cut.depth >= job.stock.thickness for each in job.operations):
        told.append("No tab holds what is cut out.")
    return " ".join(told)


def _tools(made: MakeResult) -> SheetTable:
    report, moves, above = made.report.data, made.program.moves, made.job.stock.above
    times = {each["number"]: each["time_s"] for each in report["tools"]}
    uses = []
    for tool in made.job.tools:
        mine = moves.tool == tool.number
        if np.any(mine):
            depth = above - float(moves.end[mine, 2].min())
            speeds = np.array([tool.spindle_speed])
            uses.append(ToolUse(tool, times.get(tool.number, 0.0), depth, speeds, moves.feed[mine]))
    return tool_table(uses)


_OPERATIONS = (
    SheetColumn("#", 0.05, number=True),
    SheetColumn("Operation", 0.27),
    SheetColumn("T", 0.05, number=True),
    SheetColumn("Depth mm", 0.11, number=True),
    SheetColumn("Stepdown", 0.10, number=True),
    SheetColumn("Stepover", 0.10, number=True),
    SheetColumn("rpm", 0.09, number=True),
    SheetColumn("Feeds mm/min", 0.13, number=True),
    SheetColumn("Min", 0.10, number=True),
)


def _operations(made: MakeResult) -> SheetTable:
    """Return the table of operations, in the order of cutting."""
    report, moves = made.report.data, made.program.moves
    first = {int(each): at for each, at in zip(*np.unique(moves.operation, return_index=True), strict=True)}
    rows = [
        _operation_row(made, number, index)
        for number, index in enumerate(sorted((each for each in first if each >= 0), key=first.__getitem__), 1)
    ]
    total = ("", "Total, all included", *[""] * 6, minutes_words(report["time_s"]))
    return SheetTable("Operations", _OPERATIONS, tuple(rows), total)


def _operation_row(made: MakeResult, number: int, index: int) -> tuple[str, ...]:
    job, moves, told = made.job, made.program.moves, made.report.data["operations"][index]
    operation = job.operations[index]
    tool = job.tool(operation.cut.tool)
    left = f", {told['stock_to_leave_mm']:g} mm left on walls" if told.get("stock_to_leave_mm") else ""
    curves = f", curves {', '.join(told['curves'])}" if told.get("curves") else ""
    count = _holes(moves, index) if operation.HOLES else 0
    size = f" {told['thread']}" if told.get("thread") else ""
    size += f" Ø {told['diameter_mm']:g}" if told.get("diameter_mm") else ""
    size += f", {counted(count, 'hole')}" if count else ""
    return (
        str(number),
        f"{operation.WORD.capitalize()}{size}{curves}{left}",
        str(tool.number),
        "to Z 0" if operation.FACES else _length(told.get("depth_mm")),
        _length(told.get("stepdown_mm")),
        _length(told.get("stepover_mm")),
        f"{tool.spindle_speed:.0f}",
        span_words(moves.feed[moves.operation == index]),
        minutes_words(told["time_s"]),
    )


def _holes(moves: Moves, index: int) -> int:
    """Return how many holes an operation makes, where it goes straight up and down in each; 0 = nobody can tell."""
    cuts = (moves.operation == index) & (moves.kind != MoveKind.RAPID)
    start, end = np.round(moves.start[cuts, :2], 4), np.round(moves.end[cuts, :2], 4)
    return len(np.unique(end, axis=0)) if np.array_equal(start, end) else 0


def _length(value: float | None) -> str:
    return "-" if value is None else f"{value:.4g}"


def _out_of_reach(left: Json) -> str:
    """Return in words what no tool of the job gets at."""
    places = left["out_of_reach_places"]
    if not places:
        return "nothing is out of reach"
    spots = "1 place" if places == 1 else f"{places} places"
    return f"{left['unreachable_mm2']:.3f} mm² in {spots} are out of reach of every tool"


def _proofs(made: MakeResult, report: Json) -> list[SheetProof]:
    """Return the certificate: each claim with the bound that was found, and how."""
    counting = {finding.kind for finding in made.findings if finding.counts}
    gouge, left, check, cut = report["gouge"], report["left"], report["check"], report["cut"]
    proofs = [
        SheetProof(
            "No gouge",
            f"deepest {gouge['max_mm']:.4f} mm, in closed form, of every move from every wall; counts from "
            f"{gouge['counts_from_mm']:g} mm",
            FindingKind.GOUGE not in counting,
        ),
        SheetProof(
            "Nothing left within reach",
            f"{left['reachable_mm2']:.3f} mm² of {left['floor_mm2']:.1f} mm² of floor; {_out_of_reach(left)}",
            FindingKind.LEFT_REACHABLE not in counting,
        ),
        SheetProof(
            "No rapid in metal",
            f"{len(report['rapids_in_material'])} of {report['moves']['G0']} rapids, each against the metal as it is "
            "by then",
            FindingKind.RAPID_IN_MATERIAL not in counting,
        ),
        SheetProof(
            "The file is the path",
            f"read back as its control would, within {check['largest_distance_mm']:.4f} mm both ways; allowed "
            f"{check['tolerance_mm']:g} mm",
            check["differences"] == 0,
        ),
        SheetProof("Cut, it is the part", *_cut_proof(cut, counting)),
        _holder_proof(made, counting),
    ]
    other = counting - _PROVEN
    if other:
        words = ", ".join(sorted(kind.words for kind in other))
        proofs.append(SheetProof("Nothing else counts", f"{words}: see below", holds=False))
    return proofs


_PROVEN = {
    FindingKind.GOUGE,
    FindingKind.LEFT_REACHABLE,
    FindingKind.RAPID_IN_MATERIAL,
    FindingKind.HOLDER_CONTACT,
    FindingKind.SHANK_CONTACT,
}


def _cut_proof(cut: Json | None, counting: set[FindingKind]) -> tuple[str, bool | None]:
    """Return what cutting the files has shown; between the cells only where that bound says something."""
    if cut is None:
        return "the files were not cut", None
    bound, told = cut["no_point_gouged_deeper_than_mm"], f"{cut['gouged_places']} gouged places"
    grid = f"on {cut['cols']} x {cut['rows']} heights {cut['pitch_mm']:.3g} mm apart"
    holds = not counting & {FindingKind.GOUGE, FindingKind.LEFT_REACHABLE}
    if bound < 10 * cut["pitch_mm"]:
        return f"{told} {grid}; between them, too, no point is gouged deeper than {bound:.4f} mm", holds
    return f"{told} {grid}; between them nothing is known beyond the lines above", holds


def _holder_proof(made: MakeResult, counting: set[FindingKind]) -> SheetProof:
    """Return whether shanks and holders keep clear: of tools of which neither is known nobody can say."""
    used: Sequence[int] = np.unique(made.program.moves.tool).tolist()
    unknown = [f"T{number}" for number in used if not made.job.tool(number).holder]
    claim = "Shank and holder keep clear"
    if counting & {FindingKind.HOLDER_CONTACT, FindingKind.SHANK_CONTACT}:
        return SheetProof(claim, "they meet metal, see below", holds=False)
    if unknown or made.cut is None or made.cut.holders is None:
        return SheetProof(claim, f"no holder is given for {', '.join(unknown) or 'the tools'}", None)
    return SheetProof(claim, "every motion against the metal as it is by then", holds=True)
