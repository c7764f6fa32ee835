"""Operations proposed from how curves lie in one another, and what comes out when they are cut."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import shapely

from app.core.errors import GeometryError, InputError
from app.drafting.document import Document
from app.formats.job.toml import read_job
from app.formats.job.write import job_lines
from app.formats.readers import read_drawing
from app.model.contour_operation import ContourOperation
from app.model.curve_selectors import CirclesOf, ContourKind, CurveNumber
from app.model.hole_operations import BoreOperation, DrillOperation
from app.model.job import Copies, Job
from app.model.operation import PocketOperation, RestOperation, Side
from app.model.stock_box import stock_box
from app.model.tool import Tool
from app.model.tool_kind import ToolKind
from app.operations.compute import compute
from app.toolpath.coverage.areas import region_shapes
from app.usecases.job.machining import MachiningOptions
from app.usecases.job.options import MakeOptions
from app.usecases.making.make import MakeResult, make
from app.usecases.proposal.propose import SPARE, Proposal, ProposalOptions, ProposalRule, as_in_1986, propose
from tests.part_shapes import circle, layered_part, square

ROOT = Path(__file__).resolve().parents[2]
PLATE = "rect 0,0 80,50 round 6; rect 15,12 45,38; circle 60,15 3; circle 60,35 3"


def drawing(lines: str) -> Job:
    document = Document()
    document.run(lines)
    return Job(document.part)


def proposed(lines: str, options: ProposalOptions | None = None) -> Proposal:
    return propose(drawing(lines), options)


def words(proposal: Proposal) -> list[str]:
    return [
        f"{each.operation.WORD} {' '.join(curve.text for curve in each.operation.cut.curves)}"
        for each in proposal.operations
    ]


def made_of(lines: str, **options: object) -> MakeResult:
    asked = MakeOptions(propose=ProposalOptions(), **options)  # type: ignore[arg-type]
    return make("part.draw", lines.replace("; ", "\n").encode(), asked)


def test_a_plate_with_a_rectangle_and_two_holes() -> None:
    proposal = proposed(PLATE)
    assert words(proposal) == ["drill circles:6", "pocket inner", "contour outer"]
    drill, pocket, outline = (each.operation for each in proposal.operations)
    job = proposal.job
    assert isinstance(drill, DrillOperation) and job.tool(drill.cut.tool).diameter == 6.0 and drill.cut.depth == 10.0
    assert isinstance(pocket, PocketOperation) and pocket.cut.depth == 2.0
    assert isinstance(outline, ContourOperation) and outline.side is Side.OUTSIDE and outline.cut.depth == 10.0
    assert outline.tabs.count == 4 and job.stock.margin == job.tool(outline.cut.tool).diameter + 2
    assert proposal.rule is ProposalRule.NESTING and all(each.why for each in proposal.operations)


@pytest.fixture(scope="module")
def plate() -> MakeResult:
    return made_of(PLATE)


def test_what_is_proposed_for_a_plate_comes_out_clean(plate: MakeResult) -> None:
    """The areas of the operations are what is drawn, in closed form, and nothing is left, cut into, or told of."""
    assert plate.clean and plate.proposal is not None
    assert plate.report.data["left"]["reachable_mm2"] == 0.0
    assert plate.report.data["proposal"]["operations"][1]["curves"] == ["inner"]
    sizes = [shapely.union_all(region_shapes(each.regions, 1e-3)).area for each in plate.program.areas]
    assert sizes[:2] == [pytest.approx(2 * math.pi * 9, rel=1e-3), pytest.approx(30 * 26)]
    assert plate.cut is not None and plate.cut.setup.stock.box == pytest.approx((-8, -8, 88, 58))
    tabs = [(tab.x, tab.y) for tab in plate.program.tabs]
    assert len(tabs) == 4 and all(x in (-3, 83) or y in (-3, 53) for x, y in np.round(tabs, 6).tolist())


def test_a_job_file_a_project_and_the_program_itself_tell_the_same_curves(plate: MakeResult) -> None:
    text = "\n".join(job_lines(plate.job))
    again = read_job("j.toml", text.encode()).job
    assert again.operations == plate.job.operations and again.stock == plate.job.stock
    twin = make("part.draw", PLATE.replace("; ", "\n").encode(), MakeOptions(job=again))
    assert twin.nc.text == plate.nc.text
    assert plate.cut is not None
    header = plate.cut.setup.programs[0].header
    assert header is not None and header.under == plate.job.stock.under == 2.0
    told = [note.operation() for note in header.operations]
    assert [each.cut.curves for each in told if each] == [each.cut.curves for each in plate.job.operations]


def test_without_waste_below_the_stock_the_points_of_drills_are_told(plate: MakeResult) -> None:
    job = replace(plate.job, stock=replace(plate.job.stock, under=0.0))
    made = make("part.draw", PLATE.replace("; ", "\n").encode(), MakeOptions(job=job))
    assert [each.kind.value for each in made.findings if each.counts] == ["below_table"]
    assert "It lies on 2 mm of waste" in plate.nc.text and "waste" not in made.nc.text


@pytest.mark.exhaustive
@pytest.mark.parametrize("name", ["resources/samples/gear.draw", "../shared/data/dxf/gear.dxf"])
def test_a_gear_is_cut_out_with_its_teeth_standing(name: str) -> None:
    path = ROOT / name
    if not path.exists():
        pytest.skip("the shared drawings are not here")
    made = make(path.name, path.read_bytes(), MakeOptions(propose=ProposalOptions()))
    assert made.clean
    outline = made.job.operations[-1]
    assert isinstance(outline, ContourOperation) and outline.side is Side.OUTSIDE
    solid = shapely.union_all(region_shapes(made.program.regions, 1e-3))
    teeth = shapely.Polygon(
        solid.exterior if solid.geom_type == "Polygon" else max(solid.geoms, key=lambda g: g.area).exterior
    )
    moves, radius = made.program.moves, made.job.tool(outline.cut.tool).radius
    mine = (moves.operation == len(made.job.operations) - 1) & (moves.end[:, 2] < 0)
    off = shapely.distance(teeth, shapely.points(moves.end[mine, :2]))
    assert float(off.min()) == pytest.approx(radius, abs=2e-3)  # beside the teeth, nowhere nearer
    assert made.report.data["left"]["out_of_reach_places"] == len(made.coverage.places) > 0
    assert "places out of reach" in made.report.summary("o")


def test_islands_stand_in_pockets_and_holes_in_them_are_drilled() -> None:
    lines = "rect 0,0 100,100; rect 10,10 90,90; rect 30,30 70,70; circle 50,50 3; circle 50,40 2.61"
    proposal = proposed(lines)
    assert words(proposal)[:2] == ["drill circles:6", "pocket #5 #9"]
    assert "1 island in it left standing" in proposal.operations[1].why
    assert words(proposal)[-2:] == ["bore circles:5.22", "contour outer"]


def test_several_parts_are_cut_out_together_and_nested_ones_stay_in_their_pocket() -> None:
    proposal = proposed("rect 0,0 40,40; rect 60,0 100,40; rect 70,10 90,30; rect 75,15 85,25")
    assert words(proposal) == ["pocket inner", "contour outer"]
    assert "2 outlines" in proposal.operations[-1].why


def test_round_ends_and_keyways_go_through_and_other_loops_do_not() -> None:
    gear = (ROOT / "resources/samples/gear.draw").read_bytes()
    proposal = propose(Job(read_drawing("gear.draw", gear).part))
    bore = proposal.operations[0]
    assert isinstance(bore.operation, PocketOperation) and bore.operation.cut.depth == 10.0
    assert "1 slot or bore, through" in bore.why
    slot = proposed("rect 0,0 60,40; slot 20,20 40,20 8")
    assert slot.operations[0].operation.cut.depth == 10.0
    assert proposed("rect 0,0 60,40; rect 15,15 45,25 round 2").operations[0].operation.cut.depth == 2.0


def test_open_lines_and_letters_are_engraved() -> None:
    proposal = proposed("rect 0,0 80,40; line 10,10 70,10; line 10,20 70,30")
    line = proposal.operations[0]
    assert words(proposal) == ["contour open", "contour outer"]
    assert isinstance(line.operation, ContourOperation) and line.operation.side is Side.ON
    assert proposal.job.tool(line.operation.cut.tool).kind is ToolKind.V and line.operation.cut.depth == 0.3
    plate = (ROOT / "resources/samples/nameplate.draw").read_bytes()
    as_curves = plate + b"\nselect layer engraving\nset lettering no\n"  # as other programs write words
    for data, curves in ((plate, "open"), (as_curves, "layer:engraving")):
        proposal = propose(Job(read_drawing("n.draw", data).part))
        assert words(proposal) == ["bore circles:3.2", f"contour {curves}", "contour outer"]


def test_an_outline_with_a_gap_is_told_and_what_lies_in_it_is_no_part() -> None:
    """Its holes would else be cut out as discs, and the outline engraved."""
    proposal = proposed("line 0,0 80,0; line 80,0 80,50; line 80,50 0,50; line 0,50 0,0.5; circle 40,25 3")
    assert words(proposal) == ["drill circles:6"]
    (gap,) = proposal.findings
    assert gap.counts and "gap of 0.500 mm at (0.000, 0.500)" in gap.text
    with pytest.raises(GeometryError, match=r"no curve that an operation could be proposed for\. An outline has a gap"):
        proposed("line 0,0 80,0; line 80,0 80,50; line 80,50 0,50; line 0,50 0,0.5")


def test_equal_circles_take_the_drill_of_their_size_if_there_is_one() -> None:
    tools = (Tool(1, 4.0), Tool(2, 5.0, ToolKind.DRILL))
    lines = "rect 0,0 60,40; circle 10,10 2.5; circle 20,10 2.5; circle 40,20 3; circle 50,30 9"
    proposal = proposed(lines, ProposalOptions(tools))
    assert words(proposal) == ["drill circles:5", "bore circles:6", "contour circles:18", "contour outer"]
    small, large = (each.operation for each in proposal.operations[1:3])
    assert isinstance(small, BoreOperation) and isinstance(large, ContourOperation)
    assert large.tabs.count == 3  # 4 mm leaves nothing in 6 mm, and a disc in 18 mm


def test_holes_of_several_diameters_with_one_mill_are_one_operation_and_one_short_way() -> None:
    """Closed form: no way over all places of a grid is shorter than one step to each but the first."""
    step, columns, rows, sizes = 15.0, 6, 5, (3.15, 3.35, 3.45)
    places = [(step * i, step * j, sizes[(i + 2 * j) % 3]) for i in range(columns) for j in range(rows)]
    lines = "rect -10,-10 85,70; " + "; ".join(f"circle {x:g},{y:g} {size / 2:g}" for x, y, size in places)
    proposal = proposed(lines)
    assert words(proposal) == ["bore circles:3.15 circles:3.35 circles:3.45", "contour outer"]
    assert "30 holes of 3.15, 3.35 and 3.45 mm" in proposal.operations[0].why
    moves = compute(replace(proposal.job, operations=proposal.job.operations[:1])).moves
    way = moves.end - moves.start
    ways = np.hypot(*way[moves.start[:, 2] == proposal.job.travel_z, :2].T)
    ways = ways[ways > 1.0]
    assert len(ways) in (len(places) - 1, len(places))
    assert ways[-len(places) + 1 :].sum() <= 1.05 * step * (len(places) - 1)


def test_tools_reach_the_depth_and_fit_between_the_walls() -> None:
    """A slit of 2.2 mm beside a part wants 2 mm; the library's are 6 mm long, so 10 mm of stock want a longer one."""
    slit = "line 0,0 50,0; line 50,0 50,20; line 50,20 26.1,20; line 26.1,20 26.1,8; line 26.1,8 23.9,8; "
    slit += "line 23.9,8 23.9,20; line 23.9,20 0,20; line 0,20 0,0"
    thick, thin = proposed(slit), proposed(slit, ProposalOptions(thickness=5.0))
    assert [job.tools[-1].diameter for job in (thick.job, thin.job)] == [2.0, 2.0]
    assert "a longer one than the library has" in thick.operations[-1].why and thick.job.tools[-1].number > 77
    assert "longer" not in thin.operations[-1].why and thin.job.tools[-1].number == 3


