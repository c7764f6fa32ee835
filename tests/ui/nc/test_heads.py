"""What is over text and path in the NC view gives way in the order of what is read first."""

from __future__ import annotations

import pytest
from PySide6.QtWidgets import QApplication, QWidget

from app.gcode.interpreter.dialect import Dialect
from app.ui.views.nc.heads import Banner, PathHead, TextHead


def sized(qtbot, widget, width):
    """Show a bar in a window that is as wide, however little that is."""
    widget.window_ = window = QWidget()  # kept as long as the bar
    qtbot.addWidget(window)
    window.resize(width, 36)
    widget.setParent(window)
    widget.resize(width, 36)
    window.show()
    QApplication.processEvents()
    return widget


@pytest.mark.parametrize(("width", "counts"), [(440, True), (222, False)])
def test_a_program_keeps_its_name_where_there_is_little_room(qtbot, width, counts):
    head = TextHead()
    head.show_program("tux.ngc", "4296 lines")
    head.show_dialect(Dialect.LINUXCNC, None, True)
    sized(qtbot, head, width)
    assert not head.name.cut_off
    assert head.detail.isVisible() is counts
    assert head.minimumSizeHint().width() <= width
    assert "4296 lines" in head.name.toolTip()


def test_a_banner_keeps_its_button_whole(qtbot):
    banner = Banner()
    banner.say("Not the job's program.", "Back to the job's program")
    sized(qtbot, banner, 222)
    assert banner.sentence.isHidden()
    assert banner.button.width() >= banner.button.sizeHint().width()
    banner.resize(500, 36)
    QApplication.processEvents()
    assert banner.sentence.isVisible()


def test_a_banner_without_a_button_is_its_sentence(qtbot):
    banner = Banner()
    banner.say("Nothing is drawn any more.", "")
    sized(qtbot, banner, 60)
    assert banner.sentence.isVisible() and banner.button.isHidden()
    banner.say("The job has changed since.", "Compute  F5")
    assert not banner.button.isHidden()


@pytest.mark.parametrize(("width", "colours"), [(440, True), (300, False)])
def test_the_way_to_the_cut_stays_where_there_is_little_room(qtbot, width, colours):
    head = sized(qtbot, PathHead(), width)
    assert head.minimumSizeHint().width() <= width
    assert head.cut.isVisible()
    assert head.colour.isVisible() is colours
