"""Trim, extend, break, fillet, chamfer, offset: by closed forms, and joints that are tangent."""

import math

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from app.core.errors import InputError
from app.drafting.commands.corners import fillet
from app.drafting.document import Document
from app.model.curves import Arc, Circle, Curve, Line, Point


def after(text: str) -> dict[int, Curve]:
    document = Document()
    document.run_script(text)
    return {e.id: e.curve for e in document.part.entities}


CROSS = "line 0,0 30,0\nline 10,-5 10,5\nline 20,-5 20,5\n"


@pytest.mark.parametrize(
    ("line", "left"),
    [
        ("trim 1 15,1", {1: Line((0, 0), (10, 0)), 4: Line((20, 0), (30, 0))}),
        ("trim 1 2,0", {1: Line((10, 0), (30, 0))}),
        ("trim 1 15,0 by 2", {1: Line((0, 0), (10, 0))}),
        ("tr 1 29,9", {1: Line((0, 0), (20, 0))}),
    ],
)
def test_trimming_takes_the_piece_that_is_pointed_at(line: str, left: dict[int, Curve]) -> None:
    drawn = after(CROSS + line)
    assert {k: c for k, c in drawn.items() if k not in (2, 3)} == left


def test_a_circle_is_trimmed_to_an_arc() -> None:
    drawn = after("circle 0,0 5\nline -9,3 9,3\nline 0,-9 0,9\ntrim 1 0.5,5 by 2")
    assert drawn[1] == Arc((-4, 3), (4, 3), (0, 0), ccw=True)


def test_a_spline_is_trimmed_between_its_neighbours_alone() -> None:
    drawn = after("spline degree 2 0,0 10,20 20,0\nline 2,-9 2,20\nline 18,-9 18,20\nline 10,-9 10,20\ntrim 1 10.5,10")
    assert sorted(drawn) == [1, 2, 3, 4, 5]
    assert drawn[1].end[0] == pytest.approx(10) and drawn[5].start[0] == pytest.approx(18)


@pytest.mark.parametrize(
    ("line", "curve"),
    [
        ("extend 1 9,0", Line((0, 0), (20, 0))),
        ("extend 1 1,0", Line((-5, 0), (10, 0))),
        ("extend 1 9,0 to 3", Line((0, 0), (25, 0))),
        ("extend 4 30,10", Arc((30, 0), (20, 10), (20, 0))),
        ("extend 1 10,0 to 2 3", Line((0, 0), (20, 0))),
    ],
)
def test_extending_goes_to_the_first_edge_ahead(line: str, curve: Curve) -> None:
    drawn = after(
        "line 0,0 10,0\nline 20,-20 20,20\nline 25,-5 25,5\narc 30,0 27,7.1414284285428495 centre 20,0\nline -5,-5 "
        "-5,5\n" + line
    )
    number = int(line.split()[1])
    if isinstance(curve, Arc):
        assert drawn[number].end == pytest.approx((20, 10))
    else:
        assert drawn[number] == curve


def test_construction_lines_are_edges_and_what_is_hidden_is_none() -> None:
    assert after("line 0,0 30,0\nguide up 10,5\nguide 20,0 90\ntrim 1 15,1") == {
        1: Line((0, 0), (10, 0)),
        4: Line((20, 0), (30, 0)),
    }
    assert after("line 0,0 5,0\nguide up 10,5\nguide up 20,0\nextend 1 5,0 to 3") == {1: Line((0, 0), (20, 0))}
    hidden = "layer a\nline 10,-5 10,5\nlayer b\nline 20,-5 20,5\nline 0,0 30,0\nhide a\ntrim 3 12,0"
    assert after(hidden)[3] == Line((20, 0), (30, 0))
    assert after(hidden + " by 1")[3] == Line((0, 0), (10, 0))


