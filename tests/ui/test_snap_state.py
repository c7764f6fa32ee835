"""Aiming with the real mouse on the real canvas: what it snaps to, what draws it, and what stands in the log."""

import math

import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QPainter, QPixmap
from pytestqt.qtbot import QtBot

from app.drafting.curves.intersections import intersection_points, nearest_point, tangent_points
from app.drafting.curves.perpendiculars import perpendicular_feet
from app.model.curves import Ellipse, Line, Spline
from app.model.notes import Guide, Mark
from app.model.part import Part
from app.ui.framework.theme import LIGHT
from app.ui.views.canvas.modes import CanvasTool
from app.ui.views.canvas.painting.snap_marks import paint_snap
from app.ui.views.canvas.snap import CHOICES, SNAP_NAMES, SNAP_WORDS, USUAL, Snap, SnapKind
from app.ui.views.canvas.snapped_point import tidy
from tests.ui.test_canvas import Hand


@pytest.fixture
def hand(qtbot: QtBot) -> Hand:
    return Hand(qtbot)


def aimed(
    hand: Hand, at: tuple[float, float], tool: CanvasTool = CanvasTool.LINE
) -> tuple[SnapKind | None, tuple[float, float]]:
    if hand.canvas.tool is not tool:
        hand.canvas.set_tool(tool)
    hand.move(*at)
    assert hand.canvas.aim is not None
    return (hand.canvas.aim.snap.kind if hand.canvas.aim.snap else None), hand.canvas.aim.point


CROSSINGS = [
    ("line 10,10 71,50.5", "line 10,50 70,13.3"),
    ("line 10,30 90,33", "circle 50,30 20"),
    ("circle 40,30 20", "circle 60,33 17"),
    ("arc 20,30 60,30 40,50", "line 10,44 80,45.5"),
    ("ellipse 50,30 80,35 12", "line 20,10 80,55"),
    ("spline 10,10 30,40 60,20 90,50", "line 10,40 90,21"),
    ("spline 10,10 30,40 60,20 90,50", "ellipse 50,30 70,30 15"),
]


@pytest.mark.parametrize("lines", CROSSINGS)
def test_where_curves_cross_is_met_by_both_to_the_nanometre(hand: Hand, lines: tuple[str, str]) -> None:
    for line in lines:
        hand.document.run(line)
    a, b = (entity.curve for entity in hand.document.part.entities)
    hand.canvas.snap_state.switch(kinds=frozenset({SnapKind.INTERSECTION}))
    crossings = intersection_points(a, b)
    assert crossings
    for x, y in crossings:
        kind, point = aimed(hand, (x + 0.3, y - 0.4))
        assert kind is SnapKind.INTERSECTION
        assert all(math.dist(nearest_point(curve, point), point) <= 1e-9 for curve in (a, b))


def test_perpendicular_and_tangent_start_from_the_base(hand: Hand) -> None:
    for line in ("line 10,10 90,20", "circle 60,70 12"):
        hand.document.run(line)
    hand.canvas.set_tool(CanvasTool.LINE)
    hand.click((20, 60))
    kind, foot_point = aimed(hand, (26, 12.3))
    assert kind is SnapKind.PERPENDICULAR
    assert (foot_point[0] - 20) * 80 + (foot_point[1] - 60) * 10 == pytest.approx(0, abs=1e-9)
    (x, y) = tangent_points(hand.document.part.entities[1].curve, (20, 60))[0]
    kind, touch = aimed(hand, (x + 0.4, y + 0.3))
    assert kind is SnapKind.TANGENT
    assert math.dist(touch, (60, 70)) == pytest.approx(12, abs=1e-9)
    assert (touch[0] - 20) * (touch[0] - 60) + (touch[1] - 60) * (touch[1] - 70) == pytest.approx(0, abs=1e-8)


