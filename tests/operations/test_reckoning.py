"""How long jobs are said to take, against how long they take."""

from __future__ import annotations

import math
import time
from dataclasses import replace

import pytest

from app.core.progress import Progress
from app.model.curves import Circle, Curve, Line
from app.model.job import Job
from app.model.part import Entity, Part
from app.operations.compute import compute, job_effort, regions_of
from app.operations.effort import Workload, over_area, workload_of
from app.usecases.job.options import MakeOptions, job_with_options
from app.usecases.making.make import export

WITHIN = 3.0
START_S = 1.0
"""Loading code, which is no part of what is reckoned."""


def square(side: float) -> list[Curve]:
    corners = [(0.0, 0.0), (side, 0.0), (side, side), (0.0, side)]
    return [Line(a, b) for a, b in zip(corners, [*corners[1:], corners[0]], strict=True)]


def holes(count: int) -> list[Curve]:
    return [Circle((10.0 * i + 5, 10.0 * j + 5), 4.0) for i in range(count) for j in range(count)]


def wavy(radius: float, lines: int) -> list[Curve]:
    turns = [math.tau * k / lines for k in range(lines)]
    places = [
        (radius * (1 + 0.1 * math.sin(9 * t)) * math.cos(t), radius * (1 + 0.1 * math.sin(9 * t)) * math.sin(t))
        for t in turns
    ]
    return [Line(a, b) for a, b in zip(places, [*places[1:], places[0]], strict=True)]


def job_of(curves: list[Curve], diameter: float | None = None) -> Job:
    part = Part().with_entities(tuple(Entity(k, curve) for k, curve in enumerate(curves, 1)))
    job = job_with_options(part, MakeOptions())
    if diameter is None:
        return job
    return replace(job, tools=tuple(replace(tool, diameter=diameter) for tool in job.tools))


def test_the_workload_of_a_plate_is_its_area_walls_and_counts() -> None:
    plate = [Line((a - 5, b - 5), (c - 5, d - 5)) for a, b, c, d in ((0, 0, 40, 0), (40, 0, 40, 40), (40, 40, 0, 40))]
    regions, _ = regions_of(job_of([*plate, Line((-5, 35), (-5, -5)), *holes(3)]))
    extent = workload_of(regions)
    assert extent.area == pytest.approx(1600 - 9 * math.pi * 16)
    assert extent.length == pytest.approx(160 + 9 * math.tau * 4)
    assert (extent.regions, extent.islands) == (1, 9)


def test_the_work_of_an_area_does_not_hang_on_the_units() -> None:
    """In a drawing that is a tenth as large a tool a tenth as wide has as much to do."""
    job = job_of(square(100.0))
    pocket, tool = job.operations[0], job.tool(job.operations[0].cut.tool)
    large, small = Workload(1e6, 4e3, 4, 1, 0), Workload(1e4, 4e2, 4, 1, 0)
    tenth = replace(tool, diameter=tool.diameter / 10)
    assert over_area(large, pocket, tool, 5.0) == pytest.approx(over_area(small, pocket, tenth, 0.5))


def test_a_job_of_hours_is_announced_before_it_is_computed() -> None:
    """A plate of 4 by 4 m with tools of 0.1 mm; the first word is heard before any path is made."""

    class Heard(Exception):
        pass

    def stop(sentence: str) -> None:
        raise Heard(sentence)

    begun = time.process_time()
    with pytest.raises(Heard, match=r"about \d+ (hours|days): 16,000,000 mm2 within 1 contour of 4 lines and arcs"):
        compute(job_of(square(4000.0), 0.1), Progress(remarks=stop))
    assert time.process_time() - begun < 5


def test_a_small_job_is_not_announced() -> None:
    said: list[str] = []
    compute(job_of(square(60.0)), Progress(remarks=said.append))
    assert said == []


def took(job: Job) -> float:
    begun = time.process_time()
    export(job)
    return time.process_time() - begun


@pytest.mark.exhaustive
@pytest.mark.parametrize(
    "job",
    [
        job_of(square(1000.0)),
        job_of(square(200.0), 0.5),
        job_of(wavy(450.0, 1000)),
        job_of(holes(20), 2.0),
        job_of(
            [
                *holes(14),
                *[Line((a, b), (c, d)) for a, b, c, d in ((-9, -9, 150, -9), (150, -9, 150, 150))],
                Line((150, 150), (-9, 150)),
                Line((-9, 150), (-9, -9)),
            ]
        ),
    ],
    ids=["large", "small tool", "many lines", "circles", "plate"],
)
def test_what_is_said_is_within_a_factor_of_three(job: Job) -> None:
    regions, _ = regions_of(job)
    said = job_effort(job, regions).seconds + START_S
    measured = took(job)
    assert measured / WITHIN < said < measured * WITHIN, f"said {said:.1f} s, took {measured:.1f} s"
