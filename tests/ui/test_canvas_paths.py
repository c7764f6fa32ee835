"""The Paths view: what is painted for a program, in which colour, and what the mouse finds."""

import math
import time
from collections.abc import Iterator
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from PySide6.QtCore import QPointF
from PySide6.QtGui import QColor, QPainter, QPixmap
from pytestqt.qtbot import QtBot

from app.drafting.document import Document
from app.formats.dxf.dxf import read_dxf
from app.model.contour_operation import ContourOperation
from app.model.curves import Circle
from app.model.finding import Finding, FindingKind
from app.model.hole_operations import BoreOperation
from app.model.job import Job
from app.model.moves import MoveKind, Moves, Program, Purpose
from app.model.operation import CutParameters, PocketOperation
from app.model.part import Contour, Entity, Part, Region
from app.operations.compute import compute
from app.toolpath.coverage.coverage import UncutPlace
from app.ui.framework.samples import PathLineKind, sample_of, sample_pen
from app.ui.framework.theme import DARK, LIGHT, Theme
from app.ui.views.canvas.canvas import Canvas, CanvasMode, CanvasTool, PathColourBy, PathLayers
from app.ui.views.canvas.painting.move_shapes import shape_moves
from app.ui.views.canvas.painting.program_chunks import chunks, plunges, rapids, rapids_path
from app.ui.views.canvas.painting.program_layer import ProgramLayer
from app.ui.views.canvas.program_hover import nearest_move
from app.ui.views.canvas.view_transform import ViewTransform
from tests.conftest import ROOT

Row = tuple[MoveKind, Purpose, tuple[float, float, float], tuple[float, float], int]
NOWHERE = (math.nan, math.nan)


def moves_of(rows: list[Row]) -> Moves:
    kind, purpose, end, centre, region = zip(*rows, strict=True)
    cut = [0.0 if k is MoveKind.RAPID else 600.0 for k in kind]
    operation = [1 if p is Purpose.CONTOUR else 0 for p in purpose]
    return Moves(
        np.array(end, float),
        np.array(centre, float),
        np.array(kind, np.uint8),
        np.array(purpose, np.uint8),
        np.array(operation, np.int16),
        np.array(operation, np.int16) + np.int16(1),
        np.array(region, np.int32),
        np.array(cut),
        np.zeros(len(rows), np.int32),
    )


def ring(centre: tuple[float, float], radius: float, purpose: Purpose, region: int, z: float = -2.0) -> list[Row]:
    """A rapid, a plunge and a full circle in two arcs."""
    (x, y), r = centre, radius
    return [
        (MoveKind.RAPID, Purpose.RAPID, (x + r, y, 5.0), NOWHERE, 0),
        (MoveKind.LINE, Purpose.PLUNGE, (x + r, y, z), NOWHERE, region),
        (MoveKind.ARC_CCW, purpose, (x - r, y, z), centre, region),
        (MoveKind.ARC_CCW, purpose, (x + r, y, z), centre, region),
    ]


TWO_RINGS = Program(
    moves_of([*ring((20, 20), 10, Purpose.POCKET, 1), *ring((60, 20), 10, Purpose.CONTOUR, 2)]),
    (Region(1, Contour((Circle((20.0, 20.0), 14.0),))),),
)


@cache
def fig2() -> tuple[Job, Program]:
    part = read_dxf((ROOT / "resources" / "samples" / "fig2.dxf").read_bytes()).part
    return Job(part), compute(Job(part))


@pytest.fixture
def canvas(qtbot: QtBot) -> Iterator[Canvas]:
    made = Canvas(Document(), LIGHT)
    qtbot.addWidget(made)
    made.resize(824, 624)
    made.show()
    made.set_view(ViewTransform(8.0, 100.0, 500.0))
    made.set_mode(CanvasMode.PATHS)
    made.set_program(TWO_RINGS)
    yield made


