"""The verdict on hand-made programs: gouges found to the micrometre, rapids through metal found, clean paths let
pass.
"""

from __future__ import annotations

import math
import threading
from dataclasses import replace

import pytest

from app.core.errors import Cancelled
from app.core.progress import Progress
from app.model.curves import Circle
from app.model.job import Job
from app.model.moves import Program
from app.model.part import Contour, Region
from app.verify.verdict import Gouge, deepest_of, gouge_depths, rapids_in_material
from tests.gcode.programs import Path, job, square

ISLAND = Contour((Circle((20.0, 15.0), 4.0, ccw=False),))


def gouge(program: Program, task: Job) -> Gouge:
    """The deepest gouge of a program."""
    return deepest_of(gouge_depths(program, task))


def ring(inset: float) -> Path:
    """T1 (radius 3) along the inside of the 40 x 30 rectangle."""
    low, right, top = inset, 40 - inset, 30 - inset
    path = (
        Path()
        .into_work(low, low, -1.0)
        .line(right, low, -1.0)
        .line(right, top, -1.0)
        .line(low, top, -1.0)
        .line(low, low, -1.0)
    )
    return path.out_of_work()


def test_a_ring_at_the_radius_is_no_gouge() -> None:
    found = gouge(ring(3.0).program(), job())
    assert found.count == 0
    assert found.max_mm <= 1e-12


@pytest.mark.parametrize("depth", [0.002, 0.4, 3.5])
def test_a_ring_too_near_gouges_by_what_is_missing(depth: float) -> None:
    found = gouge(ring(3.0 - depth).program(), job())
    assert found.max_mm == pytest.approx(depth, abs=1e-9) or depth > 3
    assert found.max_mm >= min(depth, 3.0) - 1e-9
    assert found.count >= 4
    assert found.z == -1.0


def test_stock_to_leave_must_be_kept_clear_of() -> None:
    task = job()
    pocket = replace(task.operations[0], cut=replace(task.operations[0].cut, stock_to_leave=0.25))
    assert gouge(ring(3.0).program(), replace(task, operations=(pocket, task.operations[1]))).max_mm == pytest.approx(
        0.25
    )


def test_a_move_through_an_island_is_a_gouge_though_its_ends_are_clear() -> None:
    region = replace(square(), islands=(ISLAND,))
    path = Path().into_work(5, 15, -1.0).line(35, 15, -1.0).out_of_work()
    assert gouge(path.program(region), job()).max_mm == pytest.approx(3.0)
    round_it = (
        Path()
        .into_work(5, 15, -1.0)
        .line(13, 15, -1.0)
        .arc((27.0, 15.0, -1.0), (20.0, 15.0))
        .line(35, 15, -1.0)
        .out_of_work()
    )
    assert gouge(round_it.program(region), job()).max_mm <= 1e-12


def test_cutting_outside_of_every_region_is_a_gouge() -> None:
    path = Path().into_work(100, 100, -1.0).line(110, 100, -1.0).out_of_work()
    found = gouge(path.program(), job())
    assert found.max_mm == pytest.approx(3 + math.hypot(70, 70), abs=1e-6)
    on_the_island = Path().into_work(20, 15, -1.0).line(20.1, 15, -1.0).out_of_work()
    region = replace(square(), islands=(Contour((Circle((20.0, 15.0), 12.0, ccw=False),)),))
    assert gouge(on_the_island.program(region), job()).max_mm == pytest.approx(15, abs=1e-3)


def test_a_plunge_too_near_to_a_wall_is_a_gouge_though_it_goes_nowhere_else() -> None:
    found = gouge(Path().into_work(2.0, 15, -1.0).out_of_work().program(), job())
    assert found.max_mm == pytest.approx(1.0, abs=1e-9) and found.count == 2


def test_above_the_stock_nothing_gouges() -> None:
    path = Path().rapid(100, 100, 5.0).line(120, 100, 0.0).rapid(100, 100, 5.0)
    assert gouge(path.program(), job()).max_mm == 0


