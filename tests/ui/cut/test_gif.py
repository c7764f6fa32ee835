"""GIFs, read again by two programs that are not ours."""

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from PySide6.QtCore import QBuffer, QByteArray
from PySide6.QtGui import QImage, QImageReader

from app.ui.views.cut.gif import changed, gif_chunks
from tests.examples import examples

WIDTH, HEIGHT = 90, 70


def moving(count, colours=6):
    """A square that moves over stripes."""
    stripes = (np.arange(WIDTH) // 7 % colours * 40)[None, :, None] * np.array([1.0, 0.6, 0.3])
    for k in range(count):
        frame = np.repeat(stripes, HEIGHT, axis=0).astype(np.uint8)
        frame[10 + 3 * k : 24 + 3 * k, 8 + 5 * k : 22 + 5 * k] = (20, 230, 120)
        yield frame


def packed(frames, per_second=25.0):
    return b"".join(gif_chunks(frames, per_second))


def by_opencv(data):
    """Durations, ms, and pictures."""
    done, found = cv2.imdecodeanimation(np.frombuffer(data, np.uint8))
    assert done
    return list(found.durations), [frame[..., 2::-1] for frame in found.frames], found.loop_count


def by_qt(data):
    """Durations, ms, pictures, and how often they are shown; -1 = for ever."""
    buffer = QBuffer()
    buffer.setData(QByteArray(data))
    buffer.open(QBuffer.OpenModeFlag.ReadOnly)
    reader, delays, images = QImageReader(buffer, b"gif"), [], []
    while reader.canRead():
        image = reader.read().convertToFormat(QImage.Format.Format_RGB888)
        delays.append(reader.nextImageDelay())
        flat = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), image.bytesPerLine())
        images.append(flat[:, : 3 * image.width()].reshape(image.height(), image.width(), 3).copy())
    return delays, images, reader.loopCount()


def test_both_read_every_picture_its_size_its_time_and_that_it_goes_on_for_ever():
    expected = list(moving(8))
    data = packed(iter(expected))
    for durations, images, loops in (by_opencv(data), by_qt(data)):
        assert durations == [40] * 8
        assert len(images) == 8 and all(image.shape == (HEIGHT, WIDTH, 3) for image in images)
        assert loops in (0, -1)
        for got, frame in zip(images, expected, strict=True):
            assert np.abs(got.astype(int) - frame).max() <= 4


def test_times_that_are_no_hundredths_do_not_add_up():
    durations, _, _ = by_opencv(packed(moving(12), 30.0))
    assert set(durations) == {30, 40} and sum(durations) == 400


def test_only_what_changes_is_written():
    still = next(moving(1))
    alone, thirty = packed(iter([still])), packed(still for _ in range(30))
    assert len(thirty) < 2 * len(alone) + 30 * 900
    durations, images, _ = by_qt(thirty)
    assert len(images) == len(durations) == 30
    assert all(np.array_equal(image, images[0]) for image in images)


def test_a_picture_of_many_colours_keeps_them_nearly():
    rows, columns = np.mgrid[0:160, 0:200]
    light = 0.5 + 0.5 * np.sin(columns / 17.0) * np.cos(rows / 23.0)
    frame = (light[..., None] * np.array([190.0, 196.0, 204.0]) + 20).astype(np.uint8)
    _, (got,), _ = by_opencv(packed(iter([frame])))
    error = np.abs(got.astype(int) - frame)
    assert error.mean() < 1.5 and error.max() < 10


@settings(max_examples=examples(40), deadline=None)
@given(st.integers(1, 40), st.integers(1, 40), st.integers(1, 4), st.integers(0, 2**32 - 1))
def test_pictures_of_any_size_and_change_come_back(width, height, count, seed):
    noise = np.random.default_rng(seed)
    colours = noise.integers(0, 256, (16, 3)).astype(np.uint8)
    frames = [colours[noise.integers(0, 16, (height, width))]]
    for _ in range(count - 1):
        frame = frames[-1].copy()
        row, col = noise.integers(0, height), noise.integers(0, width)
        frame[row : row + 5, col : col + 5] = colours[noise.integers(0, 16)]
        frames.append(frame)
    durations, images, _ = by_qt(packed(iter(frames), 10.0))
    assert durations == [100] * count
    assert all(np.abs(got.astype(int) - frame).max() <= 8 for got, frame in zip(images, frames, strict=True))


def test_the_rectangle_of_what_changed():
    before = np.zeros((5, 9, 3), np.uint8)
    after = before.copy()
    after[1, 3, 2] = after[3, 7, 0] = 1
    assert changed(before, after) == (slice(1, 4), slice(3, 8))
    assert changed(None, after) == (slice(0, 5), slice(0, 9)) and changed(after, after) == (slice(0, 1), slice(0, 1))


def test_pictures_of_two_sizes_and_no_picture_at_all_are_refused():
    with pytest.raises(ValueError, match="picture 2 is 3 by 2 px, the one before 4 by 2"):
        packed(iter([np.zeros((2, 4, 3), np.uint8), np.zeros((2, 3, 3), np.uint8)]))
    with pytest.raises(ValueError, match="no pictures"):
        packed(iter([]))
