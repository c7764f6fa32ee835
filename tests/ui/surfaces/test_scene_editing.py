"""A scene is changed in the panel and in its text, computed at once, undone, saved, and not lost."""

from dataclasses import replace

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QTextCursor
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QPushButton

from app.core.resources import resource
from app.formats.scene.toml import read_scene
from app.model.finding import Finding, FindingKind
from app.ui.framework.verdict import VerdictLevel
from app.ui.framework.view import View
from app.ui.views.surfaces.field_widgets import VectorField
from app.ui.views.surfaces.new_parts import passes_across, roughing_passes
from app.ui.views.surfaces.scene_computation import SceneState
from app.ui.views.surfaces.scene_document import SceneDocument

WAIT_MS = 60_000
SPHERES = resource("samples", "spheres.toml")
SMALL = SPHERES.read_bytes().replace(b"pitch = 1.0", b"pitch = 4.0")


@pytest.fixture
def opened(qtbot, wiring, tmp_path):
    """A scene in a file of its own, in the Surfaces view."""
    path = tmp_path / "mine.toml"
    path.write_bytes(SMALL)
    wiring.files.open_file(path)
    proven(qtbot, wiring)
    return wiring


def proven(qtbot, wiring) -> None:
    work = wiring.scenes.work
    qtbot.waitUntil(lambda: work.state in (SceneState.PROVEN, SceneState.FAILED), timeout=WAIT_MS)
    assert work.state is SceneState.PROVEN, work.problem


def again(qtbot, wiring) -> None:
    """Wait until a change has been taken up and computed."""
    qtbot.waitUntil(lambda: wiring.scenes.work.state is not SceneState.PROVEN, timeout=WAIT_MS)
    proven(qtbot, wiring)


def type_into(field, text: str) -> None:
    field.edit.setFocus()
    field.edit.selectAll()
    QTest.keyClicks(field.edit, text)
    QTest.keyClick(field.edit, Qt.Key.Key_Return)


def said(wiring):
    return read_scene("mine.toml", wiring.window_.scene.text.encode())


@pytest.mark.exhaustive
def test_a_number_in_the_panel_changes_the_text_the_picture_and_the_verdict(qtbot, opened):
    window, panel = opened.window_, opened.window_.scene_side.panel
    assert window.status.badge.property("verdict") == VerdictLevel.BAD.value  # passes 4 mm apart leave metal
    planes, verdict = len(window.views.surfaces.shown.planes), opened.scenes.work.verdict
    panel.choose(("passes", 0))
    type_into(panel.form.fields["Pitch"], "8")
    assert said(opened).passes[0].pitch == 8.0
    assert window.scene.modified
    assert window.file_label.text() == "mine.toml *"
    again(qtbot, opened)
    assert len(window.views.surfaces.shown.planes) < planes
    assert opened.scenes.work.verdict != verdict


def test_what_is_but_said_of_a_program_is_no_move_that_is_not_proven(qtbot, wiring):
    wiring.files.open_file(resource("samples", "compound.toml"))
    proven(qtbot, wiring)
    work = wiring.scenes.work
    assert work.findings and not any(finding.counts for finding in work.findings), (
        "it slots the full block, and that is a remark"
    )
    assert wiring.window_.status.badge.property("verdict") == VerdictLevel.OK.value


@pytest.mark.parametrize(("counts", "unproven", "said"), [(True, 0, "1 finding"), (False, 2, "2 moves not proven")])
def test_what_counts_is_told_by_its_kind(qtbot, opened, counts, unproven, said):
    work = opened.scenes.work
    finding = Finding(FindingKind.ENGAGEMENT, "It takes too much.", counts=counts)
    written = replace(work.proven.written, loads=(finding,), left=None, unproven=np.zeros((unproven, 3)))
    work.proven = replace(work.proven, written=written)
    assert (work.verdict.level, work.verdict.text) == (VerdictLevel.BAD, said)


@pytest.mark.exhaustive
def test_what_is_looked_at_stays_while_the_scene_changes(qtbot, opened):
    canvas, panel = opened.window_.views.surfaces.canvas, opened.window_.scene_side.panel
    canvas.zoom_by(2.5)
    camera = canvas.camera
    panel.choose(("passes", 0))
    type_into(panel.form.fields["Pitch"], "8")
    again(qtbot, opened)
    assert canvas.camera == camera


