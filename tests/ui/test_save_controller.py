"""Save, open again, leave: on the real window, with real files."""

import os
from pathlib import Path

import pytest
from PySide6.QtCore import QMimeData, QPoint, Qt, QUrl
from PySide6.QtGui import QDropEvent, QImage

from app.formats.project.extras import ProjectExtras
from app.formats.project.files import load_project, save_project
from app.formats.project.project import Project, read_project
from app.model.underlay import Underlay
from app.ui.framework.computation import ComputationState
from app.ui.framework.view import View
from app.ui.shell.files.nc_export_controller import ExportPlace
from tests.ui.conftest import WAIT_MS


@pytest.fixture
def files(wiring):
    return wiring.files


def save_to(qtbot, wiring, path: Path) -> None:
    wiring.files.save_controller.choose_file = lambda title, first: path
    with qtbot.waitSignal(wiring.files.save_controller.saved, timeout=WAIT_MS):
        wiring.window_.actions_["save_as"].trigger()


def open_it(qtbot, wiring, path: Path) -> None:
    with qtbot.waitSignal(wiring.files.open_controller.opened, timeout=WAIT_MS):
        wiring.files.open_file(path)


def press(wiring, text: str) -> None:
    next(button for button in wiring.window_.notice.buttons if button.text() == text).click()


def kinds(path: Path) -> list[str]:
    return [type(each.curve).__name__ for each in read_project(path.name, path.read_bytes()).state.job.part.entities]


def test_ctrl_s_asks_for_a_file_once_and_saves_to_it_from_then_on(qtbot, wiring, tmp_path):
    asked: list[tuple[str, str]] = []
    wiring.files.save_controller.choose_file = lambda title, first: (
        asked.append((title, first.name)) or tmp_path / "plate.hito"
    )
    wiring.document.run("rect 0,0 60,40")
    assert wiring.window_.windowTitle().startswith("untitled *")
    with qtbot.waitSignal(wiring.files.save_controller.saved, timeout=WAIT_MS):
        qtbot.keyClick(wiring.window_, Qt.Key.Key_S, Qt.KeyboardModifier.ControlModifier)
    assert asked == [("Save as", "untitled.hito")]
    assert wiring.window_.windowTitle() == "plate.hito - Hitofude" and not wiring.document.modified
    wiring.document.run("circle 30,20 5")
    assert wiring.window_.windowTitle() == "plate.hito * - Hitofude"
    with qtbot.waitSignal(wiring.files.save_controller.saved, timeout=WAIT_MS):
        qtbot.keyClick(wiring.window_, Qt.Key.Key_S, Qt.KeyboardModifier.ControlModifier)
    assert len(asked) == 1
    assert kinds(tmp_path / "plate.hito") == ["Line"] * 4 + ["Circle"]
    assert kinds(tmp_path / "plate.hito~") == ["Line"] * 4
    assert wiring.log.lines[-1].command == "save plate.hito"
    wiring.document.undo()
    assert wiring.document.modified
    wiring.document.redo()
    assert not wiring.document.modified


def test_what_is_opened_is_what_was_saved(qtbot, wiring, tmp_path):
    document, window = wiring.document, wiring.window_
    for line in ("layer holes", "let w = 1/3", "circle w,2 5 as hole", "rect 0,0 30,20", "delete 3"):
        document.run(line)
    wiring.display_controller.show_view(View.DRAW)
    window.canvas.zoom_by(3.0)
    save_to(qtbot, wiring, tmp_path / "plate.hito")
    job, view = document.job, window.canvas.view
    wiring.files.new()
    assert document.path is None
    open_it(qtbot, wiring, tmp_path / "plate.hito")
    assert document.part.entities == job.part.entities and document.part.layers == job.part.layers
    assert document.job.tools == job.tools and document.job.operations == job.operations
    assert document.layer == "holes" and not document.modified and document.part.name == "plate"
    assert (window.canvas.view.scale, window.canvas.view.ox) == (view.scale, pytest.approx(view.ox))
    document.run("delete hole")
    assert len(document.part.entities) == 3
    assert document.part.next_id() == 6


def test_a_drawing_of_another_format_is_saved_as_a_project(qtbot, wiring, samples, tmp_path):
    open_it(qtbot, wiring, samples / "plate.draw")
    wanted: list[Path] = []
    wiring.files.save_controller.choose_file = lambda title, first: wanted.append(first)
    wiring.files.save_controller.save()
    assert wanted[0].name == "plate.hito"
    assert not wiring.files.save_controller._worker.busy


