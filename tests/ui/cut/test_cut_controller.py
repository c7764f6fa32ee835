"""The window cuts what it has computed, without being asked, and shows what is left."""

import numpy as np
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from app.ui.framework.computation import ComputationState
from app.ui.framework.view import View
from app.ui.panels.changes import Subject, SubjectKind
from app.ui.shell.window_controller import WindowController


def test_the_sample_is_cut_and_forgotten_with_its_drawing(qtbot: QtBot, wiring: WindowController) -> None:
    wiring.files.open_sample()
    qtbot.waitUntil(lambda: wiring.computation.state is ComputationState.CURRENT, timeout=60_000)
    view = wiring.window_.views.cut
    qtbot.waitUntil(lambda: view.model.picture is not None, timeout=60_000)
    picture = view.model.picture
    assert picture is not None and picture.moves is not None and picture.move is not None and picture.paths is not None
    assert picture.heights.shape == (1024, 1024)
    assert (float(picture.heights.min()), picture.top, picture.floor) == (-2.0, 0.0, -10.0)
    made = wiring.computation.made
    assert made is not None
    lines = set(picture.moves.line[picture.move[picture.move >= 0]].tolist())
    assert lines <= set(made.nc.lines.tolist())
    wiring.display_controller.show_view(View.CUT)
    QApplication.processEvents()
    assert not wiring.window_.views.empty.isVisible()
    row, column = (int(k) for k in np.argwhere(picture.move >= 0)[5000])
    motion = picture.move_at(row, column)
    view.cell_picked.emit(0.0, 0.0, 0.0, motion)
    beside = wiring.window_.cut_panel.nc
    assert wiring.display_controller.view is View.CUT, "nothing leaves"
    assert beside.text.current + 1 == picture.moves.line[motion] and "Pocket T1" in beside.where.text()
    assert view.overlay.way is not None and wiring.window_.panel.subject == Subject(SubjectKind.OPERATION, 0)
    wiring.files.new()
    qtbot.waitUntil(lambda: view.model.picture is None, timeout=10_000)
    assert wiring.window_.views.empty.isVisible() or wiring.display_controller.view is not View.CUT
