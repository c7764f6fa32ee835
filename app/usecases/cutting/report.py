"""The report of a cut: every number in it is measured on what was cut, or is null where nobody has looked."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core.options import option
from ...core.wording import counted, minutes_words
from ...gcode.interpreter.program import Severity
from ...gcode.timing.duration import TIME_METHOD
from ...model.finding import Finding, FindingKind, worst_first
from ...model.motion import Floats, MotionKind
from ...model.motion_path import lengths
from ...model.tool import Tool
from ...simulation.engines import Engine, EngineReport
from ...simulation.field.workpiece import TOLERANCE
from ...verify.judgement import Judgement, Spot
from ...verify.parts import Part, SolidPart
from ..examine import COORDINATES, KINDS, ExaminedProgram
from .cut import CutProgram
from .ready_setup import ReadySetup
from .setup_stock import cut_box
from .setup_tools import KnownTool

Json = dict[str, Any]

ENGINES = {
    Engine.CPU: "cpu: the lowest height of every sweep in every cell, in closed form, as float32",
    Engine.GPU: "gpu: heights by a quad for each piece of the path, in closed form, as float32, on {renderer}",
    Engine.PATENT: "patent: heights by facets of {facet} in the depth buffer, the method of 1999, on {renderer}",
}
BESIDE = "; by the cpu: which motion cut each cell, volumes, rapids in metal, certificates"
LENGTH_METHOD = (
    "cut: motions at feed rate that took metal from the cells; link: those at feed rate that took none; G0 is rapid"
)
GOUGE_METHODS = {
    "drawing": "closed-form distance of every motion from every wall, less tool radius and stock to leave; floors by "
    "the cells",
    "solid": "exact distance from the solid's surface at the deepest place that was found, from the cells on and "
    "between them; nothing is deeper than at_most_mm, if that is known",
    "cells": "the cells' heights below the part's",
}
_TELLING = 10.0
"""Cells beyond the gouge that is told; a bound between the cells that is wider says nothing that a person could use."""

HEIGHTS = 5e-6
"""mm; how far heights of the processor's engine, float32, may be from exact ones."""
HEIGHTS_METHODS = {
    Engine.CPU: "bound, times 1 + the surface's slope, for heights up to 32 mm; cells beside an upright wall may fall "
    "to either side",
    Engine.GPU: "how far from the cpu's they may be; cells beside an upright wall may fall to either side",
    Engine.PATENT: "how far facets are at most inside the surface, square to it (d² / 8r of balls, d their size from "
    "corner to corner); cells beside an upright wall may fall to either side",
}
SPOTS = 100
"""Places that the report lists."""

SURFACE = 1e-9
"""mm below the stock's top at which a motion counts as in the stock."""


@dataclass(frozen=True)
class CutReport:
    """A report as plain values.

    Attributes:
        data: by the keys of the command line's report; units are in the names, positions in program coordinates.
        findings: everything there is to say, what counts first.
        warnings: of the control, about the text.
    """

    data: Json
    findings: tuple[Finding, ...]
    warnings: tuple[str, ...] = ()

    def text(self) -> str:
        """Return it as JSON text."""
        return json.dumps(self.data, indent=2, ensure_ascii=False, allow_nan=False) + "\n"

    def summary(self) -> list[str]:
        """Return it in a few lines for people, without the findings."""
        return list(_summary(self.data))