def test_a_copy_leaves_the_document_with_its_own_file(qtbot, wiring, tmp_path):
    wiring.document.run("circle 0,0 5")
    save_to(qtbot, wiring, tmp_path / "a.hito")
    wiring.document.run("circle 0,0 6")
    wiring.files.save_controller.choose_file = lambda title, first: tmp_path / first.name
    with qtbot.waitSignal(wiring.files.save_controller.saved, timeout=WAIT_MS):
        wiring.window_.actions_["save_copy"].trigger()
    assert wiring.document.path == tmp_path / "a.hito" and wiring.document.modified
    assert len(kinds(tmp_path / "a copy.hito")) == 2 and len(kinds(tmp_path / "a.hito")) == 1


def test_another_programs_work_is_not_overwritten_unasked(qtbot, wiring, tmp_path):
    path = tmp_path / "a.hito"
    wiring.document.run("circle 0,0 5")
    save_to(qtbot, wiring, path)
    theirs = path.read_bytes() + b"# theirs\n"
    path.write_bytes(theirs)
    wiring.document.run("circle 0,0 6")
    wiring.files.save_controller.save()
    qtbot.waitUntil(lambda: bool(wiring.window_.notice.buttons), timeout=WAIT_MS)
    assert "changed by another program" in wiring.window_.notice.text.text()
    assert path.read_bytes() == theirs and wiring.document.modified
    with qtbot.waitSignal(wiring.files.save_controller.saved, timeout=WAIT_MS):
        press(wiring, "Replace it")
    assert len(kinds(path)) == 2 and (tmp_path / "a.hito~").read_bytes() == theirs


def test_what_cannot_be_saved_is_told_and_stays_modified(qtbot, wiring, tmp_path):
    wiring.document.run("circle 0,0 5")
    wiring.files.save_controller.choose_file = lambda title, first: tmp_path / "none" / "a.hito"
    with qtbot.waitSignal(wiring.files.save_controller.failed, timeout=WAIT_MS) as caught:
        wiring.files.save_controller.save()
    assert "Cannot write" in caught.args[0] and wiring.document.modified


def test_a_name_that_is_no_projects_gets_the_ending_and_replaces_nothing_unasked(qtbot, wiring, tmp_path):
    wiring.document.run("circle 0,0 5")
    (tmp_path / "plate.dxf").write_bytes(b"theirs")
    save_to(qtbot, wiring, tmp_path / "plate.dxf")
    assert (tmp_path / "plate.dxf").read_bytes() == b"theirs"
    assert wiring.document.path == tmp_path / "plate.dxf.hito"
    wiring.document.run("circle 0,0 6")
    wiring.files.save_controller.choose_file = lambda title, first: tmp_path / "plate.dxf"
    wiring.window_.actions_["save_as"].trigger()
    assert "plate.dxf.hito is there already" in wiring.window_.notice.text.text()
    assert len(kinds(tmp_path / "plate.dxf.hito")) == 1
    with qtbot.waitSignal(wiring.files.save_controller.saved, timeout=WAIT_MS):
        press(wiring, "Replace it")
    assert len(kinds(tmp_path / "plate.dxf.hito")) == 2


def test_the_backup_opens_and_saving_it_asks_for_the_file(qtbot, wiring, tmp_path):
    wiring.document.run("circle 0,0 5")
    save_to(qtbot, wiring, tmp_path / "a.hito")
    wiring.document.run("circle 0,0 6")
    save_to(qtbot, wiring, tmp_path / "a.hito")
    open_it(qtbot, wiring, tmp_path / "a.hito~")
    assert len(wiring.document.part.entities) == 1 and wiring.document.part.name == "a"
    wanted: list[Path] = []
    wiring.files.save_controller.choose_file = lambda title, first: wanted.append(first)
    wiring.files.save_controller.save()
    assert wanted[0] == tmp_path / "a.hito"


def test_saving_twice_at_once_saves_the_last_state(qtbot, wiring, tmp_path):
    wiring.document.run("circle 0,0 5")
    save_to(qtbot, wiring, tmp_path / "a.hito")
    for radius in (6, 7, 8):
        wiring.document.run(f"circle 0,0 {radius}")
        wiring.files.save_controller.save()
    qtbot.waitUntil(lambda: not wiring.document.modified, timeout=WAIT_MS)
    assert len(kinds(tmp_path / "a.hito")) == 4


