"""The bar over the view: what speaks of one view is seen there alone."""

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QApplication, QStackedWidget, QWidget

from app.ui.framework.notice import Notice


@pytest.fixture
def views(qtbot) -> QStackedWidget:
    stack = QStackedWidget()
    qtbot.addWidget(stack)
    for _ in range(2):
        stack.addWidget(QWidget())
    stack.show()
    return stack


@pytest.fixture
def notice(qtbot) -> Notice:
    made = Notice()
    qtbot.addWidget(made)
    return made


def test_a_sentence_about_a_view_comes_and_goes_with_it(views, notice):
    notice.ask("It has no units.", [("Inches", lambda: None)], stays=True)
    notice.show_with(views.widget(1))
    assert notice.isHidden(), "its view is not at the front yet"
    for front in (1, 0, 1):
        views.setCurrentIndex(front)
        assert notice.isHidden() == (front == 0)


def test_what_was_answered_or_followed_by_another_does_not_come_back(views, notice):
    notice.ask("It has no units.", [("Inches", lambda: None)])
    notice.show_with(views.widget(0))
    notice.buttons[0].click()
    for front in (1, 0):
        views.setCurrentIndex(front)
        assert notice.isHidden()
    notice.ask("It has no units.")
    notice.show_with(views.widget(0))
    notice.ask("plate.nc is written.")
    for front in (1, 0):
        views.setCurrentIndex(front)
        assert not notice.isHidden() and notice.sentence == "plate.nc is written."


def test_buttons_go_at_once_also_where_a_dialog_opens_meanwhile(qtbot, notice):
    """What is to be deleted later lives as long as a dialog that was opened before."""
    notice.ask("Proposed: drill.", [("Undo", lambda: None)])
    (old,) = notice.buttons
    notice.ask("No gouge.")
    assert not old.isVisible() and notice.isVisible()


@pytest.mark.parametrize(("width", "below"), [(900, False), (420, True)])
def test_where_it_is_narrow_the_buttons_stand_below_the_sentence(qtbot, notice, width, below):
    words = ("Propose operations", "Keep the operations there are")
    notice.resize(width, 40)
    notice.show()
    sentence = "apu-mount.dxf says nothing about machining. F5 proposes operations for it and computes them."
    notice.ask(sentence, [(each, lambda: None) for each in words])
    QApplication.processEvents()
    notice.resize(width, notice.heightForWidth(width))
    QApplication.processEvents()
    at = [button.mapTo(notice, button.rect().topLeft()) for button in notice.buttons]
    assert all((place.y() > notice.text.geometry().bottom()) == below for place in at)
    assert all(button.width() >= button.sizeHint().width() for button in notice.buttons)
    text = notice.text
    room = text.fontMetrics().boundingRect(text.contentsRect(), Qt.TextFlag.TextWordWrap, text.text())
    assert text.width() >= 240 and text.height() >= room.height()


def test_a_question_that_another_sentence_took_the_place_of_comes_back(qtbot, notice):
    answered: list[str] = []
    notice.ask("Work was kept.", [("Recover", lambda: answered.append("Recover"))], stays=True)
    notice.come_back()
    notice.ask("Proposed: pocket.", [("Undo", lambda: answered.append("Undo"))], of_job=True)
    notice.ask("Read back.")
    notice.hide()
    assert notice.isVisible() and notice.sentence == "Work was kept."
    qtbot.mouseClick(notice.buttons[0], Qt.MouseButton.LeftButton)
    assert answered == ["Recover"] and notice.isHidden(), "it was answered"
    notice.ask("Work was kept.", [("Recover", lambda: None)])
    notice.come_back()
    notice.ask("Proposed: pocket.", [("Undo", lambda: answered.append("Undo"))], of_job=True)
    qtbot.mouseClick(notice.buttons[0], Qt.MouseButton.LeftButton)
    assert answered == ["Recover", "Undo"] and notice.sentence == "Work was kept."
    notice.hide()
    assert notice.isHidden(), "it was closed"


def test_what_is_opened_closes_a_question_about_what_was_before_and_no_offer_that_comes_back(notice):
    notice.ask("It has no units.", [("Inches", lambda: None)], stays=True)
    notice.turn_over()
    assert notice.isHidden()
    notice.ask("Work was kept.", [("Recover", lambda: None)], stays=True)
    notice.come_back()
    notice.turn_over()
    assert notice.isVisible() and notice.sentence == "Work was kept."
    notice.ask("It has no units.", [("Inches", lambda: None)], stays=True)
    notice.turn_over()
    assert notice.isVisible() and notice.sentence == "Work was kept."
