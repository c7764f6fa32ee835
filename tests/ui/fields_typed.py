"""What a person does with a field."""

from PySide6.QtCore import Qt


def enter(qtbot, field, text: str) -> None:
    """Replace what stands in a field."""
    field.edit.setFocus()
    field.edit.selectAll()
    qtbot.keyClicks(field.edit, text)
    qtbot.keyClick(field.edit, Qt.Key.Key_Return)