def test_the_rule_of_1986_is_a_proposal_and_what_a_job_begins_with() -> None:
    job = Job(read_drawing("fig2.dxf", (ROOT / "resources/samples/fig2.dxf").read_bytes()).part)
    proposal = as_in_1986(job)
    assert proposal.rule is ProposalRule.PATENT_1986 and proposal.job == job
    assert [type(each.operation) for each in proposal.operations] == [PocketOperation, RestOperation, ContourOperation]
    assert "1986" in proposal.operations[0].why


def test_what_else_is_asked_for_goes_into_what_is_proposed() -> None:
    made = made_of(PLATE, machining=MachiningOptions.of(depth=1.0, tabs=2, copies=Copies(2, 1, 120.0)), post="grbl")
    assert [each.cut.depth for each in made.job.operations] == [10.0, 1.0, 10.0]
    assert made.job.operations[-1].tabs.count == 2 and len(made.program.tabs) == 4  # type: ignore[attr-defined]
    assert made.job.copies.columns == 2 and made.job.post == "grbl"
    with pytest.raises(InputError, match="--drill does not go with --propose"):
        made_of(PLATE, machining=MachiningOptions.of(drills=(6.0,)))


@pytest.mark.parametrize("seed", range(12))
def test_the_areas_of_random_nested_parts(seed: int) -> None:
    """What is cleared and what stands, by the parity of depth alone, in closed form."""
    rng = np.random.default_rng(seed)
    contours, cleared, holes = [], 0.0, 0.0

    def put(x: float, y: float, half: float, depth: int) -> None:
        nonlocal cleared, holes
        contours.append(square(2 * half, x - half, y - half))
        cleared += (2 * half) ** 2 * (1 if depth % 2 else -1) if depth else 0.0
        for k in range(4 if half > 6 else 0):
            dx, dy = (k % 2 - 0.5) * half, (k // 2 - 0.5) * half
            what = rng.integers(3)
            if what == 1:
                put(x + dx, y + dy, 0.42 * half, depth + 1)
            elif what == 2 and depth % 2 == 0:
                contours.append(circle(0.3 * half, x + dx, y + dy))
                holes += math.pi * (0.3 * half) ** 2

    for k in range(2):
        put(200.0 * k, 0.0, 60.0, 0)
    job = propose(Job(layered_part({"0": contours}))).job
    from app.toolpath.drawn_contours import drawn_contours
    from app.toolpath.machining_areas import MachiningAreas

    sheets = MachiningAreas(job, drawn_contours(job))
    by_kind = {"cleared": 0.0, "holes": 0.0}
    for operation, area in zip(job.operations, sheets.areas(), strict=True):
        size = float(shapely.union_all(region_shapes(area.regions, 1e-4)).area)
        if isinstance(operation, PocketOperation):
            by_kind["cleared"] += size
        elif isinstance(operation, DrillOperation | BoreOperation) or (
            isinstance(operation, ContourOperation)
            and operation.side is Side.INSIDE
            and all(isinstance(each, CirclesOf) for each in operation.cut.curves)
        ):
            by_kind["holes"] += size
    assert by_kind == {"cleared": pytest.approx(cleared, rel=1e-6), "holes": pytest.approx(holes, rel=1e-3)}
    assert job.operations[-1].cut.curves == (ContourKind.OUTER,)
    assert all(not isinstance(each, CurveNumber) for each in job.operations[-1].cut.curves)


@pytest.mark.parametrize("lines", [PLATE, "circle 0,0 30", "polyline 0,0 60,0 60,20 20,20 20,60 0,60 close"])
def test_cutting_a_part_out_leaves_a_whole_frame_of_stock_round_it(lines: str) -> None:
    """Where it breaks, part and frame move."""
    made = made_of(lines)
    outline = next(k for k, each in enumerate(made.job.operations) if each.wall_side is Side.OUTSIDE)
    tool = made.job.tool(made.job.operations[outline].cut.tool)
    moves, box = made.program.moves, stock_box(made.job, made.program.regions)
    ends = moves.end[(moves.operation == outline) & (moves.end[:, 2] < 0)]
    inner = shapely.box(box.x0, box.y0, box.x1, box.y1).exterior.distance(shapely.MultiPoint(ends[:, :2]))
    assert inner - tool.radius > SPARE / 2 - 1e-3


@pytest.mark.parametrize("line", ["line 0,0 10,0", "line 3,0 3,9"])
def test_one_straight_line_has_a_stock_as_wide_as_the_tool(line: str) -> None:
    made = made_of(line)
    assert made.clean
    x, y, _ = stock_box(made.job, made.program.regions, made.program.lines).size
    assert min(x, y) == pytest.approx(max(tool.diameter for tool in made.job.tools))
