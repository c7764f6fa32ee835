"""Every way to draw, by closed forms."""

import itertools
import math

import pytest
from scipy.interpolate import CubicSpline

from app.core.errors import InputError
from app.drafting.curves.intersections import lies_on
from app.drafting.document import Document
from app.drafting.expressions.errors import CommandError
from app.geometry.sample import sample, spline_points
from app.model.curves import Arc, Circle, Curve, Ellipse, Line, Spline


def curves(text: str) -> tuple[Curve, ...]:
    document = Document()
    document.run_script(text)
    return tuple(e.curve for e in document.part.entities)


def is_closed(drawn: tuple[Curve, ...]) -> bool:
    return all(a.end == b.start for a, b in zip(drawn, (*drawn[1:], drawn[0]), strict=True))


@pytest.mark.parametrize(
    ("words", "sweep", "centre"),
    [
        ("", math.pi / 2, (0, 0)),
        ("cw", -math.pi / 2, (5, 5)),
        ("large", 1.5 * math.pi, (5, 5)),
        ("cw large", -1.5 * math.pi, (0, 0)),
        ("large cw", -1.5 * math.pi, (0, 0)),
    ],
)
def test_an_arc_with_a_radius_is_the_smaller_one_unless_told(
    words: str, sweep: float, centre: tuple[float, float]
) -> None:
    (arc,) = curves(f"arc 5,0 0,5 radius 5 {words}")
    assert isinstance(arc, Arc)
    assert arc.sweep == pytest.approx(sweep)
    assert arc.centre == pytest.approx(centre, abs=1e-12)


def test_a_half_circle_by_its_radius() -> None:
    (arc,) = curves("arc 0,0 10,0 radius 5")
    assert isinstance(arc, Arc) and abs(arc.sweep) == pytest.approx(math.pi)


def test_an_arc_goes_on_without_a_corner() -> None:
    _line, arc, onward = curves("line 0,0 10,0\narc on 15,5\narc on 10,20")
    assert arc == Arc((10, 0), (15, 5), (10, 5))
    assert isinstance(onward, Arc)
    assert onward.start == (15, 5)
    assert onward.centre[1] == pytest.approx(5)  # the arc before ends straight up


@pytest.mark.parametrize(
    ("line", "circle"),
    [
        ("circle 1,2 through 4,6", Circle((1, 2), 5)),
        ("circle diameter 0,0 6,8", Circle((3, 4), 5)),
        ("circle through 5,0 0,5 -5,0", Circle((0, 0), 5)),
        ("circle 1,2 3 cw", Circle((1, 2), 3, ccw=False)),
    ],
)
def test_circles_by_what_is_known_of_them(line: str, circle: Circle) -> None:
    (drawn,) = curves(line)
    assert isinstance(drawn, Circle)
    assert drawn.centre == pytest.approx(circle.centre)
    assert (drawn.radius, drawn.ccw) == (pytest.approx(circle.radius), circle.ccw)


def test_a_rectangle_with_round_corners_is_closed_and_smooth() -> None:
    drawn = curves("rect 20,10 0,0 round 3")
    assert is_closed(drawn) and len(drawn) == 8
    assert [c.centre for c in drawn if isinstance(c, Arc)] == [(17, 3), (17, 7), (3, 7), (3, 3)]
    assert all(c.sweep == pytest.approx(math.pi / 2) for c in drawn if isinstance(c, Arc))
    assert len(curves("rect 0,0 10,10 round 5")) == 4


def test_polygons_by_corner_and_by_side() -> None:
    by_corner, by_side = curves("polygon 6 0,0 10,0"), curves("polygon 6 0,0 side 10,0")
    assert is_closed(by_corner) and is_closed(by_side)
    assert [math.hypot(*c.start) for c in by_corner] == pytest.approx([10] * 6)
    assert [
        math.dist(((c.start[0] + c.end[0]) / 2, (c.start[1] + c.end[1]) / 2), (0, 0)) for c in by_side
    ] == pytest.approx([10] * 6)
    assert any(lies_on(c, (10, 0)) and abs(c.start[0] - 10) < 1e-9 for c in by_side)