def test_the_nearest_point_of_a_curve_is_taken_where_it_is_asked_for_and_gives_way_to_every_other(hand: Hand) -> None:
    hand.document.run("spline 10,10 30,40 60,20 90,50")
    assert aimed(hand, (45.2, 30))[0] is None
    hand.canvas.snap_state.switch(kinds=USUAL | {SnapKind.NEAREST})
    kind, point = aimed(hand, (45.2, 30))
    assert kind is SnapKind.NEAREST
    curve = hand.document.part.entities[0].curve
    assert math.dist(nearest_point(curve, point), point) < 1e-6
    assert aimed(hand, (11, 11))[0] is SnapKind.END


@pytest.mark.parametrize(
    ("word", "at", "point"),
    [
        ("end", (35, 10.4), (60, 10)),
        ("mid", (55, 10.4), (35, 10)),
        ("cen", (99.6, 62), (90, 60)),
        ("qua", (97, 67), (100, 60)),
        ("int", (58.6, 10.6), (60, 10)),
    ],
)
def test_a_typed_word_takes_that_kind_alone_for_one_click(
    hand: Hand, word: str, at: tuple[float, float], point: tuple[float, float]
) -> None:
    for line in ("rect 10,10 60,40", "circle 90,60 10"):
        hand.document.run(line)
    hand.canvas.set_tool(CanvasTool.LINE)
    hand.click((70, 30))
    assert hand.canvas.type_text(word)
    assert SNAP_NAMES[SNAP_WORDS[word]].lower() in hand.canvas.prompt
    if word == "end":
        at = (45, 10.4)
    hand.click(at)
    assert hand.said()[-1] == f"line 70,30 {point[0]},{point[1]}"
    assert hand.canvas.snap_state.forced is None


def test_a_kind_that_is_not_there_is_said_and_no_point_is_given(hand: Hand) -> None:
    hand.document.run("line 10,10 60,10")
    hand.canvas.set_tool(CanvasTool.LINE)
    hand.click((20, 30))
    hand.canvas.type_text("cen")
    hand.click((40, 10))
    assert hand.messages == ["There is no centre here; point at a curve that has one, or Esc."]
    assert len(hand.curves()) == 1
    hand.key(Qt.Key.Key_Escape)
    assert hand.canvas.snap_state.forced is None and hand.canvas.runner.busy, "Esc takes the kind back, not the line"


def test_words_of_snaps_are_nothing_without_a_tool(hand: Hand) -> None:
    assert not hand.canvas.type_text("mid")


def test_nothing_hidden_is_snapped_to_and_what_is_locked_is(hand: Hand) -> None:
    for line in ("layer A", "line 10,10 60,10", "layer B"):
        hand.document.run(line)
    assert aimed(hand, (60.5, 10.5)) == (SnapKind.END, (60, 10))
    hand.document.run("lock A")
    assert aimed(hand, (60.6, 10.5))[0] is SnapKind.END
    hand.document.run("hide A")
    assert aimed(hand, (60.5, 10.5))[0] is None


def test_notes_are_snapped_to(hand: Hand) -> None:
    part = (
        Part()
        .with_note(Mark((30, 30)), "0")
        .with_note(Guide((0, 50), 0.0), "0")
        .with_curves([Line((20, 40), (25, 70))], "0")
    )
    hand.document.load(hand.document.job.__class__(part))
    hand.canvas.set_view(hand.canvas.view.__class__(5.0, 124.0, 574.0))
    assert aimed(hand, (30.6, 30.5)) == (SnapKind.NODE, (30, 30))
    kind, point = aimed(hand, (22, 50.6))
    assert kind is SnapKind.INTERSECTION
    assert point == pytest.approx((20 + 5 / 3, 50), abs=1e-9)