def test_undo_and_redo_go_through_panel_and_text(qtbot, opened):
    window, panel = opened.window_, opened.window_.scene_side.panel
    before = window.scene.text
    panel.choose(("surface", 1))
    type_into(panel.form.fields["Name"], "left ball")
    window.scene_side.text.editor.moveCursor(QTextCursor.MoveOperation.End)
    window.scene_side.text.editor.insertPlainText("# at the end\n")
    assert said(opened).surfaces[1].name == "left ball"
    window.actions_["undo"].trigger()
    assert "# at the end" not in window.scene.text
    window.actions_["undo"].trigger()
    assert window.scene.text == before
    assert not window.scene.modified
    assert not window.actions_["undo"].isEnabled()
    window.actions_["redo"].trigger()
    assert said(opened).surfaces[1].name == "left ball"
    opened.display_controller.show_view(View.DRAW)
    assert not window.actions_["undo"].isEnabled()  # nothing was drawn


@pytest.mark.exhaustive
def test_a_wrong_line_is_marked_and_what_was_right_stays(qtbot, opened):
    window, text = opened.window_, opened.window_.scene_side.text
    shown = window.views.surfaces.shown
    window.scene_side.show_page("Text")
    line = next(n for n, each in enumerate(window.scene.text.splitlines(), 1) if each.startswith("pitch"))
    text.editor.go_to(line)
    text.editor.moveCursor(QTextCursor.MoveOperation.EndOfLine)
    text.editor.insertPlainText("x")
    qtbot.waitUntil(lambda: opened.scenes.work.state is SceneState.WRONG, timeout=WAIT_MS)
    assert text.editor.wrong == line
    assert text.verdict.text().startswith(f"Line {line}: ")
    assert window.status.badge.text() == "The text is wrong"
    assert window.views.surfaces.shown is shown
    text.editor.textCursor().deletePreviousChar()
    proven(qtbot, opened)
    assert text.editor.wrong == 0
    assert "surfaces" in text.verdict.text()


def test_a_file_that_is_wrong_is_opened_all_the_same_so_that_it_can_be_mended(qtbot, wiring, tmp_path):
    path = tmp_path / "wrong.toml"
    path.write_text('name = "wrong"\n[[surface]]\nname = "a"\n')
    with qtbot.waitSignal(wiring.scenes.failed, timeout=WAIT_MS) as told:
        wiring.files.open_file(path)
    assert "wrong.toml:2" in told.args[0]
    assert wiring.window_.scene_side.page == "Text"
    assert wiring.window_.scene_side.text.editor.wrong == 2
    assert "text is wrong" in wiring.window_.views.empty.sentence.text()
    wiring.window_.scene.replace(SMALL.decode())
    proven(qtbot, wiring)
    assert not wiring.window_.views.empty.isVisible()


def test_a_scene_that_failed_says_why_in_the_view_and_may_be_computed_again(qtbot, wiring):
    work, empty = wiring.scenes.work, wiring.window_.views.empty
    wiring.display_controller.show_view(View.SURFACES)
    with qtbot.waitSignal(work.failed, timeout=WAIT_MS) as told:
        work.reading.start(lambda progress: np.empty(1 << 55), lambda _: None)
    assert "ran out" in told.args[0] and empty.sentence.text() == told.args[0]
    assert empty.button.text() == "Compute again"


@pytest.mark.exhaustive
def test_surfaces_are_added_moved_switched_and_removed(qtbot, opened):
    panel = opened.window_.scene_side.panel
    count = len(said(opened).surfaces)
    panel.surface_requested.emit("torus")
    again(qtbot, opened)
    assert said(opened).surfaces[-1].shape.kind == "torus"
    assert panel.subject == ("surface", count)
    rows = panel.surfaces.shown
    QTest.keyClick(rows[-1], Qt.Key.Key_Up, Qt.KeyboardModifier.AltModifier)
    assert said(opened).surfaces[-2].shape.kind == "torus"
    again(qtbot, opened)
    assert panel.subject == ("surface", count - 1)
    QTest.keyClick(panel.surfaces.shown[count - 1], Qt.Key.Key_Delete)
    assert [each.shape.kind for each in said(opened).surfaces].count("torus") == 0
    panel._set(("surface", 0), {("enabled",): False})  # what the row's switch does
    assert not said(opened).surfaces[0].enabled


