"""The drawing's page comes to the front when it is asked for, and only then."""

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QLineEdit

from app.ui.framework.view import View


def test_keys_bring_the_page_and_its_sections(qtbot, wiring):
    window = wiring.window_
    wiring.document.run("line 0,0 10,0")
    wiring.document.run("select all")
    assert window.side.page == "Job"
    qtbot.keyClick(window, Qt.Key.Key_I, Qt.KeyboardModifier.ControlModifier)
    assert window.side.page == "Drawing"
    properties = window.drawing_page.properties
    qtbot.waitUntil(
        lambda: isinstance(window.focusWidget(), QLineEdit) and properties.isAncestorOf(window.focusWidget())
    )
    window.side.show_page("Job")
    qtbot.keyClick(window, Qt.Key.Key_H, Qt.KeyboardModifier.ControlModifier)
    assert window.side.page == "Drawing"
    qtbot.waitUntil(lambda: window.drawing_page.history.list.hasFocus())
    qtbot.keyClick(window, Qt.Key.Key_F11)
    qtbot.waitUntil(lambda: window.drawing_page.layers.isAncestorOf(window.focusWidget()))


def test_the_drawing_comes_along_where_the_page_has_no_place(wiring):
    wiring.document.run("line 0,0 10,0")
    wiring.display_controller.show_view(View.STAGES)
    assert wiring.window_.side.isHidden()
    wiring.window_.actions_["layers"].trigger()
    assert wiring.display_controller.view is View.DRAW and wiring.window_.side.page == "Drawing"


def test_a_layer_with_curves_goes_after_a_question(qtbot, wiring):
    window = wiring.window_
    wiring.document.run("layer holes; circle 0,0 5")
    window.actions_["layers"].trigger()
    window.drawing_page.layers.remove("holes")
    assert "1 curve on it" in window.notice.text.text()
    qtbot.mouseClick(window.notice.buttons[1], Qt.MouseButton.LeftButton)
    assert len(wiring.document.part.layers) == 2
    window.drawing_page.layers.remove("holes")
    qtbot.mouseClick(window.notice.buttons[0], Qt.MouseButton.LeftButton)
    assert [layer.name for layer in wiring.document.part.layers] == ["0"] and not wiring.document.part.entities


def test_ten_thousand_curves_are_told_of_without_delay(wiring, qtbot):
    wiring.document.run("circle 0,0 2; array 100 100 @5,5 1")
    wiring.window_.actions_["properties"].trigger()
    wiring.document.run("select all")
    page = wiring.window_.drawing_page
    qtbot.waitUntil(lambda: page.properties.figures.keys() >= {"Kinds"})
    assert page.properties.figures["Kinds"].value.text() == "10\u2009000 circles"


def looked(qtbot, wiring, tolerance: str = "0.01"):
    window = wiring.window_
    window.actions_["clean_up"].trigger()
    section = window.drawing_page.cleanup
    section.tolerance.edit.setFocus()
    section.tolerance.edit.selectAll()
    qtbot.keyClicks(section.tolerance.edit, tolerance)
    qtbot.mouseClick(section.look, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: not wiring.cleanup_controller.worker.busy and section.words.text() != "", timeout=20_000)
    return section


def test_faults_are_listed_shown_and_mended(qtbot, wiring):
    wiring.document.run("line 0,0 10,0; line 10.006,0 10,10; circle 5,5 2; circle 5,5 2")
    section = looked(qtbot, wiring)
    assert section.words.text() == "1 duplicate, 1 gap. Mending: 1 duplicate removed, 1 gap closed."
    assert [section.list.item(at).text() for at in range(section.list.count())] == [
        "Duplicate at 3,5: exact",
        "Gap at 10.003,0: 0.0060 mm wide",
    ]
    section.list.itemClicked.emit(section.list.item(1))
    assert wiring.document.selection == {1, 2} and section.list.isVisible()
    qtbot.mouseClick(section.mend, Qt.MouseButton.LeftButton)
    assert wiring.document.log[-1].command == "heal 0.01" and wiring.document.part.curve(1).end == (10.003, 0)
    assert section.list.isHidden() and section.words.isHidden()
    wiring.document.undo()
    assert len(wiring.document.part.entities) == 4


def test_a_clean_drawing_says_so_and_a_change_takes_the_answer_away(qtbot, wiring):
    wiring.document.run("line 0,0 10,0")
    section = looked(qtbot, wiring, "0.02")
    assert section.words.text() == "No fault within 0.02 mm." and section.mend.isHidden()
    wiring.document.run("circle 0,0 5")
    assert section.words.isHidden()
