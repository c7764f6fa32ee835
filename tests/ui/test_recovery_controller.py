"""Work that is in no file: kept beside while the window lives, offered after a crash, gone after a clean end."""

import os
from pathlib import Path

import pytest

from app.core.settings import state_folder
from app.drafting.document import Document
from app.formats.project.files import save_project, stamp_of
from app.formats.project.project import Project, SavedView, read_project
from app.formats.project.recovery import EditedFile, RecoveryFile
from app.ui.shell import start
from app.ui.shell.recovery_controller import WAIT_S
from tests.ui.conftest import WAIT_MS


def kept() -> list[Path]:
    return sorted(state_folder().glob("*.hito")) if state_folder().exists() else []


def keep_now(qtbot, wiring) -> None:
    with qtbot.waitSignal(wiring.recovery_controller.kept, timeout=WAIT_MS):
        wiring.recovery_controller.keep()


@pytest.fixture
def crashed(tmp_path):
    """What another window has left: two circles, in a file with one."""
    document = Document()
    document.run("circle 5,5 2")
    path = tmp_path / "plate.hito"
    stamp = save_project(path, Project(document.state))
    document.run("circle 9,9 2")
    file = RecoveryFile()
    file.keep(Project(document.state, SavedView("view_draw", (7.0, 7.0), 20.0)), EditedFile(path, stamp))
    file._lock._handle, handle = -1, file._lock._handle
    os.close(handle)
    return path


def press(wiring, text: str) -> None:
    next(button for button in wiring.window_.notice.buttons if button.text() == text).click()


def test_the_promise_is_kept_by_the_timer(wiring):
    assert WAIT_S <= 15
    assert not wiring.recovery_controller._timer.isActive()
    wiring.document.run("circle 0,0 5")
    assert wiring.recovery_controller._timer.isActive()
    first = wiring.recovery_controller._timer.remainingTime()
    wiring.document.run("circle 0,0 6")
    assert wiring.recovery_controller._timer.remainingTime() <= first


def test_a_change_is_kept_and_a_saved_document_is_not(qtbot, wiring, tmp_path):
    assert kept() == []
    wiring.document.run("circle 0,0 5")
    keep_now(qtbot, wiring)
    (file,) = kept()
    assert len(read_project("x", file.read_bytes()).state.job.part.entities) == 1
    wiring.files.save_controller.choose_file = lambda title, first: tmp_path / "a.hito"
    with qtbot.waitSignal(wiring.files.save_controller.saved, timeout=WAIT_MS):
        wiring.files.save_controller.save()
    keep_now(qtbot, wiring)
    assert kept() == []


def test_a_text_that_was_only_typed_is_kept_and_comes_back(qtbot, wiring):
    wiring.language.control.text = "circle 0,0 5  # not run"
    assert wiring.recovery_controller._timer.isActive()
    keep_now(qtbot, wiring)
    (file,) = kept()
    left = RecoveryFile()
    left.keep(read_project("x", file.read_bytes()), EditedFile())
    os.close(left._lock._handle)
    wiring.language.control.text = ""
    wiring.recovery_controller.offer()
    with qtbot.waitSignal(wiring.recovery_controller.kept, timeout=WAIT_MS):
        press(wiring, "Recover")
    assert wiring.language.control.text == "circle 0,0 5  # not run"


def test_a_clean_end_leaves_nothing(qtbot, wiring):
    wiring.document.run("circle 0,0 5")
    keep_now(qtbot, wiring)
    wiring.window_.close()
    press(wiring, "Give up the changes")
    assert list(state_folder().iterdir()) == []


def test_what_a_crash_left_comes_back(qtbot, wiring, crashed):
    window = wiring.window_
    wiring.recovery_controller.offer()
    assert "ended before plate.hito was saved" in window.notice.text.text()
    assert [button.text() for button in window.notice.buttons] == ["Recover", "Discard", "Later"]
    with qtbot.waitSignal(wiring.recovery_controller.kept, timeout=WAIT_MS):
        press(wiring, "Recover")
    assert len(wiring.document.part.entities) == 2
    assert wiring.document.modified and wiring.document.path == crashed
    assert window.canvas.view.scale == 20.0
    assert len(kept()) == 1
    with qtbot.waitSignal(wiring.files.save_controller.saved, timeout=WAIT_MS):
        wiring.files.save_controller.save()
    assert len(read_project("x", crashed.read_bytes()).state.job.part.entities) == 2


