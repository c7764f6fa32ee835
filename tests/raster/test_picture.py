"""Pictures become pixels with a size, and what their pixels leave open is found where it is."""

import random
import struct
import zlib
from pathlib import Path

import cv2
import numpy as np
import pytest

from app.core.errors import InputError, ParameterError
from app.raster.faces import ink_meaning, inner_faces
from app.raster.picture import pitch_of, read_picture, thresholded
from app.raster.picture_file import picture_size
from app.raster.picture_options import InkMeaning, PictureOptions

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
    sized = (
        png[:33]
        + struct.pack(">I", 9)
        + b"pHYs"
        + chunk
        + struct.pack(">I", __import__("zlib").crc32(b"pHYs" + chunk))
        + png[33:]
    )
    assert read_picture("a", sized, PictureOptions()).pitch == pytest.approx(0.2)
    assert read_picture("a", sized, SIZED).pitch == 0.2
    jpeg = coded(gray, ".jpg")
    at = jpeg.index(b"JFIF\0")
    at_150 = jpeg[: at + 7] + b"\x01" + struct.pack(">HH", 150, 150) + jpeg[at + 12 :]
    assert read_picture("a", at_150, PictureOptions()).pitch == pytest.approx(25.4 / 150)
    bmp = coded(gray, ".bmp")
    assert read_picture("a", bmp[:38] + struct.pack("<i", 4000) + bmp[42:], PictureOptions()).pitch == pytest.approx(
        0.25
    )
    with pytest.raises(InputError, match="does not say how large it is"):
        read_picture("a", png, PictureOptions())


def test_two_points_make_a_pitch() -> None:
    assert pitch_of((10, 10), (40, 50), 10.0) == pytest.approx(0.2)
    with pytest.raises(ParameterError, match="two that are apart"):
        pitch_of((1, 1), (1, 1), 10.0)


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (b"GIF89a", "no PNG, JPEG or BMP"),
        (b"\x89PNG\r\n\x1a\n", "header is damaged"),
        (b"\xff\xd8\xff", "header is damaged"),
        (coded(paper())[:60], "cannot be decoded"),
        (b"\x89PNG\r\n\x1a\n" + struct.pack(">I4sII", 13, b"IHDR", 50000, 50000), "50000 x 50000 px"),
        (b"\x89PNG\r\n\x1a\n" + struct.pack(">I4sII", 13, b"IHDR", 12000, 12000), "100 million"),
        (b"\x89PNG\r\n\x1a\n" + struct.pack(">I4sII", 13, b"IHDR", 0, 5), "header is damaged"),
    ],
)
def test_what_is_no_picture_is_refused(data: bytes, words: str) -> None:
    with pytest.raises(InputError, match=words):
        read_picture("a.png", data, SIZED)


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"threshold": 0}, "threshold is 0"),
        ({"despeckle": -1}, "Despeckle is -1"),
        ({"pitch": 0.0}, "pitch is 0 mm"),
        ({"dpi": 1e6}, "resolution is"),
        ({"pitch": 1.0, "dpi": 1.0}, "give one of them"),
    ],
)
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
    assert ink_meaning(ink, InkMeaning.AUTO) is InkMeaning.LINES
    assert ink_meaning(inside, InkMeaning.AUTO) is InkMeaning.AREAS
    assert ink_meaning(inside, InkMeaning.LINES) is InkMeaning.LINES


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
    assert ink_meaning(scanned(gray), InkMeaning.AUTO) is InkMeaning.LINES


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
    assert ink_meaning(scanned(gray), InkMeaning.AUTO) is InkMeaning.AREAS


@pytest.mark.parametrize("kind", ["rgba", "sixteen bits", "palette"])
def test_what_can_be_seen_through_is_paper(kind: str) -> None:
    drawn = paper() < 128
    if kind == "palette":
        rows = np.concatenate([np.zeros((120, 1), np.uint8), drawn.astype(np.uint8)], axis=1).tobytes()
        data = png((160, 120, 8, 3), (b"PLTE", bytes(6)), (b"tRNS", b"\0\xff"), (b"IDAT", zlib.compress(rows)))
    else:
        most = 255 if kind == "rgba" else 65535
        data = coded(
            np.dstack([np.zeros((120, 160, 3), np.uint8 if most == 255 else np.uint16), drawn * most]).astype(
                np.uint8 if most == 255 else np.uint16
            )
        )
    picture = read_picture("a.png", data, SIZED)
    assert np.array_equal(picture.ink, drawn)
    assert np.array_equal(picture.gray, np.where(drawn, 0, 255))


def test_half_seen_through_ink_is_grey() -> None:
    ink = np.zeros((8, 8, 4), np.uint8)
    ink[2:6, 2:6, 3] = 100
    assert read_picture("a.png", coded(ink), SIZED).gray[3, 3] == 155


def png(header: tuple[int, int, int, int], *chunks: tuple[bytes, bytes]) -> bytes:
    """A PNG of columns, rows, bits and colour type, with these chunks before its end."""
    cols, rows, bits, colour = header
    all_chunks = ((b"IHDR", struct.pack(">IIBBBBB", cols, rows, bits, colour, 0, 0, 0)), *chunks, (b"IEND", b""))
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
        for kind, body in all_chunks
    )


def grey_png(*before: tuple[bytes, bytes]) -> bytes:
    """The plate as a PNG with these chunks before its pixels."""
    rows = np.concatenate([np.zeros((120, 1), np.uint8), paper()], axis=1).tobytes()
    return png((160, 120, 8, 0), *before, (b"IDAT", zlib.compress(rows)))


