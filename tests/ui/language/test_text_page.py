"""The page of the text: typed, tried, run, undone, kept."""

import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QTextCharFormat

from app.core.resources import resource
from app.drafting.document import Document
from app.drafting.language.write import draw_text
from app.formats.draw.draw import read_draw

CONTROL = Qt.KeyboardModifier.ControlModifier
SAMPLE = resource("samples", "plate.draw").read_text(encoding="utf-8")


@pytest.fixture
def text(qtbot, wiring):
    control = wiring.language.control
    control.open()
    return control


def settle(qtbot, text) -> None:
    """Wait until what was typed has been tried."""
    qtbot.waitUntil(lambda: not text.trial_runner.busy, timeout=10_000)


def type_lines(qtbot, text, *lines: str) -> None:
    for line in lines:
        qtbot.keyClicks(text.page.editor, line)
        qtbot.keyClick(text.page.editor, Qt.Key.Key_Escape)
        qtbot.keyClick(text.page.editor, Qt.Key.Key_Return)


def shown(wiring):
    return wiring.window_.canvas._trial


def test_the_key_opens_the_page_and_the_keyboard_is_there(qtbot, wiring) -> None:
    wiring.window_.actions_["text"].trigger()
    assert wiring.window_.side.page == "Text"
    qtbot.waitUntil(wiring.language.control.page.editor.hasFocus)


def test_what_is_typed_is_shown_before_it_is_drawn(qtbot, wiring, text) -> None:
    type_lines(qtbot, text, "rect 0,0 40,20", "circle 20,10 5")
    settle(qtbot, text)
    assert len(shown(wiring).added) == 5 and not wiring.document.part.entities
    assert text.page.verdict.text() == "5 curves would come; Ctrl+Enter draws."
    wiring.window_.side.show_page("Job")
    assert not shown(wiring).added, "shown although the text is not seen"


def test_what_is_wrong_is_underlined_in_place_and_a_click_goes_there(qtbot, wiring, text) -> None:
    type_lines(qtbot, text, "circle 0,0 5", "line 0,0 wide", "rect 0,0 1,1")
    settle(qtbot, text)
    assert text.page.problem is not None and (text.page.problem.line, text.page.problem.column) == (2, 10)
    assert text.page.verdict.text().startswith("Line 2, column 10: ") and text.page.editor.gutter.wrong == 2
    marks = [
        mark
        for mark in text.page.editor.extraSelections()
        if mark.format.underlineStyle() == QTextCharFormat.UnderlineStyle.WaveUnderline
    ]
    assert [mark.cursor.selectedText() for mark in marks] == ["wide"]
    qtbot.mouseClick(text.page.verdict, Qt.MouseButton.LeftButton)
    cursor = text.page.editor.textCursor()
    assert (cursor.blockNumber(), cursor.positionInBlock()) == (1, 9)
    qtbot.keyClick(text.page.editor, Qt.Key.Key_Return, CONTROL)
    assert not wiring.document.part.entities, "run although it is wrong"


def test_the_next_key_leaves_a_long_text_and_the_last_one_is_shown(qtbot, wiring, text) -> None:
    text.text = "repeat 100000 as k; circle k,0 1; end"
    qtbot.waitUntil(lambda: text.trial_runner.worker.busy, timeout=10_000)
    text.text = "circle 0,0 1"
    assert not text.trial_runner.worker.busy
    settle(qtbot, text)
    assert len(shown(wiring).added) == 1
    qtbot.wait(50)
    assert not text.trial_runner._alive


def test_run_adds_and_is_undone_as_one_step(qtbot, wiring, text) -> None:
    wiring.document.run("line 0,0 9,9")
    text.text = SAMPLE
    qtbot.keyClick(text.page.editor, Qt.Key.Key_Return, CONTROL)
    qtbot.waitUntil(lambda: len(wiring.document.part.entities) > 1, timeout=10_000)
    assert len(wiring.document.part.entities) == 1 + len(read_draw(SAMPLE.encode()).part.entities)
    assert len(wiring.document.log) == 2 and text.page.verdict.text() == "This is drawn."
    wiring.document.undo()
    assert len(wiring.document.part.entities) == 1


def test_run_replaces_the_drawing_and_numbers_begin_anew(qtbot, wiring, text) -> None:
    wiring.document.run("line 0,0 9,9")
    text.text = "circle 5,5 2\ncircle 9,9 1\ndelete 1"
    text.page.set_replaces(True)
    settle(qtbot, text)
    assert len(shown(wiring).gone) == 1 and len(shown(wiring).added) == 1
    text.run()
    qtbot.waitUntil(lambda: wiring.document.part.entities[0].id == 2, timeout=10_000)
    wiring.document.undo()
    assert [entity.id for entity in wiring.document.part.entities] == [1]


def test_the_text_of_the_drawing_draws_it(qtbot, wiring, text) -> None:
    wiring.document.run(SAMPLE)
    part = wiring.document.part
    text.fill_from_drawing()
    assert text.text == draw_text(part).text and text.page.replaces
    settle(qtbot, text)
    assert not shown(wiring).added and not shown(wiring).gone
    text.page.editor.undo()
    assert text.text == "", "what stood there before is lost"


