"""The picture of a cut as a file."""

from pathlib import Path

import pytest
from PySide6.QtGui import QImage

from app.ui.framework.view import View
from app.ui.shell.start import build
from tests.ui.cut.made_up import made_up
from tests.ui.cut.pictures import without_a_screen


@pytest.fixture
def wiring(qtbot):
    without_a_screen().release()
    window, wiring = build()
    qtbot.addWidget(window)
    window.resize(1100, 700)
    window.show()
    return wiring


def test_the_picture_is_what_the_view_shows(qtbot, wiring, tmp_path: Path):
    view = wiring.window_.views.cut
    view.show_cut(made_up(100))
    wiring.display_controller.show_view(View.CUT)
    qtbot.waitUntil(lambda: view.render_scheduler.fine, timeout=20_000)
    wiring.image_controller.save(tmp_path / "cut")
    saved = QImage(str(tmp_path / "cut.png"))
    assert saved.size() == view.grab().size()
    assert saved.convertToFormat(QImage.Format.Format_RGB888) == view.grab().toImage().convertToFormat(
        QImage.Format.Format_RGB888
    )


def test_without_a_cut_and_without_a_folder_it_says_so(qtbot, wiring, tmp_path: Path):
    told = []
    wiring.image_controller.failed.connect(told.append)
    wiring.window_.actions_["cut_picture"].trigger()
    assert "press F5" in told[0]
    wiring.image_controller.save(tmp_path / "nowhere" / "cut.png")
    assert "nowhere" in told[1]


def test_the_empty_view_has_the_button_that_makes_the_cut(qtbot, wiring):
    wiring.document.run("rect 0,0 60,40")
    wiring.display_controller.show_view(View.CUT)
    empty = wiring.window_.views.empty
    assert empty.isVisible()
    assert (empty.sentence.text(), empty.button.text()) == ("There is no cut yet.", "Compute  F5")
    assert not wiring.window_.tool_strip.isVisible()
