"""The command line: blocks, pasting, completion, what was typed before, the words of tools, and its log."""

import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QGuiApplication

from app.drafting.document import Document
from app.ui.shell.bars.command_completion import completions
from app.ui.shell.bars.command_line import GOES_ON, CommandLine
from app.ui.views.canvas.modes import CanvasTool

RETURN, TAB = Qt.Key.Key_Return, Qt.Key.Key_Tab


@pytest.fixture
def line(qtbot) -> CommandLine:
    made = CommandLine()
    qtbot.addWidget(made)
    made.resize(1000, 100)
    made.show()
    return made


@pytest.fixture
def entered(line) -> list[str]:
    got: list[str] = []
    line.entered.connect(got.append)
    return got


def type_line(qtbot, line: CommandLine, text: str) -> None:
    qtbot.keyClicks(line.edit, text)
    qtbot.keyClick(line.edit, RETURN)


def paste(qtbot, line: CommandLine, text: str) -> None:
    QGuiApplication.clipboard().setText(text)
    qtbot.keyClick(line.edit, Qt.Key.Key_V, Qt.KeyboardModifier.ControlModifier)


def test_a_block_is_entered_when_its_last_end_is_typed(qtbot, line, entered):
    line.set_prompt("Select")
    for text in ("repeat 3 as k", "if k > 1", "circle 10*k,0 2"):
        type_line(qtbot, line, text)
    assert not entered and line.sign.text() == "…" and line.edit.placeholderText() == GOES_ON
    assert line.pending.isVisible() and line.pending.text() == "repeat 3 as k ; if k > 1 ; circle 10*k,0 2"
    type_line(qtbot, line, "end")
    assert not entered
    type_line(qtbot, line, "end")
    assert entered == ["repeat 3 as k\nif k > 1\ncircle 10*k,0 2\nend\nend"]
    assert line.sign.text() == ">" and not line.pending.isVisible() and line.edit.placeholderText() == "Select"
    document = Document()
    document.run(entered[0])
    assert len(document.part.entities) == 1
    qtbot.keyClick(line.edit, Qt.Key.Key_Up)
    assert line.edit.text() == "repeat 3 as k; if k > 1; circle 10*k,0 2; end; end"
    qtbot.keyClick(line.edit, RETURN)
    document.run(entered[1])
    assert len(document.part.entities) == 2


def test_escape_gives_a_block_up_and_a_whole_block_in_a_line_is_one(qtbot, line, entered):
    type_line(qtbot, line, "repeat 3")
    qtbot.keyClick(line.edit, Qt.Key.Key_Escape)
    type_line(qtbot, line, "repeat 2; circle 0,0 1; end")
    assert entered == ["repeat 2; circle 0,0 1; end"]


def test_an_end_in_a_remark_or_in_quotes_closes_nothing(qtbot, line, entered):
    type_line(qtbot, line, "repeat 2 # end")
    type_line(qtbot, line, 'layer "end"')
    assert not entered
    type_line(qtbot, line, "end")
    assert len(entered) == 1


def test_several_pasted_lines_are_a_block(qtbot, line, entered):
    paste(qtbot, line, "let r = 5\r\ncircle 0,0 r\n\n  circle 20,0 r\n")
    assert entered == ["let r = 5\ncircle 0,0 r\n  circle 20,0 r"] and line.edit.text() == ""
    paste(qtbot, line, "circle 1,1 1")
    assert line.edit.text() == "circle 1,1 1" and len(entered) == 1
    line.edit.clear()
    paste(qtbot, line, "repeat 2\ncircle 0,0 1\n")
    assert len(entered) == 1 and line.sign.text() == "…"
    type_line(qtbot, line, "end")
    assert entered[-1] == "repeat 2\ncircle 0,0 1\nend"


def test_pasted_rows_of_coordinates_are_points_one_by_one(qtbot, line, entered):
    paste(qtbot, line, "0,0\n10\t5.5\n@5,0\n@3<45")
    assert entered == ["0,0", "10,5.5", "@5,0", "@3<45"]