def test_breaking_at_one_point_and_between_two() -> None:
    assert after("line 0,0 10,0\nbreak 1 4,1") == {1: Line((0, 0), (4, 0)), 2: Line((4, 0), (10, 0))}
    assert after("line 0,0 10,0\nbr 1 7,0 4,1") == {1: Line((0, 0), (4, 0)), 2: Line((7, 0), (10, 0))}
    assert after("circle 0,0 5\nbreak 1 5,0 0,5") == {1: Arc((0, 5), (5, 0), (0, 0))}
    assert after("circle 0,0 5\nbreak 1 0,5 5,0") == {1: Arc((5, 0), (0, 5), (0, 0))}


def test_a_corner_is_rounded() -> None:
    assert after("line 0,0 10,0 10,10\nfillet 3 1 2") == {
        1: Line((0, 0), (7, 0)),
        2: Line((10, 3), (10, 10)),
        3: Arc((7, 0), (10, 3), (7, 3)),
    }


def test_lines_that_do_not_meet_are_lengthened_to_their_fillet() -> None:
    assert after("line 0,0 5,0\nline 10,5 10,10\nfillet 2 1 2") == {
        1: Line((0, 0), (8, 0)),
        2: Line((10, 2), (10, 10)),
        3: Arc((8, 0), (10, 2), (8, 2)),
    }


@pytest.mark.parametrize(
    ("near", "centre"), [("-5,0 0,5", (-2, 2)), ("5,0 0,5", (2, 2)), ("5,0 0,-5", (2, -2)), ("-5,0 0,-5", (-2, -2))]
)
def test_of_crossing_lines_the_sides_pointed_at_stay(near: str, centre: Point) -> None:
    first, second = near.split()
    drawn = after(f"line -10,0 10,0\nline 0,-10 0,10\nfillet 2 1 {first} 2 {second}")
    assert isinstance(drawn[3], Arc)
    assert drawn[3].centre == pytest.approx(centre)
    assert abs(drawn[3].sweep) == pytest.approx(math.pi / 2)


def test_every_corner_of_a_contour_at_once() -> None:
    drawn = after("rect 0,0 20,10\nfillet 2 1-4")
    assert len(drawn) == 8
    assert sorted(c.centre for c in drawn.values() if isinstance(c, Arc)) == [(2, 2), (2, 8), (18, 2), (18, 8)]
    cut = after("rect 0,0 20,10\nchamfer 2 1-4")
    assert sorted(math.dist(c.start, c.end) for c in cut.values()) == pytest.approx([math.sqrt(8)] * 4 + [6, 6, 16, 16])


def test_chamfers_may_be_uneven() -> None:
    assert after("line 0,0 10,0 10,10\nchamfer 3 and 1 1 2") == {
        1: Line((0, 0), (7, 0)),
        2: Line((10, 1), (10, 10)),
        3: Line((7, 0), (10, 1)),
    }


@settings(deadline=None)
@given(st.floats(0.2, 2.9), st.floats(0.1, 3), st.floats(2, 20), st.booleans())
def test_a_fillet_touches_both_curves(opening: float, radius: float, round_radius: float, ccw: bool) -> None:
    line = Line((30, 0), (0, 0))
    side = 1 if ccw else -1
    centre = (
        round_radius * math.cos(opening + side * math.pi / 2),
        round_radius * math.sin(opening + side * math.pi / 2),
    )
    end_turn = math.atan2(-centre[1], -centre[0]) + side * 0.8
    arc = Arc(
        (0, 0),
        (centre[0] + round_radius * math.cos(end_turn), centre[1] + round_radius * math.sin(end_turn)),
        centre,
        ccw,
    )
    try:
        first, made, second = fillet(line, arc, radius, ((15, 0), arc.end))
    except InputError:
        assume(False)
    assert isinstance(second, Arc)
    assert made.radius == pytest.approx(radius)
    for curve in (line, arc):
        away = abs(made.centre[1]) if curve is line else abs(math.dist(made.centre, centre) - round_radius)
        assert away == pytest.approx(radius, abs=1e-7)
    assert {made.start, made.end} <= {first.start, first.end, second.start, second.end}
    assert abs(made.sweep) < math.pi


