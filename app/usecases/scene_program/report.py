"""The report of paths over surfaces: what was computed, which surfaces a path is on, and what is proven of what was
written.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...core.wording import counted, minutes_words
from ...formats.machine_toml import DEFAULT_MACHINE, load_machine
from ...gcode.timing.duration import TIME_METHOD
from ...model.finding import Finding
from ...model.motion import MotionKind
from ...model.moves import Purpose
from ...surfaces.passes.path import ALLOWED
from ...surfaces.sections.compound import NO_SURFACE, BoundaryKind, BoundaryPoints, CompoundSurface
from ..scene.compute import ComputedFamily, ComputedScene
from .nc import WrittenScene

ENGINE = "cutters over rational Bezier patches and triangles, exact where they touch; every chord proven"
GOUGE_METHOD = (
    "a bound, not a measurement: for each move of the written text a cutter pared by so much is proven to stay clear "
    "of every surface, all along the move"
)
LEFT_METHOD = (
    "the written text cut out of the stock, on cells, beside the lowest that the same tools reach: the surfaces' "
    "heights closed by their profiles, and in corners what the tools cut from single places on the surfaces; "
    "ridges of up to twice what the pitch leaves on a plane of that slope are none of it"
)
_LENGTHS = {"cut": Purpose.CONTOUR, "link": Purpose.LINK, "plunge": Purpose.PLUNGE, "rapid": Purpose.RAPID}
_KINDS = {"G0": MotionKind.RAPID, "G1": MotionKind.LINE, "G2": MotionKind.ARC_CW, "G3": MotionKind.ARC_CCW}

Json = dict[str, Any]


@dataclass(frozen=True)
class SurfaceReport:
    """A report as plain values.

    Attributes:
        data: units are in the names of keys; positions in the scene's coordinates.
        findings: what is wrong.
    """

    data: Json
    findings: tuple[Finding, ...]

    def text(self) -> str:
        """Return it as JSON text."""
        return json.dumps(self.data, indent=2, ensure_ascii=False, allow_nan=False) + "\n"

    def summary(self) -> list[str]:
        """Return it in a few lines for people."""
        return list(_summary(self.data))


def surface_report(computed: ComputedScene, written: WrittenScene | None = None) -> SurfaceReport:
    """Return the report of a computed scene, and of its program if one was written."""
    findings = written.findings() if written is not None else computed.findings
    data = {
        "scene": computed.scene.name,
        **(_program(written) if written is not None else {}),
        "strokes": sum(len(family.path.runs) for family in computed.families),
        "length_mm": _lengths(computed),
        "surfaces": list(_surfaces(computed)),
        "passes": [_passes(computed, family) for family in computed.families],
        "engine": ENGINE,
        "tolerance": {
            "gouge_mm": ALLOWED,
            "grid_mm": computed.grid,
            "facets_mm": float(computed.facets.facets.error.max()),
        },
        "stock_mm": {
            "low": [computed.stock.x0, computed.stock.y0, computed.stock.z0],
            "high": [computed.stock.x1, computed.stock.y1, computed.stock.z1],
        },
        "origin_mm": list(computed.origin),
        "skipped": [],
        "open_contours": [],
        "findings": [
            {
                "kind": each.kind.value,
                "text": each.text,
                "x": each.x,
                "y": each.y,
                "counts": each.counts,
                "amount": each.amount,
            }
            for each in findings
        ],
    }
    return SurfaceReport(data, findings)


def _program(written: WrittenScene) -> Json:
    """Return what is known of the program as it was written and read back."""
    unproven, count = written.unproven, len(written.unproven)
    x, y, z = unproven[0].tolist() if count else (None, None, None)
    kind = np.concatenate([program.motions.kind for program in written.programs])
    return {
        "gouge": {
            "max_mm": None if count else ALLOWED,
            "x": x,
            "y": y,
            "z": z,
            "line": None,
            "count": count,
            "method": GOUGE_METHOD,
        },
        "left": _left(written),
        "rapids_in_material": list(_low_rapids(written)),
        "time_s": written.time_s,
        "time_method": TIME_METHOD.format(load_machine(DEFAULT_MACHINE).title),
        "moves": {name: int(np.sum(kind == value)) for name, value in _KINDS.items()},
        "retracts": sum(
            int(np.sum((motions.kind[1:] == MotionKind.RAPID) & (motions.kind[:-1] != MotionKind.RAPID)))
            for motions in (program.motions for program in written.programs)
        ),
        "post": written.computed.scene.post,
        "files": len(written.files),
    }


def _left(written: WrittenScene) -> Json | None:
    """Return what the program leaves within reach of its tools, in the scene's coordinates."""
    left = written.left
    if left is None:
        return None
    x, y, _ = written.computed.origin
    reported: Json = {
        "reachable_mm2": left.area_mm2,
        "places": left.places,
        "worst_mm": left.worst_mm,
        "wide_mm": left.wide_mm,
        "x": left.x + x if left.places else None,
        "y": left.y + y if left.places else None,
        "within_mm": left.within_mm,
        "cell_mm": left.cell_mm,
        "ridge": None,
        "method": LEFT_METHOD,
    }
    if (ridge := left.ridge) is not None:
        reported["ridge"] = {
            "max_mm": ridge.height_mm,
            "x": ridge.x + x,
            "y": ridge.y + y,
            "slope_deg": ridge.slope_deg,
            "level_mm": ridge.level_mm,
        }
    return reported