def along_circle(canvas: Canvas, centre: tuple[float, float], radius: float) -> list[list[QColor]]:
    """Colours of 3 x 3 px round 720 places along a circle, as the widget shows them."""
    image = canvas.grab().toImage()
    found = []
    for turn in np.linspace(0.1, 6.2, 720):
        at = canvas.view.to_screen((centre[0] + radius * math.cos(turn), centre[1] + radius * math.sin(turn))).toPoint()
        found.append([image.pixelColor(at.x() + dx, at.y() + dy) for dx in (-1, 0, 1) for dy in (-1, 0, 1)])
    return found


def share(places: list[list[QColor]], wanted: QColor) -> float:
    """Share of the places where a px has the wanted colour, but for the smoothing of edges."""

    def like(c: QColor) -> bool:
        return math.dist((c.red(), c.green(), c.blue()), (wanted.red(), wanted.green(), wanted.blue())) < 70

    return sum(any(map(like, place)) for place in places) / len(places)


def test_pocket_is_solid_and_contour_is_dashed(canvas: Canvas) -> None:
    assert share(along_circle(canvas, (20, 20), 10), LIGHT.pocket) > 0.9
    assert 0.4 < share(along_circle(canvas, (60, 20), 10), LIGHT.contour) < 0.8


def test_paths_have_the_line_of_their_operation_in_the_list_and_the_legend(canvas: Canvas) -> None:
    hole = [*ring((20, 20), 8, Purpose.CONTOUR, 1), *ring((20, 20), 10, Purpose.POCKET, 1)]
    moves = moves_of([*hole, *ring((60, 20), 10, Purpose.POCKET, 2)])
    second = np.arange(len(moves)) >= len(hole)
    operations = (BoreOperation(CutParameters(tool=1)), PocketOperation(CutParameters(tool=2)))
    program = Program(replace(moves, operation=second.astype(np.int16), tool=second.astype(np.int16) + np.int16(1)))
    canvas.set_program(ProgramLayer(program, operations=operations))
    for (centre, radius), operation in zip((((20, 20), 10), ((60, 20), 10)), operations, strict=True):
        colour = sample_pen(sample_of(operation), LIGHT).color()
        assert share(along_circle(canvas, centre, radius), colour) > 0.9
    canvas.set_visible_layers(PathLayers.ALL & ~PathLayers.POCKET)
    assert share(along_circle(canvas, (20, 20), 10), LIGHT.plunge) > 0.9, "a hole's ring is none of the pocket's"
    assert share(along_circle(canvas, (60, 20), 10), LIGHT.pocket) < 0.1


def test_tabs_have_a_line_of_their_own_that_is_switched_off_alone(canvas: Canvas) -> None:
    moves = moves_of([*ring((20, 20), 10, Purpose.TAB, 1), *ring((60, 20), 10, Purpose.CONTOUR, 1)])
    layer = ProgramLayer(Program(moves), operations=(ContourOperation(CutParameters(tool=1)),))
    assert layer.remainders[PathLineKind.TAB]
    canvas.set_program(layer)
    assert share(along_circle(canvas, (20, 20), 10), sample_pen(PathLineKind.TAB, LIGHT).color()) > 0.9
    canvas.set_visible_layers(PathLayers.ALL & ~PathLayers.TAB)
    assert share(along_circle(canvas, (20, 20), 10), LIGHT.contour) < 0.1
    assert share(along_circle(canvas, (60, 20), 10), LIGHT.contour) > 0.4
    assert not ProgramLayer(Program(moves_of(ring((60, 20), 10, Purpose.CONTOUR, 1)))).remainders[PathLineKind.TAB]


def test_colours_follow_the_region_when_asked(canvas: Canvas) -> None:
    canvas.set_colour_by(PathColourBy.REGION)
    assert share(along_circle(canvas, (20, 20), 10), LIGHT.regions[0]) > 0.9
    assert share(along_circle(canvas, (60, 20), 10), LIGHT.regions[1]) > 0.4


@pytest.mark.parametrize("theme", [LIGHT, DARK], ids=lambda t: t.name)
def test_layers_switch_off(canvas: Canvas, theme: Theme) -> None:
    canvas.set_theme(theme)
    canvas.set_visible_layers(PathLayers.ALL & ~PathLayers.POCKET & ~PathLayers.REGION & ~PathLayers.PLUNGE)
    image = canvas.grab().toImage()
    off = canvas.view.to_screen((20.0, 30.0)).toPoint()
    assert image.pixelColor(off).name() in {theme.canvas.name(), theme.grid.name(), theme.grid_major.name()}
    assert share(along_circle(canvas, (60, 20), 10), theme.contour) > 0.3


