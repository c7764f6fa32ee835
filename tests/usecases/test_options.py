"""Options over a job: which tools there are, what every value overrides."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from app.core.errors import ParameterError
from app.model.contour_operation import ContourOperation
from app.model.job import Job, Stock
from app.model.operation import CutParameters, Direction, PocketOperation
from app.model.operation_kinds import parameters
from app.model.part import Part
from app.model.tool import Tool
from app.usecases.job.machining import MachiningOptions
from app.usecases.job.options import MakeOptions, Stepover, job_with_options


def made(**options: Any) -> Job:
    asked = {key: options.pop(key) for key in tuple(options) if key in parameters() and key != "stepover"}
    return job_with_options(Part(), MakeOptions(**options, machining=MachiningOptions(asked)))


def diameters(job: Job) -> dict[str, float]:
    return {type(operation).__name__: job.tool(operation.cut.tool).diameter for operation in job.operations}


def test_nothing_said_is_the_default_job() -> None:
    assert made() == Job(Part())


@pytest.mark.parametrize(
    ("options", "tools"),
    [
        ({"pocket_diameter": 8.0, "contour_diameter": 4.0}, [(1, 8.0), (2, 4.0)]),
        ({"pocket_diameter": 8.0}, [(1, 8.0)]),
        ({"contour_diameter": 4.0}, [(1, 4.0)]),
        ({"pocket_diameter": 4.0, "contour_diameter": 4.0}, [(1, 4.0)]),
    ],
)
def test_tools_of_the_default_job(options: dict[str, float], tools: list[tuple[int, float]]) -> None:
    job = made(**options)
    assert [(tool.number, tool.diameter) for tool in job.tools] == tools
    only = next(iter(options.values()))
    pocket, contour = options.get("pocket_diameter", only), options.get("contour_diameter", only)
    assert diameters(job) == {"PocketOperation": pocket, "RestOperation": contour, "ContourOperation": contour}


def test_a_tool_option_over_a_job_changes_its_kind_of_operation_only() -> None:
    shared = Job(
        Part(), (Tool(5, 6.0, name="old"),), (PocketOperation(CutParameters(5)), ContourOperation(CutParameters(5)))
    )
    job = made(job=shared, contour_diameter=2.0)
    assert diameters(job) == {"PocketOperation": 6.0, "ContourOperation": 2.0}
    assert len({tool.number for tool in job.tools}) == 2
    apart = Job(
        Part(), (Tool(1, 6.0), Tool(4, 3.0)), (PocketOperation(CutParameters(1)), ContourOperation(CutParameters(4)))
    )
    assert diameters(made(job=apart, pocket_diameter=8.0)) == {"PocketOperation": 8.0, "ContourOperation": 3.0}


def test_stepover_by_length_per_cent_and_overlap() -> None:
    for options in ({"stepover": Stepover(2.0)}, {"stepover": Stepover(25, percent=True)}, {"overlap": 6.0}):
        pocket = made(pocket_diameter=8.0, **options).operations[0]
        assert isinstance(pocket, PocketOperation)
        assert pocket.stepover == pytest.approx(2.0)


def test_a_stepover_may_be_the_whole_diameter() -> None:
    for options in ({"stepover": Stepover(8.0)}, {"stepover": Stepover(100, percent=True)}):
        pocket = made(pocket_diameter=8.0, **options).operations[0]
        assert isinstance(pocket, PocketOperation)
        assert pocket.stepover == 8.0
    with pytest.raises(ParameterError, match=r"Stepover is 101 %; it must be 1 % to 100 %"):
        made(stepover=Stepover(101, percent=True))


def test_a_stepover_of_the_job_that_no_longer_fits_its_tool_is_refused() -> None:
    job = Job(Part(), operations=(PocketOperation(CutParameters(1), 5.0), ContourOperation(CutParameters(2))))
    with pytest.raises(ParameterError, match="Stepover is 5 mm with a pocket tool of 4 mm"):
        made(job=job, pocket_diameter=4.0)


def test_every_other_value() -> None:
    job = made(
        depth=4.0,
        stepdown=1.5,
        stock_to_leave=0.1,
        direction=Direction.CONVENTIONAL,
        feed=500.0,
        plunge=90.0,
        speed=9000.0,
        safe_z=0.4,
        join_tolerance=0.0,
    )
    assert {operation.cut for operation in job.operations} == {
        CutParameters(number, 4.0, 1.5, 0.1, Direction.CONVENTIONAL) for number in (1, 2)
    }
    assert {(tool.feed_rate, tool.plunge_rate, tool.spindle_speed) for tool in job.tools} == {(500.0, 90.0, 9000.0)}
    assert (job.safe_z, job.retract_z, job.join_tolerance) == (0.4, 0.4, 0.0)


def test_stock_grows_with_the_depth_and_never_shrinks() -> None:
    thick = replace(Job(Part()), stock=replace(Job(Part()).stock, thickness=30.0))
    assert made(depth=12.0).stock.thickness == 12.0
    assert made(job=thick, depth=12.0).stock.thickness == 30.0


def test_an_operation_without_its_tool_is_refused() -> None:
    with pytest.raises(ParameterError, match="no tool T9"):
        made(job=replace(Job(Part()), operations=(PocketOperation(CutParameters(9)),)), depth=3.0)


def test_the_stock_that_a_job_says_is_never_made_thicker() -> None:
    thin = Job(Part(), stock=Stock(0.0, 1.0))
    assert job_with_options(Part(), MakeOptions(job=thin)).stock.thickness == 1.0
    assert job_with_options(Part(), MakeOptions(machining=MachiningOptions.of(depth=12.0))).stock.thickness == 12.0