def exif(across: int, down: int, turn: int = 1) -> bytes:
    entries = [
        struct.pack(">HHIHH", 0x112, 3, 1, turn, 0),
        struct.pack(">HHII", 282, 5, 1, 62),
        struct.pack(">HHII", 283, 5, 1, 70),
        struct.pack(">HHIHH", 296, 3, 1, 2, 0),
    ]
    return b"MM\0*" + struct.pack(">IH", 8, 4) + b"".join(entries) + bytes(4) + struct.pack(">IIII", across, 1, down, 1)


def with_exif(jpeg: bytes, body: bytes) -> bytes:
    return jpeg[:2] + b"\xff\xe1" + struct.pack(">H", len(body) + 8) + b"Exif\0\0" + body + jpeg[2:]


def test_a_resolution_behind_long_chunks_is_found(capfd: pytest.CaptureFixture[str]) -> None:
    profile = b"x\0\0" + zlib.compress(np.random.default_rng(1).bytes(9000))
    data = grey_png((b"iCCP", profile), (b"pHYs", struct.pack(">IIB", 10000, 10000, 1)))
    assert read_picture("a.png", data, PictureOptions()).pitch == pytest.approx(0.1)
    assert capfd.readouterr().err == ""


def test_a_resolution_in_exif_is_found() -> None:
    assert read_picture(
        "a.jpg", with_exif(coded(paper(), ".jpg"), exif(254, 254)), PictureOptions()
    ).pitch == pytest.approx(0.1)
    assert read_picture("a.png", grey_png((b"eXIf", exif(127, 127))), PictureOptions()).pitch == pytest.approx(0.2)


def anisotropic(suffix: str) -> bytes:
    """The plate at 254 dpi along rows and 127 dpi along columns."""
    if suffix == ".png":
        return grey_png((b"pHYs", struct.pack(">IIB", 10000, 5000, 1)))
    data = coded(paper(), suffix)
    if suffix == ".bmp":
        return data[:38] + struct.pack("<ii", 10000, 5000) + data[46:]
    at = data.index(b"JFIF\0")
    return data[: at + 7] + b"\x01" + struct.pack(">HH", 254, 127) + data[at + 12 :]


@pytest.mark.parametrize("suffix", [".png", ".jpg", ".bmp"])
def test_pixels_that_are_not_square_are_made_square(suffix: str) -> None:
    picture = read_picture("a" + suffix, anisotropic(suffix), PictureOptions())
    assert picture.gray.shape == (240, 160)
    assert picture.pitch == pytest.approx(0.1)
    inside = inner_faces(picture.ink)
    assert inside[60, 30]
    assert not inside[120, 60]
    assert "made 160 x 240 square ones" in picture.remarks[0]


def test_a_turned_picture_s_resolutions_turn_with_it() -> None:
    picture = read_picture("a.jpg", with_exif(coded(paper(), ".jpg"), exif(254, 127, turn=6)), PictureOptions())
    assert picture.gray.shape == (160, 240)
    assert picture.pitch == pytest.approx(0.1)


@pytest.mark.parametrize(
    "per_metre", [(-10000, -10000), (10000, -10000), (1, 1), (2**31 - 1, 2**31 - 1), (0, 0), (10000, 10)]
)
def test_a_resolution_that_cannot_be_meant_is_none(per_metre: tuple[int, int]) -> None:
    bmp = coded(paper(), ".bmp")
    data = bmp[:38] + struct.pack("<ii", *per_metre) + bmp[46:]
    with pytest.raises(InputError, match=r"a\.bmp: the picture does not say how large it is; give the size"):
        read_picture("a.bmp", data, PictureOptions())
    assert read_picture("a.bmp", data, SIZED).gray.shape == (120, 160)


@pytest.mark.parametrize("suffix", [".png", ".jpg", ".bmp"])
def test_decoders_say_nothing_of_their_own(suffix: str, capfd: pytest.CaptureFixture[str]) -> None:
    data = coded(paper(), suffix)
    with pytest.raises(InputError, match="is damaged and cannot be decoded"):
        read_picture("a" + suffix, data[: len(data) // 2 if suffix != ".bmp" else 300], SIZED)
    assert capfd.readouterr().err == ""


def test_a_picture_that_is_all_ink_says_so() -> None:
    assert "All of the picture is ink" in read_picture("a.png", coded(np.zeros((40, 40), np.uint8)), SIZED).remarks[0]
    assert read_picture("a.png", coded(paper()), SIZED).remarks == ()


@pytest.mark.parametrize("seed", range(150))
def test_damaged_pictures_are_pictures_or_sentences(seed: int, data: Path) -> None:
    rng = random.Random(seed)
    damaged = bytearray(rng.choice(sorted((data / "figures").glob("*.png"))).read_bytes())
    way = rng.randrange(4)
    if way == 0:
        del damaged[rng.randrange(len(damaged)) :]
    elif way == 1:
        at = rng.randrange(len(damaged))
        damaged[at:at] = rng.randbytes(20)
    else:
        for _ in range(rng.choice((1, 3, 30))):
            damaged[rng.randrange(8, 60 if way == 2 else len(damaged))] = rng.randrange(256)
    try:
        read_picture("scan.png", bytes(damaged), PictureOptions(dpi=300))
    except InputError as error:
        assert "scan.png" in str(error)