def _low_rapids(written: WrittenScene) -> Iterator[Json]:
    """Yield rapids that go below the stock's top within the stock: there is metal, for all that anybody knows."""
    box, origin = written.computed.stock, np.array(written.computed.origin)
    for program in written.programs:
        motions = program.motions
        ends, starts = motions.end + origin, motions.start + origin
        known = np.isfinite(starts).all(axis=1) & (motions.kind == MotionKind.RAPID)
        low, high = np.fmin(starts, ends), np.fmax(starts, ends)
        inside = (
            (high[:, 0] > box.x0)
            & (low[:, 0] < box.x1)
            & (high[:, 1] > box.y0)
            & (low[:, 1] < box.y1)
            & (low[:, 2] < box.z1)
        )
        for row in np.flatnonzero(known & inside).tolist():
            x, y, z = ends[row].tolist()
            yield {"x": x, "y": y, "z": z, "line": int(motions.line[row])}


def _lengths(computed: ComputedScene) -> dict[str, float]:
    """Return the lengths of moves by what they are for, mm."""
    moves = computed.moves.moves
    length = np.append(0.0, np.linalg.norm(np.diff(moves.end, axis=0), axis=1))[: len(moves)]
    return {name: float(length[moves.purpose == purpose].sum()) for name, purpose in _LENGTHS.items()}


def _surfaces(computed: ComputedScene) -> Iterator[Json]:
    """Yield what there is to say of each surface."""
    moves, on = computed.moves.moves, computed.moves.surface
    length = np.append(0.0, np.linalg.norm(np.diff(moves.end, axis=0), axis=1))[: len(moves)]
    for number, surface in enumerate(computed.scene.surfaces):
        mine = on == number
        facets = int(np.sum(computed.facets.facets.owner == number))
        yield {
            "number": number + 1,
            "name": surface.name,
            "enabled": surface.enabled,
            "facets": facets,
            "moves": int(mine.sum()),
            "length_mm": float(length[mine].sum()),
        }


def _passes(computed: ComputedScene, family: ComputedFamily) -> Json:
    passes, tool = family.passes, family.tool
    return {
        "name": passes.name,
        "tool": tool.number,
        "kind": tool.kind.value,
        "diameter_mm": tool.diameter,
        "planes": len(family.planes.offsets),
        "angle_deg": float(np.degrees(family.planes.angle)),
        "pitch_mm": passes.pitch,
        "scallop_mm": passes.scallop,
        "strategy": passes.strategy.value,
        "stock_to_leave_mm": passes.stock_to_leave,
        "chord_tolerance_mm": passes.chord_tolerance,
        "compound_surface": _compound(computed, family.surface),
        "path": _compound(computed, family.path),
    }


def _compound(computed: ComputedScene, compound: CompoundSurface) -> Json:
    marks = compound.boundaries
    kinds = {kind.name.lower(): int(np.sum(marks.kind == kind)) for kind in BoundaryKind}
    return {
        "runs": len(compound.runs),
        "points": sum(len(run.points) for run in compound.runs),
        "boundary_points": kinds,
        "boundaries": list(boundary_rows(computed, marks)),
    }


def boundary_rows(computed: ComputedScene, marks: BoundaryPoints) -> Iterator[Json]:
    """Yield boundary points as plain values; surfaces count from 1, parameters are None where there are none."""
    names = (*computed.names, None)

    def at(values: list[float]) -> list[float] | None:
        return None if any(value != value for value in values) else values

    for n in range(len(marks)):
        i, j = int(marks.before[n]), int(marks.after[n])
        x, y, z = marks.place[n].tolist()
        yield {
            "plane": int(marks.plane[n]) + 1,
            "i": None if i == NO_SURFACE else i + 1,
            "j": None if j == NO_SURFACE else j + 1,
            "surface_i": names[i],
            "surface_j": names[j],
            "kind": BoundaryKind(int(marks.kind[n])).name.lower(),
            "x": x,
            "y": y,
            "z": z,
            "end": marks.end[n].tolist(),
            "uv_i": at(marks.before_at[n].tolist()),
            "uv_j": at(marks.after_at[n].tolist()),
        }


def _summary(data: Json) -> Iterator[str]:
    """Yield a line about the whole, and one for each family of passes."""
    length = data["length_mm"]
    head = f"{data['scene']}: {counted(len(data['surfaces']), 'surface')}, {length['cut']:.0f} mm of passes"
    if "gouge" in data:
        gouge = data["gouge"]
        sure = f"proven: no move deeper than {gouge['max_mm']} mm in a surface"
        proven = f"{counted(gouge['count'], 'move')} not proven" if gouge["count"] else sure
        head += f", {counted(data['retracts'], 'retract')}, {minutes_words(data['time_s'])} min; {proven}"
        if data["left"] is not None:
            head += f"; {data['left']['reachable_mm2']:.3f} mm2 left within reach"
    yield head
    for each in data["passes"]:
        met = ", ".join(f"{count} {kind}" for kind, count in each["path"]["boundary_points"].items() if count)
        name = f" {each['name']}" if each["name"] else ""
        yield (
            f"  T{each['tool']} {each['kind']} {each['diameter_mm']:g} mm{name}: {counted(each['planes'], 'plane')}, "
            f"{each['path']['points']} points; boundary points: {met or 'none'}"
        )
