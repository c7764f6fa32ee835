"""Pixels and millimetres: one conversion, there and back."""

import numpy as np
import pytest

from app.core.errors import ParameterError
from app.raster.frame import BitmapFrame


def test_row_0_is_the_top() -> None:
    x, y = BitmapFrame(4, 6, 0.5, 10.0, 20.0).centres()
    assert x.tolist() == [10.25, 10.75, 11.25, 11.75, 12.25, 12.75]
    assert y.tolist() == [21.75, 21.25, 20.75, 20.25]


def test_there_and_back() -> None:
    frame = BitmapFrame(300, 500, 0.07, -3.0, 11.0)
    points = np.random.default_rng(1).uniform(-50, 50, (100, 2))
    assert frame.to_mm(frame.to_px(points)) == pytest.approx(points, abs=1e-12)


def test_corners_of_the_picture() -> None:
    frame = BitmapFrame(300, 500, 0.1, -3.0, 11.0)
    x0, y0, x1, y1 = frame.extent
    assert frame.to_px(np.array([[x0, y1], [x1, y0]])) == pytest.approx(np.array([[0, 0], [500, 300]]))


def test_around_centres_the_extent_with_its_margin() -> None:
    frame = BitmapFrame.around((0.0, 0.0, 99.0, 40.0), 400, 2)
    assert frame.pitch == pytest.approx(0.25)
    left, top = frame.to_px(np.array([[0.0, 40.0]]))[0]
    right, bottom = frame.to_px(np.array([[99.0, 0.0]]))[0]
    assert (left, right) == pytest.approx((2.0, 398.0))
    assert top == pytest.approx(400 - bottom)


def test_around_a_point_keeps_a_pitch() -> None:
    assert BitmapFrame.around((5.0, 5.0, 5.0, 5.0)).pitch == 0.25


@pytest.mark.parametrize(
    "make",
    [
        lambda: BitmapFrame(0, 400),
        lambda: BitmapFrame(400, 40000),
        lambda: BitmapFrame(pitch=0.0),
        lambda: BitmapFrame(pitch=float("nan")),
        lambda: BitmapFrame.around((0, 0, 1, 1), 10, 5),
    ],
)
def test_senseless_frames_are_refused(make: object) -> None:
    with pytest.raises(ParameterError):
        make()  # type: ignore[operator]