def test_new_asks_only_when_something_would_be_lost(qtbot, wiring, tmp_path):
    wiring.files.ask_new()
    assert not wiring.window_.notice.buttons
    wiring.document.run("circle 0,0 5")
    wiring.files.ask_new()
    assert [button.text() for button in wiring.window_.notice.buttons] == [
        "Save",
        "Give up the changes",
        "Keep drawing",
    ]
    press(wiring, "Keep drawing")
    assert len(wiring.document.part.entities) == 1
    wiring.files.ask_new()
    wiring.files.save_controller.choose_file = lambda title, first: tmp_path / "a.hito"
    press(wiring, "Save")
    qtbot.waitUntil(lambda: not wiring.document.part.entities, timeout=WAIT_MS)
    assert kinds(tmp_path / "a.hito") == ["Circle"]


def test_closing_can_save(qtbot, wiring, tmp_path):
    wiring.document.run("circle 0,0 5")
    wiring.window_.close()
    assert wiring.window_.isVisible()
    wiring.files.save_controller.choose_file = lambda title, first: tmp_path / "a.hito"
    press(wiring, "Save")
    qtbot.waitUntil(lambda: not wiring.window_.isVisible(), timeout=WAIT_MS)
    assert kinds(tmp_path / "a.hito") == ["Circle"]


def test_closing_can_give_up(qtbot, wiring):
    wiring.document.run("circle 0,0 5")
    wiring.window_.close()
    press(wiring, "Give up the changes")
    assert not wiring.window_.isVisible()


def test_a_damaged_project_is_told_and_left_as_it_is(qtbot, wiring, tmp_path):
    path = tmp_path / "a.hito"
    wiring.document.run("circle 0,0 5")
    save_to(qtbot, wiring, path)
    damaged = path.read_bytes().replace(b"circle 0,0 5", b"circle 0,0")
    path.write_bytes(damaged)
    with qtbot.waitSignal(wiring.files.open_controller.failed, timeout=WAIT_MS) as caught:
        wiring.files.open_file(path)
    assert "a.hito:" in caught.args[0] and "circle 0,0" in caught.args[0]
    assert len(wiring.document.part.entities) == 1 and path.read_bytes() == damaged


def test_recent_files_that_are_there_are_listed_and_can_be_cleared(qtbot, wiring, tmp_path):
    wiring.document.run("circle 0,0 5")
    for name in ("a & b.hito", "c.hito"):
        save_to(qtbot, wiring, tmp_path / name)
    recent = wiring.window_.actions_.recent
    recent.aboutToShow.emit()
    assert [each.text() for each in recent.actions()][:2] == [str(tmp_path / "c.hito"), str(tmp_path / "a && b.hito")]
    os.unlink(tmp_path / "c.hito")
    recent.aboutToShow.emit()
    assert recent.actions()[0].text() == str(tmp_path / "a && b.hito")
    recent.actions()[-1].trigger()
    recent.aboutToShow.emit()
    assert recent.actions()[0].text() == "Nothing was opened yet"


def test_a_project_is_dropped_on_the_window(qtbot, wiring, tmp_path):
    wiring.document.run("circle 0,0 5")
    save_to(qtbot, wiring, tmp_path / "a.hito")
    wiring.files.new()
    data = QMimeData()
    data.setUrls([QUrl.fromLocalFile(str(tmp_path / "a.hito"))])
    buttons, keys = Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier
    with qtbot.waitSignal(wiring.files.open_controller.opened, timeout=WAIT_MS):
        wiring.window_.dropEvent(QDropEvent(QPoint(5, 5), Qt.DropAction.CopyAction, data, buttons, keys))
    assert len(wiring.document.part.entities) == 1


def test_a_project_with_a_post_that_is_not_here_opens(qtbot, wiring, tmp_path):
    wiring.document.run("circle 0,0 5")
    save_to(qtbot, wiring, tmp_path / "a.hito")
    (tmp_path / "a.hito").write_text((tmp_path / "a.hito").read_text().replace('post = "linuxcnc"', 'post = "mine"'))
    wiring.files.new()
    open_it(qtbot, wiring, tmp_path / "a.hito")
    assert wiring.document.job.post == "mine"


def test_backups_can_be_switched_off_and_that_is_remembered(qtbot, wiring, tmp_path):
    from app.core.settings import load_settings

    wiring.document.run("circle 0,0 5")
    wiring.window_.actions_["backups"].trigger()
    for _ in range(2):
        save_to(qtbot, wiring, tmp_path / "a.hito")
    assert [path.name for path in tmp_path.iterdir()] == ["a.hito"]
    assert load_settings().backups is False


