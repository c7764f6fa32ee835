"""What joins end to end is selected as one chain."""

import pytest

from app.core.errors import InputError
from app.drafting.document import Document


def test_a_chain_is_all_that_joins_in_either_direction_and_nothing_near_it() -> None:
    document = Document()
    for line in (
        "line 0,0 10,0",
        "line 10,10 10,0",
        "arc 10,10 0,10 5,15",
        "line 0,10.00001 0,20",
        "circle 0,0 3",
        "select chain 2",
    ):
        document.run(line)
    assert document.selection == {1, 2, 3}
    document.run("select add chain 5")
    assert document.selection == {1, 2, 3, 5}
    document.run("select remove chain 1")
    assert document.selection == {5}


def test_a_chain_is_turned_as_a_whole_and_runs_one_way_after() -> None:
    document = Document()
    document.run_script(
        "line 0,0 10,0; line 10,10 10,0; arc 10,10 0,10 5,15; line 50,0 60,0; point 1,1; guide across 0,5"
    )
    assert document.run("reverse 1-4") == "3 reversed, 1 ran that way."
    ways = [(e.curve.start, e.curve.end) for e in document.part.entities]
    assert ways == [((10, 0), (0, 0)), ((10, 10), (10, 0)), ((5, 15), (10, 10)), ((60, 0), (50, 0))]
    document.run("reverse 3 1 2")
    ways = [(e.curve.start, e.curve.end) for e in document.part.entities[:3]]
    assert ways == [((0, 0), (10, 0)), ((10, 0), (10, 10)), ((10, 10), (5, 15))]
    with pytest.raises(InputError, match="Only points, construction lines and dimensions"):
        document.run("reverse 5 6")


def test_a_chain_goes_on_from_what_is_selected_and_not_over_locked_layers() -> None:
    document = Document()
    for line in ("rect 0,0 20,10", "layer A 3", "lock A", "select 1", "select chain"):
        document.run(line)
    assert document.selection == {1, 2, 4}