@settings(deadline=None)
@given(st.floats(0.5, 4), st.floats(0.5, 12), st.floats(-6, 6), st.floats(0.3, 6), st.floats(0, 6))
def test_a_fillet_may_hold_a_smaller_arc(small: float, radius: float, height: float, sweep: float, turn: float) -> None:
    line = Line((-30, height), (30, height))
    arc = Arc(
        (small * math.cos(turn), small * math.sin(turn)),
        (small * math.cos(turn + sweep), small * math.sin(turn + sweep)),
        (0, 0),
    )
    for near in ((-15.0, height), (15.0, height)):
        try:
            _, made, _ = fillet(line, arc, radius, (near, arc.end))
        except InputError:
            continue
        assert math.dist(made.start, made.centre) == pytest.approx(radius) and math.dist(
            made.end, made.centre
        ) == pytest.approx(radius)
        assert abs(made.centre[1] - height) == pytest.approx(radius)
        away = math.hypot(*made.centre)
        assert min(abs(away - small - radius), abs(abs(radius - small) - away)) < 1e-7


def test_places_near_a_corner_stand_for_their_sides_of_it() -> None:
    first, made, second = fillet(Line((10, 10), (90, 10)), Line((10, 10), (10, 60)), 12, ((20, 10), (10, 15)))
    assert (first, second) == (Line((22, 10), (90, 10)), Line((10, 22), (10, 60))) and made.centre == (22, 22)
    cross = fillet(Line((-50, 0), (50, 0)), Line((0, -50), (0, 50)), 8, ((-3, 0), (0, 2)))
    assert cross[0].start == (-50, 0) and cross[0].end == pytest.approx((-8, 0), abs=1e-9)
    assert cross[2].start == pytest.approx((0, 8), abs=1e-9) and cross[2].end == (0, 50)


@settings(deadline=None)
@given(st.floats(3, 20), st.floats(-14, 14), st.floats(1, 12), st.booleans())
def test_a_fillet_of_a_line_and_a_circle_leaves_the_circle_whole(
    size: float, height: float, radius: float, circle_first: bool
) -> None:
    line, circle = Line((-60, height), (60, height)), Circle((0, 0), size)
    pair, near = (
        ((circle, line), ((-size, 0.0), (-50.0, height)))
        if circle_first
        else ((line, circle), ((-50.0, height), (-size, 0.0)))
    )
    try:
        first, made, second = fillet(*pair, radius, near)
    except InputError:
        assume(False)
    kept, whole = (second, first) if circle_first else (first, second)
    assert whole is circle and isinstance(kept, Line) and kept.start == (-60, height)
    touch, other = (made.end, made.start) if circle_first else (made.start, made.end)
    assert kept.end == touch and abs(made.centre[1] - height) == pytest.approx(radius)
    assert math.hypot(*other) == pytest.approx(size) and made.radius == pytest.approx(radius)
    # both centres and the place in one line
    assert abs(made.centre[0] * other[1] - made.centre[1] * other[0]) < 1e-6 * size * 60
    assert abs(made.sweep) < math.pi


def test_a_fillet_between_circles_lies_on_the_side_pointed_at() -> None:
    for text, centre in (("1 5,0.1 2 10,0.1", (7.5, 5.4516)), ("1 5,-0.1 2 10,-0.1", (7.5, -5.4516))):
        drawn = after(f"circle 0,0 5\ncircle 15,0 5\nfillet 4.272 {text}")
        assert drawn[1] == Circle((0, 0), 5) and drawn[2] == Circle((15, 0), 5) and isinstance(drawn[3], Arc)
        assert drawn[3].centre == pytest.approx(centre, abs=1e-3) and drawn[3].radius == pytest.approx(4.272)
        assert math.hypot(*drawn[3].start) == pytest.approx(5)
    outer = after("circle 0,0 5\ncircle 15,0 5\nfillet 20 1 -5,0.1 2 20,0.1")[3]
    assert isinstance(outer, Arc) and math.hypot(*outer.centre) == pytest.approx(15)  # it holds both


