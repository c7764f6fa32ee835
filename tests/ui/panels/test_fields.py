"""Number fields and rows of the side panel."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QEvent, Qt
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QApplication, QLabel

from app.core.errors import HitofudeError
from app.ui.framework.fields import NumberSpec
from app.ui.framework.section import ListRow

_CONTROL, _ALT, _NONE = (
    Qt.KeyboardModifier.ControlModifier,
    Qt.KeyboardModifier.AltModifier,
    Qt.KeyboardModifier.NoModifier,
)


@pytest.mark.parametrize(
    ("key", "modifier", "kept"),
    [
        (Qt.Key.Key_D, _CONTROL, True),
        (Qt.Key.Key_Up, _ALT, True),
        (Qt.Key.Key_Down, _ALT, True),
        (Qt.Key.Key_Delete, _NONE, True),
        (Qt.Key.Key_S, _CONTROL, False),
    ],
)
def test_a_row_keeps_its_keys_from_the_windows_shortcuts(
    qapp: QApplication, key: Qt.Key, modifier: Qt.KeyboardModifier, kept: bool
) -> None:
    row = ListRow(QLabel("pocket"))
    event = QKeyEvent(QEvent.Type.ShortcutOverride, key, modifier)
    event.ignore()
    QApplication.sendEvent(row, event)
    assert event.isAccepted() is kept


@pytest.mark.parametrize(
    ("spec", "text", "reason"),
    [
        (NumberSpec("Flutes", "", 1, 100, 0, False), "1.5", "Flutes is 1.5; use a whole number."),
        (NumberSpec("T number", "", 1, 9999, 0, False), "0", "T number is 0; use 1 to 9999."),
        (NumberSpec("Angle", "°", 0.06, 45, 2, False), "90", "Angle is 90°; use 0.06 to 45."),
        (NumberSpec("Speed", "rpm", 1, 200_000, 0, False), "100rpm", "Speed is in rpm; type the number alone."),
        (NumberSpec("Speed", "rpm", 1, 200_000, 0, False), "100 mm", "Speed is in rpm; type the number alone."),
        (NumberSpec("Flutes", "", 1, 100, 0, False), "2in", "Flutes has no unit; type the number alone."),
        (
            NumberSpec("Speed", "rpm", 1, 200_000, 0, False),
            "99999999",
            "The value is too large; numbers go up to 10 000 000.",
        ),
        (
            NumberSpec("Speed", "rpm", 1, 200_000, 0, False),
            "abc",
            "'abc' is no number; write a number such as 12.5 or 1in+8mm.",
        ),
    ],
)
def test_a_field_says_what_to_type(spec: NumberSpec, text: str, reason: str) -> None:
    with pytest.raises(HitofudeError) as wrong:
        spec.read(text)
    assert getattr(wrong.value, "reason", str(wrong.value)) == reason


def test_a_field_of_whole_numbers_takes_them() -> None:
    assert NumberSpec("Flutes", "", 1, 100, 0, False).read("4/2") == 2.0
