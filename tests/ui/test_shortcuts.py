"""Keys: each action's own, no two alike, changed and taken back by the keyboard, and remembered."""

from dataclasses import replace

import pytest
from PySide6.QtCore import Qt

from app.core.settings import Settings, load_settings
from app.ui.shell.bars.actions import menus
from app.ui.shell.bars.shortcuts import Shortcuts
from app.ui.shell.help.keys_window import FIXED, KeysWindow


@pytest.fixture
def keys(qtbot, wiring) -> KeysWindow:
    made = KeysWindow(wiring.window_, wiring.window_.actions_, wiring.shortcuts)
    qtbot.addWidget(made)
    made.show()
    return made


def row_of(keys: KeysWindow, name: str):
    return next(item for item in keys._items() if item.data(0, Qt.ItemDataRole.UserRole) == name)


def press(
    qtbot, keys: KeysWindow, key: Qt.Key, modifiers: Qt.KeyboardModifier = Qt.KeyboardModifier.NoModifier
) -> None:
    qtbot.keyClick(keys.list, key, modifiers)


def test_no_two_actions_have_one_key() -> None:
    used = [key for _, specs in menus() for spec in specs if spec.key for key in spec.key.split("; ")]
    assert sorted(used) == sorted(set(used))


def test_help_is_where_it_is_looked_for() -> None:
    keys = {spec.name: spec.key for _, specs in menus() for spec in specs}
    assert (keys["manual"], keys["keys"]) == ("F1", "Ctrl+F1")


def test_the_list_has_every_action_and_the_keys_of_the_views(keys: KeysWindow, wiring) -> None:
    assert len(keys._items()) == len(wiring.window_.actions_.specs) + len(FIXED)
    assert row_of(keys, "compute").text(2) == "F5"


def test_the_search_finds_by_name_and_by_key(keys: KeysWindow) -> None:
    keys.search.setText("Ctrl+P")
    assert not row_of(keys, "plot").isHidden()
    keys.search.setText("zoom in")
    assert [item.text(0) for item in keys._items() if not item.isHidden()] == ["Zoom in"]


def test_a_new_key_is_recorded_works_and_is_remembered(qtbot, keys: KeysWindow, wiring) -> None:
    keys.record("fit")
    press(qtbot, keys, Qt.Key.Key_M, Qt.KeyboardModifier.ControlModifier)
    assert row_of(keys, "fit").text(2) == "Ctrl+M"
    assert wiring.window_.actions_["fit"].toolTip() == "Fit (Ctrl+M)"
    assert load_settings().shortcuts == ("fit=Ctrl+M",)
    again = Shortcuts(wiring.window_.actions_, wiring.window_.preferences)
    assert again.is_own("fit")
    assert not again.is_own("new")


def test_keys_that_were_chosen_win_over_those_of_the_table(qtbot, wiring) -> None:
    """Redo has Ctrl+Y too: who had given that to another action had two with one key, and neither of them."""
    actions, preferences = wiring.window_.actions_, wiring.window_.preferences
    preferences.keep(replace(preferences.settings, shortcuts=("fit=Ctrl+Y", "new=Ctrl+O", "open=Ctrl+N")))
    shortcuts = Shortcuts(actions, preferences)
    assert (actions.key("fit"), actions.key("redo")) == ("Ctrl+Y", "Ctrl+Shift+Z")
    assert (actions.key("new"), actions.key("open")) == ("Ctrl+O", "Ctrl+N"), "two that changed their keys"
    assert shortcuts.owner("") is None, "nobody has the key that is none"
    shortcuts.reset_all()


def test_a_key_in_use_is_told_and_taken_only_when_pressed_again(qtbot, keys: KeysWindow, wiring) -> None:
    keys.record("fit")
    press(qtbot, keys, Qt.Key.Key_N, Qt.KeyboardModifier.ControlModifier)
    assert "Ctrl+N belongs to New" in keys.told.text()
    assert wiring.window_.actions_.key("new") == "Ctrl+N"
    press(qtbot, keys, Qt.Key.Key_N, Qt.KeyboardModifier.ControlModifier)
    assert (wiring.window_.actions_.key("fit"), wiring.window_.actions_.key("new")) == ("Ctrl+N", "")


def test_a_letter_alone_is_no_key_and_escape_leaves(qtbot, keys: KeysWindow, wiring) -> None:
    keys.record("fit")
    press(qtbot, keys, Qt.Key.Key_M)
    assert "begins a command" in keys.told.text()
    press(qtbot, keys, Qt.Key.Key_Escape)
    assert keys.recording == "" and keys.isVisible()
    assert wiring.window_.actions_.key("fit") == "Ctrl+0"


def test_backspace_takes_a_key_away_and_reset_brings_it_back(qtbot, keys: KeysWindow, wiring) -> None:
    keys.record("compute")
    press(qtbot, keys, Qt.Key.Key_Backspace)
    assert wiring.window_.actions_.key("compute") == ""
    keys.list.setCurrentItem(row_of(keys, "compute"))
    keys.reset.click()
    assert wiring.window_.actions_.key("compute") == "F5"
    assert wiring.window_.preferences.settings.shortcuts == ()


def test_an_action_with_two_keys_loses_the_one_that_is_taken(qtbot, keys: KeysWindow, wiring) -> None:
    actions = wiring.window_.actions_
    assert row_of(keys, "redo").text(2) == "Ctrl+Shift+Z; Ctrl+Y"
    assert actions["redo"].toolTip() == "Redo (Ctrl+Shift+Z)"
    keys.record("fit")
    for _ in range(2):
        press(qtbot, keys, Qt.Key.Key_Y, Qt.KeyboardModifier.ControlModifier)
    assert (actions.key("fit"), actions.key("redo")) == ("Ctrl+Y", "Ctrl+Shift+Z")
    assert load_settings().shortcuts == ("redo=Ctrl+Shift+Z", "fit=Ctrl+Y")
    wiring.shortcuts.reset("redo")
    assert (actions.key("fit"), actions.key("redo")) == ("", "Ctrl+Shift+Z; Ctrl+Y")


def test_all_keys_go_back_at_once(qtbot, keys: KeysWindow, wiring) -> None:
    wiring.shortcuts.change("fit", "Ctrl+N")
    keys.reset_all.click()
    assert (wiring.window_.actions_.key("fit"), wiring.window_.actions_.key("new")) == ("Ctrl+0", "Ctrl+N")
    assert wiring.window_.preferences.settings.shortcuts == Settings().shortcuts


def test_damaged_settings_change_no_key(wiring) -> None:
    from dataclasses import replace

    preferences, wrong = wiring.window_.preferences, ("nonsense", "gone=Ctrl+M", "fit=Ctrl+M")
    preferences.settings = replace(preferences.settings, shortcuts=wrong)
    Shortcuts(wiring.window_.actions_, wiring.window_.preferences)
    assert wiring.window_.actions_.key("fit") == "Ctrl+M"
