"""Colours by engagement: each stretch of a path has its own step, whatever the moves are cut into."""

from __future__ import annotations

import math

import numpy as np
import pytest
from PySide6.QtGui import QColor

from app.drafting.document import Document
from app.model.contour_operation import ContourOperation
from app.model.curve_selectors import on_layers
from app.model.curves import Line
from app.model.job import Job, Stock
from app.model.moves import MoveKind, Moves, Program, Purpose
from app.model.operation import CutParameters, PocketOperation, Side
from app.model.part import Contour
from app.model.tool import Tool
from app.operations.compute import compute
from app.toolpath.engagement.engagement import sample_engagement
from app.ui.framework.theme import LIGHT
from app.ui.views.canvas.canvas import Canvas
from app.ui.views.canvas.modes import CanvasMode, PathColourBy
from app.ui.views.canvas.painting.engagement_colours import colours
from app.ui.views.canvas.painting.engagement_runs import EngagementRuns, engagement_runs, steady_steps
from app.ui.views.canvas.painting.program_layer import ProgramLayer
from app.ui.views.canvas.view_transform import ViewTransform
from tests.part_shapes import layered_part, square


def slot_beside_a_slot() -> tuple[Program, Job]:
    """One move 40 mm long, of which a slot cut before leaves the whole width up to about x = 17, and a third of it
    beyond.
    """
    lines = {
        name: [Contour((Line((x, y), (40.0, y)),), closed=False)]
        for name, x, y in (("first", 20.0, 2.0), ("then", 0.0, 0.0))
    }
    operations = tuple(ContourOperation(CutParameters(1, curves=on_layers((name,))), side=Side.ON) for name in lines)
    job = Job(layered_part(lines), (Tool(1, 6.0),), operations, Stock(margin=10.0))
    return compute(job), job


def pocket(stepover: float) -> tuple[Program, Job]:
    job = Job(layered_part({"a": [square(60)]}), (Tool(1, 6.0),), (PocketOperation(CutParameters(1), stepover),))
    return compute(job), job


def seen_of(program: Program, job: Job) -> EngagementRuns:
    return engagement_runs(program.moves, sample_engagement(program, job))


def test_one_move_has_a_colour_for_each_of_its_stretches() -> None:
    program, job = slot_beside_a_slot()
    found = seen_of(program, job)
    own = (program.moves.purpose == Purpose.CONTOUR) & (program.moves.operation == 1)
    assert own.sum() == 1
    along, lengths = (found.moves.purpose == Purpose.CONTOUR) & (found.moves.operation == 1), found.moves.lengths()
    at_step = [float(lengths[along & (found.step == k)].sum()) for k in range(5)]
    assert sum(at_step) == pytest.approx(40.0)
    assert at_step[4] == pytest.approx(17.0, abs=3.0)
    assert at_step[1] == pytest.approx(23.0, abs=4.0)


@pytest.mark.parametrize("stepover", [1.5, 3.0, 4.5, 5.0])
def test_the_path_is_the_same(stepover: float) -> None:
    program, job = pocket(stepover)
    moves, found = program.moves, seen_of(program, job)
    assert len(found.moves) > len(moves)
    assert float(found.moves.lengths().sum()) == pytest.approx(float(moves.lengths().sum()), rel=1e-9)
    ends = {tuple(row) for row in found.moves.end.tolist()}
    assert all(tuple(row) in ends for row in moves.end.tolist())
    arcs = found.moves.kind >= MoveKind.ARC_CW
    radii = [np.hypot(*(at[arcs, :2] - found.moves.centre[arcs]).T) for at in (found.moves.start, found.moves.end)]
    assert radii[0] == pytest.approx(radii[1], abs=1e-9)


def test_half_a_stepover_does_not_flicker() -> None:
    program, job = pocket(3.0)
    found = seen_of(program, job)
    straight = (found.moves.purpose == Purpose.POCKET) & (found.moves.kind == MoveKind.LINE)
    lengths = found.moves.lengths()
    at_step = [float(lengths[straight & (found.step == k)].sum()) for k in range(5)]
    assert at_step[1] / sum(at_step) > 0.7, "a stepover of half the diameter is at most half"
    assert len(found.moves) < 4 * len(program.moves)


def test_a_step_changes_only_where_its_limit_is_clearly_passed() -> None:
    share = np.array([0.5, 0.49, 0.53, 0.55, 0.53, 0.51, 0.53, 0.5, 1.0, 0.98, 0.96, 0.9, 0.53, 0.0])
    begins = np.zeros(len(share), np.bool_)
    begins[[0, 12]] = True
    assert steady_steps(share, begins).tolist() == [1, 1, 1, 2, 2, 1, 1, 1, 4, 4, 3, 3, 1, 0]


def test_nothing_that_cuts_is_nothing_to_colour() -> None:
    moves = Moves(
        np.zeros((1, 3)),
        np.full((1, 2), np.nan),
        *(np.zeros(1, kind) for kind in (np.uint8, np.uint8)),
        *(np.zeros(1, np.int16) for _ in range(3)),
        np.zeros(1),
        np.zeros(1, np.int32),
    )
    job = Job(layered_part({"a": [square(10)]}))
    assert seen_of(Program(moves), job).step.tolist() == [0]


def test_the_canvas_paints_stretches_and_picks_moves(qtbot) -> None:
    program, job = slot_beside_a_slot()
    picture = ProgramLayer(program, (), seen_of(program, job))
    assert picture.shapes.moves is program.moves
    canvas = Canvas(Document(), LIGHT)
    qtbot.addWidget(canvas)
    canvas.resize(600, 200)
    canvas.show()
    canvas.set_view(ViewTransform(12.0, 60.0, 100.0))
    canvas.set_mode(CanvasMode.PATHS)
    canvas.set_program(picture)
    canvas.set_colour_by(PathColourBy.ENGAGEMENT)
    image = canvas.grab().toImage()

    def painted(x: float, colour: QColor) -> bool:
        at = canvas.view.to_screen((x, 0.0)).toPoint()
        seen = [image.pixelColor(at.x() + dx, at.y() + dy) for dx in range(-8, 9) for dy in (-1, 0, 1)]
        return any(math.dist(one.getRgb(), colour.getRgb()) < 60 for one in seen)

    little, slot = colours(LIGHT)[1], colours(LIGHT)[4]
    assert painted(8.0, slot) and not painted(8.0, little)
    assert painted(32.0, little) and not painted(32.0, slot)
