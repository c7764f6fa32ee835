"""Pictures become pixels with a size, and what their pixels leave open is found where it is."""

import struct

import cv2
import numpy as np
import pytest

from app.bitmap.faces import Doubt, ambiguities, inner_faces, shows
from app.bitmap.picture import PictureOptions, Shows, picture_size, pitch_of, read_picture, thresholded
from app.errors import InputError, ParameterError

SIZED = PictureOptions(pitch=0.2)


def paper() -> np.ndarray:
    """A plate with a hole, drawn with lines of 2 px, on paper that is not quite white."""
    gray = np.full((120, 160), 231, np.uint8)
    cv2.rectangle(gray, (20, 20), (140, 100), 30, 2)
    cv2.circle(gray, (60, 60), 20, 30, 2)
    return gray


def coded(gray: np.ndarray, suffix: str = ".png") -> bytes:
    return bytes(cv2.imencode(suffix, gray)[1])


def ink_of(*lines: str) -> np.ndarray:
    return np.array([[cell == "#" for cell in line] for line in lines])


@pytest.mark.parametrize("suffix", [".png", ".jpg", ".bmp"])
def test_each_format_is_read(suffix: str) -> None:
    data = coded(paper(), suffix)
    assert picture_size("a", data) == (160, 120)
    picture = read_picture("a" + suffix, data, SIZED)
    assert picture.gray.shape == (120, 160)
    assert picture.pitch == 0.2
    assert np.mean(picture.ink != (paper() < 128)) < 0.005


def test_the_threshold_is_otsu_s_unless_given() -> None:
    gray = paper()
    gray[90:95, 60:100] = 150
    assert 30 < thresholded(gray, 1.0, PictureOptions()).threshold <= 150
    assert not thresholded(gray, 1.0, PictureOptions()).ink[92, 80]
    assert thresholded(gray, 1.0, PictureOptions(threshold=200)).ink[92, 80]


def test_light_on_dark_is_inverted() -> None:
    dark = 255 - paper()
    assert np.array_equal(thresholded(dark, 1.0, PictureOptions(invert=True, threshold=128)).ink, dark >= 128)


def test_specks_of_ink_and_of_paper_go_and_lines_stay() -> None:
    gray = paper()
    before = thresholded(gray, 1.0, PictureOptions()).ink
    gray[50:52, 100:102], gray[20, 70] = 0, 255
    assert np.array_equal(thresholded(gray, 1.0, PictureOptions()).ink, before)
    assert thresholded(gray, 1.0, PictureOptions(despeckle=0)).ink[50, 100]


def test_the_pitch_comes_from_what_is_asked_then_from_the_file() -> None:
    gray, png = paper(), coded(paper())
    assert read_picture("a", png, PictureOptions(dpi=254)).pitch == pytest.approx(0.1)
    chunk = struct.pack(">IIB", 5000, 5000, 1)
    sized = png[:33] + struct.pack(">I", 9) + b"pHYs" + chunk + struct.pack(">I", __import__("zlib").crc32(b"pHYs" + chunk)) + png[33:]
    assert read_picture("a", sized, PictureOptions()).pitch == pytest.approx(0.2)
    assert read_picture("a", sized, SIZED).pitch == 0.2
    jpeg = coded(gray, ".jpg")
    at = jpeg.index(b"JFIF\0")
    at_150 = jpeg[: at + 7] + b"\x01" + struct.pack(">HH", 150, 150) + jpeg[at + 12 :]
    assert read_picture("a", at_150, PictureOptions()).pitch == pytest.approx(25.4 / 150)
    bmp = coded(gray, ".bmp")
    assert read_picture("a", bmp[:38] + struct.pack("<i", 4000) + bmp[42:], PictureOptions()).pitch == pytest.approx(0.25)
    with pytest.raises(InputError, match="does not say how large it is"):
        read_picture("a", png, PictureOptions())


def test_two_points_make_a_pitch() -> None:
    assert pitch_of((10, 10), (40, 50), 10.0) == pytest.approx(0.2)
    with pytest.raises(ParameterError, match="two that are apart"):
        pitch_of((1, 1), (1, 1), 10.0)


@pytest.mark.parametrize(("data", "words"), [
    (b"GIF89a", "no PNG, JPEG or BMP"), (b"\x89PNG\r\n\x1a\n", "header is damaged"), (b"\xff\xd8\xff", "header is damaged"),
    (coded(paper())[:60], "cannot be decoded"),
    (b"\x89PNG\r\n\x1a\n" + struct.pack(">I4sII", 13, b"IHDR", 50000, 50000), "50000 x 50000 px"),
    (b"\x89PNG\r\n\x1a\n" + struct.pack(">I4sII", 13, b"IHDR", 12000, 12000), "100 million"),
    (b"\x89PNG\r\n\x1a\n" + struct.pack(">I4sII", 13, b"IHDR", 0, 5), "header is damaged"),
])  # fmt: skip
def test_what_is_no_picture_is_refused(data: bytes, words: str) -> None:
    with pytest.raises(InputError, match=words):
        read_picture("a.png", data, SIZED)


