"""The window in Japanese: every menu, what is said later, and English again without a trace."""

from __future__ import annotations

import tomllib
import unicodedata

import pytest
from PySide6.QtGui import QAction
from PySide6.QtWidgets import QAbstractButton, QApplication, QLabel, QWidget

from app.resources import resource
from app.settings import Language, load_settings
from app.ui.actions import MENUS, plain
from app.ui.panels.fields import LABEL_WIDTH, NumberField
from app.ui.theme import TEXT_PX
from app.ui.translation import code_of
from app.ui.words import Catalogue, catalogue, speak, tr

ENTRIES: dict[str, str] = tomllib.loads(resource("translations", "ja.toml").read_text("utf-8"))["words"]
OWN_NAMES = {"English", "日本語", "NC"}


@pytest.fixture(autouse=True)
def english_again():
    yield
    speak("en")


@pytest.fixture
def japanese(wiring):
    wiring.window_.actions_["language_ja"].trigger()
    return wiring


def texts(window: QWidget) -> list[str]:
    found = [action.text() + action.toolTip() + action.iconText() for action in window.findChildren(QAction)]
    found += [each.text() + each.toolTip() for kind in (QLabel, QAbstractButton) for each in window.findChildren(kind)]
    return [*found, *(menu.title() for menu in (action.menu() for action in window.menuBar().actions()))]


def ems(text: str) -> float:
    """How wide a text is at most, in its height: Japanese letters are square, others at most 0.65 wide."""
    return sum(1.0 if unicodedata.east_asian_width(letter) in "WF" else 0.65 for letter in text)


def test_every_menu_has_a_japanese_text_that_is_not_long() -> None:
    menus = [plain(text) for title, specs in MENUS for text in (title, *(spec.text for spec in specs if spec.text))]
    missing = sorted({text for text in menus if text not in OWN_NAMES and text not in ENTRIES})
    assert not missing
    assert {text: ENTRIES[text] for text in menus if text in ENTRIES and ems(ENTRIES[text]) > 18} == {}


def test_entries_keep_their_holes_and_say_something() -> None:
    assert {text for text, other in ENTRIES.items() if text.count("{}") != other.count("{}") or not other.strip()} == set()


def test_names_of_fields_fit_before_their_values(japanese) -> None:
    names = {field.spec.name for field in japanese.window_.findChildren(NumberField)} & set(ENTRIES)
    assert len(names) > 10
    assert {name: ENTRIES[name] for name in names if ems(ENTRIES[name]) * TEXT_PX > LABEL_WIDTH} == {}


def test_the_window_speaks_japanese_at_once_and_remembers_it(japanese) -> None:
    window = japanese.window_
    assert window.menuBar().actions()[0].text() == "ファイル(&F)"
    assert window.actions_["open"].text() == "開く(&O)…"
    assert window.actions_["open"].toolTip() == "開く (Ctrl+O)"
    assert window.top_bar.tabs["view_draw"].text() == "作図"
    assert window.top_bar.compute.text() == " 計算  F5"
    assert window.side.tabs["Job"].text() == "加工"
    assert window.status.snap.text() == "スナップ"
    assert load_settings().language is Language.JAPANESE


def test_what_is_said_later_is_looked_up_before_it_is_seen(qtbot, japanese) -> None:
    window = japanese.window_
    japanese.document.run("line 0,0 10,0")
    japanese.files.ask_new()
    QApplication.processEvents()
    window.grab()
    assert window.notice.text.text() == "新しい図面を始めますか。 この図面はまだどのファイルにも保存されていません。"
    assert "作図を続ける" in [button.text() for button in window.notice.buttons]
    japanese.cancel()
    japanese.showing.show_hovered("Cancelled; nothing has changed.")
    window.grab()
    assert window.status.message.text() == "中止しました。何も変更していません。"


def test_english_comes_back_without_a_trace(wiring) -> None:
    before = texts(wiring.window_)
    wiring.window_.actions_["language_ja"].trigger()
    wiring.window_.grab()
    assert texts(wiring.window_) != before
    wiring.window_.actions_["language_en"].trigger()
    assert texts(wiring.window_) == before


def test_undo_names_what_it_takes_back(qtbot, japanese) -> None:
    japanese.document.run("line 0,0 10,0")
    edit = japanese.window_.menuBar().actions()[1].menu()
    edit.popup(japanese.window_.pos())
    qtbot.waitUntil(lambda: edit.isVisible())
    assert japanese.window_.actions_["undo"].text().startswith("元に戻す: ")
    edit.hide()


def test_the_palette_finds_in_both_languages(qtbot, japanese) -> None:
    for typed in ("全体", "fit"):
        japanese.palette.open()
        qtbot.keyClicks(japanese.palette.edit, typed) if typed == "fit" else japanese.palette.edit.setText(typed)
        assert japanese.palette.list.count() > 0


def test_one_entry_serves_menu_tip_and_button() -> None:
    words = Catalogue({"Open": "開く", "Undo {}": "元に戻す: {}", "Line": "直線"})
    assert words.look_up("&Open…") == "開く(&O)…"
    assert words.look_up("Open (Ctrl+O)") == "開く (Ctrl+O)"
    assert words.look_up(" Open ") == " 開く "
    assert words.look_up("&Open\tDel") == "開く(&O)\tDel"
    assert words.look_up("Undo Line") == "元に戻す: 直線"
    assert words.look_up("Undo {x}") == "元に戻す: {x}"
    assert words.look_up("Close") is None
    assert words.look_up("") is None


def test_what_the_catalogue_lacks_stays_english() -> None:
    speak("ja")
    assert tr("Never heard of") == "Never heard of"
    assert tr("Fit") == "全体表示"
    assert catalogue("en").look_up("Fit") is None


def test_the_codes_of_the_choices() -> None:
    assert [code_of(choice) for choice in (Language.ENGLISH, Language.JAPANESE)] == ["en", "ja"]
