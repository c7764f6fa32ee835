"""The whole job in the window, with mouse and keys, on the real engines."""

import time
from pathlib import Path

import pytest
from PySide6.QtCore import QMimeData, QPoint, QPointF, QRect, Qt, QUrl
from PySide6.QtGui import QDragEnterEvent, QDropEvent
from PySide6.QtWidgets import QApplication, QFileDialog, QLabel, QToolButton, QWidget

from app.core.resources import resource
from app.core.settings import ThemeChoice, load_settings
from app.ui.framework.computation import ComputationState
from app.ui.framework.samples import PathLineKind
from app.ui.framework.theme import DARK, LIGHT
from app.ui.framework.view import View
from app.ui.panels.changes import Subject, SubjectKind
from app.ui.shell.file_controller import FIRST_START
from app.ui.shell.files.nc_export_controller import ExportPlace
from app.ui.shell.window_geometry import fit_onto
from app.ui.views.canvas.modes import CanvasTool, PathColourBy
from tests.ui.conftest import WAIT_MS

NO_UNITS = (
    "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n0\n0\nENDSEC\n"
    "0\nSECTION\n2\nENTITIES\n0\nCIRCLE\n8\n0\n10\n0.0\n20\n0.0\n40\n20.0\n0\nENDSEC\n0\nEOF\n"
)


def press(qtbot, wiring, key, modifier=Qt.KeyboardModifier.NoModifier):
    qtbot.keyClick(wiring.window_.canvas, key, modifier)


def test_first_start_shows_the_sample_computed(computed):
    window = computed.window_
    assert window.notice.text.text() == FIRST_START
    assert computed.display_controller.view is View.PATHS
    assert window.status.badge.text().startswith("✓ 0 gouge · 0 left · ")
    assert window.file_label.text() == "fig2.dxf"
    assert window.views.legend.isVisible()
    assert not computed.document.modified


@pytest.mark.exhaustive
def test_changed_tool_makes_the_paths_out_of_date_until_f5(qtbot, computed):
    panel, before = computed.window_.panel, computed.computation.made
    panel.choose(Subject(SubjectKind.TOOL, 1))
    field = panel.tool_form.diameter
    field.edit.setFocus()
    field.edit.selectAll()
    qtbot.keyClicks(field.edit, "4")
    qtbot.keyClick(field.edit, Qt.Key.Key_Return)
    assert computed.window_.status.badge.text() == "Out of date"
    press(qtbot, computed, Qt.Key.Key_F5)
    qtbot.waitUntil(lambda: computed.computation.state is ComputationState.CURRENT, timeout=WAIT_MS)
    assert computed.computation.made is not before
    assert "4" in next(t.label for t in computed.computation.made.job.tools if t.number == 1)


