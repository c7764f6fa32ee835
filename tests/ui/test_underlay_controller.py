"""A picture under the drawing: read with care, scaled by two points, moved, straightened, hidden, taken away."""

import math
from pathlib import Path

import pytest
from hypothesis import strategies as st
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QColor, QImage

from app.core.errors import InputError, ParameterError
from app.model.underlay import Underlay
from app.ui.shell.window_controller import WindowController
from app.ui.views.canvas.painting import underlay_layer
from app.ui.views.canvas.painting.underlay_layer import read_picture
from app.ui.views.canvas.view_transform import ViewTransform

NUMBERS = st.floats(-1e4, 1e4)


@pytest.fixture
def picture(tmp_path: Path) -> Path:
    """200 x 100 px, white, with a red square of 20 px whose lower left corner is 40 px from the left and 10 px from
    below.
    """
    image = QImage(200, 100, QImage.Format.Format_RGB32)
    image.fill(QColor("white"))
    for x in range(40, 60):
        for y in range(70, 90):
            image.setPixelColor(x, y, QColor("red"))
    path = tmp_path / "plan.png"
    assert image.save(str(path))
    return path


@pytest.fixture
def traced(wiring: WindowController, picture: Path) -> WindowController:
    wiring.window_.canvas.set_view(ViewTransform(5.0, 124.0, 500.0))
    wiring.underlay_controller.place(picture)
    return wiring


def click(qtbot, wiring: WindowController, x: float, y: float) -> None:
    at: QPoint = wiring.window_.canvas.view.to_screen((x, y)).toPoint()
    qtbot.mouseClick(wiring.window_.canvas, Qt.MouseButton.LeftButton, pos=at)


def colour(wiring: WindowController, x: float, y: float) -> QColor:
    canvas = wiring.window_.canvas
    return canvas.grab().toImage().pixelColor(canvas.view.to_screen((x, y)).toPoint())


def reddish(seen: QColor) -> bool:
    return seen.red() > seen.green() + 60


def test_a_picture_fills_the_display_and_lies_upright(traced: WindowController) -> None:
    place = traced.underlay_controller.underlay
    assert place is not None
    assert (place.origin, place.mm_per_px) == ((0, 0), 0.5)
    assert reddish(colour(traced, 26, 11))
    assert not reddish(colour(traced, 26, 41))
    assert traced.document.part.entities == ()


def test_two_points_and_their_distance_give_the_size(qtbot, traced: WindowController) -> None:
    traced.window_.actions_["underlay_scale"].trigger()
    click(qtbot, traced, 20, 5)
    click(qtbot, traced, 30, 5)
    assert "distance" in traced.window_.canvas.prompt
    assert traced.window_.canvas.type_text("2in")
    place = traced.underlay_controller.underlay
    assert place is not None
    assert place.mm_per_px == pytest.approx(0.5 * 5.08)
    assert place.origin == pytest.approx((20 - 20 * 5.08, 5 - 5 * 5.08))
    assert traced.window_.canvas.marker_mode is None
    assert reddish(colour(traced, 46.3, 31.3))


def test_a_wrong_distance_is_said_and_asked_again(qtbot, traced: WindowController) -> None:
    traced.window_.actions_["underlay_scale"].trigger()
    click(qtbot, traced, 20, 5)
    click(qtbot, traced, 30, 5)
    assert traced.window_.canvas.type_text("0")
    assert "greater than 0" in traced.window_.status.message.toolTip()
    assert traced.window_.canvas.marker_mode is not None


def test_it_is_moved_and_straightened(qtbot, traced: WindowController) -> None:
    traced.window_.actions_["underlay_move"].trigger()
    click(qtbot, traced, 20, 5)
    click(qtbot, traced, 40, 15)
    assert traced.underlay_controller.underlay is not None
    assert traced.underlay_controller.underlay.origin == pytest.approx((20, 10))
    traced.window_.actions_["underlay_turn"].trigger()
    click(qtbot, traced, 40, 15)
    click(qtbot, traced, 60, 25)
    assert traced.underlay_controller.underlay.angle == pytest.approx(-math.atan2(10, 20))


def test_it_is_hidden_shown_and_removed(traced: WindowController) -> None:
    shown = traced.window_.actions_["underlay_shown"]
    shown.setChecked(False)
    assert not reddish(colour(traced, 26, 11))
    shown.setChecked(True)
    assert reddish(colour(traced, 26, 11))
    traced.window_.actions_["underlay_remove"].trigger()
    assert traced.underlay_controller.underlay is None
    assert not shown.isEnabled()
    assert not reddish(colour(traced, 26, 11))


def test_another_drawing_has_its_own(traced: WindowController) -> None:
    traced.document.load(traced.document.job)
    assert traced.underlay_controller.underlay is None


def test_what_is_no_picture_is_refused(tmp_path: Path, picture: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "text.png").write_text("no picture")
    with pytest.raises(InputError, match="PNG or JPEG"):
        read_picture(tmp_path / "text.png")
    (tmp_path / "cut.png").write_bytes(picture.read_bytes()[:60])
    with pytest.raises(InputError, match=r"damaged|PNG"):
        read_picture(tmp_path / "cut.png")
    monkeypatch.setattr(underlay_layer, "MOST_PX", 19_999)
    with pytest.raises(InputError, match="200 x 100 px"):
        read_picture(picture)


def test_a_picture_without_size_is_refused() -> None:
    with pytest.raises(ParameterError):
        Underlay("a.png", (0.0, 0.0), -1.0, 0.0, 1.0)