def test_stale_paths_are_faint(canvas: Canvas) -> None:
    canvas.set_stale(True)
    assert share(along_circle(canvas, (20, 20), 10), LIGHT.pocket) < 0.1
    canvas.set_stale(False)
    assert share(along_circle(canvas, (20, 20), 10), LIGHT.pocket) > 0.9


def test_stale_paths_stay_faint_where_they_lie_over_one_another(canvas: Canvas) -> None:
    down, turn = ring((20, 20), 10, Purpose.PLUNGE, 1)[:2], ring((20, 20), 10, Purpose.PLUNGE, 1)[2:]
    canvas.set_program(Program(moves_of([*down, *turn * 8])))
    assert share(along_circle(canvas, (20, 20), 10), LIGHT.plunge) > 0.9
    canvas.set_stale(True)
    assert share(along_circle(canvas, (20, 20), 10), LIGHT.plunge) < 0.1


def test_draw_mode_shows_no_paths(canvas: Canvas) -> None:
    canvas.set_mode(CanvasMode.DRAW)
    assert share(along_circle(canvas, (20, 20), 10), LIGHT.pocket) == 0


def test_the_region_is_lightly_filled(canvas: Canvas) -> None:
    def inside() -> str:
        return canvas.grab().toImage().pixelColor(canvas.view.to_screen((20.3, 23.3)).toPoint()).name()

    assert inside() == LIGHT.region_fill.name()
    canvas.set_visible_layers(PathLayers.ALL & ~PathLayers.REGION)
    assert inside() == LIGHT.canvas.name()


@pytest.mark.parametrize(
    ("reachable", "layer", "colour"),
    [(True, PathLayers.LEFT, "left"), (False, PathLayers.UNREACHABLE, "unreachable")],
    ids=["left", "out of reach"],
)
def test_what_is_left_is_hatched_but_for_its_holes(
    canvas: Canvas, reachable: bool, layer: PathLayers, colour: str
) -> None:
    def square(half: float) -> np.ndarray:
        return np.array(
            [(40 - half, 50 - half), (40 + half, 50 - half), (40 + half, 50 + half), (40 - half, 50 + half)]
        )

    place = UncutPlace(40.0, 50.0, 48.0, 2.0, reachable, square(4.0), (square(2.0),))
    canvas.set_program(ProgramLayer(TWO_RINGS, (place,)))

    def share_of_hatch(x: float) -> float:
        image, at = canvas.grab().toImage(), canvas.view.to_screen((x, 50.0)).toPoint()
        wanted = getattr(LIGHT, colour)
        seen = [image.pixelColor(at.x() + dx, at.y() + dy) == wanted for dx in range(-6, 7) for dy in range(-6, 7)]
        return sum(seen) / len(seen)

    assert 0.05 < share_of_hatch(37.0) < 0.5
    assert share_of_hatch(40.0) == 0
    canvas.set_visible_layers(PathLayers.ALL & ~layer)
    assert share_of_hatch(37.0) == 0


def test_arcs_are_round_at_every_zoom(canvas: Canvas) -> None:
    for scale in (8.0, 200.0, 2000.0):
        turn = 0.3
        place = (20 + 10 * math.cos(turn), 20 + 10 * math.sin(turn))
        canvas.set_view(ViewTransform(scale).centred(place, canvas.area))
        canvas.repaint_scene()
        image = canvas.grab().toImage()
        green = [
            (x, y)
            for y in range(40, 600, 9)
            for x in range(30, 820)
            if image.pixelColor(x, y).name() == LIGHT.pocket.name()
        ]
        off = [abs(math.dist(canvas.view.to_world(QPointF(x + 0.5, y + 0.5)), (20, 20)) - 10) * scale for x, y in green]
        assert len(green) > 10
        assert max(off) < 1.5, f"{max(off):.2f} px off the circle at {scale:g} px/mm"


