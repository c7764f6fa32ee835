"""Ctrl+Z undoes the job's last change also while a field has the keyboard, unless something is being typed in it."""

from PySide6.QtCore import Qt

from app.ui.panels.changes import Subject, SubjectKind

CTRL = Qt.KeyboardModifier.ControlModifier


def test_undo_after_a_value_was_entered(qtbot, wiring):
    panel = wiring.window_.panel
    panel.choose(Subject(SubjectKind.TOOL, 1))
    edit = panel.tool_form.diameter.edit
    edit.setFocus()
    qtbot.mouseDClick(edit, Qt.MouseButton.LeftButton)
    assert edit.selectedText() == "6.000"
    qtbot.keyClicks(edit, "8")
    qtbot.keyClick(edit, Qt.Key.Key_Z, CTRL)
    assert (edit.text(), wiring.document.undo_name) == ("6.000", None)
    edit.selectAll()
    qtbot.keyClicks(edit, "8")
    qtbot.keyClick(edit, Qt.Key.Key_Return)
    assert wiring.document.job.tool(1).diameter == 8.0
    qtbot.keyClick(edit, Qt.Key.Key_Z, CTRL)
    assert wiring.document.job.tool(1).diameter == 6.0
    assert edit.text() == "6.000"
    qtbot.keyClick(edit, Qt.Key.Key_Z, CTRL | Qt.KeyboardModifier.ShiftModifier)
    assert wiring.document.job.tool(1).diameter == 8.0