def test_arcs_against_arcs() -> None:
    region = Region(1, Contour((Circle((0.0, 0.0), 20.0),)))
    for radius, depth in ((17.0, 0.0), (17.3, 0.3)):
        path = Path().into_work(radius, 0, -1.0).arc((radius, 0.0, -1.0), (0.0, 0.0)).out_of_work()
        assert gouge(path.program(region), job()).max_mm == pytest.approx(depth, abs=1e-9)


def test_rapids_above_the_stock_and_out_of_a_hole_are_safe() -> None:
    assert rapids_in_material(ring(3.0).program(), job()) == ()


def test_a_rapid_down_into_metal_or_across_below_the_top_is_found() -> None:
    down = Path().rapid(10, 10, 5).rapid(10, 10, -1.0).line(20, 10, -1.0).rapid(20, 10, 5)
    assert [(hit.x, hit.z, hit.move) for hit in rapids_in_material(down.program(), job())] == [(10.0, -1.0, 1)]
    across = Path().into_work(10, 10, -1.0).rapid(20, 10, -1.0).rapid(20, 10, 5)
    assert [hit.move for hit in rapids_in_material(across.program(), job())] == [3]


def test_a_rapid_down_to_a_floor_that_is_cleared_is_safe() -> None:
    path = (
        Path()
        .into_work(10, 10, -1.0)
        .line(20, 10, -1.0)
        .out_of_work()
        .rapid(15, 10, 5)
        .rapid(15, 10, -0.5)
        .line(15, 10, -2.0)
    )
    assert rapids_in_material(path.out_of_work().program(), job()) == ()
    beside = Path().into_work(10, 10, -1.0).line(20, 10, -1.0).out_of_work().rapid(15, 10.01, 5).rapid(15, 10.01, -0.5)
    assert len(rapids_in_material(beside.out_of_work().program(), job())) == 1


def test_a_rapid_down_where_only_a_smaller_tool_or_a_ramp_has_been_is_found() -> None:
    path = Path(tool=2, operation=1).into_work(10, 10, -1.0).line(20, 10, -1.0).out_of_work()
    path.tool, path.operation = 1, 0
    path.rapid(15, 10, 5).rapid(15, 10, -0.5).out_of_work()
    assert len(rapids_in_material(path.program(), job())) == 1
    ramp = (
        Path()
        .into_work(10, 10, 0.0)
        .line(20, 10, -1.0)
        .rapid(20, 10, 5)
        .rapid(12, 10, 5)
        .rapid(12, 10, -0.5)
        .out_of_work()
    )
    assert len(rapids_in_material(ramp.program(), job())) == 1


def zigzag(count: int) -> Path:
    """T1 there and back that many times in the middle of the rectangle."""
    path = Path().into_work(10, 15, -1.0)
    for _ in range(count):
        path.line(20, 15, -1.0).line(10, 15, -1.0)
    return path


def test_a_gouge_behind_many_moves_is_found_where_it_is() -> None:
    found = gouge(zigzag(6000).line(10, 2.5, -1.0).out_of_work().program(), job())
    assert found.max_mm == pytest.approx(0.5)
    assert (found.x, found.y) == (10.0, 2.5)


def test_looking_for_gouges_tells_how_far_it_is_and_can_be_stopped() -> None:
    program, told, stop = zigzag(6000).out_of_work().program(), list[float](), threading.Event()
    gouge_depths(program, job(), progress=Progress(lambda fraction, text: told.append(fraction)))
    assert len(told) >= 3
    assert told == sorted(set(told))
    told.clear()
    with pytest.raises(Cancelled):
        gouge_depths(
            program, job(), progress=Progress(lambda fraction, text: (told.append(fraction), stop.set())[0], stop)
        )
    assert len(told) == 1


def test_looking_at_rapids_can_be_stopped() -> None:
    stop = threading.Event()
    stop.set()
    program = Path().into_work(10, 15, -1.0).rapid(30, 15, -1.0).out_of_work().program()
    with pytest.raises(Cancelled):
        rapids_in_material(program, job(), Progress(None, stop))
