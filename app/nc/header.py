"""The comments at the head of a program: for the operator, and for `hitofude cut --against`.

Comments that begin with `hitofude:` hold one `key=value` each, in this order and always in mm, part coordinates:

    program=1                                       version of this list
    part=NAME                                       as in the first comment, which begins with a word of its own:
                                                    controls obey comments that begin with MSG or PRINT
    drawing_units=mm|inch|cm|m|foot|micron          of the drawing that the part came from
    layer=NAME                                      one a layer, where layers were chosen; see `spelled_name`
    join_tolerance_mm=T                             at which loose ends of the drawing were joined
    units=mm|in                                     of the program's words
    origin_mm=X,Y,Z                                 the work origin; part = program + origin
    stock_mm=X0,Y0,Z0,X1,Y1,Z1                      the stock's box
    tool=NUMBER,KIND,DIAMETER                       one a tool, in the order of use; ,CORNER,TIP,ANGLE behind it (radius of the
                                                    corner, diameter of the tip, full angle in degrees) where it has one of them
    operation=KIND,TOOL,DEPTH,STOCK_TO_LEAVE        one an operation that cuts
    path_tolerance_mm=T                             proven: the written path is nowhere nearer to the walls than asked by more
    allowance_mm=T                                  of paths made from pixels: so thick a skin may they leave along the walls
    blend_mm=P                                      how far the control may leave the written path

A comment that begins with `hitofude+` goes on with the one before. For a control that knows capitals alone, all of this is
in capitals, so keys and values are read without regard to case. Where each tool has a file of its own, `tool` and `operation`
tell of that file.
"""

from __future__ import annotations

import math
import unicodedata
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from app.model.job import Job
from app.model.moves import Program
from app.model.operation import Operation, PocketOperation
from app.model.part import Units
from app.model.stock_box import StockBox, work_origin
from app.model.tool import Tool
from app.nc.post import Post
from app.tolerances import LEVEL

ALLOWED = frozenset("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789 _.,+-/")
LONGEST_NAME = 60


@dataclass(frozen=True, slots=True)
class Heading:
    """What the header tells of.

    Attributes:
        blend_mm: how far the control may leave the path, mm; 0 = exact path.
        writing_mm: how far the written path may leave the computed one, mm.
        file, files: which of how many files of the program this is, from 1.
    """

    program: Program
    job: Job
    post: Post
    box: StockBox
    blend_mm: float
    writing_mm: float
    file: int = 1
    files: int = 1


def safe_name(text: str) -> str:
    """Return a name as any control takes it in a comment: ASCII letters, digits and a few signs, not too long."""
    plain = unicodedata.normalize("NFKD", text)
    kept = "".join(c if c in ALLOWED else "_" for c in plain if not unicodedata.combining(c))
    return kept.strip()[:LONGEST_NAME].rstrip() or "untitled"


def spelled_name(text: str) -> str:
    """Return a name in safe characters from which it can be read again: others become their code point, "+DF+"."""
    return "".join(c if c in ALLOWED and c != "+" else f"+{ord(c):X}+" for c in text)


def tool_words(tool: Tool, units: Units) -> str:
    """Return a tool in the trade's habit: "T1 flat 6 mm"; a V or drill with its name, if it has one."""
    words = f"T{tool.number} {tool.kind.value} {_length(tool.diameter, units)}"
    return f"{words} {safe_name(tool.name)}" if tool.name else words


def operation_words(operation: Operation, job: Job) -> str:
    """Return an operation in words: "Pocket T1: depth 2 mm, ..."."""
    cut, units = operation.cut, job.out_units
    pocket = isinstance(operation, PocketOperation)
    words = [f"depth {_length(cut.depth, units)}", f"stepdown {_length(cut.stepdown, units)}"]
    if isinstance(operation, PocketOperation):
        stepover = operation.stepover or job.tool(cut.tool).radius
        words.append(f"stepover {_length(stepover, units)}")
    words += [f"stock to leave {_length(cut.stock_to_leave, units)}", cut.direction.value]
    return f"{'Pocket' if pocket else 'Contour'} T{cut.tool}: {', '.join(words)}"


