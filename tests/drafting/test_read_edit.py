"""Copies, turns, mirrors and arrays."""

import pytest

from app.core.errors import InputError
from app.drafting.document import Document
from app.model.curves import Arc, Circle, Line


@pytest.fixture
def document() -> Document:
    made = Document()
    made.run_script("layer holes\ncircle 10,0 2\nlayer 0\nline 0,0 5,0 as a")
    return made


def test_copies_stand_in_a_row_and_keep_their_layer(document: Document) -> None:
    document.run("copy @0,10 times 3 1")
    assert [(e.id, e.curve.centre, e.layer) for e in document.part.entities if isinstance(e.curve, Circle)] == [
        (1, (10, 0), "holes"),
        (3, (10, 10), "holes"),
        (4, (10, 20), "holes"),
        (5, (10, 30), "holes"),
    ]


def test_turning_with_and_without_the_original(document: Document) -> None:
    document.run("rotate 0,0 90 a")
    assert document.part.curve(2) == Line((0, 0), (0, 5))
    document.run("rotate 0,0 90 copy 1 a")
    assert (document.part.curve(3), document.part.curve(4)) == (Circle((0, 10), 2), Line((0, 0), (-5, 0)))


def test_scaling_and_mirroring_turn_arcs_the_right_way(document: Document) -> None:
    document.run_script("arc 5,0 0,5 centre 0,0 as q\nmirror 0,0 1,0 q\nscale 0,0 2 q")
    assert document.part.curve(3) == Arc((10, 0), (0, -10), (0, 0), ccw=False)


def test_arrays(document: Document) -> None:
    document.run("array 3 2 @20,15 1")
    centres = [e.curve.centre for e in document.part.entities if isinstance(e.curve, Circle)]
    assert centres == [(10, 0), (30, 0), (50, 0), (10, 15), (30, 15), (50, 15)]
    document.undo()
    document.run("array polar 0,0 4 1")
    assert [e.curve.centre for e in document.part.entities if isinstance(e.curve, Circle)] == [
        (10, 0),
        (0, 10),
        (-10, 0),
        (0, -10),
    ]
    document.undo()
    document.run("array polar 0,0 3 over 90 1 as more")
    assert [e.curve.centre for e in document.part.entities if isinstance(e.curve, Circle)][-1] == (0, 10)
    document.run("delete more")
    assert len(document.part.entities) == 2


def test_reversing_twice_is_nothing(document: Document) -> None:
    before = document.part
    document.run("reverse a")
    assert document.part.curve(2) == Line((5, 0), (0, 0))
    document.run("reverse a")
    assert document.part == before


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("copy @1,1 times 0 1", "from 1 to"),
        ("array 1 1 @1,1 1", "2 to 10000"),
        ("array 200 200 @1,1 1", "40000 places"),
        ("scale 0,0 -1 1", "greater than 0"),
        ("mirror 0,0 0,0 1", "two different"),
        ("rotate 0,0 5mm 1", "does not fit"),
        ("copy 1,1 1", "no shift"),
        ("reverse 9", "no entity 9"),
        ("array polar 0,0 1 1", "from 2"),
        ("rotate 0,0 90", "Nothing is selected"),
    ],
)
def test_what_cannot_be_is_refused(document: Document, line: str, says: str) -> None:
    before = document.part
    with pytest.raises(InputError, match=says):
        document.run(line)
    assert document.part is before