def test_the_origin_of_the_drawing_is_snapped_to_even_where_nothing_is_drawn(hand: Hand) -> None:
    assert aimed(hand, (0.4, -0.3)) == (SnapKind.ORIGIN, (0, 0))
    hand.click((0.4, -0.3))
    assert aimed(hand, (0.4, 0.3))[0] is None
    hand.canvas.set_snap(False)
    assert aimed(hand, (0.4, -0.3), CanvasTool.CIRCLE)[0] is None


def test_a_typed_length_gives_a_point_without_the_noise_of_its_digits(hand: Hand) -> None:
    hand.canvas.set_tool(CanvasTool.LINE)
    assert hand.canvas.type_text("80.1,25")
    hand.move(40, 25)
    assert hand.canvas.type_text("30.3")
    hand.move(10, 25)
    assert hand.canvas.type_text("49.8")
    assert [line.command for line in hand.document.log] == ["line 80.1,25 49.8,25", "line 49.8,25 0,25"]


def test_each_kind_has_a_word_a_name_and_a_mark_of_its_own(hand: Hand) -> None:
    assert set(SNAP_WORDS.values()) == set(CHOICES)
    pictures = set()
    for kind in CHOICES:
        pixmap = QPixmap(40, 40)
        pixmap.fill(LIGHT.canvas)
        painter = QPainter(pixmap)
        view = hand.canvas.view.__class__(1.0, 20.0, 20.0)
        paint_snap(painter, view, Snap((0.0, 0.0), kind), LIGHT)
        painter.end()
        pictures.add(bytes(pixmap.toImage().constBits()))
    assert len(pictures) == len(CHOICES) == len({SNAP_NAMES[kind] for kind in CHOICES})


@pytest.mark.parametrize(
    ("value", "text"), [(12.500000000001, 12.5), (33.333333333333336, 33.333333333333336), (-1e-15, 0.0)]
)
def test_snapped_coordinates_lose_noise_but_no_place(value: float, text: float) -> None:
    assert tidy((value, 1.0)) == (text, 1.0)
    assert abs(tidy((value, 1.0))[0] - value) < 1e-9


def test_polar_rays_draw_the_mouse(hand: Hand) -> None:
    hand.canvas.snap_state.switch(polar=30.0)
    hand.canvas.set_tool(CanvasTool.LINE)
    hand.click((10, 10))
    hand.move(40, 27.8)
    aim = hand.canvas.aim
    assert aim is not None and aim.word == "Polar 30°"
    assert math.degrees(math.atan2(aim.point[1] - 10, aim.point[0] - 10)) == pytest.approx(30, abs=1e-8)
    hand.move(40, 35)
    assert hand.canvas.aim is not None and hand.canvas.aim.word == ""
    hand.move(40, 10.6)
    assert hand.canvas.aim is not None and hand.canvas.aim.point == (40, 10)
    hand.canvas.type_text("25")
    assert hand.said() == ["line 10,10 35,10"]


@pytest.mark.parametrize(
    ("line", "kind", "others"),
    [
        ("ellipse 60,40 85,45 12", SnapKind.PERPENDICULAR, 2),
        ("ellipse 60,40 85,45 12", SnapKind.TANGENT, 2),
        ("spline 40,10 50,40 70,20 90,55", SnapKind.PERPENDICULAR, 1),
        ("spline 40,10 50,40 70,20 90,55", SnapKind.TANGENT, 1),
    ],
)
def test_ellipses_and_splines_are_met_square_and_touched(hand: Hand, line: str, kind: SnapKind, others: int) -> None:
    hand.document.run(line)
    curve, base = hand.document.part.entities[0].curve, (12.0, 60.0)
    assert isinstance(curve, Ellipse | Spline)
    places = perpendicular_feet(curve, base) if kind is SnapKind.PERPENDICULAR else tangent_points(curve, base)
    assert len(places) >= others
    hand.canvas.set_tool(CanvasTool.LINE)
    hand.click(base)
    hand.canvas.snap_state.switch(kinds=frozenset({kind}), polar=None)
    for x, y in places:
        found, point = aimed(hand, (x + 0.4, y + 0.3))
        assert found is kind and math.dist(point, (x, y)) < 1e-9