def test_up_and_down_keep_what_is_being_typed(qtbot, line):
    for text in ("circle 0,0 1", "circle 0,0 2"):
        type_line(qtbot, line, text)
    qtbot.keyClicks(line.edit, "rect")
    seen = []
    for key in (Qt.Key.Key_Up, Qt.Key.Key_Up, Qt.Key.Key_Up, Qt.Key.Key_Down, Qt.Key.Key_Down, Qt.Key.Key_Down):
        qtbot.keyClick(line.edit, key)
        seen.append(line.edit.text())
    assert seen == ["circle 0,0 2", "circle 0,0 1", "circle 0,0 1", "circle 0,0 2", "rect", "rect"]


def complete(qtbot, line: CommandLine, text: str) -> str:
    line.edit.clear()
    qtbot.keyClicks(line.edit, text)
    qtbot.keyClick(line.edit, TAB)
    return line.edit.text()


@pytest.fixture
def knowing(line) -> CommandLine:
    document = Document()
    document.run_script(
        'layer holes\nlayer "bolt holes"\nlet width = 3\ncircle 0,0 2 as bore\ndefine washer(c)\ncircle c 3\nend'
    )
    line.completions = lambda text: completions(text, document)
    return line


def test_tab_completes_commands_names_and_layers(qtbot, knowing):
    assert complete(qtbot, knowing, "circ") == "circle "
    assert complete(qtbot, knowing, "was") == "washer "
    assert complete(qtbot, knowing, "circle 0,0 wid") == "circle 0,0 width"
    assert complete(qtbot, knowing, "layer ho") == "layer holes"
    assert complete(qtbot, knowing, "hide bol") == 'hide "bolt holes"'
    assert complete(qtbot, knowing, 'rename layer "bo') == 'rename layer "bolt holes"'
    assert complete(qtbot, knowing, "set bore dia") == "set bore diameter "
    assert complete(qtbot, knowing, "set bor") == "set bore "
    assert complete(qtbot, knowing, "set 1 layer ho") == "set 1 layer holes"
    assert complete(qtbot, knowing, "let w = sq") == "let w = sqrt("
    assert complete(qtbot, knowing, "xyzzy") == "xyzzy"


def test_where_there_is_a_choice_it_is_offered(qtbot, knowing):
    assert complete(qtbot, knowing, "poly") == "poly"
    words = [knowing.offers.item(at).text() for at in range(knowing.offers.count())]
    assert "polyline" in words and "polygon" in words and knowing.offers.isVisible()
    while knowing.offers.currentItem().text() != "polyline":
        qtbot.keyClick(knowing.edit, TAB)
    qtbot.keyClick(knowing.edit, RETURN)
    assert knowing.edit.text() == "polyline " and knowing.offers.isHidden()
    assert complete(qtbot, knowing, "pol") == "poly"
    assert knowing.offers.isVisible()
    qtbot.keyClick(knowing.edit, Qt.Key.Key_Escape)
    assert knowing.offers.isHidden() and knowing.edit.text().startswith("pol")
    complete(qtbot, knowing, "pol")
    qtbot.keyClicks(knowing.edit, "y")
    assert knowing.offers.isHidden()


def test_words_of_the_tool_are_buttons(qtbot, line, entered):
    chosen = []
    line.chosen.connect(chosen.append)
    line.set_options(("copy", "radius"))
    qtbot.mouseClick(line.options["radius"], Qt.MouseButton.LeftButton)
    assert chosen == ["radius"] and entered == []
    line.set_options(("copy", "radius"), on={"copy"})
    assert [bool(button.property("on")) for button in line.options.values()] == [True, False]
    line.set_options(())
    assert not line.options


