"""The comments at the head of a program: for the operator, and what `hitofude cut --against` reads."""

from __future__ import annotations

import math
import unicodedata
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from ...core.tolerances import LEVEL
from ...model.fields import Parameter, ParameterPlace, Unit, parameters_of
from ...model.job import Copies, Job
from ...model.moves import Program
from ...model.operation import Operation
from ...model.part import Units
from ...model.read_options import DrawingOptions
from ...model.stock_box import StockBox, work_origin
from ...model.tool import Tool
from ..operation_notes import ALLOWED, plain_numbers, spelled, written
from ..posts import Post

LONGEST_NAME = 60
"""Letters of a part's name in a comment, at most."""


@dataclass(frozen=True, slots=True)
class HeaderContent:
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


def tool_words(tool: Tool, units: Units) -> str:
    """Return a tool in the trade's habit: "T1 flat 6 mm"; with its name, if it has one that says more."""
    words = f"T{tool.number} {tool.kind.value} {_length(tool.diameter, units)}"
    unnamed = replace(tool, name="").label
    return f"{words} {safe_name(tool.name)}" if tool.name and tool.name.casefold() != unnamed.casefold() else words


def operation_words(operation: Operation, job: Job) -> str:
    """Return an operation in words: "Pocket T1: depth 2 mm, ...", the kind first, as
    `app.gcode.interpreter.notes_operation` reads it.
    """
    words = (
        _parameter_words(placed, placed.of(operation), job.out_units)
        for placed in parameters_of(type(operation)).values()
    )
    return f"{operation.WORD.capitalize()} T{operation.cut.tool}: {', '.join(filter(None, words))}"


_SHORT = 12  # letters

_NAMED = 6
"""Selectors of curves that an operator is told one by one."""

_ALWAYS = ("depth", "stepdown", "stepover", "stock_to_leave", "direction", "peck", "thread")
"""Parameters that are told also where they have their default."""


def _parameter_words(placed: ParameterPlace, value: Any, units: Units) -> str:
    """Return a parameter in words; none where it has its default, or is told elsewhere."""
    declared, name = placed.parameter, placed.parameter.label.lower()
    if placed.key in ("tool", "enabled") or (value == placed.default and placed.key not in _ALWAYS):
        return ""
    match declared.unit:
        case Unit.LENGTH:
            return f"{name} {_auto(declared) if value is None else _length(value, units)}"
        case Unit.CHOICE:
            return str(value.value) if placed.key == "direction" else f"{name} {value.value}"
        case Unit.FLAG:
            return name
        case Unit.COUNT:
            return f"{value} {name}"
        case Unit.CURVES:
            more = [f"{len(value) - _NAMED} more"] if len(value) > _NAMED else []
            return f"{name} {' and '.join([*(safe_name(each.words) for each in value[:_NAMED]), *more])}"
        case Unit.POINTS:
            return f"{len(value)} {name}"
        case _:
            return f"{name} {plain_numbers(declared.shown(value))}{declared.sign}".replace("%", "percent")


def _auto(declared: Parameter) -> str:
    """Return in a word what stands for a parameter that nobody has said."""
    return declared.auto if len(declared.auto) <= _SHORT else "automatic"


def heading_lines(heading: HeaderContent) -> Iterator[str]:
    """Yield the comments for the operator, without their brackets."""
    job, units = heading.job, heading.job.out_units
    yield f"Part {safe_name(job.part.name)}"
    yield f"Hitofude for {safe_name(heading.post.title)}, lengths in {units.name.lower()}"
    if heading.files > 1:
        yield (
            f"File {heading.file} of {heading.files}, with T{heading.program.moves.tool[0]} alone, X and Y zero as "
            "in the others"
        )
        yield "Set Z zero with this tool in the spindle"
    yield "Stock " + " x ".join(_length(side, units) for side in heading.box.size)
    if job.stock.above:
        yield f"{_length(job.stock.above, units)} of it stand above Z 0 of the drawing"
    if job.stock.under:
        yield f"It lies on {_length(job.stock.under, units)} of waste, which the tool cuts into"
    origin = ", ".join(
        f"{axis} {_length(value, units)}" for axis, value in zip("XYZ", work_origin(job, heading.box), strict=True)
    )
    yield f"Work origin: {job.origin_xy.value}, {job.origin_z.value}"
    yield f"It is at {origin} of the drawing, whose Z 0 is the top of stock"
    yield from _copies_and_clamps(job)
    yield from (tool_words(tool, units) + f", {tool.spindle_speed:.0f} rpm" for tool in tools_of(heading))
    yield from (
        operation_words(operation, job) + ("" if cuts else ", makes no moves")
        for operation, cuts in operations_of(heading)
    )
    yield from _registers(heading)
    if heading.program.given_up_mm is None:
        yield f"Path within {_length(path_tolerance(heading), units)} of the exact offset of the drawing"
    else:
        yield (
            "Path made from pixels, nowhere nearer to the walls than asked by more than "
            f"{_length(path_tolerance(heading), units)}"
        )
        yield f"It is up to {_length(heading.program.given_up_mm, units)} farther from them"
    yield _blending_words(heading)