def test_the_part_is_named_after_its_file_in_all_that_can_be_undone(qtbot, wiring, tmp_path):
    document = wiring.document
    for line in ("rect 0,0 60,40", "circle 30,20 8", "undo"):
        document.run(line)
    save_to(qtbot, wiring, tmp_path / "lid 蓋.hito")
    assert document.part.name == "lid 蓋" and not document.modified
    assert read_project("x", (tmp_path / "lid 蓋.hito").read_bytes()).state.job.part.name == "lid 蓋"
    for step, names in ((document.redo, 5), (document.undo, 4), (document.undo, 0), (document.redo, 4)):
        step()
        assert document.part.name == "lid 蓋" and len(document.part.entities) == names
    assert not document.modified


def test_the_program_bears_the_name_of_the_file(qtbot, wiring, tmp_path):
    wiring.document.run("rect 0,0 60,40")
    wiring.computation.start()
    qtbot.waitUntil(lambda: wiring.computation.state is ComputationState.CURRENT, timeout=WAIT_MS)
    save_to(qtbot, wiring, tmp_path / "lid.hito")
    assert wiring.computation.state is ComputationState.STALE
    wiring.files.export_controller.choose_file = lambda suffix, post: ExportPlace(tmp_path / "lid.ngc", post)
    with qtbot.waitSignal(wiring.files.export_controller.written, timeout=WAIT_MS):
        wiring.files.export_controller.start()
        qtbot.waitUntil(lambda: wiring.computation.state is ComputationState.CURRENT, timeout=WAIT_MS)
        if wiring.window_.notice.buttons:
            press(wiring, "Write anyway")
    text = (tmp_path / "lid.ngc").read_text()
    assert "Part lid" in text and "untitled" not in text


def test_the_text_of_the_editor_and_the_picture_lie_in_the_file(qtbot, wiring, tmp_path):
    picture = tmp_path / "plan.png"
    image = QImage(20, 10, QImage.Format.Format_RGB32)
    image.fill(0)
    assert image.save(str(picture))
    wiring.document.run("circle 0,0 5")
    wiring.underlay_controller.place(picture)
    wiring.language.control.text = "let r = 5  # the bore's\ncircle 0,0 r"
    wiring.language.control.page.set_replaces(True)
    save_to(qtbot, wiring, tmp_path / "a.hito")
    place, saved = wiring.underlay_controller.underlay, (tmp_path / "a.hito").read_bytes()
    assert b'path = "plan.png"' in saved and not wiring.files.save_controller.beside.unsaved
    wiring.files.new()
    assert wiring.underlay_controller.underlay is None and wiring.language.control.text == ""
    wiring.language.control._kept.clear()
    open_it(qtbot, wiring, tmp_path / "a.hito")
    assert wiring.underlay_controller.underlay == place
    assert (
        wiring.language.control.text == "let r = 5  # the bore's\ncircle 0,0 r"
        and wiring.language.control.page.replaces
    )
    assert not wiring.files.save_controller.beside.unsaved


def test_a_picture_that_has_gone_is_told_and_its_place_is_not_lost(qtbot, wiring, tmp_path):
    place = Underlay(str(tmp_path / "gone.png"), (1.0, 2.0), 0.1, 0.3)
    wiring.document.run("circle 0,0 5")
    save_project(tmp_path / "a.hito", Project(wiring.document.state, beside=ProjectExtras(place)))
    wiring.files.new()
    open_it(qtbot, wiring, tmp_path / "a.hito")
    assert len(wiring.document.part.entities) == 1
    assert "gone.png is not there" in wiring.log.lines[-1].reply and wiring.log.lines[-1].error
    with qtbot.waitSignal(wiring.files.save_controller.saved, timeout=WAIT_MS):
        wiring.files.save_controller.save()
    assert load_project(tmp_path / "a.hito").project.beside.underlay == place
    wiring.window_.actions_["underlay_remove"].trigger()
    assert wiring.underlay_controller.underlay is None and wiring.files.save_controller.beside.unsaved


def test_a_text_that_was_only_typed_is_asked_for_before_the_window_closes(wiring):
    wiring.language.control.text = "circle 0,0 5"
    wiring.window_.close()
    assert wiring.window_.isVisible() and "Close?" in wiring.window_.notice.text.text()
    press(wiring, "Give up the changes")
    assert not wiring.window_.isVisible()