def test_a_start_offers_it_over_the_last_files(qtbot, wiring, crashed):
    start.begin(wiring, None)
    assert "plate.hito" in wiring.window_.notice.text.text() and wiring.window_.notice.isVisible()
    assert not wiring.window_.worker.busy
    assert wiring.window_.views.starting
    press(wiring, "Recover")
    qtbot.waitUntil(lambda: len(wiring.document.part.entities) == 2, timeout=WAIT_MS)
    assert not wiring.window_.views.starting


def test_what_is_opened_instead_leaves_the_offer(qtbot, wiring, crashed):
    """The window's own close of the bar took it away for good, as if the user had closed it."""
    wiring.recovery_controller.offer()
    wiring.files.new()
    notice = wiring.window_.notice
    assert notice.isVisible() and "ended before plate.hito" in notice.sentence
    wiring.files.open_sample()
    qtbot.waitUntil(lambda: "fig. 2 of the 1986 patent" in notice.sentence, timeout=WAIT_MS)
    notice.hide()
    assert notice.isVisible() and "ended before plate.hito" in notice.sentence


def test_a_start_with_a_file_offers_it_once_that_is_open(qtbot, wiring, crashed):
    start.begin(wiring, crashed)
    qtbot.waitUntil(lambda: "ended before plate.hito" in wiring.window_.notice.text.text(), timeout=WAIT_MS)
    assert len(wiring.document.part.entities) == 1
    press(wiring, "Recover")
    qtbot.waitUntil(lambda: len(wiring.document.part.entities) == 2, timeout=WAIT_MS)


def test_the_file_that_changed_after_the_crash_is_not_overwritten(qtbot, wiring, crashed):
    crashed.write_bytes(crashed.read_bytes() + b"# newer\n")
    wiring.recovery_controller.offer()
    with qtbot.waitSignal(wiring.recovery_controller.kept, timeout=WAIT_MS):
        press(wiring, "Recover")
    stamp = stamp_of(crashed)
    wiring.files.save_controller.save()
    qtbot.waitUntil(lambda: "changed by another program" in wiring.window_.notice.text.text(), timeout=WAIT_MS)
    assert stamp_of(crashed) == stamp


def test_discard_takes_it_away(wiring, crashed):
    wiring.recovery_controller.offer()
    press(wiring, "Discard")
    assert kept() == []
    wiring.recovery_controller.offer()
    assert wiring.window_.notice.isHidden()


def test_later_leaves_it_for_the_next_start(wiring, crashed):
    wiring.recovery_controller.offer()
    press(wiring, "Later")
    assert len(kept()) == 1 and not wiring.document.part.entities
    wiring.recovery_controller.offer()
    assert "plate.hito" in wiring.window_.notice.text.text()


def test_a_damaged_recovery_file_is_told_and_stops_nothing(qtbot, wiring, crashed):
    (file,) = kept()
    file.write_bytes(b"\xff\xff")
    wiring.recovery_controller.offer()
    assert "a new drawing" in wiring.window_.notice.text.text()
    press(wiring, "Recover")
    qtbot.waitUntil(lambda: "damaged" in wiring.window_.notice.text.text(), timeout=WAIT_MS)
    assert kept() == [] and file.with_suffix(".damaged").read_bytes() == b"\xff\xff"


def test_recovering_asks_before_it_replaces_a_drawing(wiring, crashed):
    wiring.document.run("circle 0,0 1")
    wiring.recovery_controller.offer()
    press(wiring, "Recover")
    assert wiring.window_.notice.text.text().startswith("Recover?")
    press(wiring, "Keep drawing")
    assert len(wiring.document.part.entities) == 1


def test_a_folder_that_cannot_be_written_is_told_once(qtbot, wiring, monkeypatch, tmp_path):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("HITOFUDE_CONFIG", str(tmp_path / "file"))
    for radius in (1, 2):
        wiring.document.run(f"circle 0,0 {radius}")
        wiring.recovery_controller.keep()
        qtbot.waitUntil(lambda: not wiring.recovery_controller._worker.busy, timeout=WAIT_MS)
    assert [line.command for line in wiring.log.lines].count("recovery") == 1