@pytest.mark.parametrize(("values", "words"), [
    ({"threshold": 0}, "threshold is 0"), ({"despeckle": -1}, "Despeckle is -1"), ({"pitch": 0.0}, "pitch is 0 mm"),
    ({"dpi": 1e6}, "resolution is"), ({"pitch": 1.0, "dpi": 1.0}, "give one of them"),
])  # fmt: skip
def test_options_have_ranges(values: dict, words: str) -> None:
    with pytest.raises(ParameterError, match=words):
        PictureOptions(**values)


def test_what_lines_enclose_once_is_inside_twice_is_an_island() -> None:
    ink = thresholded(paper(), 1.0, PictureOptions()).ink
    inside = inner_faces(ink)
    assert inside[30, 30]
    assert not inside[60, 60]
    assert not inside[5, 5]
    assert not np.any(inside & ink)
    assert shows(ink, Shows.AUTO) is Shows.LINES
    assert shows(inside, Shows.AUTO) is Shows.AREAS
    assert shows(inside, Shows.LINES) is Shows.LINES


def scanned(gray: np.ndarray) -> np.ndarray:
    """Ink of a scan: blurred, with noise."""
    noise = np.random.default_rng(1).normal(0, 6, gray.shape)
    soft = np.clip(cv2.GaussianBlur(gray, (3, 3), 0.8) + noise, 0, 255).astype(np.uint8)
    return thresholded(soft, 1.0, PictureOptions()).ink


@pytest.mark.parametrize("width", [1, 3, 4, 5, 6, 7, 8, 12])
@pytest.mark.parametrize("size", [300, 1200])
def test_lines_of_any_width_of_a_pen_are_lines(width: int, size: int) -> None:
    gray = np.full((size, size), 235, np.uint8)
    near, middle, far = size // 20, size // 2, size - size // 20
    cv2.rectangle(gray, (near, near), (far, far), 25, min(width, size // 30))
    for end in ((far, middle), (middle, far)):
        cv2.line(gray, (middle, middle), end, 25, min(width, size // 30))
    cv2.circle(gray, (size // 4, size // 4), size // 8, 25, min(width, size // 30))
    assert shows(scanned(gray), Shows.AUTO) is Shows.LINES


@pytest.mark.parametrize("size", [300, 1200])
@pytest.mark.parametrize("figure", ["plate", "bar", "bracket", "washers", "window"])
def test_filled_figures_are_areas(figure: str, size: int) -> None:
    gray = np.full((size, size), 235, np.uint8)
    near, far, bar = size // 20, size - size // 20, size // 36
    cv2.rectangle(gray, (near, near), (far, far), 25 if figure in ("plate", "window") else 235, -1)
    if figure == "plate":
        cv2.circle(gray, (size // 3, size // 3), size // 10, 235, -1)
    elif figure == "window":
        cv2.rectangle(gray, (3 * near, 3 * near), (size - 3 * near, size - 3 * near), 235, -1)
    elif figure == "washers":
        for k in (1, 3, 5):
            cv2.circle(gray, (k * size // 6, size // 2), size // 8, 25, -1)
            cv2.circle(gray, (k * size // 6, size // 2), size // 10, 235, -1)
    else:
        cv2.rectangle(gray, (near, near), (far, near + bar), 25, -1)
        cv2.rectangle(gray, (near, near), (near + bar, far if figure == "bracket" else near + bar), 25, -1)
    assert shows(scanned(gray), Shows.AUTO) is Shows.AREAS


def test_a_clear_picture_leaves_nothing_open() -> None:
    assert ambiguities(thresholded(paper(), 1.0, PictureOptions()).ink) == ()
    assert ambiguities(np.zeros((9, 9), bool)) == ()


def doubts(gray: np.ndarray) -> list[tuple[Doubt, int, int]]:
    found = ambiguities(thresholded(gray, 1.0, PictureOptions()).ink)
    return [(each.doubt, round(each.col / 5) * 5, round(each.row / 5) * 5) for each in found]


def test_where_lines_meet_is_told() -> None:
    gray = paper()
    cv2.line(gray, (110, 20), (110, 100), 30, 2)
    assert doubts(gray) == [(Doubt.JUNCTION, 110, 20), (Doubt.JUNCTION, 110, 100)]


def test_where_a_line_nearly_closes_is_told() -> None:
    gray = paper()
    gray[18:24, 100:102] = 255
    assert doubts(gray) == [(Doubt.GAP, 100, 20)]


def test_where_two_lines_have_become_one_is_told() -> None:
    gray = paper()
    cv2.line(gray, (137, 40), (137, 80), 30, 2)
    assert [each[0] for each in doubts(gray)] == [Doubt.MERGED]


def test_lines_of_one_pixel_that_run_side_by_side_are_told() -> None:
    ink = ink_of("............", ".##########.", ".##########.", ".#........#.", ".#........#.", ".##########.", "............")
    assert [each.doubt for each in ambiguities(ink)] == [Doubt.MERGED]


def test_lines_a_pixel_apart_are_told() -> None:
    gray = paper()
    cv2.line(gray, (136, 40), (136, 80), 30, 2)
    assert Doubt.NARROW in [each[0] for each in doubts(gray)]
