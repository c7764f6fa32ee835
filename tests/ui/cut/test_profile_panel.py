"""A line drawn over the metal shows its heights."""

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt

from app.ui.framework.theme import DARK
from app.ui.views.cut.view import CutView
from tests.ui.cut.made_up import made_up
from tests.ui.cut.pictures import without_a_screen

CTRL, LEFT = Qt.KeyboardModifier.ControlModifier, Qt.MouseButton.LeftButton


@pytest.fixture
def view(qtbot):
    without_a_screen().release()
    made = CutView()
    qtbot.addWidget(made)
    made.resize(900, 600)
    made.set_theme(DARK)
    made.show()
    made.show_cut(made_up(200))
    return made


def at(view, place):
    x, y, _ = view.model.camera.project(np.array([place]), (view.width(), view.height()))[0]
    return QPoint(round(x), round(y))


def test_ctrl_drag_draws_a_line_and_its_profile_and_does_not_turn(qtbot, view):
    camera, begin, end = view.model.camera, at(view, (5.0, 50.0, 0.0)), at(view, (95.0, 50.0, 0.0))
    qtbot.mousePress(view, LEFT, CTRL, begin)
    qtbot.mouseMove(view, (begin + end) / 2)
    qtbot.mouseMove(view, end)
    qtbot.mouseRelease(view, LEFT, CTRL, end)
    assert view.model.camera == camera
    drawn = view.profile.drawn
    assert drawn is not None and drawn.borders[-1] == pytest.approx(90.0, abs=1.5)
    assert (drawn.heights.max(), drawn.heights.min()) == (0.0, pytest.approx(-9.0, abs=0.3))
    assert "Z \u22128.9" in view.profile.figures.text() or "Z \u22129.0" in view.profile.figures.text()
    qtbot.keyClick(view, Qt.Key.Key_Escape)
    assert view.profile.drawn is None and view.overlay.line is None


def test_another_cut_has_no_line_yet(view):
    view.show_line(((5.0, 50.0, 0.0), (95.0, 50.0, 0.0)))
    assert view.profile.drawn is not None
    view.show_cut(made_up(100))
    assert view.profile.drawn is None