def test_hovering_tells_operation_tool_feed_length_and_z(canvas: Canvas, qtbot: QtBot) -> None:
    told: list[str] = []
    canvas.hovered.connect(told.append)
    qtbot.mouseMove(canvas, canvas.view.to_screen((20.0, 30.1)).toPoint())
    assert told[-1] == "Pocket · T1 Flat 6 mm · region 1 · F 600 · 31.416 of 62.832 mm · R 10.000 · Z -2.000"
    qtbot.mouseMove(canvas, canvas.view.to_screen((20.0, 25.0)).toPoint())
    assert told[-1] == ""
    qtbot.mouseMove(canvas, canvas.view.to_screen((60.0, 30.0)).toPoint())
    assert told[-1].startswith("Contour · T2 Flat 3 mm")


def test_hovering_passes_over_what_is_switched_off(canvas: Canvas, qtbot: QtBot) -> None:
    told: list[str] = []
    canvas.set_visible_layers(PathLayers.ALL & ~PathLayers.POCKET)
    canvas.hovered.connect(told.append)
    qtbot.mouseMove(canvas, canvas.view.to_screen((20.0, 30.0)).toPoint())
    assert told == []


def test_the_whole_stroke_piece_lights_up(canvas: Canvas, qtbot: QtBot) -> None:
    qtbot.mouseMove(canvas, canvas.view.to_screen((20.0, 25.0)).toPoint())
    before = along_circle(canvas, (20, 20), 10.35)
    qtbot.mouseMove(canvas, canvas.view.to_screen((20.0, 30.0)).toPoint())
    after = along_circle(canvas, (20, 20), 10.35)
    assert sum(a != b for a, b in zip(before, after, strict=True)) > 0.95 * len(before)


def test_the_nearest_move_is_the_nearest_by_exact_distance() -> None:
    _, program = fig2()
    shapes = shape_moves(program.moves)
    everything = frozenset(Purpose)
    rng = np.random.default_rng(7)
    fine = [np.array([shapes.start[k, :2]]) for k in range(len(program.moves))]
    for k in range(len(program.moves)):
        t = np.linspace(0, 1, 400)[:, None]
        a, b = shapes.start[k, :2], program.moves.end[k, :2]
        fine[k] = a + (b - a) * t
        if shapes.sweep[k]:
            c = program.moves.centre[k]
            turn = math.atan2(*(a - c)[::-1]) + shapes.sweep[k] * t[:, 0]
            fine[k] = c + np.hypot(*(a - c)) * np.column_stack([np.cos(turn), np.sin(turn)])
    for place in rng.uniform(5, 95, (60, 2)):
        away = np.array([np.hypot(*(points - place).T).min() for points in fine])
        found = nearest_move(shapes, (float(place[0]), float(place[1])), 3.0, everything)
        if away.min() > 3.0 + 1e-2:
            assert found is None
        elif away.min() < 3.0 - 1e-2:
            assert found is not None and away[found] < away.min() + 2e-2


def test_every_cutting_move_is_painted_where_it_lies() -> None:
    _, program = fig2()
    shapes = shape_moves(program.moves)
    painted = chunks(shapes)
    shown = sum(c.path.length() for c in painted if c.style.purpose in (Purpose.POCKET, Purpose.CONTOUR))
    cut = np.isin(program.moves.purpose, [Purpose.POCKET, Purpose.CONTOUR])
    assert shown == pytest.approx(float(program.moves.lengths()[cut].sum()), rel=1e-3)
    for chunk in painted:
        box = chunk.path.boundingRect()
        assert (box.left(), box.top(), box.right(), box.bottom()) == pytest.approx(chunk.box, abs=1e-3)


def test_a_deeper_pass_on_the_same_place_is_painted_once() -> None:
    once = ring((20, 20), 10, Purpose.POCKET, 1)
    twice = moves_of([*once, *ring((20, 20), 10, Purpose.POCKET, 1, z=-4.0)])
    length = sum(c.path.length() for c in chunks(shape_moves(twice)) if c.style.purpose is Purpose.POCKET)
    assert length == pytest.approx(20 * math.pi, rel=3e-3)
    assert plunges(shape_moves(twice)).tolist() == [[30.0, 20.0]]