def test_a_slot_is_all_within_half_its_width_of_a_line() -> None:
    drawn = curves("slot 0,0 10,0 4")
    assert drawn == (
        Line((0, -2), (10, -2)),
        Arc((10, -2), (10, 2), (10, 0)),
        Line((10, 2), (0, 2)),
        Arc((0, 2), (0, -2), (0, 0)),
    )


def test_ellipses_take_the_longer_axis_for_major() -> None:
    (wide,), (tall,) = curves("ellipse 1,1 5,1 2"), curves("ellipse 1,1 3,1 4")
    assert wide == Ellipse((1, 1), (4, 0), 0.5)
    assert isinstance(tall, Ellipse)
    assert (tall.major, tall.ratio) == ((0, 4), 0.5)
    (part,) = curves("ellipse 0,0 2,0 4 from 0 to 90")
    assert part.start == pytest.approx((2, 0)) and part.end == pytest.approx((0, 4), abs=1e-12)
    (back,) = curves("ellipse 0,0 4,0 2 from 0 to 90 cw")
    assert back.start == pytest.approx((0, 2), abs=1e-12) and back.end == pytest.approx((4, 0))


@pytest.mark.parametrize("close", [False, True])
def test_a_spline_through_points_is_the_interpolating_cubic(close: bool) -> None:
    points = [(0.0, 0.0), (10.0, 5.0), (12.0, -3.0), (30.0, 1.0)]
    (drawn,) = curves("spline " + " ".join(f"{x},{y}" for x, y in points) + " close" * close)
    assert isinstance(drawn, Spline)
    ring = points + points[:1] * close
    way = [0.0]
    for a, b in itertools.pairwise(ring):
        way.append(way[-1] + math.dist(a, b))
    meant = CubicSpline(way, ring, bc_type="periodic" if close else "natural")
    knots = sorted(set(drawn.knots))
    assert knots == pytest.approx(way)
    assert spline_points(drawn, meant.x) == pytest.approx(meant(meant.x), abs=1e-9)
    between = (meant.x[:-1] + meant.x[1:]) / 2
    assert spline_points(drawn, between) == pytest.approx(meant(between), abs=1e-9)


def test_splines_by_control_points() -> None:
    (plain,), (given,) = (
        curves("spline degree 2 0,0 5,5 10,0"),
        curves("spline degree 2 0,0 5,5 10,0 knots 0 0 0 1 1 1 weights 1 0.5 1"),
    )
    assert plain == Spline(2, ((0, 0), (5, 5), (10, 0)), (0, 0, 0, 1, 1, 1))
    assert given == Spline(2, ((0, 0), (5, 5), (10, 0)), (0, 0, 0, 1, 1, 1), (1, 0.5, 1))
    assert len(sample(given)) > 2


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("arc 0,0 10,0 radius 4", "5.000 mm or more"),
        ("arc on 5,5", "Nothing that was drawn"),
        ("circle through 0,0 1,1 2,2", "straight line"),
        ("rect 0,0 10,4 round 3", "at most 2.000"),
        ("polygon 2 0,0 1,0", "from 3 to 1000"),
        ("polygon 3.5 0,0 1,0", "whole number"),
        ("slot 0,0 0,0 3", "greater than 0"),
        ("ellipse 0,0 5,0 0", "half axes"),
        ("ellipse 0,0 5,0 2 from 10", "add to"),
        ("ellipse 0,0 5,0 2 from 90 to 90", "spans"),
        ("spline 0,0 1,1", "three points"),
        ("spline 0,0 1,1 1,1", "same as point 2"),
        ("spline degree 3 0,0 1,1 2,2", "4 control points"),
        ("spline degree 1 0,0 1,1 knots 0 0 1", "4 knots"),
        ("spline degree 1 0,0 1,1 weights 1 -1", "greater than 0"),
        ("spline degree 1 0,0 1,1 knots 0 0 1 0", "do not fall"),
    ],
)
def test_a_shape_that_is_none_is_refused(line: str, says: str) -> None:
    with pytest.raises(InputError, match=says):
        Document().run(line)


def test_an_arc_straight_ahead_is_refused() -> None:
    document = Document()
    document.run("line 0,0 10,0")
    with pytest.raises(CommandError, match="straight ahead or behind"):
        document.run("arc on 20,0")