def test_places_take_three_numbers(qtbot, opened):
    panel = opened.window_.scene_side.panel
    panel.choose(("surface", 1))
    field = panel.form.fields["Moved by"]
    assert isinstance(field, VectorField)
    type_into(field.fields[2], "1.5")
    assert said(opened).surfaces[1].move == (0.0, 0.0, 1.5)
    type_into(field.fields[0], "abc")
    assert said(opened).surfaces[1].move == (0.0, 0.0, 1.5)
    assert field.fields[0].edit.property("wrong") == "true"


def test_places_are_shown_and_typed_in_inches_while_the_window_shows_inches(qtbot, opened):
    panel = opened.window_.scene_side.panel
    panel.choose(("surface", 1))
    field = panel.form.fields["Moved by"]
    opened.window_.actions_["units_inch"].trigger()
    type_into(field.fields[0], "2")
    assert said(opened).surfaces[1].move == pytest.approx((50.8, 0.0, 0.0))
    qtbot.waitUntil(lambda: field.fields[0].edit.text() == "2")
    opened.window_.actions_["units_mm"].trigger()


def test_a_tool_keeps_its_passes_under_another_number(qtbot, opened):
    panel = opened.window_.scene_side.panel
    panel.choose(("tool", 0))
    type_into(panel.form.fields["T number"], "7")
    assert said(opened).tools[0].number == 7
    assert said(opened).passes[0].tool == 7


@pytest.mark.exhaustive
def test_curves_of_the_drawing_become_a_surface(qtbot, opened):
    window = opened.window_
    with qtbot.waitSignal(opened.scenes.failed) as told:
        window.scene_side.panel.curves_requested.emit("loft")
    assert "select them in the Draw view" in told.args[0]
    opened.run("line 0,20 30,25")
    opened.run("spline 0,0 10,8 20,2 30,6")
    opened.run("select all")
    qtbot.waitUntil(lambda: len(opened.document.selection) == 2)
    window.scene_side.panel.curves_requested.emit("ruled")
    again(qtbot, opened)
    assert said(opened).surfaces[-1].shape.kind == "ruled"


@pytest.mark.exhaustive
def test_save_writes_the_text_and_samples_are_not_written_over(qtbot, opened, tmp_path):
    window, panel = opened.window_, opened.window_.scene_side.panel
    panel.choose(("passes", 0))
    type_into(panel.form.fields["Pitch"], "8")
    window.actions_["save"].trigger()
    assert read_scene("mine.toml", (tmp_path / "mine.toml").read_bytes()).passes[0].pitch == 8.0
    assert not window.scene.modified
    asked = []
    opened.scenes.choose_file = lambda first: asked.append(first) or tmp_path / "own.toml"
    opened.scenes.open_sample("spheres")
    again(qtbot, opened)
    window.actions_["save"].trigger()
    assert asked[0].name == "spheres.toml"
    assert (tmp_path / "own.toml").read_text() == SPHERES.read_text()
    assert window.scene.path == tmp_path / "own.toml"


def test_changes_are_not_lost_unasked(qtbot, opened):
    window = opened.window_
    window.scene.replace(window.scene.text.replace("pitch", "pitch "))
    assert window.scene.modified
    opened.scenes.open_sample("torus")
    assert "not saved" in window.notice.text.text()
    assert window.scene.name == "mine.toml"
    window.close()
    assert window.isVisible()
    assert "Close?" in window.notice.text.text()


def test_f5_takes_the_file_as_it_is_now_unless_it_was_changed_here(qtbot, opened, tmp_path):
    path, window = tmp_path / "mine.toml", opened.window_
    path.write_text(path.read_text().replace("pitch = ", "pitch = 1"))
    QTest.keyClick(window, Qt.Key.Key_F5)
    assert "pitch = 1" in window.scene.text
    assert not window.scene.modified
    again(qtbot, opened) if opened.scenes.work.state is SceneState.PROVEN else proven(qtbot, opened)
    window.scene.replace(window.scene.text + "# mine\n")
    path.write_text("")
    QTest.keyClick(window, Qt.Key.Key_F5)
    assert window.scene.text.endswith("# mine\n")


def test_the_program_is_shown_in_the_nc_view(qtbot, opened):
    window = opened.window_
    window.actions_["scene_nc"].trigger()
    qtbot.waitUntil(
        lambda: opened.display_controller.view is View.NC and window.views.nc.shown is not None, timeout=WAIT_MS
    )
    assert window.views.nc.shown.source.name == "mine.ngc"
    assert "Scene" in window.views.nc.pane.text.text.line(0)