def test_the_log_is_copied_and_put_back(qtbot, wiring):
    log, line = wiring.window_.command_line.log, wiring.window_.command_line
    for text in ("circle 0,0 5", "repeat 2 as k\ncircle 10*k,20 3\nend", "circle 0,0 -1"):
        wiring.run(text)
    assert [each.command for each in log.lines[-3:]] == [
        "circle 0,0 5",
        "repeat 2 as k\ncircle 10*k,20 3\nend",
        "circle 0,0 -1",
    ]
    last = log.model().rowCount() - 1
    place = log.visualRect(log.model().index(last, 0)).center()
    qtbot.mouseClick(log.viewport(), Qt.MouseButton.LeftButton, pos=place)
    qtbot.mouseDClick(log.viewport(), Qt.MouseButton.LeftButton, pos=place)
    assert line.edit.text() == "circle 0,0 -1" and line.edit.hasFocus()
    log.setFocus()
    log.setCurrentIndex(log.model().index(last - 1, 0))
    qtbot.keyClick(log, RETURN)
    assert line.edit.text() == "repeat 2 as k; circle 10*k,20 3; end"
    log.selectAll()
    qtbot.keyClick(log, Qt.Key.Key_C, Qt.KeyboardModifier.ControlModifier)
    assert QGuiApplication.clipboard().text().splitlines()[-5:] == [
        "circle 0,0 5",
        "repeat 2 as k",
        "circle 10*k,20 3",
        "end",
        "circle 0,0 -1",
    ]
    log.copy_with_replies()
    assert "greater than 0" in QGuiApplication.clipboard().text()


def test_the_newest_line_of_a_long_log_is_seen(qtbot, wiring):
    log = wiring.window_.command_line.log
    for k in range(40):
        wiring.run(f"line 0,0 10,{k}")
    qtbot.waitUntil(lambda: log.model().rowCount() == 40)  # what the first line imports may take it to another thread
    newest = log.model().index(log.model().rowCount() - 1, 0)
    assert log.viewport().rect().contains(log.visualRect(newest))


def test_tab_leaves_an_empty_line(qtbot, wiring):
    edit = wiring.window_.command_line.edit
    edit.setFocus()
    qtbot.keyClick(edit, TAB)
    assert not edit.hasFocus()


def test_the_words_of_the_tool_in_hand_come_and_go(wiring):
    canvas, line = wiring.window_.canvas, wiring.window_.command_line
    for tool in (CanvasTool.LINE, CanvasTool.CIRCLE, CanvasTool.SELECT):
        canvas.set_tool(tool)
        assert tuple(line.options) == (canvas.runner.tool.options if canvas.runner.tool is not None else ())


def test_a_typed_answer_leaves_the_keys_with_the_canvas_and_a_whole_line_leaves_them_here(qtbot, wiring) -> None:
    window = wiring.window_
    line, canvas = window.command_line.edit, window.canvas
    canvas.setFocus()
    for text in ("circle", "1,2", "5"):
        typed_into = line if text[0].isalpha() else canvas
        qtbot.keyClick(canvas, text[0])
        assert window.focusWidget() is typed_into
        qtbot.keyClicks(typed_into, text[1:])
        qtbot.keyClick(typed_into, Qt.Key.Key_Return)
        assert window.focusWidget() is canvas
    assert wiring.document.log[-1].command == "circle 1,2 5"
    canvas.cancel()
    line.setFocus()
    qtbot.keyClicks(line, "line 0,0 5,5")
    qtbot.keyClick(line, Qt.Key.Key_Return)
    assert window.focusWidget() is line


@pytest.mark.parametrize("word", ["fillet", "f", "Slot"])
def test_letters_typed_on_the_canvas_lose_nothing(qtbot, wiring, word) -> None:
    window = wiring.window_
    window.canvas.setFocus()
    for letter in word:
        qtbot.keyClicks(window.focusWidget(), letter)
    assert window.focusWidget() is window.command_line.edit
    assert window.command_line.edit.text() == word


def test_a_number_that_tab_ends_goes_into_the_first_box_at_the_pointer(qtbot, wiring) -> None:
    window = wiring.window_
    line, canvas = window.command_line.edit, window.canvas
    canvas.set_tool(CanvasTool.RECTANGLE)
    assert canvas.type_text("0,0")
    line.setFocus()
    qtbot.keyClicks(line, "80")
    qtbot.keyClick(line, TAB)
    assert line.text() == "" and window.focusWidget() is canvas
    qtbot.keyClicks(canvas, "50")
    qtbot.keyClick(canvas, Qt.Key.Key_Return)
    assert wiring.document.log[-1].command == "rect 0,0 80,50"


