"""The command `set`: each property of each shape, and what stays the same."""

import math

import pytest

from app.core.errors import InputError
from app.drafting.document import Document
from app.model.curves import Arc, Circle, Ellipse, Line
from app.model.notes import Guide, Mark
from app.model.part import Part


def drawn(line: str) -> Document:
    document = Document()
    document.run(line)
    return document


@pytest.mark.parametrize(
    ("draws", "sets", "becomes"),
    [
        ("line 10,10 60,10", "start 0,0", Line((0, 0), (60, 10))),
        ("line 10,10 60,10", "end 60,20", Line((10, 10), (60, 20))),
        ("line 10,10 60,10", "end @10,5", Line((10, 10), (70, 15))),
        ("line 10,10 60,10", "middle 0,0", Line((-25, 0), (25, 0))),
        ("line 10,10 60,10", "length 1in", Line((10, 10), (35.4, 10))),
        ("line 10,10 60,10", "angle 90", Line((10, 10), (10, 60))),
        ("arc 10,0 0,10 centre 0,0", "radius 20", Arc((20, 0), (0, 20), (0, 0))),
        ("arc 10,0 0,10 centre 0,0", "diameter 5", Arc((2.5, 0), (0, 2.5), (0, 0))),
        ("arc 10,0 0,10 centre 0,0", "centre 5,5", Arc((15, 5), (5, 15), (5, 5))),
        ("arc 10,0 0,10 centre 0,0", "sweep 180", Arc((10, 0), (-10, 0), (0, 0))),
        ("arc 0,10 10,0 centre 0,0 cw", "sweep 180", Arc((0, 10), (0, -10), (0, 0), ccw=False)),
        ("arc 10,0 0,10 centre 0,0", "end 10,20", Arc((10, 0), (10, 20), (0, 10))),
        ("circle 5,5 3", "diameter 1in/2", Circle((5, 5), 6.35)),
        ("circle 5,5 3 cw", "centre 1,2", Circle((1, 2), 3, ccw=False)),
        ("circle 5,5 3", "radius 4", Circle((5, 5), 4)),
        ("ellipse 0,0 10,0 5", "major 20", Ellipse((0, 0), (20, 0), 0.25)),
        ("ellipse 0,0 10,0 5", "minor 2", Ellipse((0, 0), (10, 0), 0.2)),
        ("ellipse 0,0 10,0 5", "angle 90", Ellipse((0, 0), (0, 10), 0.5)),
    ],
)
def test_one_property_changes_and_the_rest_stays(draws: str, sets: str, becomes: object) -> None:
    document = drawn(draws)
    document.run(f"set 1 {sets}")
    assert document.part.curve(1) == becomes
    document.undo()
    assert document.part == drawn(draws).part


def test_lengths_of_what_is_round() -> None:
    document = drawn("circle 0,0 1")
    document.run("set 1 length 10*pi")
    made = document.part.curve(1)
    assert isinstance(made, Circle) and made.radius == pytest.approx(5, abs=1e-12)
    document.run("arc 10,0 0,10 centre 0,0")
    document.run("set 2 length 10*pi")
    arc = document.part.curve(2)
    assert isinstance(arc, Arc) and arc.sweep == pytest.approx(math.pi) and arc.start == (10, 0)


def test_what_is_selected_is_meant_and_several_change_at_once() -> None:
    document = drawn("circle 0,0 1; circle 10,0 2; line 0,0 5,5")
    document.run("select 1 2")
    document.run("set diameter 7")
    assert [e.curve.radius for e in document.part.entities if isinstance(e.curve, Circle)] == [3.5, 3.5]
    with pytest.raises(InputError, match="3: A line has no diameter; it has start, end, middle, length, angle, layer"):
        document.run("set 1 3 diameter 2")
    assert document.undo_name == "Set diameter"


def test_a_name_of_the_users_does_not_hide_a_property() -> None:
    document = drawn("circle 0,0 1 as hole; let length = 5")
    document.run("set hole diameter length")
    document.run("line 0,0 10,0")
    document.run("set 2 length length*2")
    assert document.part.curve(1) == Circle((0, 0), 2.5) and document.part.curve(2) == Line((0, 0), (10, 0))


def test_a_layer_is_a_property_and_is_made_when_it_is_new() -> None:
    document = drawn("circle 0,0 1")
    document.run('set 1 layer "bolt holes"')
    assert document.part.entities[0].layer == "bolt holes"
    assert [layer.name for layer in document.part.layers] == ["0", "bolt holes"]


def test_notes_have_properties_too() -> None:
    document = Document()
    part = Part().with_note(Mark((1, 1)), "0").with_note(Guide((0, 0), 0.0), "0")
    document.change_job("notes", type(document.job)(part))
    document.run("set 1 place @1,2")
    document.run("set 2 angle 270")
    assert [n.shape for n in document.part.notes] == [Mark((2, 3)), Guide((0, 0), math.pi / 2)]


@pytest.mark.parametrize(
    ("sets", "says"),
    [
        ("9 radius 3", "no entity 9"),
        ("1 radius 0", "greater than 0"),
        ("1 sweep 20", "A circle has no sweep"),
        ("1", "Write what to set"),
        ("1 radius", "ends too early"),
        ("1 centre 5", "point"),
        ("radius 5", "Nothing is selected"),
        ("1 radius 5 6", "not expected"),
        ("2 end 0,0", "same as point"),
        ("3 sweep 360", "less than 360"),
        ("3 length 1000", "less than 62.832 mm"),
        ("2 length -1", "greater than 0"),
    ],
)
def test_what_cannot_be_is_told_and_nothing_changes(sets: str, says: str) -> None:
    document = drawn("circle 0,0 1; line 0,0 5,0; arc 10,0 0,10 centre 0,0")
    before = document.part
    with pytest.raises(InputError, match=says):
        document.run(f"set {sets}")
    assert document.part is before