@pytest.mark.exhaustive
def test_the_cut_is_shown_beside_the_surfaces(qtbot, opened):
    window = opened.window_
    window.actions_["scene_cut"].trigger()
    qtbot.waitUntil(lambda: opened.cut_controller.cut is not None, timeout=WAIT_MS)
    assert opened.display_controller.view is View.CUT
    assert opened.cut_controller.cut.histogram is not None
    assert not [entry for entry in window.cut_panel.entries if entry.counts and "gouge" in entry.title.lower()]


@pytest.mark.exhaustive
def test_a_new_scene_is_computed_and_has_no_file(qtbot, wiring):
    wiring.window_.actions_["scene_new"].trigger()
    proven(qtbot, wiring)
    assert wiring.window_.scene.path is None
    assert wiring.window_.file_label.text() == "untitled.toml"


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("a b c", "a x c"),
        ("", "new"),
        ("old", ""),
        ("aaa", "aaaa"),
        ("a\U0001d400b", "a\U0001d400c"),
        ("\U0001d400\U0001d401", "\U0001d401"),
        ("one\ntwo\n", "one\n\ntwo\n"),
    ],
)
def test_replacing_text_is_one_step_that_can_be_undone(qtbot, before, after):
    document = SceneDocument()
    document.load(before, None)
    document.replace(after)
    assert document.text == after
    document.document.undo()
    assert document.text == before
    assert not document.document.isUndoAvailable()


@pytest.mark.exhaustive
def test_metal_that_is_left_has_a_button_that_adds_passes_across(qtbot, opened):
    window, text = opened.window_, opened.window_.scene.text
    (before,) = [each for each in opened.scenes.work.findings if each.kind is FindingKind.LEFT_REACHABLE]
    window.status.badge.click()
    shown = [each for each in window.findings_list.findChildren(QPushButton) if each.isVisible()]
    (button,) = [each for each in shown if each.text() == "Add passes across"]
    assert "T1 at 90 degrees" in button.toolTip()
    button.click()
    again(qtbot, opened)
    assert [each.angle_deg for each in said(opened).passes] == [0.0, 90.0] and said(opened).passes[1].pitch == 4.0
    after = [each.amount for each in opened.scenes.work.findings if each.kind is FindingKind.LEFT_REACHABLE]
    assert sum(after) < 0.7 * before.amount
    offered = [mend for each in opened.scenes.work.findings for mend in opened.scenes.shown_document.mends(each)]
    assert "Add passes across" not in [each.words for each in offered], "they are there"
    window.actions_["undo"].trigger()
    assert window.scene.text == text


@pytest.mark.parametrize(
    ("rule", "across"),
    [
        ("angle_deg = 30.0\npitch = 2.0", {"tool": 1, "angle_deg": 120.0, "pitch": 2.0}),
        ("angle_deg = 150.0\nscallop = 0.1", {"tool": 1, "angle_deg": 60.0, "scallop": 0.1}),
        ("fan_deg = [0.0, 90.0, 5.0]", None),
        ("line = [0.0, 0.0, 5.0, 5.0]\npitch = 2.0", None),
        ("pitch = 2.0\nenabled = false", None),
    ],
)
def test_passes_across_are_square_to_straight_ones(rule, across):
    text = SPHERES.read_text("utf-8").partition("[[passes]]")[0] + f"[[passes]]\ntool = 1\n{rule}\n"
    assert passes_across(read_scene("a.toml", text.encode())) == across


def test_a_part_is_roughed_in_depths_before_its_first_passes():
    scene = read_scene("a.toml", SPHERES.read_bytes())
    made = roughing_passes(scene, (0.0, 0.0, -10.0, 100.0, 60.0, 20.0))
    assert [each["floor"] for each in made] == [16.25, 12.5, 8.75, 5.0, 1.25, -2.5, -6.25, -10.0]
    assert {(each["tool"], each["pitch"], each["stock_to_leave"]) for each in made} == {(1, 3.0, 0.5)}
    shallow = roughing_passes(scene, (0.0, 0.0, -10.0, 100.0, 60.0, -5.0))
    assert [each["floor"] for each in shallow] == [-7.5, -10.0], "no deeper than half the tool is wide"