@dataclass(frozen=True, eq=False)
class _Motions:
    """The motions of all programs, (n,) each, in the order of cutting.

    Attributes:
        feed: at feed rate. took: took metal.
        length: mm. tool: T number. low, high: of Z, mm; end: Z of the end, mm.
        line, file: where each stands; `names` of the files.
    """

    kind: NDArray[np.uint8]
    took: NDArray[np.bool_]
    length: Floats
    tool: NDArray[np.int32]
    start: Floats
    end: Floats
    line: NDArray[np.int32]
    file: NDArray[np.int32]
    names: tuple[str, ...]

    @staticmethod
    def of(done: CutProgram, ready: ReadySetup) -> _Motions:
        """Return the motions of what was cut."""
        each = [examined.program.motions for examined in ready.programs]
        file = np.repeat(np.arange(len(each), dtype=np.int32), [len(motions) for motions in each])
        return _Motions(
            kind=np.concatenate([motions.kind for motions in each]),
            took=done.cut.engaged > 0,
            length=np.concatenate([lengths(motions) for motions in each]),
            tool=done.setup.numbers(),
            start=np.concatenate([motions.start[:, 2] for motions in each]),
            end=np.concatenate([motions.end[:, 2] for motions in each]),
            line=done.setup.lines(),
            file=file,
            names=tuple(examined.name for examined in ready.programs),
        )

    @property
    def feed(self) -> NDArray[np.bool_]:
        """Which are at feed rate."""
        return np.asarray(self.kind != MotionKind.RAPID)

    def where(self, row: int) -> Json:
        """Return the line of a motion, and of several files which one; null where there is no such motion."""
        if row < 0:
            return {"line": None}
        return {"line": int(self.line[row])} | ({"file": self.names[self.file[row]]} if len(self.names) > 1 else {})

    def lengths(self) -> Json:
        """Return the lengths by what the motions do, mm."""
        chosen = {"cut": self.feed & self.took, "link": self.feed & ~self.took, "rapid": ~self.feed}
        return {name: float(np.sum(self.length[mask])) for name, mask in chosen.items()}

    def leaves(self, top: float) -> NDArray[np.bool_]:
        """Return which take the tool out of the stock."""
        return np.asarray((np.minimum(self.start, self.end) < top - SURFACE) & (self.end >= top))

    def strokes(self, top: float) -> int:
        """Return how many runs of motions at feed rate took metal, unbroken by rapids or by leaving the stock."""
        breaks = ~self.feed | np.diff(self.file, prepend=0).astype(bool)
        breaks[1:] |= self.leaves(top)[:-1]
        return len(np.unique(np.cumsum(breaks)[self.feed & self.took]))


def cut_report(done: CutProgram, ready: ReadySetup) -> CutReport:
    """Return the report of what was cut; it must have been traced."""
    warnings = tuple(
        problem.message(each.name)
        for each in ready.programs
        for problem in each.problems
        if problem.severity is Severity.WARNING
    )
    findings = worst_first((*done.findings, *ready.findings))
    motions = _Motions.of(done, ready)
    data = _judged(done, motions) | _path(done, ready, motions) | _said(findings) | _about(done, ready, motions)
    return CutReport(data, findings, warnings)


def _judged(done: CutProgram, motions: _Motions) -> Json:
    """Return what is right and wrong with the metal."""
    judged = done.judgement
    reported: Json = {"gouge": None, "left": None, "worst": [], "worst_count": 0, "bands": [], "certificate": None}
    if judged is not None:
        reported = {
            "gouge": _gouge(judged, done.setup.part, motions),
            "left": {
                "reachable_mm2": judged.reachable_mm2,
                "unreachable_mm2": judged.unreachable_mm2,
                **({"given_up_mm2": judged.skin_mm2} if judged.skin_mm2 else {}),
                "largest_disc_mm": judged.largest_disc_mm,
            },
            "worst": [_spot(spot, motions) for spot in judged.spots[:SPOTS]],
            "worst_count": len(judged.spots),
            "bands": [
                {"low_mm": _finite(band.low), "high_mm": _finite(band.high), "area_mm2": band.area_mm2}
                for band in judged.bands
            ],
            "certificate": asdict(judged.certificate) if judged.certificate is not None else None,
        }
    rapids = [
        {"x": hit.x, "y": hit.y, "z": hit.z, **motions.where(hit.motion), "depth_mm": hit.depth, "cells": hit.cells}
        for hit in done.cut.rapids
    ]
    return {
        "removed_mm3": done.cut.removed_volume,
        **reported,
        "rapids_in_material": rapids,
        "holder_contacts": _contacts(done, motions),
    }


def _contacts(done: CutProgram, motions: _Motions) -> list[Json] | None:
    """Return where shanks and holders go into metal; null where nobody has looked."""
    if done.holders is None:
        return None
    return [
        {
            "tool": each.tool,
            "part": each.part.value,
            "x": each.x,
            "y": each.y,
            "z": each.z,
            **motions.where(each.motion),
            "depth_mm": each.depth,
            "motions": each.count,
        }
        for each in done.holders.contacts
    ]


def _gouge(judged: Judgement, part: Part | None, motions: _Motions) -> Json:
    """Return the deepest gouge; of a solid also how deep any other place may be at most, null where nobody knows."""
    gouge, sure = judged.gouge, judged.certificate
    reported = {
        "max_mm": gouge.max_mm,
        "x": gouge.x,
        "y": gouge.y,
        "z": gouge.z,
        **motions.where(gouge.move),
        "count": gouge.count,
    }
    if not isinstance(part, SolidPart):
        return reported | {"method": GOUGE_METHODS["drawing" if judged.exact else "cells"]}
    return reported | {
        "at_most_mm": max(gouge.max_mm, sure.gouge_mm) if sure else None,
        "method": GOUGE_METHODS["solid"],
    }


