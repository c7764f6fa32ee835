"""A drawing that a program is held against: the areas that its comments lead to are those that it was computed from."""

from __future__ import annotations

import io
from dataclasses import replace

import pytest
import shapely
from ezdxf.document import Drawing

from app.formats.readers import read_drawing
from app.gcode.posts import load_post
from app.gcode.writer.write import write_files
from app.model.contour_operation import ContourOperation
from app.model.curve_selectors import on_layers
from app.model.entry import Lead, LeadKind
from app.model.hole_operations import DrillOperation
from app.model.job import Copies, Job
from app.model.moves import Area, DogBone, Program, Tab
from app.model.operation import CutParameters, Operation, PocketOperation, Side
from app.model.tool import Tool
from app.model.tool_kind import ToolKind
from app.operations.compute import followed_lines
from app.toolpath.coverage.areas import region_shapes
from app.toolpath.drawn_contours import drawn_contours
from app.toolpath.machining_areas import MachiningAreas
from app.usecases.cutting.ready_setup import SetupRequest, setup_of
from app.usecases.examine import ExamineOptions, examine
from app.verify.parts import FlatPart
from tests.gcode.programs import Path

TOOLS = (Tool(1, 4.0), Tool(2, 5.0, ToolKind.DRILL))
TABS, BONES = (Tab(50.0, -2.0, 5.0, -1.0, 4.0),), (DogBone(1.0, 1.0, 0.5, 0.5, 4.0),)


def drawing() -> bytes:
    """A plate with holes, a pocket, two clamps over one another, and a line to engrave, in lower and upper case
    layers.
    """
    document = Drawing.new()
    document.header["$INSUNITS"] = 4
    space = document.modelspace()
    space.add_lwpolyline([(0, 0), (100, 0), (100, 60), (0, 60)], close=True, dxfattribs={"layer": "outline"})
    for x, y, radius in ((10, 10, 2.5), (90, 10, 2.5), (90, 50, 2.5), (30, 30, 8)):
        space.add_circle((x, y), radius, dxfattribs={"layer": "Holes"})
    for x in (-5, 2):
        space.add_lwpolyline([(x, 40), (x + 12, 40), (x + 12, 52), (x, 52)], close=True, dxfattribs={"layer": "clamps"})
    space.add_line((60, 20), (80, 40), dxfattribs={"layer": "text"})
    stream = io.StringIO()
    document.write(stream)
    return stream.getvalue().encode()


OPERATIONS: dict[str, tuple[Operation, ...]] = {
    "pocket": (PocketOperation(CutParameters(1, 3.0, floor_to_leave=0.5)),),
    "layers": (
        PocketOperation(CutParameters(1, 3.0, curves=on_layers(("Holes",)))),
        ContourOperation(CutParameters(1, 5.0, curves=on_layers(("outline",))), Side.OUTSIDE),
    ),
    "holes": (
        DrillOperation(CutParameters(2, 4.0, curves=on_layers(("Holes",))), through=1.0),
        ContourOperation(CutParameters(1, 2.0, curves=on_layers(("text",))), Side.ON),
    ),
    "leads": (
        ContourOperation(
            CutParameters(1, 2.0, 1.0, 0.25, curves=on_layers(("outline",))),
            Side.OUTSIDE,
            Lead(LeadKind.LINE, 35.5),
            finish_width=1.5,
        ),
    ),
    "wide holes": (DrillOperation(CutParameters(2, 4.0), least=4.0, most=20.0),),
}


@pytest.mark.parametrize("post", ["linuxcnc", "fanuc"])
@pytest.mark.parametrize("name", list(OPERATIONS))
def test_comments_lead_to_the_same_areas(name: str, post: str) -> None:
    """Through the capitals of a control that knows no others too."""
    part = read_drawing("plate.dxf", drawing()).part
    job = Job(
        part,
        TOOLS,
        OPERATIONS[name],
        layer_names=("outline", "Holes", "text"),
        copies=Copies(2, 1, 130.0 + 1 / 3),
        keep_out_layers=("clamps",),
        keep_out_height=8.0,
        post=post,
    )
    made = drawn_contours(job)
    program = replace(
        _moves(job),
        regions=made.regions.regions,
        areas=MachiningAreas(job, made).areas(),
        lines=followed_lines(job, made),
        tabs=TABS,
        dog_bones=BONES,
    )
    texts = [file.nc.text for file in write_files(program, job, load_post(post))]
    examined = tuple(
        examine(f"{k}.nc", text.encode(), ExamineOptions(load_post(post).dialect)) for k, text in enumerate(texts)
    )
    found = setup_of(examined, SetupRequest(against=("plate.dxf", drawing()))).setup.part
    assert isinstance(found, FlatPart)
    assert len(found.areas) == len(program.areas)
    for mine, theirs in zip(program.areas, found.areas, strict=True):
        assert _apart(mine, theirs) < 1e-6
        assert (len(mine.lines), len(mine.bare), mine.whole) == (len(theirs.lines), len(theirs.bare), theirs.whole)
    assert len(found.lines) == len(program.lines)
    assert (found.tabs, found.dog_bones) == (TABS, BONES)
    assert found.job.keep_out_layers == ("clamps",)
    assert found.job.travel_z == job.travel_z
    for asked, told in zip(job.operations, found.job.operations, strict=True):
        assert type(told) is type(asked)
        assert (told.cut.depth, told.cut.floor, told.cut.curves) == (asked.cut.depth, asked.cut.floor, asked.cut.curves)
        if isinstance(asked, DrillOperation) and isinstance(told, DrillOperation):
            assert (told.least, told.most, told.through) == (asked.least, asked.most, asked.through)


def _moves(job: Job) -> Program:
    """A short cut with the tool of each operation."""
    path = Path()
    for index, operation in enumerate(job.operations):
        path.operation, path.tool = index, operation.cut.tool
        z = job.travel_z
        path.rapid(30, 30, z).line(30, 30, -1).line(31, 30, -1).rapid(31, 30, z)
    return path.program()


def _apart(mine: Area, theirs: Area) -> float:
    """The area by which two differ, mm2."""
    shapes = [shapely.union_all(region_shapes(area.regions, 1e-4)) for area in (mine, theirs)]
    return float(shapely.symmetric_difference(*shapes).area)