@pytest.mark.parametrize("rule", ["pitch = 2.0\nstock_to_leave = 0.3", "fan_deg = [0.0, 90.0, 5.0]", ""])
def test_what_leaves_stock_or_goes_no_straight_way_is_not_roughed_before(rule):
    head = SPHERES.read_text("utf-8").partition("[[passes]]")[0]
    text = head + (f"[[passes]]\ntool = 1\n{rule}\n" if rule else "")
    assert roughing_passes(read_scene("a.toml", text.encode()), (0.0, 0.0, -10.0, 100.0, 60.0, 20.0)) == ()


def test_a_slot_that_is_too_deep_has_a_button_that_roughs_first(opened):
    text = opened.window_.scene.text
    (mend,) = opened.scenes.shown_document.mends(Finding(FindingKind.ENGAGEMENT, "too deep"))
    assert mend.words == "Rough it first" and mend.change == "T1 in 8 depths"
    mend.act()
    assert [each.stock_to_leave for each in said(opened).passes] == [0.5] * 8 + [0.0], "before what finishes"
    opened.window_.actions_["undo"].trigger()
    assert opened.window_.scene.text == text


def test_where_nothing_is_drawn_a_scene_goes_on_to_its_program_and_its_cut(qtbot, opened):
    window, display = opened.window_, opened.display_controller
    display.show_view(View.NC)
    qtbot.waitUntil(lambda: window.views.nc.shown is not None, timeout=WAIT_MS)
    assert window.file_label.text() == "mine.ngc *" and window.actions_["export"].isEnabled()
    display.show_view(View.CUT)
    assert opened.cut_controller.of_scene
    assert window.file_label.text() == "mine.ngc" and window.actions_["export"].isEnabled()
    assert window.cut_panel.back.text() == "Close it", "there is no job's cut to go back to"
    assert window.status.message.toolTip() == "", "and nothing that was not computed"


@pytest.mark.exhaustive
def test_a_scene_s_cut_that_was_closed_comes_back_when_it_is_asked_for(qtbot, opened):
    window, display = opened.window_, opened.display_controller
    display.show_view(View.CUT)
    qtbot.waitUntil(lambda: window.views.cut.model.picture is not None, timeout=WAIT_MS)
    window.cut_panel.back.click()
    assert window.views.cut.model.picture is None, "it can be closed"
    display.show_view(View.SURFACES)
    display.show_view(View.CUT)
    assert display.page.missing().action == "scene_cut", "and is not shown against one's will"


@pytest.fixture
def after_a_program(qtbot, wiring, tmp_path):
    """A scene that was opened after a program of a file, and that is being computed."""
    program, scene = tmp_path / "other.ngc", tmp_path / "mine.toml"
    program.write_text("G21 G90\nT1 M6\nS9000 M3\nG0 X5 Y10 Z5\nG1 Z-1 F200\nX25\nG0 Z5\nM30\n")
    scene.write_bytes(SMALL)
    wiring.files.open_file(program)
    qtbot.waitUntil(lambda: wiring.nc.foreign and wiring.nc.shown is not None, timeout=WAIT_MS)
    wiring.files.open_file(scene)
    qtbot.waitUntil(lambda: wiring.window_.scene.open, timeout=WAIT_MS)
    return wiring


@pytest.mark.exhaustive
def test_a_program_of_a_file_in_the_nc_view_keeps_no_scene_from_being_cut(qtbot, after_a_program):
    proven(qtbot, after_a_program)
    window, display = after_a_program.window_, after_a_program.display_controller
    display.show_view(View.CUT)
    assert after_a_program.cut_controller.of_scene
    assert window.file_label.text() == "mine.ngc" and window.actions_["export"].isEnabled()
    display.show_view(View.NC)
    assert window.file_label.text() == "other.ngc" and not window.actions_["compute"].isEnabled()
    after_a_program.cut_controller.back()


@pytest.mark.exhaustive
def test_where_a_scene_s_program_is_to_come_title_badge_and_side_are_the_scene_s(after_a_program):
    window, display = after_a_program.window_, after_a_program.display_controller
    display.show_view(View.CUT)
    assert window.views.empty.sentence.text() == "The scene's program is shown here when it is computed and proven."
    assert window.file_label.text() == "mine.toml"
    assert window.status.badge.text().endswith("Computing")
    assert window.scene_side.isVisibleTo(window) and not window.side.isVisibleTo(window)


def test_a_drawing_beside_a_scene_keeps_its_own_cut(opened):
    opened.document.run("rectangle 0,0 20,20")
    opened.display_controller.show_view(View.CUT)
    assert opened.cut_controller.source is None
