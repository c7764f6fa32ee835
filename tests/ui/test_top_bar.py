"""The bar with files, views, Compute and Export: what it shows fits."""

from collections.abc import Iterator

import pytest
from PySide6.QtWidgets import QMainWindow

from app.ui.framework import style
from app.ui.framework.arrow import arrow_picture
from app.ui.framework.theme import LIGHT
from app.ui.shell.bars.actions import Actions
from app.ui.shell.bars.top_bar import TopBar

LEAST_PX = 860
"""Width of the smallest window."""


@pytest.fixture
def bar(qtbot, qapp) -> Iterator[TopBar]:
    style.prepare(qapp, LIGHT)
    style.apply(qapp, LIGHT, arrow_picture(LIGHT))
    window = QMainWindow()
    qtbot.addWidget(window)
    made = TopBar(Actions(window))
    made.setParent(window)
    made.set_theme(LIGHT)
    window.show()
    yield made  # the window must outlive it


def test_buttons_say_what_there_is_room_for(bar):
    said = []
    for width in range(1280, LEAST_PX - 1, -20):
        bar.resize(width, bar.height())
        bar.layout().activate()
        said.append(bar.compute.text())
        for button in (bar.compute, bar.export):
            assert button.text() or not button.icon().isNull()
            assert button.width() >= button.minimumSizeHint().width() and button.geometry().right() < width
    assert list(dict.fromkeys(said)) == [" Compute  F5", "Compute", ""], "less and less, and nothing twice"
    assert bar.compute.accessibleName() == "Compute"