def test_words_for_the_drawing_are_typed_where_blanks_are_letters(wiring) -> None:
    window = wiring.window_
    window.canvas.set_tool(CanvasTool.TEXT)
    window.command_line.edit.setFocus()
    window.command_line.entered.emit("0,0")
    assert window.focusWidget() is window.command_line.edit


def test_what_the_mouse_did_wrong_is_told_without_a_column(qtbot, wiring) -> None:
    said: list[str] = []
    wiring.window_.canvas.message.connect(said.append)
    wiring.document.run("line 0,0 10,0")
    wiring.window_.canvas.runner._run("trim 1 5,0")
    assert said and "olumn" not in said[-1]


def test_an_unknown_word_is_answered_with_those_that_are_like_it(qtbot, wiring) -> None:
    for text, answer in (("lime 0,0 1,1", "'lime' is no command; try line"), ("qqqq 1", "F1 lists them all")):
        said = len(wiring.document.log)
        wiring.window_.command_line.entered.emit(text)
        qtbot.waitUntil(lambda said=said: len(wiring.document.log) > said)  # the first line may go to another thread
        assert answer in wiring.document.log[-1].reply


def test_what_was_begun_goes_when_a_tool_is_taken_or_esc_is_pressed_on_the_canvas(qtbot, wiring) -> None:
    canvas, edit = wiring.window_.canvas, wiring.window_.command_line.edit
    qtbot.keyClicks(canvas, "f")
    assert edit.text() == "f"
    wiring.window_.actions_["tool_circle"].trigger()
    assert edit.text() == ""
    qtbot.keyClicks(edit, "12,")
    qtbot.keyClick(canvas, Qt.Key.Key_Escape)
    assert edit.text() == ""


def test_escape_gives_up_what_is_typed_before_the_tool(qtbot, wiring):
    canvas, edit = wiring.window_.canvas, wiring.window_.command_line.edit
    wiring.window_.actions_["tool_text"].trigger()
    canvas.type_text("5,5")
    qtbot.keyClicks(edit, "Mt Fuij")
    qtbot.keyClick(edit, Qt.Key.Key_Escape)
    assert edit.text() == "" and "type the words" in canvas.prompt
    qtbot.keyClick(edit, Qt.Key.Key_Escape)
    assert "lower left of the words" in canvas.prompt


def test_fonts_are_offered_when_one_is_asked_for(qtbot, wiring):
    canvas, line = wiring.window_.canvas, wiring.window_.command_line
    wiring.window_.actions_["tool_text"].trigger()
    qtbot.mouseClick(line.options["font"], Qt.MouseButton.LeftButton)
    worker = wiring.command_line_controller.worker
    qtbot.waitUntil(lambda: not worker.busy, timeout=20_000)
    canvas.type_text("5,5")
    assert line.offers is None or line.offers.isHidden(), "words are asked for"
    line.entered.emit("Mt Fuji")
    assert line.offers.isVisible() and line.offers.current is not None
    line._answer_offers(Qt.Key.Key_Return)
    line.edit.setText("")
    begun, found = line.completions("serif bold it")
    assert begun == "serif bold it" and [offer.word for offer in found] == ["DejaVu Serif Bold Italic"]
    line.entered.emit("DejaVu Serif Bold Italic")
    assert wiring.log.lines[-1].command == 'text 5,5 10 "Mt Fuji" font "DejaVu Serif Bold Italic"'


def test_an_option_is_lit_also_while_a_selection_is_asked_for(qtbot, wiring):
    """The prompt does not tell of it then, and nothing else was looked at."""
    canvas, line = wiring.window_.canvas, wiring.window_.command_line
    wiring.document.run("rect 0,0 60,40")
    canvas.set_tool(CanvasTool.ROTATE)
    assert not line.options["copy"].property("on")
    qtbot.mouseClick(line.options["copy"], Qt.MouseButton.LeftButton)
    assert line.options["copy"].property("on")
    line.edit.setText("copy")
    qtbot.keyClick(line.edit, Qt.Key.Key_Return)
    assert not line.options["copy"].property("on"), "typed, it is switched off again"
