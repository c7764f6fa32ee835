"""The command palette by keys alone: what fits, in what order, and that it does it."""

import pytest
from PySide6.QtCore import Qt

from app.ui.framework.fuzzy import fit
from app.ui.shell.bars.command_palette import _ENTRY


def open_palette(qtbot, wiring):
    wiring.window_.actions_["palette"].trigger()
    assert wiring.palette.isVisible()
    return wiring.palette


def names(palette) -> list[str]:
    return [palette.list.item(row).data(_ENTRY).text for row in range(palette.list.count())]


def test_a_few_letters_and_enter_do_it(qtbot, wiring) -> None:
    palette = open_palette(qtbot, wiring)
    qtbot.keyClicks(palette.edit, "circ")
    assert "Circle" in names(palette)[:3]
    palette.edit.clear()
    qtbot.keyClicks(palette.edit, "stages view")
    assert names(palette)[0] == "Stages"
    qtbot.keyClick(palette.edit, Qt.Key.Key_Return)
    assert not palette.isVisible()
    assert wiring.window_.actions_["view_stages"].isChecked()


def test_what_was_used_lately_comes_first_and_is_remembered(qtbot, wiring) -> None:
    palette = open_palette(qtbot, wiring)
    qtbot.keyClicks(palette.edit, "ortho")
    qtbot.keyClick(palette.edit, Qt.Key.Key_Return)
    assert wiring.window_.actions_["ortho"].isChecked()
    assert wiring.window_.preferences.settings.recent_commands[0] == "ortho"
    open_palette(qtbot, wiring)
    assert names(palette)[0] == "Ortho"


def test_a_command_of_the_language_goes_into_the_command_line(qtbot, wiring) -> None:
    palette = open_palette(qtbot, wiring)
    qtbot.keyClicks(palette.edit, "chamfer shape")
    qtbot.keyClick(palette.edit, Qt.Key.Key_Return)
    assert wiring.window_.command_line.edit.text() == "chamfer "


def test_down_chooses_and_escape_leaves(qtbot, wiring) -> None:
    palette = open_palette(qtbot, wiring)
    qtbot.keyClick(palette.edit, Qt.Key.Key_Down)
    assert palette.list.currentRow() == 1
    qtbot.keyClick(palette.edit, Qt.Key.Key_Escape)
    assert not palette.isVisible()
    assert wiring.window_.canvas.hasFocus()


def test_what_cannot_be_done_is_not_offered(qtbot, wiring) -> None:
    assert "Export NC" not in names(open_palette(qtbot, wiring))


@pytest.mark.parametrize(
    ("typed", "better", "worse"),
    [
        ("fit", "Fit", "Go to fifth tool"),
        ("zi", "Zoom in", "Size"),
        ("exp nc", "Export NC", "Example of a cone"),
    ],
)
def test_letters_fit_best_where_words_begin(typed: str, better: str, worse: str) -> None:
    first, second = fit(typed, better), fit(typed, worse)
    assert first is not None
    assert second is None or first > second


def test_letters_out_of_order_do_not_fit() -> None:
    assert fit("tif", "Fit") is None
    assert fit("", "Fit") == 0.0
