"""The tube over the window: crisp squares, the same in every theme, all keys its own; pictures that were looked at."""

import cv2
import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QImage

from app.core.settings import Phosphor, Settings, ThemeChoice, load_settings, save_settings
from app.ui.shell.start import build
from app.ui.views.session1986.questions import SessionQuestion
from app.ui.views.session1986.screen import BOTTOM, LINE_PX
from tests.conftest import ROOT

SNAPSHOTS = ROOT / "tests" / "data" / "session1986"
_MEASURED = BOTTOM + 3 + 4 * LINE_PX
"""Row of the line under the four questions: it states a length that every better fit changes."""


def seen(in_window) -> np.ndarray:
    """The window's picture (rows, cols, 4) BGRA."""
    image = in_window.wiring.window_.grab().toImage().convertToFormat(QImage.Format.Format_RGB32)
    return np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), image.width(), 4).copy()


@pytest.mark.parametrize(
    ("size", "side"), [((1280, 800), 800), ((1920, 1080), 800), ((1300, 1210), 1200), ((1100, 700), 700)]
)
def test_points_are_whole_squares_where_two_or_more_fit(in_window, size, side) -> None:
    in_window.wiring.window_.resize(*size)
    rect = in_window.tube.screen_rect()
    assert in_window.tube.size() == in_window.wiring.window_.size()
    assert (rect.width(), rect.height()) == (side, side)
    if side % 400:
        return
    lit = seen(in_window)[rect.top() : rect.bottom() + 1, rect.left() : rect.right() + 1, 1] > 140
    k = side // 400
    assert np.array_equal(lit, np.kron(in_window.screen.bits(), np.ones((k, k), bool)))


def test_it_is_the_same_in_both_themes_and_covers_the_window(in_window) -> None:
    in_window.tube._blink.stop()
    pictures = []
    for choice in (ThemeChoice.LIGHT, ThemeChoice.DARK):
        in_window.wiring.window_.set_theme_choice(choice)
        pictures.append(seen(in_window))
    assert np.array_equal(*pictures)
    assert pictures[0][:, :200, :3].max() < 40, "nothing of the window shows beside the tube"


def test_f2_takes_the_amber_tube(in_window) -> None:
    row, col = 5, in_window.tube.screen_rect().left() + 500
    blue, green, red = seen(in_window)[row, col, :3].tolist()
    assert green > red
    in_window.key(Qt.Key.Key_F2)
    assert in_window.tube.phosphor is Phosphor.AMBER
    blue, green, red = seen(in_window)[row, col, :3].tolist()
    assert red > green > blue


def test_the_tube_that_was_chosen_is_there_again_the_next_time(qtbot, in_window) -> None:
    save_settings(Settings(phosphor=Phosphor.AMBER, last_folder="/x"))
    assert load_settings() == Settings(phosphor=Phosphor.AMBER, last_folder="/x")
    save_settings(Settings())
    in_window.key(Qt.Key.Key_F2)
    assert load_settings().phosphor is Phosphor.AMBER
    window, wiring = build()
    qtbot.addWidget(window)
    window.actions_["session_1986"].trigger()
    assert wiring.session_1986.tube.phosphor is Phosphor.AMBER
    wiring.session_1986.session.finish()
    window.worker.finish(20.0)


def test_the_window_s_keys_rest(qtbot, in_window) -> None:
    window = in_window.wiring.window_
    fired: list[str] = []
    for name in ("open", "export", "compute", "undo", "view_cut"):
        window.actions_[name].triggered.connect(lambda _=False, name=name: fired.append(name))
    for key, modifiers in (
        (Qt.Key.Key_F5, Qt.KeyboardModifier.NoModifier),
        (Qt.Key.Key_E, Qt.KeyboardModifier.ControlModifier),
        (Qt.Key.Key_4, Qt.KeyboardModifier.ControlModifier),
        (Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier),
    ):
        in_window.key(key, modifiers)
    assert fired == [] and in_window.screen.typed == ""
    window.canvas.setFocus()
    qtbot.waitUntil(in_window.tube.hasFocus, timeout=2000)
    in_window.key(Qt.Key.Key_Escape)
    qtbot.keyClick(window.canvas, Qt.Key.Key_4, Qt.KeyboardModifier.ControlModifier)
    assert fired == ["view_cut"]


def test_the_screen_after_each_process_looks_as_it_did_when_it_was_looked_at(in_window, tmp_path) -> None:
    in_window.screen.lit = False
    in_window.tube._blink.stop()
    in_window.answer("2")
    in_window.until(SessionQuestion.CONTOUR)
    pictures = {"110": in_window.screen.bits()}
    in_window.answer("1.5")
    in_window.until(SessionQuestion.PLAY)
    pictures["120"] = in_window.screen.bits()
    in_window.see_all(SessionQuestion.POCKET)
    pictures["130"] = in_window.screen.bits()
    in_window.answer("3")
    in_window.answer("3")
    in_window.until(SessionQuestion.PLAY)
    in_window.key(Qt.Key.Key_Left)
    for _ in range(len(in_window.session.playing._stills)):
        in_window.key(Qt.Key.Key_Right)
    pictures["140"] = in_window.screen.bits()
    for name, bits in pictures.items():
        cv2.imwrite(str(tmp_path / f"{name}.png"), bits.astype(np.uint8) * 255)
    for name, bits in pictures.items():
        expected = cv2.imread(str(SNAPSHOTS / f"{name}.png"), cv2.IMREAD_GRAYSCALE)
        assert np.array_equal(bits[:_MEASURED], expected[:_MEASURED] > 0), (
            f"the screen after {name} looks otherwise: {tmp_path}/{name}.png"
        )