def _spot(spot: Spot, motions: _Motions) -> Json:
    return {
        "kind": spot.kind.value,
        "x": spot.x,
        "y": spot.y,
        "z": spot.z,
        "depth_mm": spot.depth_mm,
        "area_mm2": spot.area_mm2,
        "disc_mm": spot.disc_mm,
        **motions.where(spot.motion),
    }


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None


def _path(done: CutProgram, ready: ReadySetup, motions: _Motions) -> Json:
    """Return what the tools do on the way."""
    return {
        "strokes": motions.strokes(done.top),
        "retracts": int(np.sum(motions.leaves(done.top))),
        "length_mm": motions.lengths(),
        "length_method": LENGTH_METHOD,
        "time_s": sum(each.time.total for each in ready.programs),
        "time_method": TIME_METHOD.format(ready.programs[0].machine.title),
        "moves": {name: int(np.sum(motions.kind == kind)) for name, kind in KINDS.items()},
    }


def _said(findings: tuple[Finding, ...]) -> Json:
    """Return the findings, and some of them under keys of their own."""
    reported = [
        (
            each,
            {
                "kind": each.kind.value,
                "text": each.text,
                "x": each.x,
                "y": each.y,
                "counts": each.counts,
                "amount": each.amount,
                "line": each.line or None,
            },
        )
        for each in findings
    ]
    chosen = {
        "skipped": (FindingKind.REGION_TOO_SMALL, FindingKind.LEFT_OUT, FindingKind.TINY_ENTITY),
        "open_contours": (FindingKind.OPEN_CONTOUR,),
    }
    return {name: [plain for each, plain in reported if each.kind in kinds] for name, kinds in chosen.items()} | {
        "assumed": [each.text for each in findings if each.kind is FindingKind.ASSUMED],
        "findings": [plain for _, plain in reported],
    }


def _about(done: CutProgram, ready: ReadySetup, motions: _Motions) -> Json:
    """Return what was cut out of what, with what, how finely."""
    grid, box, ends = (
        done.cut.before.grid,
        done.setup.stock.box,
        zip(("low", "high"), cut_box(ready.programs).tolist(), strict=True),
    )
    return {
        **_engine(done.engine_report),
        "tolerance": _tolerance(done),
        "grid": {"x0": grid.x0, "y0": grid.y0, "pitch_mm": grid.pitch, "rows": grid.rows, "cols": grid.cols},
        "window": done.options.window,
        "coordinates": COORDINATES,
        "extent_mm": {end: [_finite(value) for value in corner] for end, corner in ends},
        "stock": {"low": [*box[:2], done.floor], "high": [*box[2:], done.top], "from": ready.stock.source},
        "tools": [_tool(number, known, done, motions, ready) for number, known in ready.tools.items()],
        "programs": [_program(each) for each in ready.programs],
    }


def _engine(reported: EngineReport) -> Json:
    """Return what has computed the heights, and how far they are from the cpu's where it has computed them as well."""
    size = f"{reported.facet:.4g} mm" if reported.facet else "two cells from corner to corner"
    text, found = ENGINES[reported.engine].format(renderer=reported.renderer, facet=size), reported.difference
    if reported.engine is not Engine.CPU:
        text += BESIDE
    elif reported.fault:
        text += f"; {reported.fault}"
    apart = (
        {"largest_mm": found.largest, "cells": found.cells, "beyond_mm": TOLERANCE, "rim_cells": found.rims}
        if found
        else None
    )
    facet = {"facet_mm": reported.facet} if reported.facet else {}
    return {"engine": text, "apart_from_cpu": apart, **facet}


def _tolerance(done: CutProgram) -> Json:
    """Return within which lengths what is true; of a part only where there is one."""
    reported, part = done.engine_report, done.setup.part
    within = {Engine.CPU: HEIGHTS, Engine.GPU: TOLERANCE, Engine.PATENT: reported.error}[reported.engine]
    cells: Json = {
        "heights_mm": within,
        "heights": HEIGHTS_METHODS[reported.engine],
        "pitch_mm": done.cut.before.grid.pitch,
    }
    if part is None:
        return cells
    cells |= {"part_mm": part.tolerance}
    if isinstance(part, SolidPart):
        return cells | {"leave_mm": part.leave}
    contours = [contour for region in part.regions for contour in region.contours]
    return cells | {
        "wall_mm": part.wall_tolerance,
        "join_mm": part.job.join_tolerance,
        "curves_mm": max((contour.deviation for contour in contours), default=0.0),
    }


