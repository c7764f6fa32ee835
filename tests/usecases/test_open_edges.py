"""Areas that are open at the stock's edge: entered from outside, cleared past the edge, judged by the cut."""

from __future__ import annotations

import math

import numpy as np
import pytest

from app.core.errors import ParameterError
from app.model.finding import FindingKind
from app.model.moves import MoveKind, Purpose
from app.toolpath.drawn_contours import drawn_contours
from app.toolpath.machining_areas import MachiningAreas
from app.usecases.making.make import MakeResult
from tests.usecases.test_holes_program import assert_same_cuts, made_of, report_of

STOCK = "[stock]\nthickness = 10.0\n"
TOOLS = STOCK + "[[tool]]\nnumber = 1\ndiameter = 6.0\n[[tool]]\nnumber = 2\ndiameter = 3.0\n"
PLATE = "layer part\nrectangle 0,0 100,60\nlayer p\n"
WHOLE = "rectangle 0,0 60,36\n"
"""A plate that is an open area, all of it."""
KINDS = pytest.mark.parametrize("kind", ["pocket", "adaptive"])
CORNER = (1 - math.pi / 4) * 9
"""What a tool of 3 mm radius leaves in a right corner, mm2."""


def opened(kind: str, shape: str, more: str = "", tools: str = TOOLS) -> MakeResult:
    operation = f'[[operation]]\nkind = "{kind}"\ntool = 1\ndepth = 4\nstepdown = 4\ncurves = ["layer:p"]\n'
    plate = "layer p\n" if WHOLE in shape else PLATE
    return made_of(operation + "open_edges = true\n" + more, plate + shape, tools=tools)


SHAPES = {
    "one edge": ("rectangle 20,0 50,30\n", 30 * 30 - 2 * CORNER),
    "a corner": ("rectangle 60,30 100,60\n", 40 * 30 - CORNER),
    "across": ("rectangle 0,20 100,40\n", 100 * 20),
    "all": (WHOLE, 60 * 36),
    "all but a boss": (WHOLE + "circle 30,18 8\n", 60 * 36 - math.pi * 64),
    "narrow inwards": ("polyline 20,0 30,30 60,30 70,0 close\n", None),
    "wide inwards": ("polyline 40,0 30,30 70,30 60,0 close\n", None),
}


@KINDS
@pytest.mark.parametrize("name", SHAPES)
def test_it_is_cleared_up_to_its_walls_and_past_the_edge(kind: str, name: str) -> None:
    shape, area = SHAPES[name]
    made = opened(kind, shape)
    report = report_of(made)
    assert made.clean and report["gouge"]["max_mm"] < 1e-3 and report["cut"]["gouged_places"] == 0
    if area is None:  # the lines slant by as much to both sides: a sharp and a blunt corner, or two of each
        angle = math.pi - math.atan2(30, 10) if name == "narrow inwards" else math.atan2(30, 10)
        area = (40 if name == "narrow inwards" else 30) * 30 - 2 * 9 * (1 / math.tan(angle / 2) - (math.pi - angle) / 2)
    assert report["cut"]["removed_mm3"] == pytest.approx(4 * area, rel=3e-3)


@KINDS
def test_the_tool_goes_down_beside_the_stock_and_comes_in(kind: str) -> None:
    moves = opened(kind, "rectangle 20,0 50,30\n").program.moves
    down = (moves.kind != MoveKind.RAPID) & (moves.end[:, 2] < -1e-9) & (moves.start[:, 2] > -1e-9)
    level = np.hypot(*(moves.end - moves.start)[down, :2].T)
    assert down.any() and level.max() < 1e-9  # neither helix nor ramp
    assert moves.end[down, 1].max() < -3.0


def test_linuxcnc_reads_the_same_motion() -> None:
    assert_same_cuts(opened("pocket", "rectangle 20,0 50,30\n"))


def test_closed_areas_of_the_same_operation_are_entered_as_ever() -> None:
    made = opened("pocket", "rectangle 20,0 50,30\ncircle 75,30 12\n")
    assert made.clean
    moves = made.program.moves
    assert (np.abs(moves.start[moves.purpose == Purpose.PLUNGE, 0] - 75) < 12).any()


def test_where_walls_are_in_the_way_the_tool_comes_along_its_path() -> None:
    """The pocket's middle lies round a corner from its open edge."""
    made = opened("pocket", "polyline 10,0 22,0 22,35 90,35 90,55 10,55 close\n")
    moves = made.program.moves
    down = (moves.kind != MoveKind.RAPID) & (moves.end[:, 2] < -1e-9) & (moves.start[:, 2] > moves.end[:, 2] + 1e-9)
    assert made.clean and moves.end[down, 1].max() < -3.0


def test_a_contour_follows_the_walls_of_an_open_pocket() -> None:
    contour = '[[operation]]\nkind = "contour"\ntool = 2\ndepth = 4\nstepdown = 4\ncurves = ["layer:p"]\n'
    made = opened("pocket", "rectangle 20,0 50,30\n", contour + "open_edges = true\n")
    assert made.clean
    moves = made.program.moves
    assert moves.end[(moves.purpose == Purpose.CONTOUR) & (moves.operation == 1), 1].min() < 1e-9  # past the edge
    left = opened("pocket", "rectangle 20,0 50,30\n", contour)  # it turns at the edge, and leaves its corners there
    assert not left.clean and report_of(left)["left"]["reachable_mm2"] == pytest.approx(2 * CORNER / 4, rel=0.02)
    assert report_of(made)["cut"]["removed_mm3"] == pytest.approx(4 * (900 - 2 * CORNER / 4), rel=3e-3)


def test_the_walls_are_the_drawn_ones_and_those_of_the_strips() -> None:
    job = opened("pocket", "rectangle 20,0 50,30\n").job
    area = MachiningAreas(job, drawn_contours(job)).of(job.operations[0])
    assert area is not None
    drawn = area.primitives.rows[~area.bare]
    ends = {tuple(np.round(row, 9)) for row in drawn[:, :4].reshape(-1, 2)}
    assert ends == {(20, 0), (20, 30), (50, 30), (50, 0)} and len(drawn) == 3


@KINDS
def test_an_edge_that_the_stock_has_not_is_refused(kind: str) -> None:
    with pytest.raises(ParameterError, match="none of its walls lies on the stock's edge: draw the area"):
        opened(kind, "rectangle 20,10 50,30\n")
    with pytest.raises(ParameterError, match="the stock reaches 5 mm beyond the drawing"):
        opened(kind, "rectangle 20,0 50,30\n", tools=TOOLS.replace(STOCK, STOCK + "margin = 5\n"))


def test_without_the_key_an_edge_is_a_wall() -> None:
    operation = '[[operation]]\nkind = "pocket"\ntool = 1\ndepth = 4\nstepdown = 4\ncurves = ["layer:p"]\n'
    made = made_of(operation, PLATE + "rectangle 20,0 50,30\n", tools=TOOLS)
    assert report_of(made)["left"]["unreachable_mm2"] == pytest.approx(4 * CORNER, rel=0.01)


def test_a_clamp_on_an_open_edge_is_kept_off() -> None:
    more = '[keep_out]\nlayers = ["clamps"]\nheight = 12.0\n'
    made = opened("pocket", "rectangle 20,0 50,30\nlayer clamps\ncircle 35,0 6\n", more)
    assert any(each.kind is FindingKind.LEFT_OUT for each in made.findings)
    assert not any(each.kind is FindingKind.GOUGE for each in made.findings)
