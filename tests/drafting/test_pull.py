"""Grips: what a pulled point takes along, and what stays."""

import math

import pytest

from app.core.errors import InputError
from app.drafting.commands.grips import GripKind, grip_position, grips, pulled
from app.drafting.document import Document
from app.model.curves import Arc, Circle, Ellipse, Line, Spline
from app.model.notes import Dimension, DimensionKind, Guide, Mark
from tests.drafting.documents import drawn


def curve_of(document: Document, number: int = 1) -> object:
    return document.part.curve(number)


def test_an_end_of_a_line_moves_alone_and_its_middle_takes_it_along() -> None:
    document = drawn("line 0,0 10,0", "pull 1 10,0 to 12,5")
    assert curve_of(document) == Line((0, 0), (12, 5))
    document.run("pull 1 6,2.5 to 7,3.5")
    assert curve_of(document) == Line((1, 1), (13, 6))
    assert document.last_point == (7, 3.5)
    document.undo()
    assert curve_of(document) == Line((0, 0), (12, 5))


def test_a_corner_of_a_rectangle_takes_both_its_lines() -> None:
    document = drawn("rect 0,0 20,10", "select all", "pull 1-2 20,0 to 25,-5")
    assert curve_of(document, 1) == Line((0, 0), (25, -5))
    assert curve_of(document, 2) == Line((25, -5), (20, 10))
    assert grip_position(document.part, frozenset({1, 2, 3, 4}), (20, 10)) == {2, 3}
    assert grip_position(document.part, frozenset({1, 2, 3, 4}), (10, 10)) == {3}


def test_circles_move_by_the_centre_and_grow_by_a_quadrant() -> None:
    document = drawn("circle 10,10 5", "pull 1 10,10 to 12,13", "pull 1 17,13 to 12,20")
    assert curve_of(document) == Circle((12, 13), 7)


@pytest.mark.parametrize("index", [0, 1])
def test_an_end_of_an_arc_keeps_the_other_end_and_the_angle(index: int) -> None:
    arc = Arc((10, 0), (0, 10), (0, 0))
    grip = grips(arc)[index]
    made = pulled(arc, grip, (15, 12))
    assert isinstance(made, Arc)
    kept = (arc.end, made.end) if index == 0 else (arc.start, made.start)
    assert kept[0] == kept[1] and (made.start, made.end)[index] == (15, 12)
    assert made.sweep == pytest.approx(arc.sweep, abs=1e-12)
    assert math.dist(made.start, made.centre) == pytest.approx(math.dist(made.end, made.centre), abs=1e-12)


def test_the_middle_of_an_arc_keeps_both_ends_and_its_quadrant_the_centre() -> None:
    arc = Arc((10, 0), (-10, 0), (0, 0))
    middle = next(g for g in grips(arc) if g.hold is GripKind.MIDDLE)
    made = pulled(arc, middle, (0, 4))
    assert isinstance(made, Arc) and (made.start, made.end) == ((10, 0), (-10, 0))
    assert made.radius == pytest.approx((100 + 16) / 8)
    quadrant = next(g for g in grips(arc) if g.hold is GripKind.QUADRANT and g.at == (0, 10))
    assert pulled(arc, quadrant, (0, 5)) == Arc((5, 0), (-5, 0), (0, 0))


def test_axes_of_an_ellipse_swap_when_the_minor_grows_longer() -> None:
    ellipse = Ellipse((0, 0), (10, 0), 0.5)
    _, right, top, _, bottom = grips(ellipse)
    assert pulled(ellipse, right, (0, 20)) == Ellipse((0, 0), (0, 20), 0.25)
    assert pulled(ellipse, top, (3, 8)) == Ellipse((0, 0), (10, 0), 0.8)
    longer = pulled(ellipse, bottom, (0, -20))
    assert isinstance(longer, Ellipse) and longer.ratio == pytest.approx(0.5)
    for t in range(4):
        x, y = ellipse.at(t)
        assert longer.at(t - math.pi / 2) == pytest.approx((x, y * 4)), "the points stay where they were along it"


def test_a_control_point_bends_a_spline_and_a_closed_one_stays_closed() -> None:
    document = drawn("spline degree 2 0,0 5,10 10,0", "pull 1 5,10 to 6,12")
    assert curve_of(document) == Spline(2, ((0, 0), (6, 12), (10, 0)), (0, 0, 0, 1, 1, 1))
    closed = Spline(2, ((0, 0), (5, 10), (10, 0), (0, 0)), (0, 0, 0, 1, 2, 2, 2))
    made = pulled(closed, grips(closed)[0], (1, 1))
    assert made.start == made.end == (1, 1)


def test_notes_are_pulled_too() -> None:
    document = drawn("line 0,0 10,0")
    part = document.part
    for shape in (Mark((5, 5)), Guide((0, 8), 0.0), Dimension(DimensionKind.ALIGNED, ((0, 0), (10, 0)), (5, -4))):
        part = part.with_note(shape, "0")
    document.change_job("Notes", document.job.__class__(part))
    for line in ("pull 2 5,5 to 6,6", "pull 3 0,8 to 0,9", "pull 4 5,-4 to 5,-6", "pull 4 10,0 to 12,0"):
        document.run(line)
    assert [note.shape for note in document.part.notes] == [
        Mark((6, 6)),
        Guide((0, 9), 0.0),
        Dimension(DimensionKind.ALIGNED, ((0, 0), (12, 0)), (5, -6)),
    ]


@pytest.mark.parametrize(
    ("line", "reason"),
    [
        ("pull 1 3,3 to 5,5", "nearest place to pull it by is 5.000,0.000"),
        ("pull 1 0,0 to 10,0", "Nothing would be left"),
        ("pull 7 0,0 to 1,1", "no entity 7"),
        ("pull 0,0 to 1,1", "Nothing is selected"),
        ("pull 1 0,0 1,1", "to x,y"),
    ],
)
def test_what_cannot_be_pulled_is_said(line: str, reason: str) -> None:
    document = drawn("line 0,0 10,0")
    before = document.part
    with pytest.raises(InputError, match=reason):
        document.run(line)
    assert document.part is before
