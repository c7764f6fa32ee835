"""What a finding offers really mends it: the job is computed again, and the finding is gone."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from app.model.contour_operation import ContourOperation
from app.model.finding import FindingKind
from app.model.hole_operations import DrillOperation
from app.model.job import Job
from app.model.operation import CutParameters, PocketOperation, RestOperation
from app.model.tool import Tool
from app.model.tool_kind import ToolKind
from app.usecases.making.make import MakeResult, export
from app.usecases.making.program_lines import operation_of_line
from app.usecases.mending import Fault, mends
from tests.part_shapes import circle, layered_part, square

PART = layered_part({"0": [square(40.0)]})
HOLDER = ((0.0, 20.0), (30.0, 20.0))


def pocket(tool: Tool, depth: float) -> Job:
    cut = CutParameters(tool.number, depth=depth, stepdown=2.0)
    return Job(PART, (tool,), (PocketOperation(cut), ContourOperation(cut)))


def fault_in(made: MakeResult, kind: FindingKind) -> Fault:
    finding = next(each for each in made.findings if each.kind is kind and each.line)
    return Fault.of(finding, operation_of_line(made, 0, finding.line))


CASES = {
    FindingKind.SHANK_CONTACT: pocket(Tool(1, 6.0, flute_length=4.0, shank_diameter=8.0), 6.0),
    FindingKind.HOLDER_CONTACT: pocket(Tool(1, 6.0, flute_length=12.0, stick_out=5.0, holder=HOLDER), 8.0),
    FindingKind.BELOW_TABLE: Job(
        layered_part({"0": [circle(2.5)]}),
        (Tool(1, 5.0, ToolKind.DRILL, tip_angle=math.radians(118)),),
        (DrillOperation(CutParameters(1, depth=10.0, stepdown=10.0)),),
    ),
}


_SLOW = (FindingKind.SHANK_CONTACT, FindingKind.HOLDER_CONTACT)


@pytest.mark.parametrize(
    "kind",
    [pytest.param(kind, marks=pytest.mark.exhaustive if kind in _SLOW else (), id=kind.value) for kind in CASES],
)
def test_every_offer_against_an_accident_mends_it(kind):
    job = CASES[kind]
    made = export(job)
    fault = fault_in(made, kind)
    assert fault.operation is not None
    offered = mends(job, fault, (Tool(9, 6.0, flute_length=20.0, shank_diameter=6.0),))
    assert len(offered) >= 2
    for mend in offered:
        assert kind not in {each.kind for each in export(mend.job).findings if each.counts}, mend.words


def test_a_tool_of_the_library_takes_the_place_of_one_with_short_flutes():
    job = CASES[FindingKind.SHANK_CONTACT]
    long, longer = (Tool(number, 6.0, flute_length=length) for number, length in ((7, 15.0), (8, 40.0)))
    ball = replace(long, number=9, diameter=5.0)
    mend = mends(job, Fault(FindingKind.SHANK_CONTACT, 0, 2.0), (longer, ball, long))[0]
    assert mend.job.tools == (replace(long, number=1),)
    assert mend.change == "flutes 4 \u2192 15 mm"


def test_metal_that_is_left_gets_a_rest_operation_with_the_smallest_mill():
    large, small = Tool(1, 12.0), Tool(2, 3.0)
    job = Job(PART, (large, small), (PocketOperation(CutParameters(1)), ContourOperation(CutParameters(2))))
    made = export(job)
    left = next(each for each in made.findings if each.kind is FindingKind.LEFT_REACHABLE)
    (mend,) = mends(job, Fault.of(left, None))
    assert [type(each) for each in mend.job.operations] == [PocketOperation, RestOperation, ContourOperation]
    assert mend.job.operations[1].cut.tool == 2
    assert FindingKind.LEFT_REACHABLE not in {each.kind for each in export(mend.job).findings}


def test_a_rest_operation_that_is_off_is_switched_on():
    rest = RestOperation(CutParameters(2, enabled=False))
    job = Job(PART, (Tool(1, 12.0), Tool(2, 3.0)), (PocketOperation(CutParameters(1)), rest))
    (mend,) = mends(job, Fault(FindingKind.LEFT_REACHABLE))
    assert [each.cut.enabled for each in mend.job.operations] == [True, True]


def test_what_no_tool_reaches_gets_the_largest_that_fits():
    job = pocket(Tool(1, 6.0), 2.0)
    (mend,) = mends(job, Fault(FindingKind.LEFT_UNREACHABLE, None, disc=2.2))
    assert mend.job.tools[-1].diameter == 2.0 and mend.job.operations[1].cut.tool == 2
    assert mends(job, Fault(FindingKind.LEFT_UNREACHABLE, None, disc=0.5)) == ()


def test_a_rapid_in_metal_goes_higher():
    (mend,) = mends(pocket(Tool(1, 6.0), 2.0), Fault(FindingKind.RAPID_IN_MATERIAL, 0, 1.5))
    assert mend.job.safe_z == 7.0 and mend.words == "Clearance height 7 mm"


@pytest.mark.parametrize("kind", [FindingKind.GOUGE, FindingKind.OPEN_CONTOUR, FindingKind.SHANK_CONTACT])
def test_what_the_job_cannot_help_offers_nothing(kind):
    assert mends(pocket(Tool(1, 6.0), 2.0), Fault(kind)) == ()
