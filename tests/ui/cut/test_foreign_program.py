"""Programs that are none of the job's, cut and shown in the real window."""

import numpy as np
import pytest
from PySide6.QtCore import Qt

from app.model.tool import Tool
from app.model.tool_kind import ToolKind, tool_kinds
from app.simulation.engines import Engine
from app.ui.framework.view import View
from app.ui.views.cut.setup_form import as_kind
from tests.ui.conftest import WAIT_MS

TOLD = "(T1 D=4 - flat end mill)\n"
PROGRAM = "G21 G90\nT1 M6\nS8000 M3\nG0 X10 Y15 Z5\nG1 Z-2 F200\nG1 X30 F400\nG0 Z5\nM2\n"


@pytest.fixture
def opened(qtbot, computed, tmp_path):
    """Open a text as a program in the NC view and ask for its cut."""

    def act(text, name="slot.ngc"):
        path = tmp_path / name
        path.write_text(text)
        computed.nc.open(path)
        qtbot.waitUntil(lambda: computed.nc.source is not None and computed.nc.source.name == name, timeout=WAIT_MS)
        qtbot.mouseClick(computed.window_.views.nc.path_head.cut, Qt.MouseButton.LeftButton)
        qtbot.waitUntil(lambda: computed.cut_controller.foreign_worker.busy, timeout=WAIT_MS)
        qtbot.waitUntil(lambda: not computed.cut_controller.foreign_worker.busy, timeout=WAIT_MS)
        return computed

    qtbot.waitUntil(lambda: computed.cut_controller.cut is not None, timeout=WAIT_MS)
    return act


def test_a_program_that_tells_its_tool_is_cut_at_once_and_what_was_assumed_is_told(opened):
    wiring = opened(TOLD + PROGRAM)
    cut = wiring.cut_controller.cut
    assert wiring.display_controller.view is View.CUT and cut.names == ("slot.ngc",)
    assert wiring.window_.cut_panel.isVisible()
    assert float(cut.picture.heights.min()) == pytest.approx(-2.0) and cut.picture.floor < -2.5
    assert any("does not tell the stock" in entry.sentence for entry in wiring.window_.cut_panel.entries)
    assert not any("--" in entry.sentence for entry in wiring.window_.cut_panel.entries)


def test_an_unknown_tool_is_asked_for(qtbot, opened):
    wiring = opened(PROGRAM)
    form, own = wiring.window_.cut_form, wiring.cut_controller.cut
    assert form.isVisible() and "T1 cuts, and slot.ngc does not tell what it is" in form.reason.text()
    assert own is None, "another cut is shown under the program's name"
    assert "slot.ngc is not cut yet" in wiring.window_.views.empty.sentence.text()
    surface = wiring.window_.views.cut.render_scheduler.surface
    assert surface is None or surface.isHidden()
    fields = form.tools[1]
    fields.kind.chosen.emit(ToolKind.BALL)
    fields.fields["diameter"].committed.emit(3.0)
    form.stock[5].edit.setText("-9")
    form.stock[5].edit.setModified(True)
    form.stock[5].edit.editingFinished.emit()
    qtbot.mouseClick(form.cut, Qt.MouseButton.LeftButton)
    assert form.wrong.isVisible() and "no volume" in form.wrong.text()
    form.stock[5].show_value(0.0)
    qtbot.mouseClick(form.cut, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: wiring.cut_controller.cut is not own, timeout=WAIT_MS)
    cut = wiring.cut_controller.cut
    assert not form.isVisible() and cut.given.tools[1].kind is ToolKind.BALL
    grid, heights = cut.cut.cut.before.grid, cut.picture.heights
    across = heights[:, int((20.0 - grid.x0) / grid.pitch)]
    ys = grid.ys() - 15.0
    inside = np.abs(ys) < 1.3
    assert np.allclose(across[inside], -2.0 + 1.5 - np.sqrt(1.5**2 - ys[inside] ** 2), atol=1e-5)


def test_other_tools_and_back_to_the_jobs_own_cut(qtbot, opened):
    wiring = opened(TOLD + PROGRAM)
    window, foreign = wiring.window_, wiring.cut_controller.cut
    window.cut_panel.form.click()
    assert window.cut_form.isVisible() and window.cut_form.tools[1].tool.diameter == 4.0
    window.cut_form.leave.click()
    assert window.cut_panel.isVisible() and wiring.cut_controller.cut is foreign
    window.cut_panel.back.click()
    assert (
        wiring.cut_controller.cut.given is None and wiring.cut_controller.cut.picture is window.views.cut.model.picture
    )


