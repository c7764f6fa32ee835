"""Each operation's moves are held against its own area: walls, lines, clamps, floor; what was done on purpose is no
gouge.
"""

from __future__ import annotations

from dataclasses import replace

import pytest

from app.geometry.outlines import polygon_contour
from app.model.contour_operation import ContourOperation
from app.model.curves import Circle, Line
from app.model.finding import FindingKind
from app.model.hole_operations import DrillOperation
from app.model.job import Job, Stock
from app.model.moves import Area, DogBone, Program, Tab
from app.model.operation import CutParameters, PocketOperation, RestOperation, Side
from app.model.part import Contour, Entity, Part, Region
from app.model.tool import Tool
from app.model.tool_kind import ToolKind
from app.toolpath.coverage.coverage import measure
from app.toolpath.coverage.floor_target import floor_targets
from app.usecases.making.make import export
from app.verify.verdict import bounds_of, clamps_met, deepest_of, gouge_depths
from tests.gcode.programs import Path, square
from tests.verify.test_gouge import gouge

LEFT, RIGHT = square(0, 0, 20, 20), replace(square(30, 0, 50, 20), number=2)
POCKET = PocketOperation(CutParameters(1, 2.0))


def job(*operations: object, tools: tuple[Tool, ...] = (Tool(1, 6.0), Tool(2, 3.0))) -> Job:
    return Job(Part(), tools, operations, Stock(0.0, 10.0))  # type: ignore[arg-type]


def across(x: float, z: float, tool: int = 1, operation: int = 0) -> Path:
    """A cut 4 mm long in the middle of a square that begins at x."""
    path = Path(tool, operation)
    return path.into_work(x + 8, 10, z).line(x + 12, 10, z).out_of_work()


def test_an_operation_may_not_cut_in_the_area_of_another_one() -> None:
    task = job(POCKET, replace(POCKET, cut=CutParameters(1, 5.0)))
    areas = (Area((LEFT,), whole=True), Area((RIGHT,), whole=True))
    at_home = replace(across(0, -2).program(LEFT, RIGHT), areas=areas)
    assert gouge(at_home, task).max_mm <= 0
    abroad = replace(across(30, -2).program(LEFT, RIGHT), areas=areas)
    assert gouge(abroad, task).max_mm > 3
    assert deepest_of(gouge_depths(abroad, task, by_tool=True)).max_mm <= 0  # the tool may be there, whoever leads it
    assert deepest_of(
        gouge_depths(replace(across(0, -5).program(LEFT, RIGHT), areas=areas), task, by_tool=True)
    ).max_mm == pytest.approx(3)


def test_the_floor_is_that_of_the_operation_less_what_is_left_on_it() -> None:
    task = job(replace(POCKET, cut=CutParameters(1, 2.0, floor_to_leave=0.5)))
    assert gouge(across(0, -1.5).program(LEFT), task).max_mm <= 0
    assert gouge(across(0, -2.0).program(LEFT), task).max_mm == pytest.approx(0.5)


def test_a_path_on_the_line_stays_on_it() -> None:
    line = Contour((Line((5.0, 10.0), (15.0, 10.0)),), closed=False)
    task = job(ContourOperation(CutParameters(1), Side.ON))
    frame = Region(1, polygon_contour([(-50, -50), (70, -50), (70, 70), (-50, 70)]))
    areas = (Area((frame,), (line,), bare=(frame.boundary,)),)
    program = replace(across(0, -2).program(), areas=areas, lines=(line,))
    assert gouge(program, task).max_mm <= 1e-9
    off = Path().into_work(8, 10.2, -2).line(12, 10.2, -2).out_of_work()
    assert gouge(replace(off.program(), areas=areas, lines=(line,)), task).max_mm == pytest.approx(0.2)
    beyond = Path().into_work(8, 10, -2).line(16, 10, -2).out_of_work()
    assert gouge(replace(beyond.program(), areas=areas, lines=(line,)), task).max_mm == pytest.approx(1.0)
    (wanted,) = floor_targets(program, task)
    assert wanted.target.area == pytest.approx(10 * 6 + 9 * 3.14159, rel=1e-3)


def test_a_dog_bone_excuses_its_own_way_and_no_other() -> None:
    task = job(ContourOperation(CutParameters(1), dog_bones=True))
    path = Path().into_work(3, 3, -2).line(2, 2, -2).line(3, 3, -2).out_of_work()
    assert gouge(path.program(LEFT), task).max_mm == pytest.approx(1.0)
    bone = DogBone(3.0, 3.0, 2.0, 2.0, 6.0)
    assert gouge(replace(path.program(LEFT), dog_bones=(bone,)), task).max_mm <= 0
    other = Path().into_work(17, 17, -2).line(18, 18, -2).out_of_work()
    assert gouge(replace(other.program(LEFT), dog_bones=(bone,)), task).max_mm == pytest.approx(1.0)
    too_deep = Path().into_work(3, 3, -2).line(2, 2, -3).out_of_work()
    assert gouge(replace(too_deep.program(LEFT), dog_bones=(bone,)), task).max_mm == pytest.approx(1.0)