def _registers(heading: HeaderContent) -> Iterator[str]:
    """Yield what has to stand in the registers of tools by whose whole radius the control offsets contours."""
    job, units = heading.job, heading.job.out_units
    for number in sorted({each.cut.tool for each, _ in operations_of(heading) if each.offset_by_control}):
        tool = job.tool(number)
        yield heading.post.compensation.register.format(
            tool=number, radius=_length(tool.radius, units), diameter=_length(tool.diameter, units)
        )


def _copies_and_clamps(job: Job) -> Iterator[str]:
    """Yield what an operator has to set up beside the stock."""
    copies, units = job.copies, job.out_units
    if len(copies.shifts) > 1:
        yield (
            f"{copies.columns} x {copies.rows} copies, {_length(copies.dx, units)} apart along X and "
            f"{_length(copies.dy, units)} along Y"
        )
    if job.keep_out_layers:
        names = " and ".join(map(safe_name, job.keep_out_layers))
        yield f"Clamps of layer {names}, up to {_length(job.keep_out_height, units)} above the stock"
        yield f"The tool travels at {_length(job.travel_z, units)} above the stock"


def _blending_words(heading: HeaderContent) -> str:
    """Return what the control may do at corners."""
    if heading.blend_mm == 0:
        return "Exact path: the control does not blend"
    amount = _length(heading.blend_mm, heading.job.out_units)
    before, field, _ = heading.post.blending.blend.partition("{blend}")
    if not field:
        return f"Proven on the path; the control may blend by its own setting, taken as {amount}"
    return f"Proven on the path; the control may blend by up to {before[-1]} {amount}"


def path_tolerance(heading: HeaderContent) -> float:
    """Return by how much the written path may be too near to the walls, mm: curves as arcs, the path's levels, its
    writing.
    """
    contours = (*(contour for region in heading.program.regions for contour in region.contours), *heading.program.lines)
    curves = max((contour.deviation for contour in contours), default=0.0)
    return curves + LEVEL + heading.writing_mm


def tools_of(heading: HeaderContent) -> list[Tool]:
    """Return the tools in the order of their use."""
    return [heading.job.tool(number) for number in dict.fromkeys(heading.program.moves.tool.tolist())]


class ListedOperation(NamedTuple):
    """An operation that a header names, and whether it has moves there."""

    operation: Operation
    cuts: bool


def operations_of(heading: HeaderContent) -> list[ListedOperation]:
    """Return enabled operations, and whether each has moves; in one of several files those that it holds."""
    used = set(np.unique(heading.program.moves.operation).tolist())
    shown = ((i, operation) for i, operation in enumerate(heading.job.operations) if operation.cut.enabled)
    return [ListedOperation(operation, i in used) for i, operation in shown if i in used or heading.files == 1]


def _length(value: float, units: Units) -> str:
    """Return a length in out units with its unit."""
    return f"{plain_numbers(value / units.value)} {unit_sign(units)}"


def unit_sign(units: Units) -> str:
    """Return the unit's sign."""
    return "in" if units is Units.INCH else "mm"


# The comments at the head of a program that `hitofude cut --against` reads.
#
# Comments that begin with `hitofude:` hold one `key=value` each, in this order and always in mm, part coordinates:
#
#     program=1                                     version of this list     part=NAME
# as in the first comment, which begins with a word of its own: controls
# obey comments that begin with MSG or PRINT     drawing_units=mm|inch|cm|m|foot|micron        of the drawing that the
# part came from     layer=NAME                                    one a layer, where layers were chosen; see `spelled`
# skip_layer=NAME, skip_type=NAME               one a layer, one a type of entities, of which nothing was read
# layout=NAME                                   of paper space that was read in place of model space     to_zero=1
# where the drawing was moved to zero     px_per_inch=N                                 units to the inch of a drawing
# without a real size, as said or assumed     overrule_units=1                              where drawing_units hold
# though the drawing names others     join_tolerance_mm=T                           at which loose ends of the drawing
# were joined     copies=COLUMNS,ROWS,DX,DY                     where the part was cut more than once     keep_out=NAME
# one a layer of clamps     keep_out_height_mm=H                          of clamps above the stock, where there are
# any     units=mm|in                                   of the program's words     origin_mm=X,Y,Z
# the work origin; part = program + origin     stock_mm=X0,Y0,Z0,X1,Y1,Z1                    the stock's box
# above_mm=H                                    what of the stock stands above Z 0 of the drawing, if any
# under_mm=H                                    of waste below the stock that may be cut into, if any
# tool=NUMBER,KIND,DIAMETER,CORNER,TIP,ANGLE    one a tool, in the order of use, those that make no moves last; radius
# of the corner, diameter of the tip and full angle in degrees only
# where it has one of them     plunge_mm_min=NUMBER,RATE                     of programs over surfaces: how fast each
# tool is fed straight down     operation=KIND,KEY=VALUE,...                  one an operation, also one that makes no
# moves: see                                                   `app.gcode.operation_notes`
# tab=X,Y,WIDTH,TOP,DIAMETER                    one a bridge of metal: its middle, and the diameter of the cutter that
# went over it     dog_bone=X0,Y0,X1,Y1,DIAMETER                 one a way of the cutter's centre into a corner
# path_tolerance_mm=T                           proven: the written path is nowhere nearer to the walls than asked by
# more     allowance_mm=T                                of paths made from pixels: so thick a skin may they leave
# along the                                                   walls     blend_mm=P
# how far the control may leave the written path
#
# `registers=wear` says that the registers of D words hold the wear of tools, 0 at first, and no diameters, but for
# those of `register_mm=T,D`: the diameter of a tool whose contours the control offsets by its whole radius.
#
# A comment that begins with `hitofude+` goes on with the one before. For a control that knows capitals alone, all of
# this is in capitals, so keys and values are read without regard to case. Where each tool has a file of its own,
# `tool` and `operation` tell of that file.


