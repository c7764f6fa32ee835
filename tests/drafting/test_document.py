"""The open document: one door for changes, undo of everything, a log that replays."""

from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.core.errors import InputError
from app.drafting.document import Document, DocumentChange, LogLine
from app.model.curves import Circle, Line
from app.model.job import Job, Stock
from app.model.part import Entity, Layer, Part, Units
from app.model.reading import DrawingSource, ReadingOptions
from tests.examples import examples


@pytest.fixture
def document() -> Document:
    return Document()


def ids(document: Document) -> list[int]:
    return [e.id for e in document.part.entities]


def test_a_line_is_drawn_answered_and_logged(document: Document) -> None:
    assert document.run("line 10,10 60,10") == "Line, 50.000 mm."
    assert document.log == [LogLine("line 10,10 60,10", "Line, 50.000 mm.")]
    assert (len(document.part.entities), document.revision, document.modified, document.undo_name) == (
        1,
        1,
        True,
        "Line",
    )


def test_a_refused_line_changes_nothing_and_is_logged(document: Document) -> None:
    with pytest.raises(InputError, match="Column 6"):
        document.run("line foo")
    assert document.log[0].error
    assert (document.part, document.revision, document.undo_name) == (Part(), 0, None)


def test_relative_points_go_on_from_the_line_before(document: Document) -> None:
    document.run("line 10,10 20,10")
    document.run("line @0,0 @0,5")
    assert document.part.entities[1].curve.start == (20, 10)
    document.undo()
    assert document.last_point == (20, 10)


def test_undo_and_redo_bring_back_whole_states(document: Document) -> None:
    document.run("rect 0,0 10,10")
    document.run("circle 5,5 2")
    after = document.part
    document.undo()
    assert len(document.part.entities) == 4
    assert document.redo_name == "Circle"
    document.redo()
    assert document.part is after
    assert document.run("redo") == "Nothing to redo."


def test_a_new_change_ends_redo(document: Document) -> None:
    document.run("circle 5,5 2")
    document.undo()
    document.run("circle 1,1 1")
    assert document.redo_name is None


def test_modified_knows_the_way_back(document: Document) -> None:
    document.run("circle 5,5 2")
    document.mark_saved(Path("part.hito"))
    assert not document.modified
    document.run("circle 9,9 2")
    assert document.modified
    document.undo()
    assert not document.modified


def test_select_by_number_layer_window_and_crossing(document: Document) -> None:
    document.run("rect 0,0 10,10")
    document.run("layer Holes")
    document.run("circle 20,5 3")
    assert document.run("select 1 3") == "2 selected."
    document.run("select add layer Holes")
    assert document.selection == {1, 3, 5}
    document.run("select remove 1")
    assert document.selection == {3, 5}
    document.run("select window -1,-1 18,11")
    assert document.selection == {1, 2, 3, 4}
    document.run("select crossing 16,4 18,6")
    assert document.selection == {5}
    document.run("select crossing 19,4 21,6")
    assert document.selection == frozenset(), "inside the circle, but on no line of it"
    document.run("select all")
    assert len(document.selection) == 5
    document.run("select none")
    assert document.selection == frozenset()


def test_selecting_is_no_change_of_the_job(document: Document) -> None:
    document.run("circle 0,0 1")
    before = document.revision
    document.run("select all")
    assert (document.revision, document.undo_name) == (before, "Circle")


def test_hidden_and_locked_layers_are_not_selected() -> None:
    circles = tuple(
        Entity(n, Circle((n * 10.0, 0.0), 1.0), name) for n, name in ((1, "0"), (2, "hidden"), (3, "locked"))
    )
    document = Document(Job(Part(circles, (Layer(), Layer("hidden", visible=False), Layer("locked", locked=True)))))
    document.run("select all")
    assert document.selection == {1}


def test_the_selection_lets_go_of_what_is_deleted(document: Document) -> None:
    document.run("rect 0,0 10,10")
    document.select([1, 2, 99])
    assert document.selection == {1, 2}
    assert document.run("delete") == "2 deleted."
    assert (document.selection, ids(document)) == (frozenset(), [3, 4])
    with pytest.raises(InputError, match="no entity 1"):
        document.run("delete 1")


def test_move_shifts_every_kind_of_curve(document: Document) -> None:
    document.run("line 0,0 1,0")
    document.run("circle 5,5 1")
    document.run("arc 0,0 5,5 10,0")
    document.run("select all")
    document.run("move @10,20")
    line, circle, arc = (e.curve for e in document.part.entities)
    assert (line.end, circle.centre, arc.start, arc.centre) == ((11, 20), (15, 25), (10, 20), (15, 20))


def test_layer_takes_new_curves_or_those_named(document: Document) -> None:
    document.run("circle 0,0 1")
    document.run('layer "Outer wall"')
    document.run("circle 5,0 1")
    assert [e.layer for e in document.part.entities] == ["0", "Outer wall"]
    document.run("layer Holes 1")
    assert [e.layer for e in document.part.entities] == ["Holes", "Outer wall"]
    assert document.layer == "Outer wall"
    document.undo()
    document.undo()
    document.undo()
    assert document.layer == "0"


