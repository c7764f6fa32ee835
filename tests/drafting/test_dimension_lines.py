"""Dimensions as they are drawn: what they measure, where their arrows point, and how their figures are read."""

import math

import pytest

from app.geometry.dimension_lines import dimension_lines, figure, measured
from app.model.curves import Line
from app.model.notes import Dimension, DimensionKind


def between(measure: DimensionKind, place: tuple[float, float] = (20.0, 50.0)) -> Dimension:
    return Dimension(measure, ((0.0, 0.0), (30.0, 40.0)), place)


def test_each_kind_measures_its_own() -> None:
    kinds = (
        DimensionKind.ALIGNED,
        DimensionKind.ACROSS,
        DimensionKind.UP,
        DimensionKind.RADIUS,
        DimensionKind.DIAMETER,
    )
    assert [measured(between(kind)) for kind in kinds] == [50, 30, 40, 50, 100]
    assert [figure(between(kind)) for kind in kinds] == ["50", "30", "40", "R 50", "\u2300 100"]
    angle = Dimension(DimensionKind.ANGLE, ((0.0, 0.0), (1.0, 0.0), (-1.0, -1.0)), (5.0, 5.0))
    assert (measured(angle), figure(angle)) == (pytest.approx(225), "225°")
    assert figure(Dimension(DimensionKind.ALIGNED, ((0.0, 0.0), (25.4, 0.0)), (0.0, 5.0)), 25.4) == "1"


def test_arrows_touch_the_extension_lines_and_point_outward() -> None:
    drawn = dimension_lines(Dimension(DimensionKind.ALIGNED, ((0.0, 0.0), (30.0, 0.0)), (15.0, 10.0)), 3.0)
    assert [head[0] for head in drawn.heads] == [(0.0, 10.0), (30.0, 10.0)]
    assert [head[1][0] for head in drawn.heads] == [3.0, 27.0]
    assert drawn.lines[-1] == Line((0.0, 10.0), (30.0, 10.0))
    assert [(line.start, line.end) for line in drawn.lines[:2]] == [
        (pytest.approx((x, 1.2)), pytest.approx((x, 11.8))) for x in (0.0, 30.0)
    ]
    assert (drawn.at, drawn.angle) == ((15.0, 10.0), 0.0)


def test_where_there_is_no_room_the_arrows_come_from_outside_and_the_line_reaches_the_figure() -> None:
    drawn = dimension_lines(Dimension(DimensionKind.ALIGNED, ((0.0, 0.0), (4.0, 0.0)), (20.0, 10.0)), 3.0)
    assert [head[1][0] for head in drawn.heads] == [-3.0, 7.0]
    assert drawn.lines[-1] == Line((-6.0, 10.0), (20.0, 10.0))


def test_figures_are_never_upside_down() -> None:
    for degrees in range(0, 360, 15):
        way = (math.cos(math.radians(degrees)) * 20, math.sin(math.radians(degrees)) * 20)
        for kind in (DimensionKind.ALIGNED, DimensionKind.DIAMETER):
            assert (
                -math.pi / 2 < dimension_lines(Dimension(kind, ((0.0, 0.0), way), way), 3.0).angle <= math.pi / 2 + 1e-9
            )


def test_a_radius_begins_at_the_centre_and_ends_on_the_circle() -> None:
    inside = dimension_lines(Dimension(DimensionKind.RADIUS, ((0.0, 0.0), (10.0, 0.0)), (0.0, 5.0)), 2.0)
    assert inside.lines == (Line((0.0, 0.0), (0.0, 10.0)),)
    assert inside.heads[0][0] == (0.0, 10.0)
    outside = dimension_lines(Dimension(DimensionKind.RADIUS, ((0.0, 0.0), (10.0, 0.0)), (0.0, 15.0)), 2.0)
    assert outside.lines == (Line((0.0, 10.0), (0.0, 15.0)),)
    assert outside.heads[0][1][1] == pytest.approx(12.0)


def test_an_angle_is_an_arc_through_the_place() -> None:
    drawn = dimension_lines(Dimension(DimensionKind.ANGLE, ((0.0, 0.0), (5.0, 0.0), (0.0, 5.0)), (10.0, 0.0)), 2.0)
    (arc,) = drawn.arcs
    assert (arc.start, arc.end, arc.radius, arc.ccw) == ((10.0, 0.0), (0.0, 10.0), 10.0, True)
    assert len(drawn.lines) == 2


@pytest.mark.parametrize("measure", list(DimensionKind))
def test_what_has_no_size_is_still_drawn(measure: DimensionKind) -> None:
    drawn = dimension_lines(Dimension(measure, ((1.0, 1.0),) * 3, (1.0, 1.0)), 2.0)
    assert drawn.figure.strip("R\u2300° ") == "0"
