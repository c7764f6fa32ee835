"""Undo over a thousand random edits, all the way back and forth: each time the identical document; bounded by
memory.
"""

import random

import pytest

from app.core.errors import InputError
from app.drafting.document import Document
from app.drafting.history import HistoryState, UndoHistory
from app.model.curves import Circle, Line
from app.model.job import Job, Stock
from app.model.part import Part


def random_line(rng: random.Random, document: Document) -> str:
    """Return one line of the language that may or may not be possible."""
    x, y, r = (round(rng.uniform(-100, 100), 3) for _ in range(3))
    some = " ".join(str(e.id) for e in rng.sample(document.part.entities, min(3, len(document.part.entities))))
    return rng.choice(
        [
            f"line {x},{y} {y},{r}",
            f"circle {x},{y} {abs(r) + 1}",
            f"rect {x},{y} @{abs(r) + 1},5",
            f"let w = {x}",
            f"layer l{rng.randrange(4)}",
            f"arc {x},{y} @10,0 @5,5 as bow",
            f"polygon 5 {x},{y} @{abs(r) + 1},0",
            f"move @{x},{y} {some}",
            f"copy @{x},{y} {some}",
            f"rotate {x},{y} 30 {some}",
            f"delete {some}",
            f"layer m {some}",
            "hide m",
            "show m",
            "select all",
            f"mirror 0,0 {abs(x) + 1},{y} {some}",
            f"reverse {some}",
            f"repeat 3 as k; line {x},10*k @5,0; end",
            f"define d{rng.randrange(3)}(r); circle 0,0 r; end",
            "undo",
            "redo",
            "undo 2",
        ]
    )


@pytest.mark.parametrize("seed", [1, 2])
def test_a_thousand_random_edits_back_and_forth(seed: int) -> None:
    rng = random.Random(seed)
    document = Document()
    tried = 0
    while len(document.history_names[0]) < 1000:
        tried += 1
        assert tried < 20_000
        try:
            if rng.random() < 0.05:
                thickness = round(rng.uniform(1, 50), 2)
                document.change_job("Stock", Job(document.part, stock=Stock(0, thickness)), merge=rng.random() < 0.5)
            else:
                document.run(random_line(rng, document))
        except InputError:
            continue
    count = len(document.history_names[0])
    document.go_to(count)
    states: dict[int, HistoryState] = {count: document.state}
    for done in range(count - 1, -1, -1):
        document.undo()
        states[done] = document.state
    assert document.part == Part() and document.undo_name is None
    for done in range(1, count + 1):
        document.redo()
        assert document.state == states[done]
    assert document.redo_name is None
    for _ in range(50):
        done = rng.randrange(count + 1)
        document.go_to(done)
        assert document.state == states[done] and document.history_names[1] == done


def test_going_to_a_step_is_one_line_and_one_change() -> None:
    document = Document()
    for x in range(5):
        document.run(f"line {x},0 {x},10")
    told: list[object] = []
    document.subscribe(told.append)
    document.go_to(2)
    assert document.log[-1].command == "undo 3" and document.log[-1].reply == "3 steps undone."
    assert len(told) == 1 and len(document.part.entities) == 2
    assert document.history_names == (("Line",) * 5, 2)
    document.go_to(99)
    assert document.log[-1].command == "redo 3" and len(document.part.entities) == 5


@pytest.mark.parametrize("line", ["undo 1.5", "undo 0", "undo 3mm", "redo 1 2", "undo -1"])
def test_steps_are_whole_numbers(line: str) -> None:
    document = Document()
    document.run("line 0,0 1,0")
    with pytest.raises(InputError, match="three steps"):
        document.run(line)
    assert len(document.part.entities) == 1


def test_more_steps_than_there_are() -> None:
    document = Document()
    document.run("line 0,0 1,0")
    assert document.run("undo 100") == "Line undone."
    assert document.run("undo 2") == "Nothing to undo."


def drawn(part: Part, count: int) -> Part:
    return part.with_curves([Line((float(k), 0.0), (float(k), 1.0)) for k in range(count)], "0")


def test_the_oldest_steps_go_when_memory_is_full() -> None:
    states = [HistoryState(Job(Part()))]
    for _ in range(30):
        states.append(HistoryState(Job(drawn(Part(), 1000))))
    history = UndoHistory(states[0], most_bytes=4_000_000)
    for number, state in enumerate(states[1:]):
        history.change(f"step {number}", state)
    names, done = history.names
    assert 5 < len(names) < 15 and done == len(names)
    assert names[-1] == "step 29"
    for _ in names:
        history.undo()
    assert history.state is states[30 - len(names)]


def test_what_steps_share_counts_once() -> None:
    part = drawn(Part(), 1000)
    history = UndoHistory(HistoryState(Job(part)), most_bytes=4_000_000)
    for number in range(300):
        part = part.with_curves([Circle((0.0, 0.0), 1.0)], "0")
        history.change(f"step {number}", HistoryState(Job(part)))
    assert len(history.names[0]) == 300


def test_one_step_can_always_be_undone() -> None:
    first = HistoryState(Job(drawn(Part(), 1000)))
    history = UndoHistory(first, most_bytes=10)
    history.change("a", HistoryState(Job(Part())))
    history.change("b", HistoryState(Job(drawn(Part(), 10))))
    assert history.names == (("b",), 1)
    assert history.undo() == "b" and history.redo() == "b"
