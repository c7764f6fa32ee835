"""The drawing's page comes to the front when it is asked for, and only then."""

from PySide6.QtCore import Qt

from app.ui.views import View


def test_keys_bring_the_page_and_its_sections(qtbot, wiring):
    window = wiring.window_
    wiring.run("line 0,0 10,0")
    wiring.run("select all")
    assert window.side.page == "Job"
    qtbot.keyClick(window, Qt.Key.Key_I, Qt.KeyboardModifier.ControlModifier)
    assert window.side.page == "Drawing"
    qtbot.waitUntil(lambda: window.drawing_page.properties.layer.box.hasFocus())
    window.side.show_page("Job")
    qtbot.keyClick(window, Qt.Key.Key_H, Qt.KeyboardModifier.ControlModifier)
    assert window.side.page == "Drawing"
    qtbot.waitUntil(lambda: window.drawing_page.history.list.hasFocus())
    qtbot.keyClick(window, Qt.Key.Key_F11)
    qtbot.waitUntil(lambda: window.drawing_page.layers.isAncestorOf(window.focusWidget()))


def test_the_drawing_comes_along_where_the_page_has_no_place(wiring):
    wiring.run("line 0,0 10,0")
    wiring.showing.show_view(View.STAGES)
    assert wiring.window_.side.isHidden()
    wiring.window_.actions_["layers"].trigger()
    assert wiring.showing.view is View.DRAW and wiring.window_.side.page == "Drawing"


def test_a_layer_with_curves_goes_after_a_question(qtbot, wiring):
    window = wiring.window_
    wiring.run("layer holes; circle 0,0 5")
    window.actions_["layers"].trigger()
    window.drawing_page.layers.remove("holes")
    assert "1 curve on it" in window.notice.text.text()
    qtbot.mouseClick(window.notice.buttons[1], Qt.MouseButton.LeftButton)
    assert len(wiring.document.part.layers) == 2
    window.drawing_page.layers.remove("holes")
    qtbot.mouseClick(window.notice.buttons[0], Qt.MouseButton.LeftButton)
    assert [layer.name for layer in wiring.document.part.layers] == ["0"] and not wiring.document.part.entities


def test_ten_thousand_curves_are_told_of_without_delay(wiring, qtbot):
    wiring.run("circle 0,0 2; array 100 100 @5,5 1")
    wiring.window_.actions_["properties"].trigger()
    wiring.run("select all")
    page = wiring.window_.drawing_page
    qtbot.waitUntil(lambda: page.properties.figures.keys() >= {"Kinds"})
    assert page.properties.figures["Kinds"].value.text() == "10\u2009000 circles"