def heading_lines(heading: Heading) -> Iterator[str]:
    """Yield the comments for the operator, without their brackets."""
    job, units = heading.job, heading.job.out_units
    yield f"Part {safe_name(job.part.name)}"
    yield f"Hitofude for {safe_name(heading.post.title)}, lengths in {units.name.lower()}"
    if heading.files > 1:
        yield f"File {heading.file} of {heading.files}, with T{heading.program.moves.tool[0]} alone, X and Y zero as in the others"
        yield "Set Z zero with this tool in the spindle"
    yield "Stock " + " x ".join(_length(side, units) for side in heading.box.size)
    origin = ", ".join(f"{axis} {_length(value, units)}" for axis, value in zip("XYZ", work_origin(job, heading.box), strict=True))
    yield f"Work origin: {job.origin_xy.value}, {job.origin_z.value}"
    yield f"It is at {origin} of the drawing, whose Z 0 is the top of stock"
    yield from (tool_words(tool, units) + f", {tool.spindle_speed:.0f} rpm" for tool in _tools(heading))
    yield from (operation_words(operation, job) + ("" if cuts else ", makes no moves") for operation, cuts in _operations(heading))
    if heading.program.given_up_mm is None:
        yield f"Path within {_length(_path_tolerance(heading), units)} of the exact offset of the drawing"
    else:
        yield f"Path made from pixels, nowhere nearer to the walls than asked by more than {_length(_path_tolerance(heading), units)}"
        yield f"It is up to {_length(heading.program.given_up_mm, units)} farther from them"
    yield _blending_words(heading)


def heading_notes(heading: Heading) -> Iterator[str]:
    """Yield the comments for `hitofude cut --against`, without their brackets."""
    yield from (f"hitofude: {note}" for note in _notes(heading))


def _blending_words(heading: Heading) -> str:
    """Return what the control may do at corners."""
    if heading.blend_mm == 0:
        return "Exact path: the control does not blend"
    amount = _length(heading.blend_mm, heading.job.out_units)
    before, field, _ = heading.post.blending.blend.partition("{blend}")
    if not field:
        return f"Proven on the path; the control may blend by its own setting, taken as {amount}"
    return f"Proven on the path; the control may blend by up to {before[-1]} {amount}"


def _notes(heading: Heading) -> Iterator[str]:
    """Yield every key and its value."""
    job, box = heading.job, heading.box
    yield "program=1"
    yield f"part={safe_name(job.part.name)}"
    yield f"drawing_units={job.part.units.name.lower()}"
    yield from (f"layer={spelled_name(name)}" for name in job.layer_names)
    yield f"join_tolerance_mm={_numbers(job.join_tolerance)}"
    yield f"units={_unit(job.out_units)}"
    yield f"origin_mm={_numbers(*work_origin(job, box))}"
    yield f"stock_mm={_numbers(box.x0, box.y0, box.z0, box.x1, box.y1, box.z1)}"
    for tool in _tools(heading):
        yield f"tool={tool.number},{tool.kind.value},{_numbers(tool.diameter, *_shape(tool))}"
    for operation, cuts in _operations(heading):
        if cuts:
            kind = "pocket" if isinstance(operation, PocketOperation) else "contour"
            yield f"operation={kind},{operation.cut.tool},{_numbers(operation.cut.depth, operation.cut.stock_to_leave)}"
    yield f"path_tolerance_mm={_numbers(_path_tolerance(heading))}"
    if heading.program.allowance_mm:
        yield f"allowance_mm={_numbers(heading.program.allowance_mm)}"
    yield f"blend_mm={_numbers(heading.blend_mm)}"


def _shape(tool: Tool) -> tuple[float, ...]:
    """Return corner radius and tip diameter, mm, and full tip angle, degrees, of a tool that has one of them."""
    shape = (tool.corner_radius, tool.tip_diameter, math.degrees(tool.tip_angle))
    return shape if any(shape) else ()


def _path_tolerance(heading: Heading) -> float:
    """Return by how much the written path may be too near to the walls, mm: curves as arcs, the path's levels, its writing."""
    curves = max((contour.deviation for region in heading.program.regions for contour in region.contours), default=0.0)
    return curves + LEVEL + heading.writing_mm


def _tools(heading: Heading) -> list[Tool]:
    """Return the tools in the order of their use."""
    return [heading.job.tool(number) for number in dict.fromkeys(heading.program.moves.tool.tolist())]


def _operations(heading: Heading) -> list[tuple[Operation, bool]]:
    """Return enabled operations, and whether each has moves; in one of several files those that it holds."""
    used = set(np.unique(heading.program.moves.operation).tolist())
    shown = ((i, operation) for i, operation in enumerate(heading.job.operations) if operation.cut.enabled)
    return [(operation, i in used) for i, operation in shown if i in used or heading.files == 1]


def _length(value: float, units: Units) -> str:
    """Return a length in out units with its unit."""
    return f"{_numbers(value / units.value)} {_unit(units)}"


def _unit(units: Units) -> str:
    """Return the unit's sign."""
    return "in" if units is Units.INCH else "mm"


def _numbers(*values: float) -> str:
    """Return numbers with at most 6 decimals and no zeros behind, joined by commas."""
    return ",".join(f"{round(value, 6) + 0.0:.6f}".rstrip("0").rstrip(".") for value in values)