def test_a_tab_is_no_metal_left_but_a_gap_in_the_path_is() -> None:
    task = job(ContourOperation(CutParameters(1)))
    path = Path().into_work(3, 3, -2).line(17, 3, -2).line(17, 17, -2).line(3, 17, -2).line(3, 13, -2)
    path = path.line(3, 13, -1).line(3, 7, -1).line(3, 7, -2).line(3, 3, -2).out_of_work()
    program = path.program(LEFT)
    assert measure(program, task).reachable_left_mm2 > 1
    assert measure(replace(program, tabs=(Tab(3.0, 10.0, 0.5, -1.0, 6.0),)), task).reachable_left_mm2 == 0
    assert measure(replace(program, tabs=(Tab(17.0, 10.0, 0.5, -1.0, 6.0),)), task).reachable_left_mm2 > 1


def test_floors_at_two_depths_are_each_asked() -> None:
    task = job(POCKET, PocketOperation(CutParameters(1, 5.0)))
    areas = (Area((LEFT,), whole=True), Area((RIGHT,), whole=True))
    program = replace(across(0, -2).program(LEFT, RIGHT), areas=areas)
    shallow, deep = floor_targets(program, task)
    assert (shallow.depth, deep.depth) == (2.0, 5.0)
    corners = (4 - 3.14159) * 9
    assert shallow.target.area == pytest.approx(400 - corners, rel=1e-3)
    assert deep.target.bounds == pytest.approx((30, 0, 50, 20), abs=0.01)
    assert measure(program, task).floor_mm == 5.0


def test_holes_that_cross_are_holes_each_and_a_drill_stays_in_its_own() -> None:
    holes = tuple(Region(k, Contour((Circle((x, 10.0), 3.0),))) for k, x in enumerate((10.0, 14.0), 1))
    task, area = job(DrillOperation(CutParameters(1, 2.0))), (Area(holes),)

    def drilled(x: float) -> float:
        program = Path().into_work(x, 10, -2.0).out_of_work().program()
        return gouge(replace(program, areas=area, regions=holes), task).max_mm

    assert drilled(10.0) == drilled(14.0) == 0
    assert drilled(10.5) == pytest.approx(0.5) and drilled(12.0) == pytest.approx(2.0)


def test_a_drill_goes_on_by_its_tip_and_what_is_asked_for() -> None:
    drill = Tool(3, 5.0, ToolKind.DRILL, tip_angle=2.0943951)
    task = job(DrillOperation(CutParameters(3, 4.0), through=0.5), tools=(drill,))
    (bound,) = bounds_of(Program(across(0, -1, 3).moves(), (LEFT,)), task)
    assert bound.floor == pytest.approx(4.5 + 2.5 / 1.7320508)


@pytest.mark.parametrize(("height", "z", "met"), [(12.0, 5.0, True), (4.0, 5.0, False), (12.0, 15.0, False)])
def test_a_rapid_over_a_clamp_keeps_above_it(height: float, z: float, met: bool) -> None:
    clamp = square(24, 5, 28, 15)
    task = replace(job(POCKET), keep_out_layers=("0",), keep_out_height=height)
    path = Path().into_work(8, 10, -2).line(12, 10, -2).rapid(12, 10, z).rapid(40, 10, z)
    program = replace(path.program(LEFT, RIGHT), clamps=(clamp,))
    found = deepest_of(clamps_met(program, task))
    assert (found.max_mm > 0) is met
    assert not met or found.z == z


def test_rest_machining_alone_is_judged_as_a_pocket_is() -> None:
    task = job(RestOperation(CutParameters(1)))
    program = replace(across(0, -2).program(LEFT), areas=(Area((LEFT,), whole=True),))
    (wanted,) = floor_targets(program, task)
    assert wanted.target.area == pytest.approx(400 - (4 - 3.14159) * 9, rel=1e-3)
    assert measure(program, task).unreachable_mm2 == pytest.approx((4 - 3.14159) * 9, rel=1e-2)


@pytest.mark.parametrize(
    ("operation", "told"),
    [(ContourOperation(CutParameters(1), Side.ON), False), (ContourOperation(CutParameters(1)), True)],
)
def test_a_cutter_with_a_point_may_engrave_but_not_cut_walls(operation: ContourOperation, told: bool) -> None:
    lines = polygon_contour([(0, 0), (40, 0), (40, 30), (0, 30)]).primitives
    part = Part().with_entities(tuple(Entity(k, line) for k, line in enumerate(lines, 1)))
    made = export(Job(part, (Tool(1, 6.0, ToolKind.V, tip_angle=1.0471976),), (operation,)))
    assert any(finding.kind is FindingKind.TOOL_SHAPE for finding in made.findings) is told
