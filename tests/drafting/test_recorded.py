"""The record of a drawing's lines draws it again."""

from contextlib import suppress
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.core.errors import Cancelled, InputError
from app.core.progress import Progress
from app.drafting.document import Document
from app.model.curves import Circle, Line
from app.model.job import Job, OriginXY
from app.model.part import Entity, Part

LINES = st.sampled_from(
    [
        "line 0,0 10,0 10,10",
        "circle @5,5 2",
        "rect 1,1 @4,3 round 1",
        "arc on @2,2",
        "select all",
        "select none",
        "select window 0,0 9,9",
        "delete",
        "move @1,0",
        "copy @3,1 times 2",
        "mirror 0,0 0,1 copy",
        "layer cut",
        "layer 0",
        "undo",
        "redo",
        "clear",
        "clear; circle 1,1 1",
        "let w = 4",
        "circle 0,0 w as hole",
        "repeat 2 as k; line k,0 k,5; end",
        "reverse",
        "fillet 1 1 2",
    ]
)


def drawn_again(document: Document) -> Part:
    again = Document()
    again.run_script(document.recorded.text())
    return again.part


@given(st.lists(st.one_of(LINES, st.sets(st.integers(1, 9)), st.just(None)), max_size=25))
def test_the_lines_draw_the_identical_part(steps) -> None:
    document = Document()
    for step in steps:
        if step is None:
            document.change_job("Origin", replace(document.job, origin_xy=OriginXY.CENTRE))
        elif isinstance(step, str):
            with suppress(InputError):
                document.run(step)
        else:
            document.select(step)
    assert drawn_again(document) == document.part


def test_what_was_selected_by_hand_is_told_before_what_needs_it() -> None:
    document = Document()
    document.run("line 0,0 5,5")
    document.run("circle 3,3 1")
    document.select([2])
    document.run("circle 9,9 1")
    document.run("delete")
    assert document.recorded.text() == "line 0,0 5,5\ncircle 3,3 1\ncircle 9,9 1\nselect 2\ndelete\n"


def test_blocks_that_begin_anew_or_with_a_drawing_command_heed_the_selection() -> None:
    for block in ("clear; circle 1,1 1; line 5,5 9,9", "line 5,5 9,9; delete", "clear; line 0,0 1,1; select 1"):
        document = Document()
        document.run("rect 0,0 4,4")
        document.select({2, 3})
        document.run(block)
        document.run("line 0,9 9,9")
        if document.selection:
            document.run("move @0,1")
        assert drawn_again(document) == document.part, block


def test_undo_of_a_tool_leaves_the_lines() -> None:
    document = Document()
    document.run("line 0,0 5,5")
    document.change_job("Origin", replace(document.job, origin_xy=OriginXY.CENTRE))
    document.undo()
    assert document.recorded.text() == "line 0,0 5,5\n"
    document.undo()
    assert document.recorded.text() == ""


def test_a_drawing_from_a_file_is_drawn_before_its_lines() -> None:
    part = Part((Entity(1, Line((0, 0), (1, 1))), Entity(2, Circle((0, 0), 2))))
    document = Document(Job(part))
    document.run("delete 1")
    assert drawn_again(document) == document.part
    gaps = Document(Job(Part((Entity(4, Line((0, 0), (1, 1))),))))
    gaps.run("delete 4")
    with pytest.raises(InputError, match="gaps"):
        gaps.recorded.text()
    gaps.run("clear; line 0,0 1,1")
    assert gaps.recorded.text() == "line 0,0 1,1\n"


def test_clear_begins_anew_and_is_undone() -> None:
    document = Document()
    document.run("let w = 3")
    document.run("layer cut")
    document.run("circle 0,0 w")
    before = document.session
    document.run("clear")
    assert (
        document.part.entities == ()
        and document.layer == "0"
        and [layer.name for layer in document.part.layers] == ["0"]
    )
    with pytest.raises(InputError):
        document.run("circle 0,0 w")
    document.run("circle 0,0 1")
    assert document.part.entities[0].id == 1
    document.undo()
    document.undo()
    assert document.session == before


def test_a_line_that_is_cancelled_changes_and_logs_nothing() -> None:
    document, steps = Document(), []

    def listen(fraction: float, text: str) -> None:
        steps.append(fraction)
        if len(steps) == 3:
            raise Cancelled

    with pytest.raises(Cancelled):
        document.run("line 0,0 1,1; repeat 9 as k; circle k,0 1; end", Progress(listen))
    assert not document.part.entities and not document.log and document.undo_name is None