def test_only_rapids_near_the_view_are_painted() -> None:
    far = rapids(
        shape_moves(
            moves_of(
                [
                    *ring((20, 20), 10, Purpose.POCKET, 1),
                    *ring((60, 20), 10, Purpose.POCKET, 1),
                    *ring((60, 90), 10, Purpose.POCKET, 1),
                ]
            )
        )
    )
    assert far.tolist() == [[30, 20, 70, 20], [70, 20, 70, 90]]
    assert rapids_path(far, (40, 10, 50, 30)).elementCount() == 2
    assert rapids_path(far, (0, 0, 100, 100)).elementCount() == 4
    assert rapids_path(far, (0, 95, 5, 99)).isEmpty()


def test_an_empty_program_paints_nothing(canvas: Canvas) -> None:
    columns = [((0, 3), float), ((0, 2), float), *[(0, np.uint8)] * 2, *[(0, np.int16)] * 3, (0, float), (0, np.int32)]
    empty = Moves(*(np.zeros(shape, kind) for shape, kind in columns))
    canvas.set_program(Program(empty))
    canvas.look_at((20.0, 30.0))
    assert not canvas.grab().isNull()


def test_findings_are_marked_and_can_be_gone_to(canvas: Canvas, qtbot: QtBot) -> None:
    canvas.set_findings(
        (
            Finding(FindingKind.OPEN_CONTOUR, "Contour 1 is open.", 40.0, 45.0),
            Finding(FindingKind.LEFT_OUT, "2 texts left out."),
        )
    )
    at = canvas.view.to_screen((41.0, 45.0)).toPoint()
    image = canvas.grab().toImage()
    around = [image.pixelColor(at.x() + dx, at.y()) for dx in range(-3, 4)]
    assert any(c.red() > 150 and c.green() < 120 for c in around)
    canvas.go_to(40.0, 45.0)
    qtbot.wait(300)
    assert canvas.view.to_world(canvas.area.center()) == pytest.approx((40, 45))
    assert canvas.view.scale == 8.0
    canvas.go_to(20.0, 30.0, closely=True)
    qtbot.wait(300)
    assert canvas.view.to_world(canvas.area.center()) == pytest.approx((20, 30))
    assert canvas.view.scale > 30


def test_a_crowded_scene_stays_fluid(qtbot: QtBot) -> None:
    """20,000 moves over 10,000 entities: what follows the mouse is painted within 16 ms, a pan step too."""
    rng = np.random.default_rng(3)
    rows: list[Row] = []
    while len(rows) < 20_000:
        rows += ring(
            tuple(rng.uniform(10, 90, 2)),
            float(rng.uniform(1, 8)),
            Purpose(int(rng.integers(2, 4))),
            int(rng.integers(1, 9)),
        )
    entities = tuple(
        Entity(n + 1, Circle((float(x), float(y)), 0.5)) for n, (x, y) in enumerate(rng.uniform(0, 100, (10_000, 2)))
    )
    canvas = Canvas(Document(Job(Part(entities))), LIGHT)
    qtbot.addWidget(canvas)
    canvas.resize(1100, 740)
    canvas.show()
    canvas.set_mode(CanvasMode.PATHS)
    canvas.set_program(Program(moves_of(rows)))
    canvas.set_tool(CanvasTool.LINE)
    canvas.grab()
    target = QPixmap(canvas.size())

    def follow(step: int) -> None:
        qtbot.mouseMove(canvas, QPointF(300.0 + step, 300.0).toPoint())
        painter = QPainter(target)
        canvas.paint_overlay(painter)
        painter.end()

    def pan(step: int) -> None:
        canvas.set_view(canvas.view.panned(2, 1))
        canvas.grab()

    for act in (follow, pan):
        assert min(_seconds(act, step) for step in range(8)) < 0.016, act.__name__


def _seconds(act: object, step: int) -> float:
    begun = time.process_time()
    act(step)  # type: ignore[operator]
    return time.process_time() - begun
