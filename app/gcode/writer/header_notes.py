"""The comments at the head of a program that `hitofude cut --against` reads.

Comments that begin with `hitofude:` hold one `key=value` each, in this order and always in mm, part coordinates:

    program=1                                     version of this list
    part=NAME                                     as in the first comment, which begins with a word of its own: controls
                                                  obey comments that begin with MSG or PRINT
    drawing_units=mm|inch|cm|m|foot|micron        of the drawing that the part came from
    layer=NAME                                    one a layer, where layers were chosen; see `spelled`
    skip_layer=NAME, skip_type=NAME               one a layer, one a type of entities, of which nothing was read
    layout=NAME                                   of paper space that was read in place of model space
    to_zero=1                                     where the drawing was moved to zero
    px_per_inch=N                                 units to the inch of a drawing without a real size, as said or assumed
    overrule_units=1                              where drawing_units hold though the drawing names others
    join_tolerance_mm=T                           at which loose ends of the drawing were joined
    copies=COLUMNS,ROWS,DX,DY                     where the part was cut more than once
    keep_out=NAME                                 one a layer of clamps
    keep_out_height_mm=H                          of clamps above the stock, where there are any
    units=mm|in                                   of the program's words
    origin_mm=X,Y,Z                               the work origin; part = program + origin
    stock_mm=X0,Y0,Z0,X1,Y1,Z1                    the stock's box
    above_mm=H                                    what of the stock stands above Z 0 of the drawing, if any
    under_mm=H                                    of waste below the stock that may be cut into, if any
    tool=NUMBER,KIND,DIAMETER,CORNER,TIP,ANGLE    one a tool, in the order of use, those that make no moves last; radius
                                                  of the corner, diameter of the tip and full angle in degrees only
                                                  where it has one of them
    plunge_mm_min=NUMBER,RATE                     of programs over surfaces: how fast each tool is fed straight down
    operation=KIND,KEY=VALUE,...                  one an operation, also one that makes no moves: see
                                                  `app.gcode.operation_notes`
    tab=X,Y,WIDTH,TOP,DIAMETER                    one a bridge of metal: its middle, and the diameter of the cutter that
                                                  went over it
    dog_bone=X0,Y0,X1,Y1,DIAMETER                 one a way of the cutter's centre into a corner
    path_tolerance_mm=T                           proven: the written path is nowhere nearer to the walls than asked by
                                                  more
    allowance_mm=T                                of paths made from pixels: so thick a skin may they leave along the
                                                  walls
    blend_mm=P                                    how far the control may leave the written path

`registers=wear` says that the registers of D words hold the wear of tools, 0 at first, and no diameters, but for those
of `register_mm=T,D`: the diameter of a tool whose contours the control offsets by its whole radius.

A comment that begins with `hitofude+` goes on with the one before. For a control that knows capitals alone, all of this
is in capitals, so keys and values are read without regard to case. Where each tool has a file of its own, `tool` and
`operation` tell of that file.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from ...model.job import Copies, Job
from ...model.moves import Program
from ...model.read_options import DrawingOptions
from ...model.stock_box import work_origin
from ...model.tool import Tool
from ..note_texts import plain_numbers, spelled
from ..operation_notes import written
from .header import HeaderContent, operations_of, path_tolerance, safe_name, tools_of, unit_sign


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
    yield from _copies_and_clamps(job)
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


def _copies_and_clamps(job: Job) -> Iterator[str]:
    if job.copies != Copies():
        yield f"copies={plain_numbers(job.copies.columns, job.copies.rows, job.copies.dx, job.copies.dy, decimals=9)}"
    yield from (f"keep_out={spelled(name)}" for name in job.keep_out_layers)
    if job.keep_out_layers:
        yield f"keep_out_height_mm={plain_numbers(job.keep_out_height)}"


def _on_purpose(program: Program) -> Iterator[str]:
    """Yield where metal was left standing, and where walls were cut into."""
    for tab in program.tabs:
        yield f"tab={plain_numbers(tab.x, tab.y, tab.width, tab.top, tab.diameter)}"
    for dog_bone in program.dog_bones:
        yield f"dog_bone={plain_numbers(dog_bone.x0, dog_bone.y0, dog_bone.x1, dog_bone.y1, dog_bone.diameter)}"


def shape_numbers(tool: Tool) -> tuple[float, ...]:
    """Return corner radius and tip diameter, mm, and full tip angle, degrees, of a tool that has one of them."""
    shape = (tool.corner_radius, tool.tip_diameter, math.degrees(tool.tip_angle))
    return shape if any(shape) else ()