def test_undo_of_the_change_makes_the_paths_current_again(qtbot, computed):
    computed.document.run("circle 150,50 10")
    assert computed.computation.state is ComputationState.STALE
    action = computed.window_.actions_["undo"]
    assert action.text() == "&Undo circle"
    press(qtbot, computed, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    assert computed.computation.state is ComputationState.CURRENT
    assert computed.window_.actions_["redo"].text() == "&Redo circle"


def test_tabs_lead_from_drawing_to_nc(qtbot, computed):
    window = computed.window_
    qtbot.mouseClick(window.top_bar.tabs["view_nc"], Qt.MouseButton.LeftButton)
    assert window.views.currentWidget() is window.views.nc
    assert window.views.nc.pane.text.text.text == computed.computation.made.nc.text
    assert not window.views.legend.isVisible()
    qtbot.mouseClick(window.top_bar.tabs["view_draw"], Qt.MouseButton.LeftButton)
    assert window.views.currentWidget() is window.canvas
    press(qtbot, computed, Qt.Key.Key_3, Qt.KeyboardModifier.ControlModifier)
    assert computed.display_controller.view is View.PATHS


def test_export_writes_what_was_computed(qtbot, computed, tmp_path):
    target = tmp_path / "part"
    computed.files.export_controller.choose_file = lambda _, post: ExportPlace(target, post)
    with qtbot.waitSignal(computed.files.export_controller.written, timeout=WAIT_MS):
        press(qtbot, computed, Qt.Key.Key_E, Qt.KeyboardModifier.ControlModifier)
    assert (tmp_path / "part.ngc").read_text("ascii") == computed.computation.made.nc.text


def test_export_that_cannot_be_written_says_so(qtbot, computed, tmp_path):
    computed.files.export_controller.choose_file = lambda _, post: ExportPlace(tmp_path / "no" / "folder.ngc", post)
    with qtbot.waitSignal(computed.files.export_controller.failed) as caught:
        computed.files.export_controller.start()
    assert "folder.ngc" in caught.args[0]
    assert computed.window_.notice.text.text() == caught.args[0]


def test_export_of_a_changed_job_computes_first_and_shows_findings_before_the_file(qtbot, computed, tmp_path):
    target = tmp_path / "open.ngc"
    computed.files.export_controller.choose_file = lambda _, post: ExportPlace(target, post)
    computed.document.run("line 150,0 150,50 170,50")
    computed.files.export_controller.start()
    notice = computed.window_.notice
    qtbot.waitUntil(lambda: [b.text() for b in notice.buttons] == ["Show", "Write anyway"], timeout=WAIT_MS)
    assert "open contour" in notice.text.text()
    assert not target.exists()
    qtbot.mouseClick(notice.buttons[1], Qt.MouseButton.LeftButton)
    assert target.exists()


def test_cancel_is_answered_within_0_2_s(qtbot, wiring, data):
    wiring.files.open_file(data / "dxf" / "complex.dxf")
    qtbot.waitUntil(lambda: wiring.proposal_controller.due, timeout=WAIT_MS)
    qtbot.mouseClick(wiring.window_.notice.buttons[1], Qt.MouseButton.LeftButton)
    press(qtbot, wiring, Qt.Key.Key_F5)
    assert wiring.computation.state is ComputationState.RUNNING
    qtbot.waitUntil(lambda: wiring.window_.status.bar.value() > 0, timeout=WAIT_MS)
    begun = time.monotonic()
    qtbot.mouseClick(wiring.window_.status.cancel, Qt.MouseButton.LeftButton)
    assert time.monotonic() - begun < 0.2
    assert wiring.computation.state is ComputationState.NONE
    assert wiring.window_.status.badge.text() == "Not computed"
    assert not wiring.window_.status.bar.isVisible()


@pytest.mark.exhaustive
def test_answer_for_a_job_that_has_changed_is_dropped(qtbot, computed):
    before = computed.computation.made
    computed.computation.start()
    computed.document.run("circle 150,50 10")
    qtbot.wait(1500)
    assert computed.computation.made is before
    assert computed.computation.state is ComputationState.STALE


def test_drawing_by_command_and_by_mouse_then_computing(qtbot, wiring):
    window = wiring.window_
    assert window.views.empty.isVisible(), "an empty drawing does not say what is missing"
    window.command_line.edit.setFocus()
    qtbot.keyClicks(window.command_line.edit, "rect 0,0 60,40")
    qtbot.keyClick(window.command_line.edit, Qt.Key.Key_Return)
    # the first line of a run waits until the language is loaded
    qtbot.waitUntil(lambda: len(wiring.document.part.entities) == 4, timeout=WAIT_MS)
    assert not window.views.empty.isVisible()
    assert window.command_line.log.lines[-1].command == "rect 0,0 60,40"
    qtbot.mouseClick(window.tool_strip.buttons["tool_circle"], Qt.MouseButton.LeftButton)
    middle = window.canvas.rect().center()
    qtbot.mouseClick(window.canvas, Qt.MouseButton.LeftButton, pos=middle)
    qtbot.mouseMove(window.canvas, middle)
    qtbot.mouseClick(window.canvas, Qt.MouseButton.LeftButton, pos=middle + middle / 12)
    assert wiring.document.log[-1].command.startswith("circle ")
    press(qtbot, wiring, Qt.Key.Key_F5)
    qtbot.waitUntil(lambda: wiring.computation.state is ComputationState.CURRENT, timeout=WAIT_MS)
    assert wiring.display_controller.view is View.PATHS


def test_wrong_command_is_answered_in_the_log(qtbot, wiring):
    line = wiring.window_.command_line
    qtbot.keyClicks(line.edit, "lime 3,4")
    qtbot.keyClick(line.edit, Qt.Key.Key_Return)
    assert line.log.lines[-1].error
    assert "'lime' is no command" in line.log.lines[-1].reply
    qtbot.keyClick(line.edit, Qt.Key.Key_Up)
    assert line.edit.text() == "lime 3,4"


def test_characters_typed_over_the_canvas_begin_a_command(qtbot, wiring):
    press(qtbot, wiring, Qt.Key.Key_R)
    assert wiring.window_.command_line.edit.text() == "r"


def test_drawing_without_units_asks_above_the_canvas(qtbot, wiring, tmp_path):
    path = tmp_path / "plate.dxf"
    path.write_text(NO_UNITS, "ascii")
    with qtbot.waitSignal(wiring.files.open_controller.opened, timeout=WAIT_MS):
        wiring.files.open_file(path)
    card = wiring.window_.card
    assert card.title.text() == "plate.dxf" and card.text.text() == "It names no units. It was read in mm."
    assert "40 \u00d7 40 mm" in [label.text() for label in card.findChildren(QLabel)]
    inch = next(b for b in card.buttons if b.text() == "Read in inch")
    with qtbot.waitSignal(wiring.files.open_controller.opened, timeout=WAIT_MS):
        qtbot.mouseClick(inch, Qt.MouseButton.LeftButton)
    assert wiring.display_controller.part_size() == pytest.approx((1016.0, 1016.0))


def test_an_svg_in_pixels_can_be_read_in_mm(qtbot, wiring, tmp_path):
    path = tmp_path / "plate.svg"
    path.write_text(
        '<svg xmlns="http://www.w3.org/2000/svg"><rect width="40" height="20" stroke="black" fill="none"/></svg>',
        "ascii",
    )
    with qtbot.waitSignal(wiring.files.open_controller.opened, timeout=WAIT_MS):
        wiring.files.open_file(path)
    card = wiring.window_.card
    assert card.text.text() == "It has no real size. It names no editor and was read with 96 units to the inch."
    assert "10.583 \u00d7 5.292 mm" in [label.text() for label in card.findChildren(QLabel)]
    assert [b.text() for b in card.buttons] == [
        "Keep 96 to the inch",
        "Read 90 to the inch",
        "Read 72 to the inch",
        "Read in mm",
        "Read in inch",
    ]
    with qtbot.waitSignal(wiring.files.open_controller.opened, timeout=WAIT_MS):
        qtbot.mouseClick(card.buttons[3], Qt.MouseButton.LeftButton)
    assert wiring.display_controller.part_size() == pytest.approx((40.0, 20.0))


def test_a_drawing_in_words_opens_in_the_window(qtbot, wiring):
    with qtbot.waitSignal(wiring.files.open_controller.opened, timeout=WAIT_MS):
        wiring.files.open_file(resource("samples", "plate.draw"))
    assert wiring.display_controller.part_size() == pytest.approx((90.0, 60.0))


def test_file_that_is_no_drawing_leaves_the_document(qtbot, computed, tmp_path):
    path = tmp_path / "empty.dxf"
    path.write_bytes(b"")
    job = computed.document.job
    with qtbot.waitSignal(computed.files.open_controller.failed, timeout=WAIT_MS) as caught:
        computed.files.open_file(path)
    assert "empty.dxf" in caught.args[0]
    assert computed.document.job is job
    assert computed.window_.notice.text.text() == caught.args[0]


def test_dropped_drawing_is_opened(qtbot, wiring, samples):
    mime = QMimeData()
    mime.setUrls([QUrl.fromLocalFile(str(samples / "fig2.dxf"))])
    how = (Qt.DropAction.CopyAction, mime, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier)
    enter, drop = QDragEnterEvent(QPoint(400, 10), *how), QDropEvent(QPointF(400, 10), *how)
    QApplication.sendEvent(wiring.window_, enter)
    assert enter.isAccepted()
    with qtbot.waitSignal(wiring.files.open_controller.opened, timeout=WAIT_MS):
        QApplication.sendEvent(wiring.window_, drop)
    assert wiring.document.path == Path(samples / "fig2.dxf")


SAVE, GIVE_UP, KEEP = range(3)


def test_changes_are_not_lost_without_asking(qtbot, wiring):
    wiring.document.run("circle 10,10 5")
    press(qtbot, wiring, Qt.Key.Key_N, Qt.KeyboardModifier.ControlModifier)
    notice = wiring.window_.notice
    assert len(wiring.document.part.entities) == 1
    qtbot.mouseClick(notice.buttons[KEEP], Qt.MouseButton.LeftButton)
    assert len(wiring.document.part.entities) == 1
    assert not wiring.window_.close(), "the window closed over changes"
    assert notice.isVisible()
    press(qtbot, wiring, Qt.Key.Key_N, Qt.KeyboardModifier.ControlModifier)
    qtbot.mouseClick(notice.buttons[GIVE_UP], Qt.MouseButton.LeftButton)
    assert wiring.document.part.entities == ()
    wiring.document.run("circle 10,10 5")
    assert not wiring.window_.close()
    qtbot.mouseClick(notice.buttons[GIVE_UP], Qt.MouseButton.LeftButton)
    assert not wiring.window_.isVisible()


def test_theme_switches_and_is_remembered(wiring):
    wiring.window_.actions_["theme_dark"].trigger()
    assert wiring.window_.theme is DARK
    assert DARK.paper.name() in QApplication.instance().styleSheet()
    assert load_settings().theme is ThemeChoice.DARK
    wiring.window_.actions_["theme_light"].trigger()
    assert wiring.window_.theme is LIGHT


def test_finding_leads_to_its_place(qtbot, computed):
    computed.document.run("line 150,0 150,50 170,50")
    computed.compute()
    qtbot.waitUntil(lambda: computed.computation.state is ComputationState.CURRENT, timeout=WAIT_MS)
    badge, findings = computed.window_.status.badge, computed.window_.findings_list
    assert badge.property("verdict") == "remark"
    qtbot.mouseClick(badge, Qt.MouseButton.LeftButton)
    assert findings.isVisible()
    with qtbot.waitSignal(findings.picked) as caught:
        qtbot.mouseClick(findings.rows[0], Qt.MouseButton.LeftButton)
    assert caught.args[0].kind.value == "open_contour"
    assert computed.document.selection == frozenset(caught.args[0].entity_ids)


def test_legend_switches_layers(qtbot, computed):
    legend = computed.window_.views.legend
    before = computed.window_.canvas.grab().toImage()
    for row in filter(QWidget.isVisible, legend.rows.values()):
        qtbot.mouseClick(row, Qt.MouseButton.LeftButton)
    assert computed.window_.canvas.grab().toImage() != before


def test_legend_tells_of_left_material_only_when_there_is_some(qtbot, wiring):
    rows = wiring.window_.views.legend.rows
    wiring.display_controller.show_view(View.PATHS)

    def compute():
        wiring.computation.start()
        qtbot.waitUntil(lambda: wiring.computation.state is ComputationState.CURRENT, timeout=WAIT_MS)

    wiring.document.run("circle 50,50 20")
    compute()
    assert not rows[PathLineKind.LEFT].isVisible()
    assert not rows[PathLineKind.UNREACHABLE].isVisible()
    wiring.document.run("rect 80,30 120,70")
    compute()
    assert not rows[PathLineKind.LEFT].isVisible()
    assert rows[PathLineKind.UNREACHABLE].isVisible()


def test_empty_command_line_leaves_undo_to_the_drawing(qtbot, wiring):
    line = wiring.window_.command_line.edit
    line.setFocus()
    for words in ("circle 0,0 10", "circle 0,0 20"):
        qtbot.keyClicks(line, words)
        qtbot.keyClick(line, Qt.Key.Key_Return)
    for left in (1, 0, 0):
        qtbot.keyClick(line, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
        assert len(wiring.document.part.entities) == left
        assert line.text() == ""


def test_empty_view_gives_way_to_a_drawing_tool(qtbot, wiring):
    empty = wiring.window_.views.empty
    assert empty.isVisible()
    wiring.window_.actions_["tool_circle"].trigger()
    assert not empty.isVisible()
    wiring.window_.actions_["tool_select"].trigger()
    assert empty.isVisible()


def test_window_fits_onto_a_small_screen(qtbot, wiring):
    window = wiring.window_
    window.resize(1440, 900)
    fit_onto(window, QRect(0, 0, 1280, 800))
    assert window.width() <= 1280
    assert window.height() < 800


def test_legend_folds_and_colours_by_region(qtbot, computed):
    legend = computed.window_.views.legend
    qtbot.mouseClick(legend.colour.buttons[PathColourBy.REGION], Qt.MouseButton.LeftButton)
    assert computed.window_.canvas.colour_by is PathColourBy.REGION
    tall = legend.height()
    qtbot.mouseClick(legend.fold, Qt.MouseButton.LeftButton)
    assert legend.height() < tall / 2


def test_tool_strip_follows_the_canvas(qtbot, wiring):
    line = wiring.window_.command_line.edit
    qtbot.keyClicks(line, "li")
    qtbot.keyClick(line, Qt.Key.Key_Return)
    assert wiring.window_.tool_strip.buttons["tool_line"].isChecked()
    assert wiring.window_.canvas.tool is CanvasTool.LINE
    qtbot.keyClicks(line, "10,10")
    qtbot.keyClick(line, Qt.Key.Key_Return)
    qtbot.keyClicks(line, "@30<90")
    qtbot.keyClick(line, Qt.Key.Key_Return)
    assert wiring.display_controller.part_size() == pytest.approx((0.0, 30.0))
    press(qtbot, wiring, Qt.Key.Key_Escape)
    press(qtbot, wiring, Qt.Key.Key_Escape)
    assert wiring.window_.tool_strip.buttons["tool_select"].isChecked()


def test_hidden_field_does_not_choose_another_row(qtbot, wiring):
    panel = wiring.window_.panel
    panel.choose(Subject(SubjectKind.TOOL, 1))
    panel.tool_form.diameter.edit.setFocus()
    panel.choose(Subject(SubjectKind.JOB))
    qtbot.wait(20)
    assert panel.subject == Subject(SubjectKind.JOB)


def test_opening_while_computing_leaves_the_computation(qtbot, computed, data):
    computed.computation.start()
    with qtbot.waitSignal(computed.files.open_controller.opened, timeout=WAIT_MS):
        computed.files.open_controller.open(data / "dxf" / "gear.dxf")
    assert computed.computation.state is ComputationState.NONE
    assert not computed.window_.worker.busy
    assert not computed.window_.status.bar.isVisible()


def test_drawing_that_changed_while_a_file_was_read_is_kept(qtbot, wiring, samples):
    with qtbot.waitSignal(wiring.files.open_controller.failed, timeout=WAIT_MS) as caught:
        wiring.files.open_controller.open(samples / "fig2.dxf")
        wiring.document.run("circle 10,10 5")
    assert "was changed while fig2.dxf was being read" in caught.args[0]
    assert len(wiring.document.part.entities) == 1


def test_drawings_opened_lately_are_in_the_menu(qtbot, wiring, data):
    path = data / "dxf" / "genshi.dxf"
    with qtbot.waitSignal(wiring.files.open_controller.opened, timeout=WAIT_MS):
        wiring.files.open_file(path)
    recent = wiring.window_.actions_.recent
    recent.aboutToShow.emit()
    assert recent.actions()[0].text() == str(path)
    with qtbot.waitSignal(wiring.files.open_controller.opened, timeout=WAIT_MS):
        recent.actions()[0].trigger()


def test_words_of_the_window_can_be_typed(qtbot, wiring):
    line = wiring.window_.command_line.edit
    for words in ("rect 0,0 40,30", "compute"):
        qtbot.keyClicks(line, words)
        qtbot.keyClick(line, Qt.Key.Key_Return)
        qtbot.waitUntil(lambda: bool(wiring.document.part.entities), timeout=WAIT_MS)
    qtbot.waitUntil(lambda: wiring.computation.state is ComputationState.RUNNING, timeout=WAIT_MS)


@pytest.mark.parametrize("theme", [LIGHT, DARK], ids=["light", "dark"])
def test_buttons_of_a_file_dialog_can_be_seen_by_day_and_by_night(qtbot, wiring, theme):
    wiring.window_.actions_[f"theme_{theme.name}"].trigger()
    dialog = QFileDialog(wiring.window_)
    dialog.open()
    button = dialog.findChild(QToolButton, "toParentButton")
    assert button is not None
    image = button.icon().pixmap(20, 20).toImage()
    places = [(x, y) for x in range(image.width()) for y in range(image.height())]
    seen = {image.pixelColor(x, y).name() for x, y in places if image.pixelColor(x, y).alpha() == 255}
    assert seen == {theme.ink.name()}
    dialog.reject()
