"""Points, construction lines and dimensions in words."""

import math

import pytest

from app.core.errors import InputError
from app.drafting.document import Document
from app.drafting.language.write import draw_text
from app.model.curves import Line
from app.model.notes import Dimension, DimensionKind, Guide, Mark, Shape
from tests.drafting.documents import drawn

QUARTER = math.pi / 2


def shape(*lines: str) -> Shape:
    return drawn(*lines).part.notes[-1].shape


def test_expressions_meet_construction_lines_and_take_numbers() -> None:
    document = drawn(
        "guide up 4,0 as g", "line 0,0 10,5 as l", "line meet(g, l, 0,0) foot(9,9, g)", "line 0,0 meet(1, 2, 0,0)"
    )
    assert [e.curve for e in document.part.entities[1:]] == [Line((4, 2), (4, 9)), Line((0, 0), (4, 2))]
    document.run("point 1,1")
    for line, says in (
        ("point start(g)", "no ends"),
        ("point meet(5, 2, 0,0)", "a point or a dimension"),
        ("trim 1 0,0", "no ends"),
    ):
        with pytest.raises(InputError, match=says):
            document.run(line)


@pytest.mark.parametrize(
    ("lines", "made"),
    [
        (["point 3,4"], Mark((3, 4))),
        (["guide 1,2 225deg"], Guide((1, 2), math.pi / 4)),
        (["guide 1,2 -45"], Guide((1, 2), 3 * math.pi / 4)),
        (["guide 1,2 @0,-5"], Guide((1, 2), QUARTER)),
        (["guide across 1,2"], Guide((1, 2), 0)),
        (["guide up 1,2"], Guide((1, 2), QUARTER)),
        (["dimension 0,0 30,40 place 10,30"], Dimension(DimensionKind.ALIGNED, ((0, 0), (30, 40)), (10, 30))),
        (["dimension 0,0 30,40 place 10,30 across"], Dimension(DimensionKind.ACROSS, ((0, 0), (30, 40)), (10, 30))),
        (["line 0,0 30,40", "dimension 1 place 10,30"], Dimension(DimensionKind.ALIGNED, ((0, 0), (30, 40)), (10, 30))),
        (
            ["circle 1,1 5 as c", "dimension c place 10,30"],
            Dimension(DimensionKind.DIAMETER, ((1, 1), (6, 1)), (10, 30)),
        ),
        (
            ["arc 5,0 0,5 centre 0,0", "dimension 1 place 3,3"],
            Dimension(DimensionKind.RADIUS, ((0, 0), (12.5**0.5, 12.5**0.5)), (3, 3)),
        ),
        (["dimension angle 0,0 5,0 0,5 place 3,3"], Dimension(DimensionKind.ANGLE, ((0, 0), (5, 0), (0, 5)), (3, 3))),
    ],
)
def test_each_is_drawn(lines: list[str], made: Shape) -> None:
    found = shape(*lines)
    if isinstance(made, Guide):
        assert isinstance(found, Guide) and found.through == made.through and found.angle == pytest.approx(made.angle)
    elif isinstance(made, Dimension):
        assert isinstance(found, Dimension) and found.measure is made.measure and found.place == made.place
        assert sum(found.points, ()) == pytest.approx(sum(made.points, ()))
    else:
        assert found == made


def test_they_are_numbered_named_and_edited_like_curves() -> None:
    document = drawn("line 0,0 5,0", "point 5,5 as p", "guide up 7,0", "rotate 0,0 90 copy 2 3")
    assert [(n.id, n.shape) for n in document.part.notes][2:] == [(4, Mark((-5, 5))), (5, Guide((0, 7), 0))]
    document.run("move @1,1 p")
    assert document.part.notes[0].shape == Mark((6, 6))
    document.run("layer help p")
    document.run("select layer help")
    assert document.selection == {2}
    document.run("delete 1-3")
    assert [n.id for n in document.part.notes] == [4, 5] and document.selection == frozenset()
    document.run("point 1,1")
    assert document.part.notes[-1].id == 6


def test_a_mirrored_angle_stays_as_large_and_a_turned_measure_keeps_its_figure() -> None:
    angle = shape("dimension angle 0,0 5,0 0,5 place 3,3", "mirror 0,0 0,1 1")
    assert isinstance(angle, Dimension) and angle.points == ((0, 0), (0, 5), (-5, 0))
    across = shape("dimension 0,0 30,40 place 10,50 across", "rotate 0,0 90 1")
    assert isinstance(across, Dimension) and across.measure is DimensionKind.UP and across.points == ((0, 0), (-40, 30))


def test_windows_and_crossings_choose_them() -> None:
    document = drawn("point 5,5", "guide 0,20 0", "dimension 0,0 10,0 place 5,-8", "layer far", "point 6,6", "lock far")
    document.run("select all")
    assert document.selection == {1, 2, 3}
    document.run("select window -1,-9 30,30")
    assert document.selection == {1, 3}
    document.run("select crossing 4,-9 6,-7")
    assert document.selection == {3}
    document.run("select crossing 50,19 60,21")
    assert document.selection == {2}


def test_a_text_draws_them_again_in_their_order() -> None:
    document = drawn(
        "point 1,2",
        "line 0,0 5,0",
        "layer help",
        "guide 1,2 30",
        "circle 0,0 3",
        "dimension 4 place 5,5",
        "dimension angle 0,0 5,0 0,5 place 3,3",
        "layer 0",
        "dimension 0,0 3,4 place 1,9 up",
    )
    again = Document()
    again.run_script(draw_text(document.part).text)
    assert again.part.entities == document.part.entities and again.part.notes == document.part.notes


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("point", "too early"),
        ("guide 0,0 0,0", "two different points"),
        ("guide 0,0", "another point of it, or its angle"),
        ("dimension 0,0 0,0 place 1,1", "different points"),
        ("dimension 0,0 5,5", "place"),
        ("dimension 1 place 0,0", "give two points"),
        ("delete 9", "no entity 9"),
        ("dimension angle 0,0 5,0 place 1,1", "place"),
    ],
)
def test_what_cannot_be_is_told(line: str, says: str) -> None:
    with pytest.raises(InputError, match=says):
        drawn("spline 0,0 5,5 9,0").run(line)