def test_listeners_hear_what_changed_until_they_leave(document: Document) -> None:
    heard: list[DocumentChange] = []
    leave = document.subscribe(heard.append)
    document.run("circle 0,0 1")
    document.select([1])
    document.change_job("Stock", replace(document.job, stock=Stock(2.0)))
    leave()
    document.run("circle 9,0 1")
    assert heard == [
        DocumentChange.PART | DocumentChange.HISTORY | DocumentChange.LOG,
        DocumentChange.SELECTION,
        DocumentChange.JOB | DocumentChange.HISTORY,
    ]


def test_repeated_edits_of_one_field_are_one_step(document: Document) -> None:
    for margin in (1.0, 2.0, 3.0):
        document.change_job("Stock margin", replace(document.job, stock=Stock(margin)), merge=True)
    document.change_job("Stock thickness", replace(document.job, stock=Stock(3.0, 20.0)), merge=True)
    document.undo()
    assert document.job.stock == Stock(3.0)
    document.undo()
    assert document.job.stock == Stock()
    assert document.undo_name is None


def test_an_edit_of_its_own_is_not_merged_with_the_one_before(document: Document) -> None:
    document.change_job("Stock", replace(document.job, stock=Stock(1.0)))
    document.change_job("Stock", replace(document.job, stock=Stock(2.0)), merge=True)
    document.undo()
    assert document.job.stock == Stock(1.0)


def test_the_same_job_again_is_no_change(document: Document) -> None:
    document.change_job("Nothing", replace(document.job))
    assert (document.revision, document.undo_name) == (0, None)


def test_load_begins_afresh(document: Document) -> None:
    document.run("circle 0,0 1")
    heard: list[DocumentChange] = []
    document.subscribe(heard.append)
    document.load(Job(Part(name="other")), Path("other.dxf"))
    assert heard == [DocumentChange.ALL]
    assert (document.log, document.undo_name, document.modified, document.path) == ([], None, False, Path("other.dxf"))
    assert document.revision == 2


SCRIPT = """
# a plate with a hole
rect 0,0 60,40
circle 30,20 8      # the hole
layer slots
pl 5,5 20,5 arc 22,7 20,9 5,9 arc 3,7 5,5
select layer slots
move @2,2
undo
delete 2
"""


def test_a_list_of_lines_is_a_drawing_and_its_log_replays(document: Document) -> None:
    document.run_script(SCRIPT, "plate.draw")
    again = Document()
    again.run_script("\n".join(line.command for line in document.log))
    assert again.part == document.part
    assert again.selection == document.selection
    assert len(document.part.entities) == 3 + 1 + 4


def test_a_wrong_line_of_a_list_is_found(document: Document) -> None:
    with pytest.raises(InputError, match=r"plate\.draw:3: column 6: 'x' has no value"):
        document.run_script("circle 0,0 1\n\nline x\n", "plate.draw")


LINES = st.sampled_from(
    [
        "line 0,0 10,0",
        "line @0,0 @5,5",
        "rect 1,1 9,9",
        "circle 5,5 2",
        "select all",
        "select 1",
        "select none",
        "delete",
        "delete 2",
        "move @1,1",
        "undo",
        "redo",
        "layer a",
        "layer b 1",
        "arc 0,0 5,5 10,0",
        "nonsense",
    ]
)


@settings(max_examples=examples(60), deadline=None)
@given(st.lists(LINES, max_size=15))
def test_undoing_everything_leads_back_and_every_log_replays(lines: list[str]) -> None:
    document, again = Document(), Document()
    for line in lines:
        try:
            document.run(line)
        except InputError:
            assert document.log[-1].error
    for entry in document.log:
        if not entry.error:
            again.run(entry.command)
    assert again.part == document.part
    while document.undo_name is not None:
        document.undo()
    assert document.part == Part()


def test_a_drawing_that_is_read_again_is_one_step_that_undo_takes_back_with_how_it_was_read() -> None:
    first, second = DrawingSource("a.dxf"), DrawingSource("a.dxf", ReadingOptions(Units.INCH))
    document = Document()
    document.load(Job(Part().with_curves([Line((0, 0), (1, 0))], "0")), None, first)
    document.run("let w = 3")
    document.run("circle 5,5 2 as hole")
    document.select({1})
    part = Part(layers=(Layer("cut"),)).with_curves([Line((0, 0), (25.4, 0))], "cut")
    document.read_again("Read a.dxf", replace(document.job, part=part), second)
    assert (document.part, document.state.source, document.selection, document.layer) == (
        part,
        second,
        frozenset(),
        "cut",
    )
    assert set(document.state.names) == {"w"}, "a name of curves that are no longer there"
    assert document.recorded.base is part
    document.run("circle 0,0 1")
    assert document.state.source == second
    document.go_to(2)
    assert document.state.source == first and len(document.part.entities) == 2 and "hole" in document.state.names