@pytest.mark.exhaustive
def test_computing_anew_brings_the_cut_of_the_job_back(qtbot, opened):
    wiring = opened(TOLD + PROGRAM)
    before = wiring.computation.made
    wiring.compute()
    qtbot.waitUntil(lambda: wiring.computation.made is not before, timeout=WAIT_MS)
    qtbot.waitUntil(lambda: not wiring.cut_controller.worker.busy, timeout=WAIT_MS)
    assert wiring.cut_controller.cut.cut is wiring.computation.made.cut


@pytest.mark.exhaustive
def test_the_own_program_written_to_a_file_is_compared_with_the_drawing(qtbot, opened, computed):
    wiring = opened(computed.computation.made.nc.text, "own.ngc")
    assert not wiring.window_.cut_form.isVisible()
    wiring.window_.cut_panel.form.click()
    wiring.window_.cut_form.compare.setChecked(True)
    before = wiring.cut_controller.cut
    wiring.window_.cut_form.cut.click()
    qtbot.waitUntil(lambda: wiring.cut_controller.cut is not before, timeout=WAIT_MS)
    assert wiring.cut_controller.cut.cut.judgement.clean


def test_a_program_with_an_error_is_refused_in_words(qtbot, opened):
    said = []
    opened(TOLD + PROGRAM).cut_controller.failed.connect(said.append)
    wiring = opened(TOLD + PROGRAM.replace("X30", "X"), "broken.ngc")
    assert "broken.ngc:7" in said[0] and "--" not in said[0]
    assert wiring.cut_controller.cut.names == ("slot.ngc",)


def test_the_line_of_the_metal_is_shown_in_the_nc_view(qtbot, opened):
    wiring = opened(TOLD + PROGRAM)
    cut = wiring.cut_controller.cut
    motion = int(np.flatnonzero(cut.picture.moves.line == 7)[0])
    wiring.window_.cut_panel.line_requested.emit(motion)
    assert wiring.display_controller.view is View.NC and wiring.window_.views.nc.pane.text.current == 6
    wiring.cut_controller.back()
    motion = int(wiring.cut_controller.cut.picture.move.max())
    wiring.window_.cut_panel.line_requested.emit(motion)
    line = wiring.cut_controller.cut.picture.moves.line[motion]
    assert not wiring.nc.foreign
    qtbot.waitUntil(lambda: wiring.window_.views.nc.pane.text.current + 1 == line, timeout=WAIT_MS)


@pytest.mark.parametrize("kind", tool_kinds(), ids=lambda kind: kind.value)
def test_any_kind_can_be_chosen_and_is_a_shape(kind):
    from app.simulation.cutter import cutter_of

    clears = 2.1 if kind.threads else 3.0  # of one that cuts threads the core within its teeth
    assert cutter_of(as_kind(Tool(1, 6.0), kind)).radius == pytest.approx(clears)


def test_heights_are_exact_or_by_the_facets_of_1999(qtbot, opened):
    wiring = opened(PROGRAM)
    form, own = wiring.window_.cut_form, wiring.cut_controller.cut
    form.tools[1].kind.chosen.emit(ToolKind.BALL)
    assert form.heights.value is False
    qtbot.mouseClick(form.heights.buttons[True], Qt.MouseButton.LeftButton)
    qtbot.mouseClick(form.cut, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: wiring.cut_controller.cut is not own, timeout=WAIT_MS)
    cut = wiring.cut_controller.cut
    assert cut.given.published and any("method of 1999" in found.text for found in cut.assumed)
    report = cut.cut.engine_report
    assert report.engine is Engine.PATENT or report.fault
    if report.engine is Engine.PATENT:
        lowest = float(cut.picture.heights[:-1].min())  # the last row's centres lie beside the stock
        assert -2.0 <= lowest < -1.98, "facets lie inside the ball's sweep"


def test_a_program_that_is_being_cut_is_not_called_one_that_is_not_shown(qtbot, wiring, tmp_path):
    path = tmp_path / "told.ngc"
    path.write_text(TOLD + PROGRAM)
    wiring.files.open_file(path)
    qtbot.waitUntil(lambda: wiring.nc.foreign and wiring.nc.shown is not None, timeout=WAIT_MS)
    qtbot.mouseClick(wiring.window_.views.nc.path_head.cut, Qt.MouseButton.LeftButton)
    empty = wiring.window_.views.empty
    qtbot.waitUntil(lambda: wiring.cut_controller.foreign_worker.busy, timeout=WAIT_MS)
    assert empty.sentence.text() == "The program is being cut." and "Cancel" in empty.button.text()
    qtbot.waitUntil(lambda: wiring.cut_controller.cut is not None, timeout=WAIT_MS)
    assert not empty.isVisible()
