"""Which changes of a job leave its paths as they are."""

from dataclasses import replace

from app.model.contour_operation import ContourOperation
from app.model.job import Job
from app.model.operation import CutParameters
from app.model.tool import Tool, ToolKind
from app.model.vcarve_operation import VcarveOperation
from tests.part_shapes import layered_part, square

PART = layered_part({"a": [square(10)]})
FLAT, CONE = Tool(1, diameter=3.0), Tool(2, kind=ToolKind.V, diameter=6.0, tip_angle=1.0)


def test_a_tool_that_nothing_uses_makes_no_other_paths() -> None:
    job = Job(PART, tools=(FLAT,), operations=(ContourOperation(CutParameters(tool=1)),))
    assert job.same_paths(replace(job, tools=(FLAT, Tool(9, diameter=12.0))))
    assert not job.same_paths(replace(job, tools=(replace(FLAT, diameter=4.0),)))
    assert not replace(job, operations=()).same_paths(job)


def test_the_tool_that_clears_the_floor_of_a_carving_is_used() -> None:
    carved = VcarveOperation(CutParameters(tool=2), flat_tool=1)
    job = Job(PART, tools=(FLAT, CONE), operations=(carved,))
    assert job.needed_tools() == (FLAT, CONE)
    assert not job.same_paths(replace(job, tools=(replace(FLAT, diameter=4.0), CONE)))
