"""The comments at the head of a program for the operator; `app.gcode.writer.header_notes` has those for `hitofude cut
--against`.
"""

from __future__ import annotations

import unicodedata
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from ...core.tolerances import LEVEL
from ...model.fields import Parameter, ParameterPlace, Unit, parameters_of
from ...model.job import Job
from ...model.moves import Program
from ...model.operation import Operation
from ...model.part import Units
from ...model.stock_box import StockBox, work_origin
from ...model.tool import Tool
from ..note_texts import ALLOWED, plain_numbers
from ..posts.post import Post

LONGEST_NAME = 60


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