@pytest.mark.parametrize(
    "line", ["line 40,10 44,60", "circle 60,40 20", "ellipse 60,40 85,45 12", "spline 30,60 40,20 70,20 90,55"]
)
def test_rays_stop_where_they_meet_a_curve(hand: Hand, line: str) -> None:
    hand.document.run(line)
    hand.canvas.snap_state.switch(polar=30.0, kinds=frozenset({SnapKind.END, SnapKind.NEAREST}))
    hand.canvas.set_tool(CanvasTool.LINE)
    hand.click((10, 10))
    ray, curve = Line((10, 10), (10 + 90 * math.cos(math.radians(30)), 55)), hand.document.part.entities[0].curve
    crossings = intersection_points(ray, curve)
    assert crossings
    for x, y in crossings:
        hand.move(x + 0.5, y + 0.4)
        aim = hand.canvas.aim
        assert aim is not None and aim.word == "Polar 30° \u00d7 curve"
        assert math.dist(aim.point, (x, y)) < 1e-9


def test_a_point_rested_on_draws_the_mouse_straight_across_and_up(hand: Hand) -> None:
    hand.document.run("line 30,40 50,60")
    hand.canvas.set_tool(CanvasTool.LINE)
    hand.click((80, 20))
    hand.move(30.3, 40.2)
    hand.qtbot.waitUntil(lambda: bool(hand.canvas.snap_state.acquired), timeout=2000)
    hand.move(30.5, 15)
    assert hand.canvas.aim is not None and hand.canvas.aim.point[0] == 30 and hand.canvas.aim.word == "Aligned 270°"
    hand.canvas.grab()
    hand.click((30.5, 15))
    assert hand.canvas.snap_state.acquired == (), "a click ends it"
    assert hand.said()[-1] == "line 80,20 30,15"


def test_rays_cross_and_lines_go_on(hand: Hand) -> None:
    for line in ("line 20,20 30,30", "line 90,70 95,75"):
        hand.document.run(line)
    hand.canvas.set_tool(CanvasTool.LINE)
    hand.move(30.2, 30.1)
    hand.qtbot.waitUntil(lambda: len(hand.canvas.snap_state.acquired) == 1, timeout=2000)
    hand.move(90.2, 70.1)
    hand.qtbot.waitUntil(lambda: len(hand.canvas.snap_state.acquired) == 2, timeout=2000)
    hand.move(50.3, 49.9)
    assert hand.canvas.aim is not None and hand.canvas.aim.word == "Extension 45°"
    hand.move(70.4, 70.6)
    assert hand.canvas.aim is not None and hand.canvas.aim.point == pytest.approx((70, 70), abs=1e-9)
    hand.key(Qt.Key.Key_Escape)
    assert hand.canvas.snap_state.acquired == ()


def test_resting_twice_on_a_point_forgets_it(hand: Hand) -> None:
    hand.document.run("line 30,40 50,60")
    hand.canvas.set_tool(CanvasTool.LINE)
    for count in (1, 0):
        hand.move(30.3, 40.2)
        hand.qtbot.waitUntil(lambda wanted=count: len(hand.canvas.snap_state.acquired) == wanted, timeout=2000)
        hand.move(70, 20)


def test_ten_thousand_curves_are_looked_at_only_where_the_mouse_is(qtbot: QtBot) -> None:
    hand = Hand(qtbot)
    hand.document.run("line 0,0 1,0.5")
    hand.document.run("array 100 100 @1.5,1.5 1")
    assert len(hand.curves()) == 10_000
    near = hand.canvas.picture.near_curves((30.0, 30.1), 1.0)
    assert 0 < len(near) < 12
    assert aimed(hand, (31.02, 30.52)) == (SnapKind.END, (31, 30.5))
