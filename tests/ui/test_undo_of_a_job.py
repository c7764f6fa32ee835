"""Ctrl+Z through a whole job to the empty start, and Ctrl+Y back: every state is the one that it was."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QApplication

from app.model.job import Job
from app.ui.framework.computation import ComputationState
from app.ui.framework.view import View
from app.ui.panels.changes import Subject, SubjectKind

WAIT_MS = 60_000
CTRL = Qt.KeyboardModifier.ControlModifier
DRAWN = (
    "layer plate",
    "rect 0,0 80,50 round 6",
    "rect 25,15 55,35 round 4",
    "circle 10,25 3",
    "circle 70,25 3",
    'text 30,40 4 "Hitofude"',
    "line 5,5 20,5",
)
STEPS_AT_LEAST = 11


def typed(qtbot, edit, text: str) -> None:
    """Enter a value in a field as a user does."""
    edit.setFocus()
    edit.selectAll()
    qtbot.keyClicks(edit, text)
    qtbot.keyClick(edit, Qt.Key.Key_Return)


def made_by_hand(qtbot, wiring) -> None:
    """Draw a plate, have it proposed and computed, and change stock, tool, operation and order in the panel."""
    window, panel = wiring.window_, wiring.window_.panel
    for line in DRAWN:
        wiring.document.run(line)
    with qtbot.waitSignal(wiring.proposal_controller.worker.done, timeout=WAIT_MS):
        window.actions_["propose"].trigger()
    panel.choose(Subject(SubjectKind.TOOL, wiring.document.job.tools[0].number))
    typed(qtbot, panel.tool_form.diameter.edit, "5")
    panel.choose(Subject(SubjectKind.OPERATION, 0))
    window.actions_["add_pocket"].trigger()
    panel.choose(Subject(SubjectKind.JOB))
    typed(qtbot, panel.job_form.clamping.edit, "two vices")
    wiring.document.select([wiring.document.part.entities[0].id])
    window.actions_["delete"].trigger()


@pytest.mark.exhaustive
def test_every_state_of_a_job_comes_back_by_keys(qtbot, wiring) -> None:
    wiring.display_controller.show_view(View.DRAW)
    window, document = wiring.window_, wiring.document
    seen: list[Job] = [document.job]
    document.subscribe(lambda _: seen.append(document.job) if document.job != seen[-1] else None)
    made_by_hand(qtbot, wiring)
    states, steps = list(seen), 0
    window.canvas.setFocus()
    back = [document.job]
    while document.undo_name is not None:
        qtbot.keyClick(QApplication.focusWidget() or window, Qt.Key.Key_Z, CTRL)
        back.append(document.job)
        steps += 1
        assert steps < 100, "undo goes on for ever"
    assert steps >= STEPS_AT_LEAST
    assert document.job == states[0] and not document.part.entities
    assert all(job in states for job in back)
    forth = [document.job]
    for _ in range(steps):
        qtbot.keyClick(QApplication.focusWidget() or window, Qt.Key.Key_Y, CTRL)
        forth.append(document.job)
    assert forth == back[::-1] and document.redo_name is None
    wiring.compute()
    qtbot.waitUntil(lambda: wiring.computation.state is ComputationState.CURRENT, timeout=WAIT_MS)
    made = wiring.computation.made
    qtbot.keyClick(window.canvas, Qt.Key.Key_Z, CTRL)
    assert wiring.computation.state is not ComputationState.CURRENT
    qtbot.keyClick(window.canvas, Qt.Key.Key_Y, CTRL)
    assert wiring.computation.state is ComputationState.CURRENT and wiring.computation.made is made, "and its paths"