def test_the_log_saved_as_a_file_draws_the_identical_part(qtbot, wiring, text, tmp_path) -> None:
    document = wiring.document
    for line in (
        "rect 0,0 40,20 round 3",
        "circle 20,10 5 as hole",
        "line 50,0 60,5",
        "undo",
        "layer holes",
        "circle 8,10 2",
    ):
        document.run(line)
    document.select([document.part.entities[-1].id])
    wiring.run("array 3 1 @12,0")
    wiring.run("repeat 2 as k; circle 20,30+9*k 2; end")
    document.select([1])
    wiring.run("delete")
    text.fill_from_log()
    text.save_file(tmp_path / "log.draw")
    again = Document()
    again.run_script((tmp_path / "log.draw").read_text(encoding="utf-8"))
    assert again.part == document.part
    assert "select 10" in text.text and "undo" not in text.text and "line 50,0" not in text.text


def test_the_text_is_kept_for_each_drawing(qtbot, wiring, text, tmp_path) -> None:
    document, job = wiring.document, wiring.document.job
    text.text = "circle 1,1 1"
    document.load(job, tmp_path / "a.dxf")
    assert text.text == ""
    text.text = "circle 2,2 2"
    document.load(job)
    assert text.text == "circle 1,1 1"
    document.load(job, tmp_path / "a.dxf")
    assert text.text == "circle 2,2 2"


def test_files_that_are_no_text_are_told_and_leave_the_text(qtbot, text, tmp_path) -> None:
    text.text = "circle 1,1 1"
    (tmp_path / "x.draw").write_bytes(b"\xff\xfe\x00")
    text.open_file(tmp_path / "x.draw")
    assert "UTF-8" in text.page.verdict.text() and text.text == "circle 1,1 1"
    text.open_file(tmp_path / "none.draw")
    assert "none.draw" in text.page.verdict.text()


def test_blocks_are_indented_and_closed_while_typing(qtbot, text) -> None:
    type_lines(qtbot, text, "repeat 3 as k", "if k > 1", "circle k,0 1", "else", "line 0,0 1,k", "end", "end")
    assert text.text == "repeat 3 as k\n  if k > 1\n    circle k,0 1\n  else\n    line 0,0 1,k\n  end\nend\n"


def test_an_offer_is_taken_by_key_and_by_click(qtbot, text) -> None:
    editor = text.page.editor
    qtbot.keyClicks(editor, "cir")
    assert (
        editor.list.isVisible() and editor.list.current is not None and editor.list.current.form.startswith("circle P")
    )
    qtbot.keyClick(editor, Qt.Key.Key_Return)
    qtbot.keyClicks(editor, "0,0 sq")
    assert editor.list.isVisible()
    item = editor.list.visualItemRect(editor.list.item(0)).center()
    qtbot.mouseClick(editor.list.viewport(), Qt.MouseButton.LeftButton, pos=item)
    assert text.text == "circle 0,0 sqrt(" and not editor.list.isVisible()
    qtbot.keyClick(editor, Qt.Key.Key_Space, CONTROL)
    assert editor.list.count() > 20
    qtbot.keyClick(editor, Qt.Key.Key_Escape)
    assert not editor.list.isVisible()


def test_remarks_and_find_by_key(qtbot, text) -> None:
    text.text = "circle 1,1 1\nline 0,0 1,1"
    text.page.editor.selectAll()
    qtbot.keyClick(text.page.editor, Qt.Key.Key_Slash, CONTROL)
    assert text.text == "# circle 1,1 1\n# line 0,0 1,1"
    qtbot.keyClick(text.page.editor, Qt.Key.Key_F, CONTROL)
    qtbot.keyClicks(text.page.finder.edit, "line")
    assert text.page.finder.count.text() == "1 of 1" and text.page.editor.textCursor().blockNumber() == 1


def test_only_lines_in_sight_are_coloured(qtbot, text) -> None:
    text.text = "circle 1,1 1\n" * 20_000
    document = text.page.editor.document()
    assert document.findBlockByNumber(0).layout().formats()
    assert not document.findBlockByNumber(15_000).layout().formats()
    text.page.editor.go_to(15_001)
    assert document.findBlockByNumber(15_000).layout().formats()


def test_the_manual_opens_at_its_own_page(wiring) -> None:
    wiring.window_.actions_["manual"].trigger()
    assert wiring.language.help.isVisible() and wiring.language.help.page == "manual"
    wiring.language.help.close()


def test_help_on_the_word_under_the_cursor(qtbot, wiring, text) -> None:
    text.text = "arc 0,0 5,5 radius 4"
    text.page.editor.go_to(1, 2)
    qtbot.keyClick(text.page.editor, Qt.Key.Key_F1)
    window = wiring.language.help
    assert window.isVisible() and window.page == "language"
    assert window.browser.textCursor().selectedText().startswith("arc P P centre P")
    window.close()
    wiring.window_.command_line.edit.setText("circle foot(p, c) 3")
    wiring.window_.command_line.edit.setCursorPosition(9)
    qtbot.keyClick(wiring.window_.command_line.edit, Qt.Key.Key_F1)
    assert window.isVisible() and window.browser.textCursor().selectedText() == "foot("
