"""The manual: every page, a search through all of them, words of the language."""

import pytest
from PySide6.QtCore import Qt, QUrl

from app.core.resources import resource
from app.ui.framework.catalogue import set_language
from app.ui.framework.theme import DARK
from app.ui.shell.help.help_pages import rendered
from app.ui.shell.help.help_window import HelpWindow
from app.usecases.manual.pages import GROUPS, TUTORIALS, WORK


@pytest.fixture
def manual(qtbot):
    made = HelpWindow(None)
    qtbot.addWidget(made)
    return made


def test_every_page_of_the_manual_can_be_read(manual) -> None:
    manual.show_page()
    assert manual.page == "language"
    english = {path.stem for path in resource("docs").glob("*.md") if not path.stem.endswith("_ja")}
    assert {page.name for page in manual.pages} == english and manual.pages[0].name == "first_part"
    for page in manual.pages:
        manual.show_page(page.name)
        assert page.title in manual.browser.toPlainText() and not page.title.startswith("#")


def test_the_pages_are_in_the_language_of_the_window(manual) -> None:
    manual.show_page("first_part")
    assert "First part" in manual.browser.toPlainText()
    set_language("ja")
    try:
        manual.show_page("first_part")
        assert "最初の部品" in manual.browser.toPlainText() and manual.page == "first_part"
        assert manual.search.text() == "" and len(manual.pages) + len(GROUPS) == manual.list.count()
        assert manual.list.item(0).text() == "チュートリアル"
        manual.browser.anchorClicked.emit(QUrl("sign.md"))
        assert manual.page == "sign" and "銘板" in manual.browser.toPlainText()
        manual.browser.anchorClicked.emit(QUrl("mould_ja.md"))
        assert manual.page == "mould"
        manual.search.setText("段取り票")
        manual.search.textEdited.emit("段取り票")
        assert manual.browser.textCursor().selectedText() == "段取り票"
        manual.show_page("changelog")
        assert "Changes" in manual.browser.toPlainText()
    finally:
        set_language("en")
    manual.show_page("sign")
    assert "A sign" in manual.browser.toPlainText()


def test_the_list_names_groups_that_the_keys_pass_over(qtbot, manual) -> None:
    manual.show_page(TUTORIALS.bases[-1])
    assert manual.list.item(0).text() == "Tutorials"
    qtbot.keyClick(manual.list, Qt.Key.Key_Down)
    assert manual.page == WORK.bases[0]
    qtbot.keyClick(manual.list, Qt.Key.Key_Up)
    assert manual.page == TUTORIALS.bases[-1]
    qtbot.keyClick(manual.list, Qt.Key.Key_Home)
    assert manual.page == TUTORIALS.bases[0]
    qtbot.keyClick(manual.list, Qt.Key.Key_End)
    assert manual.page == "changelog"
    for _ in range(6):
        qtbot.keyClick(manual.list, Qt.Key.Key_PageUp)
    assert manual.page == TUTORIALS.bases[0]


def test_search_goes_on_through_all_pages(qtbot, manual) -> None:
    manual.show_page()
    qtbot.keyClicks(manual.search, "preselect")
    assert manual.page == "posts" and manual.browser.textCursor().selectedText() == "preselect"
    first = manual.browser.textCursor().position()
    qtbot.keyClick(manual.search, Qt.Key.Key_Return)
    assert manual.browser.textCursor().position() != first or manual.page != "posts"
    manual.search.selectAll()
    qtbot.keyClicks(manual.search, "xyzzy")
    assert manual.count.text() == "Not found"


def test_a_word_that_is_none_is_looked_for(manual) -> None:
    manual.show_word("trimming-nothing")
    assert manual.search.text() == "trimming-nothing" and manual.count.text() == "Not found"
    manual.show_word("fillet")
    assert manual.search.text() == "" and manual.browser.textCursor().selectedText().startswith("fillet r CURVE")


def test_the_theme_changes_the_page_in_front(manual) -> None:
    manual.show_page()
    before = manual.browser.document()
    manual.set_theme(DARK)
    assert manual.browser.document() is not before and manual.page == "language"


def test_pictures_of_a_page_are_found_and_no_wider_than_it_is(manual) -> None:
    manual.show_page()
    page = next(page for page in manual.pages if page.name == "texts")
    document = rendered(page, DARK)
    block, seen = document.begin(), []
    while block.isValid():
        for piece in block:
            form = piece.fragment().charFormat()
            if form.isImageFormat():
                seen.append(form.toImageFormat())
        block = block.next()
    assert len(seen) == page.text.count("](figures/")
    assert all(0 < picture.width() <= 320 and 0 < picture.height() <= 400 for picture in seen)


def test_pictures_of_the_window_are_as_wide_as_the_page(manual) -> None:
    manual.show_page()
    page = next(page for page in manual.pages if page.name == "first_part")
    document = rendered(page, DARK)
    block, widths = document.begin(), []
    while block.isValid():
        widths += [
            piece.fragment().charFormat().toImageFormat().width()
            for piece in block
            if piece.fragment().charFormat().isImageFormat()
        ]
        block = block.next()
    assert widths == [580] * 4


def test_the_list_of_pages_is_as_wide_as_its_room(qtbot, manual) -> None:
    manual.show_page()
    qtbot.waitExposed(manual)
    assert not manual.list.horizontalScrollBar().isVisible()
    assert manual.list.textElideMode() is Qt.TextElideMode.ElideRight
