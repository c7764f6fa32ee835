"""The window cuts what it has computed, without being asked, and shows what is left."""

import numpy as np
import pytest
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from app.core.progress import Progress
from app.model.finding import FindingKind
from app.model.job import Job
from app.model.operation import CutParameters, PocketOperation
from app.model.tool import Tool
from app.ui.framework.computation import ComputationState
from app.ui.framework.verdict import VerdictLevel
from app.ui.framework.view import View
from app.ui.panels.changes import Subject, SubjectKind
from app.ui.shell.window_controller import WindowController
from app.ui.views.cut.cell_colours import CutColourBy
from app.ui.views.cut.controller import trial_shown
from app.ui.views.cut.cut_player import PlaybackStep
from app.ui.views.cut.findings import title_of
from app.usecases.mending import Mend
from tests.part_shapes import layered_part, square


def test_the_sample_is_cut_and_forgotten_with_its_drawing(qtbot: QtBot, wiring: WindowController) -> None:
    wiring.files.open_sample()
    qtbot.waitUntil(lambda: wiring.computation.state is ComputationState.CURRENT, timeout=60_000)
    view, empty = wiring.window_.views.cut, wiring.window_.views.empty
    wiring.display_controller.show_view(View.CUT)
    assert view.model.picture is not None or empty.sentence.text() == "The cut is being made ready to be looked at."
    qtbot.waitUntil(lambda: view.model.picture is not None, timeout=60_000)
    picture = view.model.picture
    assert picture is not None and picture.moves is not None and picture.move is not None and picture.paths is not None
    assert picture.heights.shape == (1024, 1024)
    assert (float(picture.heights.min()), picture.top, picture.floor) == (-2.0, 0.0, -10.0)
    made = wiring.computation.made
    assert made is not None
    lines = set(picture.moves.line[picture.move[picture.move >= 0]].tolist())
    assert lines <= set(made.nc.lines.tolist())
    wiring.display_controller.show_view(View.CUT)
    QApplication.processEvents()
    assert not wiring.window_.views.empty.isVisible()
    row, column = (int(k) for k in np.argwhere(picture.move >= 0)[5000])
    motion = picture.move_at(row, column)
    view.cell_picked.emit(0.0, 0.0, 0.0, motion)
    beside = wiring.window_.cut_panel.nc
    assert wiring.display_controller.view is View.CUT, "nothing leaves"
    assert beside.text.current + 1 == picture.moves.line[motion] and "Contour T2" in beside.where.text()
    assert view.overlay.way is not None and wiring.window_.panel.subject == Subject(SubjectKind.OPERATION, 2)
    wiring.files.new()
    qtbot.waitUntil(lambda: view.model.picture is None, timeout=10_000)
    assert wiring.window_.views.empty.isVisible() or wiring.display_controller.view is not View.CUT


def test_text_and_picture_go_together_while_it_is_played_both_ways(qtbot: QtBot, computed: WindowController) -> None:
    control, beside = computed.cut_controller, computed.window_.cut_panel.nc
    computed.display_controller.show_view(View.CUT)
    player = control.player
    qtbot.waitUntil(lambda: player.timeline is not None, timeout=60_000)
    assert beside.text.current == -1, "at the end nothing is marked"
    player.go(40)
    qtbot.waitUntil(lambda: player.at is not None and player.at.motion == 40, timeout=20_000)
    lines = player.timeline.line
    assert beside.text.current + 1 == lines[39] and "Pocket T1" in beside.where.text()
    player.step(PlaybackStep.LINE, 1)
    qtbot.waitUntil(lambda: player.at.motion == 41, timeout=20_000)
    assert beside.text.current + 1 == lines[40]
    beside.text.pick(int(lines[99]) - 1)
    qtbot.waitUntil(lambda: player.at.motion == 100, timeout=20_000)
    assert beside.motion == 99 and computed.window_.views.cut.overlay.way is not None
    beside.text.pick(0)
    qtbot.waitUntil(lambda: player.at.motion == 0, timeout=20_000)
    assert computed.display_controller.view is View.CUT


@pytest.mark.exhaustive
def test_a_mend_is_one_step_that_is_computed_and_can_be_taken_back(qtbot: QtBot, wiring: WindowController) -> None:
    cut = CutParameters(1, depth=6.0, stepdown=3.0)
    tool = Tool(1, 6.0, flute_length=4.0, shank_diameter=8.0)
    wiring.document.load(Job(layered_part({"0": [square(20.0)]}), (tool,), (PocketOperation(cut),)))
    wiring.compute()
    panel = wiring.window_.cut_panel
    qtbot.waitUntil(lambda: bool(panel.entries), timeout=60_000)
    wiring.display_controller.show_view(View.CUT)
    panel.choose(next(each for each in panel.entries if each.kind is FindingKind.SHANK_CONTACT))
    words = [button.text() for button in panel.mends]
    assert words[0] == "T1 of the library" and "T1 flutes 7 mm" in words and "Depth 3.5 mm" in words
    own, at = wiring.cut_controller.cut, words.index("Depth 3.5 mm")
    panel.looks[at].click()
    qtbot.waitUntil(lambda: wiring.cut_controller.cut is not own, timeout=60_000)
    assert wiring.document.job.operations[0].cut == cut, "a preview changes nothing"
    assert wiring.cut_controller.cut.picture.lowest == pytest.approx(-3.5, abs=1e-4) != own.picture.lowest
    assert panel.title.text() == "Preview · Clean" and "preview" in wiring.window_.file_label.text()
    assert not any(each.kind is FindingKind.SHANK_CONTACT for each in panel.entries)
    panel.mends[1].click()
    assert wiring.cut_controller.cut is own and "preview" not in wiring.window_.file_label.text()
    panel.choose(next(each for each in panel.entries if each.kind is FindingKind.SHANK_CONTACT))
    panel.looks[at].click()
    qtbot.waitUntil(lambda: wiring.cut_controller.cut is not own, timeout=60_000)
    panel.mends[0].click()
    assert not panel.mends and wiring.document.undo_name == "Depth 3.5 mm"
    qtbot.waitUntil(lambda: wiring.computation.state is ComputationState.CURRENT, timeout=60_000)
    assert wiring.window_.status.badge.text().startswith("✓ 0 gouge")
    wiring.document.undo()
    assert wiring.document.job.operations[0].cut == cut
    assert wiring.computation.state is ComputationState.STALE


def test_a_preview_is_headed_by_the_verdict_on_the_whole_program(qtbot: QtBot, wiring: WindowController) -> None:
    """It was "Clean" where the drawing had an open contour, which is found on its way into paths, not in the cut."""
    for line in ("rect 0,0 20,20", "line 4,4 9,4"):
        wiring.document.run(line)
    job = Job(wiring.document.part, (Tool(1, 6.0),), (PocketOperation(CutParameters(1, depth=1.0)),))
    control, panel = wiring.cut_controller, wiring.window_.cut_panel
    making = wiring.computation.making(job)
    trial = trial_shown(Mend("Depth 1 mm", "depth 2 to 1 mm", job), making, CutColourBy.DEPTH, Progress())
    assert any(each.kind is FindingKind.OPEN_CONTOUR and each.counts for each in trial.findings)
    assert trial.cut is not None and title_of(trial.cut) == "Clean", "the cut alone does not know of it"
    control._show_trial(trial, wiring.document.revision)
    told = control.shown_document
    assert told is not None and told.verdict is not None and told.findings == trial.findings
    assert panel.title.text() == told.verdict.text == f"Preview · {trial.told.text}" != "Preview · Clean"
    assert told.verdict.level is trial.told.level is not VerdictLevel.OK