def test_a_radius_of_zero_makes_a_corner_sharp() -> None:
    assert after("line 0,0 4,0\nline 10,5 10,10\nfillet 0 1 2") == {
        1: Line((0, 0), (10, 0)),
        2: Line((10, 0), (10, 10)),
    }
    assert after("line -10,0 10,0\nline 0,-9 0,9\nfi 0 1 -5,0 2 0,5") == {
        1: Line((-10, 0), (0, 0)),
        2: Line((0, 0), (0, 9)),
    }
    drawn = after("arc 5,0 0,5 centre 0,0\nline -9,3 -6,3\nfillet 0 1 2")
    assert drawn[1].end == pytest.approx((-4, 3)) and drawn[2] == Line((-9, 3), drawn[1].end)


def test_of_several_curves_only_true_corners_are_rounded_and_what_cannot_be_stays() -> None:
    document = Document()
    document.run_script("line 0,0 20,0 20,10\narc on 10,20\nline 10,20 0,20 0,0")
    assert document.run("fillet 2 1-5") == "3 corners."
    assert len(document.part.entities) == 8
    document.run_script("clear\nline 0,0 20,0 20,1 40,1 40,30")
    assert document.run("fillet 3 1-4") == "1 corner, 2 left as before."


def test_an_arc_never_goes_on_to_its_own_other_end() -> None:
    with pytest.raises(InputError, match="No edge lies ahead"):
        after("arc 5,0 0,5 centre 0,0\nline 5,-9 5,0\nextend 1 0,5 to 2")


@pytest.mark.parametrize(
    ("line", "made"),
    [
        ("offset 2 5,5 1", Line((0, 2), (10, 2))),
        ("offset 2 5,-5 1", Line((0, -2), (10, -2))),
        ("offset 1 30,0 2", Circle((20, 0), 6)),
        ("offset 1 20,1 2", Circle((20, 0), 4)),
        ("offset 1 0,0 3", Arc((4, 0), (0, 4), (0, 0))),
    ],
)
def test_parallels_lie_on_the_side_of_the_point(line: str, made: Curve) -> None:
    assert after("line 0,0 10,0\ncircle 20,0 5\narc 5,0 0,5 centre 0,0\n" + line)[4] == made


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("trim 1 5,0 by 4", "Nothing crosses"),
        ("trim 4 5,0", "crossed twice"),
        ("extend 4 1,1", "Only lines and arcs"),
        ("extend 1 29,0", "No edge lies ahead"),
        ("break 1 0,0", "is an end"),
        ("break 4 5,5", "two points"),
        ("break 1 5,0 5,1", "same place"),
        ("fillet 100 1 2", "No arc of radius"),
        ("fillet 0 1 4", "no end"),
        ("fillet -1 1 2", "greater than 0"),
        ("chamfer 1 1 4", "two lines"),
        ("fillet 9 2 4", "No arc"),
        ("fillet 0 2 3", "do not meet"),
        ("fillet 1 1", "Two curves"),
        ("fillet 1 1-4", "No two"),
        ("chamfer 50 1 2", "use less"),
        ("chamfer 1 2 3", "Parallel"),
        ("offset 9 100,50 4", "nearer"),
        ("offset 1 0,0 9", "no entity 9"),
        ("trim 9 0,0", "no curve 9"),
        ("trim 1 0,0 by 9", "no entity 9"),
        ("offset 0 5,5 1", "greater than 0"),
        ("offset 1 5,5", "Nothing is selected"),
    ],
)
def test_what_cannot_be_done_is_told(line: str, says: str) -> None:
    document = Document()
    document.run_script(CROSS + "circle 100,50 5")
    before = document.part
    with pytest.raises(InputError, match=says):
        document.run(line)
    assert document.part is before
