"""What a command would make of a drawing, before it is carried out."""

import pytest

from app.core.errors import InputError
from app.drafting.difference import DrawingDifference, difference
from app.drafting.document import Document
from app.model.curves import Line
from app.model.job import Job
from app.model.notes import Mark
from app.model.part import Part


@pytest.fixture
def document() -> Document:
    """Two lines."""
    part = Part().with_curves([Line((0, 0), (10, 0)), Line((0, 5), (10, 5))], "0")
    return Document(Job(part))


def test_the_same_drawing_differs_in_nothing(document: Document) -> None:
    assert difference(document.part, document.part) == DrawingDifference()


def test_what_is_drawn_is_added_and_nothing_has_happened(document: Document) -> None:
    before = document.part
    found = difference(before, document.tried("circle 3,3 2").part)
    assert [e.id for e in found.added] == [3] and found.gone == ()
    assert document.part is before and document.log == [] and document.undo_name is None


def test_what_is_moved_is_shown_as_it_was_and_as_it_would_be(document: Document) -> None:
    found = difference(document.part, document.tried("move @0,1 2").part)
    assert [e.curve for e in found.gone] == [Line((0, 5), (10, 5))]
    assert [e.curve for e in found.added] == [Line((0, 6), (10, 6))]


def test_what_is_deleted_goes(document: Document) -> None:
    found = difference(document.part, document.tried("delete 1").part)
    assert [e.id for e in found.gone] == [1] and found.added == ()


def test_a_note_takes_the_next_number_and_is_told(document: Document) -> None:
    after = document.part.with_note(Mark((1.0, 2.0)), "marks")
    found = difference(document.part, after)
    assert [(n.id, n.layer) for n in found.notes] == [(3, "marks")] and after.next_id() == 4
    assert [layer.name for layer in after.layers] == ["0", "marks"]


def test_what_cannot_be_read_is_said(document: Document) -> None:
    with pytest.raises(InputError):
        document.tried("circle 3,3")
