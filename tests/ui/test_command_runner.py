"""Lines that take long are carried out beside the window, in order, and can be left."""

import time

import pytest

from app.drafting.document import Document
from app.ui.views.canvas.command_trials import CommandTrial, CommandTrials, keeps_the_window
from app.ui.views.language import command_runner
from app.ui.views.language.command_runner import AT_ONCE_S, CommandRunner

LONG = "repeat 3000 as k; circle k,0 1; end"


@pytest.fixture
def document() -> Document:
    return Document()


@pytest.fixture
def lines(document):
    made = CommandRunner(document)
    yield made
    made.worker.finish()


def test_a_short_block_is_carried_out_at_once(monkeypatch, document, lines) -> None:
    monkeypatch.setattr(command_runner, "AT_ONCE_S", 10.0)  # a loaded machine is given time
    lines.run("repeat 3 as k; circle k,0 1; end")
    assert len(document.part.entities) == 3 and not lines.busy


def test_a_long_block_leaves_the_window_at_once_and_is_one_step(qtbot, document, lines) -> None:
    told = []
    lines.ran.connect(lambda line, well: told.append((line, well)))
    lines.run(LONG)
    assert lines.busy and not document.part.entities and not document.log
    qtbot.waitUntil(lambda: not lines.busy, timeout=20_000)
    assert len(document.part.entities) == 3000 and told == [(LONG, True)]
    assert [line.command for line in document.log] == [LONG]
    document.undo()
    assert not document.part.entities


def test_lines_wait_for_the_one_on_its_way(qtbot, document, lines) -> None:
    lines.run(LONG)
    lines.run("circle 0,50 9")
    lines.run("undo")
    lines.run("circle 0,60 9")
    assert not document.part.entities
    qtbot.waitUntil(lambda: len(document.log) == 4, timeout=20_000)
    assert [line.command for line in document.log] == [LONG, "circle 0,50 9", "undo", "circle 0,60 9"]
    assert len(document.part.entities) == 3001


def test_a_change_by_hand_meanwhile_is_kept(qtbot, document, lines) -> None:
    lines.run(LONG)
    document.run("line 0,0 5,5")
    qtbot.waitUntil(lambda: len(document.part.entities) == 3001, timeout=20_000)
    assert document.part.entities[0].curve.start == (0, 0)


def test_cancel_leaves_everything_as_it_was(qtbot, document, lines) -> None:
    lines.run(LONG)
    lines.run("circle 0,0 1")
    lines.cancel()
    qtbot.wait(100)
    assert not lines.busy and not document.part.entities and not document.log


def test_a_wrong_line_is_in_the_log_wherever_it_was_tried(qtbot, document, lines) -> None:
    lines.run("circle 0,0")
    lines.run(LONG.replace("; end", "; if k > 2990; circle 0,0 0; end; end"))
    qtbot.waitUntil(lambda: not lines.busy, timeout=20_000)
    assert [line.error for line in document.log] == [True, True] and not document.part.entities


def test_the_moment_is_short(document, lines) -> None:
    start = time.perf_counter()
    lines.run("repeat 150000; end")
    assert lines.busy and time.perf_counter() - start < 100 * AT_ONCE_S
    lines.cancel()
    assert not document.log


def test_what_looks_at_many_curves_together_leaves_the_window_and_is_not_tried_under_the_mouse(
    qtbot, document, lines
) -> None:
    document.run("repeat 400 as k; circle k*10,0 3; end")
    document.select(e.id for e in document.part.entities)
    line = "offset 1 0,0"
    assert CommandTrials(document).of(line) == CommandTrial()
    lines.run(line)
    assert lines.busy and len(document.part.entities) == 400
    qtbot.waitUntil(lambda: not lines.busy, timeout=20_000)
    assert len(document.part.entities) == 800
    document.select([document.part.entities[0].id])
    assert len(CommandTrials(document).of(line).difference.added) == 1


@pytest.mark.parametrize(
    "line",
    [
        "fillet 1 1 4,0 2 5,1",
        "chamfer 1 and 1.5 1 4,0 2 5,1",
        "offset 1 1,1 1",
        "measure 1 2",
        "measure 0,0 3,4",
    ],
)
@pytest.mark.parametrize("everything", [False, True], ids=["nothing selected", "everything selected"])
def test_what_names_a_few_curves_of_many_is_tried_and_done_at_once(
    monkeypatch, document, lines, line, everything
) -> None:
    monkeypatch.setattr(command_runner, "AT_ONCE_S", 10.0)  # a loaded machine is given time
    document.run("repeat 400 as k; rect k*10,0 k*10+5,5; end")
    document.select(document.part.ids() if everything else ())
    trial = CommandTrials(document).of(line)
    assert not trial.reason
    lines.run(line)
    assert not lines.busy and not document.log[-1].error


def test_two_corners_clicked_in_a_heavy_drawing_show_their_fillet(document) -> None:
    document.run("repeat 400 as k; rect k*10,0 k*10+5,5; end")
    document.select(document.part.ids())
    assert CommandTrials(document).of("fillet 1 1 4,0 2 5,1").difference.added


@pytest.mark.parametrize(
    "line", ["fillet 1", "join within 0.1", "explode", "measure", "heal 0.01", "offset 1 2,2 1-1600"]
)
def test_what_means_many_curves_is_not_tried_under_the_mouse(document, line) -> None:
    document.run("repeat 400 as k; rect k*10,0 k*10+5,5; end")
    document.select(document.part.ids())
    assert keeps_the_window(line, document)


def test_an_offset_of_many_curves_that_is_cancelled_changes_nothing(qtbot, document, lines) -> None:
    document.run("repeat 400 as k; circle k*10,0 3; end")
    document.select(document.part.ids())
    part, log = document.part, tuple(document.log)
    lines.run("offset 1 0,0")
    lines.cancel()
    lines.worker.finish(20.0)
    qtbot.wait(20)
    assert not lines.busy and document.part is part and tuple(document.log) == log
