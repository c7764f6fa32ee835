"""An operation that is added in the panel has a tool that can do it, a depth that suits it, and a place."""

import math
from dataclasses import replace

import pytest

from app.formats.tools.library import load_libraries
from app.model.chamfer_operation import ChamferOperation
from app.model.contour_operation import ContourOperation
from app.model.job import Job
from app.model.operation import CutParameters, Operation, Order, PocketOperation, Side
from app.model.part import Part
from app.model.tool import Tool
from app.model.tool_kind import ToolKind
from app.model.vcarve_operation import VcarveOperation
from app.ui.panels.changes import kind_name, operation_name, refusal, with_new_operation

CUT_OUT = Job(
    Part(),
    tools=(Tool(8, 6.0),),
    operations=(ContourOperation(CutParameters(8, depth=8.0), Side.OUTSIDE),),
    order=Order.POCKET_FIRST,
)


def library() -> list[Tool]:
    return [tool for each in load_libraries().libraries.values() for tool in each.tools]


@pytest.mark.parametrize("kind", [VcarveOperation, ChamferOperation])
def test_a_tool_that_can_do_it_comes_from_the_library(kind: type[Operation]) -> None:
    job, place = with_new_operation(CUT_OUT, kind, library)
    new = job.operations[place]
    assert refusal(job, new) == "" and job.tools[0].number == 8 and len(job.tools) == 2
    assert math.degrees(job.cutter(new).tip_angle) == pytest.approx(60.0)
    assert new.cut.depth == CutParameters(8).depth, "not as deep as what cuts the part out"


def test_one_of_the_job_is_taken_first_and_nothing_is_added_where_its_own_can_do_it() -> None:
    pointed = Tool(3, 6.0, ToolKind.V, tip_angle=math.radians(90))
    with_v = replace(CUT_OUT, tools=(*CUT_OUT.tools, pointed))
    job, place = with_new_operation(with_v, VcarveOperation, library)
    assert (job.operations[place].cut.tool, job.tools) == (3, with_v.tools)
    job, place = with_new_operation(CUT_OUT, PocketOperation, library)
    assert (job.operations[place].cut.tool, job.tools) == (8, CUT_OUT.tools)


def test_without_a_library_it_is_added_and_says_what_is_wrong() -> None:
    job, place = with_new_operation(CUT_OUT, VcarveOperation)
    assert job.operations[place].cut.tool == 8 and "needs a V cutter" in refusal(job, job.operations[place])


def test_nothing_comes_behind_what_cuts_the_part_out() -> None:
    job, place = with_new_operation(CUT_OUT, VcarveOperation, library)
    assert place == 0 and job.operations[1] == CUT_OUT.operations[0]
    assert with_new_operation(CUT_OUT, ContourOperation, library).place == 1


def test_kinds_are_called_as_the_trade_does() -> None:
    assert kind_name(VcarveOperation) == operation_name(VcarveOperation(CutParameters(1))) == "V-carve"
    assert kind_name(PocketOperation) == "Pocket"