def heading_notes(heading: HeaderContent) -> Iterator[str]:
    """Yield the comments for `hitofude cut --against`, without their brackets."""
    yield from (f"hitofude: {note}" for note in _notes(heading))


def _notes(heading: HeaderContent) -> Iterator[str]:
    """Yield every key and its value."""
    job, box = heading.job, heading.box
    yield "program=1"
    yield f"part={safe_name(job.part.name)}"
    yield f"drawing_units={job.part.units.name.lower()}"
    yield from (f"layer={spelled(name)}" for name in job.layer_names)
    yield from _reading(job.part.reading)
    yield f"join_tolerance_mm={plain_numbers(job.join_tolerance)}"
    yield from _copies_and_clamps_note(job)
    yield f"units={unit_sign(job.out_units)}"
    yield f"origin_mm={plain_numbers(*work_origin(job, box))}"
    yield f"stock_mm={plain_numbers(box.x0, box.y0, box.z0, box.x1, box.y1, box.z1)}"
    if job.stock.above:
        yield f"above_mm={plain_numbers(job.stock.above)}"
    if job.stock.under:
        yield f"under_mm={plain_numbers(job.stock.under)}"
    operations = [listed.operation for listed in operations_of(heading)]
    for tool in dict.fromkeys((*tools_of(heading), *(job.tool(each.cut.tool) for each in operations))):
        yield f"tool={tool.number},{tool.kind.value},{plain_numbers(tool.diameter, *shape_numbers(tool))}"
    yield from (f"operation={written(operation)}" for operation in operations)
    yield from _on_purpose(heading.program)
    if any(each.wear for each in operations):
        yield "registers=wear"
    for number in sorted({each.cut.tool for each in operations if each.offset_by_control}):
        yield f"register_mm={number},{plain_numbers(job.tool(number).diameter)}"
    yield f"path_tolerance_mm={plain_numbers(path_tolerance(heading))}"
    if heading.program.allowance_mm:
        yield f"allowance_mm={plain_numbers(heading.program.allowance_mm)}"
    yield f"blend_mm={plain_numbers(heading.blend_mm)}"


def _reading(how: DrawingOptions) -> Iterator[str]:
    """Yield how the drawing was read, where that is not as it is drawn."""
    yield from (f"skip_layer={spelled(name)}" for name in how.without_layers)
    yield from (f"skip_type={spelled(name)}" for name in how.without_types)
    if how.layout:
        yield f"layout={spelled(how.layout)}"
    if how.to_zero:
        yield "to_zero=1"
    if how.pixels_per_inch is not None:
        yield f"px_per_inch={plain_numbers(how.pixels_per_inch, decimals=9)}"
    if how.overrule:
        yield "overrule_units=1"


def _copies_and_clamps_note(job: Job) -> Iterator[str]:
    if job.copies != Copies():
        yield f"copies={plain_numbers(job.copies.columns, job.copies.rows, job.copies.dx, job.copies.dy, decimals=9)}"
    yield from (f"keep_out={spelled(name)}" for name in job.keep_out_layers)
    if job.keep_out_layers:
        yield f"keep_out_height_mm={plain_numbers(job.keep_out_height)}"


def _on_purpose(program: Program) -> Iterator[str]:
    """Yield where metal was left standing, and where walls were cut into."""
    for tab in program.tabs:
        waste = () if tab.holds_part else (0.0,)
        yield f"tab={plain_numbers(tab.x, tab.y, tab.width, tab.top, tab.diameter, *waste)}"
    for dog_bone in program.dog_bones:
        yield f"dog_bone={plain_numbers(dog_bone.x0, dog_bone.y0, dog_bone.x1, dog_bone.y1, dog_bone.diameter)}"


def shape_numbers(tool: Tool) -> tuple[float, ...]:
    """Return corner radius and tip diameter, mm, and full tip angle, degrees, of a tool that has one of them."""
    shape = (tool.corner_radius, tool.tip_diameter, math.degrees(tool.tip_angle))
    return shape if any(shape) else ()