def _tool(number: int, known: KnownTool, done: CutProgram, motions: _Motions, ready: ReadySetup) -> Json:
    """Return a tool's shape, who tells of it, and what it did."""
    tool, mine = known.tool, motions.tool == number
    return {
        "number": number,
        "kind": tool.kind.value,
        "diameter_mm": tool.diameter,
        "corner_radius_mm": tool.corner_radius,
        "tip_diameter_mm": tool.tip_diameter,
        "tip_angle_deg": math.degrees(tool.tip_angle),
        "from": known.source,
        "shank": _shank(tool),
        "holder": _holder(tool),
        "stick_out_mm": tool.stick_out or None,
        "least_stick_out_mm": done.holders.least.get(number) if done.holders is not None else None,
        "removed_mm3": float(np.sum(done.cut.volume[mine])),
        "cut_mm": float(np.sum(motions.length[mine & motions.feed & motions.took])),
        "time_s": sum(each.time.by_tool.get(number, 0.0) for each in ready.programs),
    }


def _shank(tool: Tool) -> str:
    """Return what of a shank was looked at."""
    return (
        f"{tool.shank_diameter or tool.diameter:g} mm from {tool.flute_length:g} mm up"
        if tool.flute_length and (tool.shank_diameter or not tool.kind.threads)
        else "not known"
    )


def _holder(tool: Tool) -> str:
    """Return what of a holder was looked at."""
    if not tool.holder:
        return "not known"
    return f"{2 * max(radius for _, radius in tool.holder):g} mm wide" if tool.stick_out else "known, its stick-out not"


def _program(examined: ExaminedProgram) -> Json:
    return {
        "file": examined.name,
        "control": examined.read.dialect.value,
        "block_delete": examined.read.block_delete,
        "lines": examined.program.line_count,
        "problems": [problem.message(examined.name) for problem in examined.problems],
    }


def _summary(data: Json) -> Iterator[str]:
    """Yield a line about the whole, one about the space between the cells, and one a tool."""
    names = ", ".join(program["file"] for program in data["programs"])
    gouge, left, certificate = data["gouge"], data["left"], data["certificate"]
    part = f"compared with no part ({option('against')})"
    if gouge is not None:
        part = (
            f"{gouge['max_mm']:.4f} mm gouge, {left['reachable_mm2']:.3f} mm2 left within reach, "
            f"{left['unreachable_mm2']:.3f} mm2 out of reach"
        )
    path = ", ".join(
        (
            counted(len(data["rapids_in_material"]), "rapid") + " in material",
            *_touching(data),
            counted(data["strokes"], "stroke"),
            counted(data["retracts"], "retract"),
        )
    )
    yield (
        f"{names}: {data['removed_mm3']:.1f} mm3 removed; {part}; {path}, {sum(data['length_mm'].values()):.0f} mm, "
        f"{minutes_words(data['time_s'])} min"
    )
    if certificate is not None and certificate["gouge_mm"] - gouge["max_mm"] < _TELLING * certificate["pitch_mm"]:
        yield (
            f"  between the cells, {certificate['pitch_mm']:.4g} mm wide, too: no point deeper than "
            f"{certificate['gouge_mm']:.4f} mm inside the part was cut"
        )
    if (apart := data["apart_from_cpu"]) is not None:
        yield (
            f"  {data['engine'].partition(';')[0]}; {counted(apart['cells'], 'cell')} more than "
            f"{apart['beyond_mm']:g} mm from the cpu's, {apart['rim_cells']} beyond the stated error, on walls"
        )
    if not data["removed_mm3"]:
        yield (
            f"  nothing was removed: the motions at feed rate reach {_words(data['extent_mm'])}, and the stock "
            f"{_words(data['stock'])}"
        )
    for tool in data["tools"]:
        yield (
            f"  T{tool['number']} {tool['kind']} {tool['diameter_mm']:g} mm ({tool['from']}): "
            f"{tool['removed_mm3']:.1f} mm3, {minutes_words(tool['time_s'])} min{_held(tool)}"
        )


def _touching(data: Json) -> Iterator[str]:
    """Yield how many contacts of shanks and holders there are, if some are known to be looked for."""
    if data["holder_contacts"]:
        yield counted(len(data["holder_contacts"]), "contact") + " of shank or holder"


def _held(tool: Json) -> str:
    """Return how far a tool must stick out, or that nobody knows its holder."""
    if tool["least_stick_out_mm"] is None:
        return f"; holder {tool['holder']}"
    return f"; sticks out {tool['stick_out_mm']:g} mm, {tool['least_stick_out_mm']:.1f} mm are needed"


def _words(box: Json) -> str:
    sides = zip("XYZ", box["low"], box["high"], strict=True)
    return ", ".join(f"{axis} {low:.3f} to {high:.3f}" for axis, low, high in sides if low is not None) + " mm"
