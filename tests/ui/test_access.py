"""Whoever does not use the mouse, or does not see the window, gets everywhere and is told where."""

from collections.abc import Iterator

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QAbstractButton, QApplication, QPlainTextEdit, QScrollArea, QWidget

from app.ui.start import build
from app.ui.views import View
from app.ui.wiring import Wiring


@pytest.fixture
def wiring(qtbot) -> Iterator[Wiring]:
    window, made = build()
    qtbot.addWidget(window)
    window.resize(1280, 800)
    window.show()
    made.document.run("rect 0,0 50,40")
    yield made
    window.close()


def reached(window: QWidget) -> list[QWidget]:
    """What Tab goes to, as far as it is there to be seen."""
    return [
        each for each in window.findChildren(QWidget)
        if each.isVisible() and each.isEnabled() and each.focusPolicy() & Qt.FocusPolicy.TabFocus
    ]  # fmt: skip


def name_of(widget: QWidget) -> str:
    return widget.accessibleName() or (widget.text() if isinstance(widget, QAbstractButton) else "") or widget.toolTip()


@pytest.mark.parametrize("view", list(View))
@pytest.mark.parametrize("page", ["Job", "Drawing", "Text"])
def test_everything_that_takes_the_keys_has_a_name(wiring, view: View, page: str) -> None:
    wiring.showing.show_view(view)
    wiring.window_.side.show_page(page)
    QApplication.processEvents()
    nameless = [f"{type(each).__name__} in {type(each.parentWidget()).__name__}" for each in reached(wiring.window_) if not name_of(each)]
    assert not nameless


def test_what_has_the_keys_is_seen(wiring) -> None:
    """Marked by itself or, as a field in its frame, by what is round it."""
    wiring.window_.side.show_page("Job")
    wiring.window_.activateWindow()
    unmarked = []
    for each in reached(wiring.window_):
        if each.size().isEmpty() or each is wiring.window_.canvas:
            continue
        wiring.window_.canvas.setFocus()
        for area in wiring.window_.findChildren(QScrollArea):
            if area.isAncestorOf(each):
                area.ensureWidgetVisible(each)
        QApplication.processEvents()
        before = wiring.window_.grab().toImage()
        each.setFocus(Qt.FocusReason.TabFocusReason)
        QApplication.processEvents()
        if each.hasFocus() and wiring.window_.grab().toImage() == before:
            unmarked.append(f"{type(each).__name__} {name_of(each)}")
    assert not unmarked


def test_tab_goes_round_and_the_editor_lets_go_by_escape(qtbot, wiring) -> None:
    wiring.window_.side.show_page("Job")
    wiring.window_.canvas.setFocus()
    seen: list[QWidget] = []
    for _ in range(200):
        now = QApplication.focusWidget()
        if now is None or now in seen:
            break
        seen.append(now)
        QTest.keyClick(now, Qt.Key.Key_Tab)
    assert len(seen) > 15
    wiring.window_.actions_["text"].trigger()
    editor = wiring.window_.findChild(QPlainTextEdit)
    assert editor is not None
    editor.setFocus()
    QTest.keyClick(editor, Qt.Key.Key_Escape)
    qtbot.waitUntil(lambda: QApplication.focusWidget() is wiring.window_.canvas, timeout=2000)
