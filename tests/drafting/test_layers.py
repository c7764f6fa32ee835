"""Layers renamed and removed, and everything that calls them by name."""

from dataclasses import replace

import pytest

from app.core.errors import InputError
from app.drafting.document import Document
from app.model.curve_selectors import CurveNumber, on_layers


@pytest.fixture
def document() -> Document:
    made = Document()
    made.run_script("layer holes\ncircle 10,0 2\nlayer 0\nline 0,0 5,0")
    return made


def names(document: Document) -> list[str]:
    return [layer.name for layer in document.part.layers]


def test_a_renamed_layer_keeps_its_curves_its_look_and_its_place(document: Document) -> None:
    document.run('colour holes "#d55e00"; layer holes')
    document.run('rename layer holes to "bolt holes"')
    assert names(document) == ["0", "bolt holes"] and document.part.layers[1].colour == "#d55e00"
    assert document.part.entities[0].layer == "bolt holes" and document.layer == "bolt holes"
    document.undo()
    assert names(document) == ["0", "holes"] and document.layer == "holes"


def test_the_job_calls_a_renamed_layer_by_its_new_name(document: Document) -> None:
    job = document.job
    operation = replace(
        job.operations[0], cut=replace(job.operations[0].cut, curves=(*on_layers(("holes", "0")), CurveNumber(1)))
    )
    changed = replace(
        job, operations=(operation, *job.operations[1:]), layer_names=("holes",), keep_out_layers=("clamps", "holes")
    )
    document.change_job("layers", changed)
    document.run("rename layer holes to bores")
    assert document.job.operations[0].cut.curves == (*on_layers(("bores", "0")), CurveNumber(1))
    assert (document.job.layer_names, document.job.keep_out_layers) == (("bores",), ("clamps", "bores"))
    document.undo()
    assert document.job == changed


def test_a_removed_layer_takes_its_curves_along(document: Document) -> None:
    document.run("layer holes; select all")
    reply = document.run("remove layer holes")
    assert reply == "Layer holes removed, with 1 curve on it."
    assert names(document) == ["0"] and [e.id for e in document.part.entities] == [2]
    assert document.layer == "0" and document.selection == {2}
    document.run("line 0,0 1,1")
    assert document.part.entities[-1].id == 3
    document.undo()
    document.undo()
    assert names(document) == ["0", "holes"] and len(document.part.entities) == 2


def test_layers_are_put_in_order(document: Document) -> None:
    document.run("layer a; layer b")
    assert document.run("order layer b before 0") == "Layer b comes before 0 now."
    assert names(document) == ["b", "0", "holes", "a"]
    document.run("order layer b after holes")
    assert names(document) == ["0", "holes", "b", "a"] and document.layer == "b"
    document.undo()
    assert names(document) == ["b", "0", "holes", "a"] and document.undo_name == "Order layers"


def test_notes_on_a_removed_layer_are_told(document: Document) -> None:
    document.run("layer marks; point 1,1; guide across 0,2; line 0,0 1,1")
    assert document.run("remove layer marks") == "Layer marks removed, with 1 curve and 2 notes on it."
    assert not document.part.notes


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("rename layer nothing to x", "no layer nothing"),
        ("rename layer holes to 0", "a layer 0 already"),
        ("rename holes to x", "Write rename layer"),
        ("rename layer holes x", "Write to"),
        ('rename layer holes to " "', "empty"),
        ("remove layer nothing", "no layer nothing"),
        ("remove 1", "with delete"),
    ],
)
def test_what_cannot_be_is_told(document: Document, line: str, says: str) -> None:
    with pytest.raises(InputError, match=says):
        document.run(line)
    assert names(document) == ["0", "holes"]


def test_the_last_layer_stays() -> None:
    with pytest.raises(InputError, match="only layer"):
        Document().run("remove layer 0")
