"""Pictures of rare kinds: turned ones that can be seen through, clear greys, BMP of the oldest kind."""

import struct
import zlib

import cv2
import numpy as np
import pytest

from app.raster.picture_file import decoded, density_of, picture_size


def chunk(kind: bytes, body: bytes) -> bytes:
    return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))


def turned(png: bytes, turn: int) -> bytes:
    entry = struct.pack(">HHIHH", 0x112, 3, 1, turn, 0)
    return png[:33] + chunk(b"eXIf", b"MM\0*" + struct.pack(">IH", 8, 1) + entry + bytes(4)) + png[33:]


def grey_png(depth: int, row: bytes, clear: int) -> bytes:
    """Return a picture of one row of 8 pixels; the grey `clear` is one that can be seen through."""
    header = chunk(b"IHDR", struct.pack(">IIBBBBB", 8, 1, depth, 0, 0, 0, 0))
    pixels = chunk(b"tRNS", struct.pack(">H", clear)) + chunk(b"IDAT", zlib.compress(b"\0" + row))
    return b"\x89PNG\r\n\x1a\n" + header + pixels + chunk(b"IEND", b"")


@pytest.mark.parametrize("depth", [np.uint8, np.uint16])
@pytest.mark.parametrize("turn", range(1, 9))
def test_a_picture_that_can_be_seen_through_is_turned_as_any_other(turn: int, depth: type) -> None:
    most = np.iinfo(depth).max
    image = np.full((4, 6, 4), most, depth)
    image[1, 1:4, :3] = image[2, 1, :3] = 0
    whole, plain = (cv2.imencode(".png", each)[1].tobytes() for each in (image, image[..., 0]))
    assert np.array_equal(decoded("x.png", turned(whole, turn)), decoded("x.png", turned(plain, turn)))


@pytest.mark.parametrize(
    ("depth", "row", "clear"),
    [
        (1, bytes([0x0F]), 0),
        (2, bytes([0x00, 0xFF]), 0),
        (4, bytes([0x55, 0x55, 0xFF, 0xFF]), 5),
        (8, bytes([7] * 4 + [255] * 4), 7),
        (16, struct.pack(">8H", *[300] * 4, *[65535] * 4), 300),
    ],
)
def test_a_clear_grey_is_paper(depth: int, row: bytes, clear: int) -> None:
    assert decoded("x.png", grey_png(depth, row, clear)).min() == 255


def test_a_grey_beside_the_clear_one_is_ink() -> None:
    assert decoded("x.png", grey_png(8, bytes([7, 8] * 4), 7)).tolist() == [[255, 8] * 4]


def test_a_bmp_of_the_oldest_kind() -> None:
    header = struct.pack("<IHHHH", 12, 8, 2, 1, 24)
    data = b"BM" + struct.pack("<IHHI", 26 + 48, 0, 0, 26) + header + (bytes(12) + b"\xff" * 12) * 2
    assert picture_size("x.bmp", data) == (8, 2) and density_of(data) is None
    assert decoded("x.bmp", data).tolist() == [[0] * 4 + [255] * 4] * 2


def masked_bmp(pixels: bytes, header: int = 124, alpha: int = 0xFF000000) -> bytes:
    """Return a BMP of 4 by 1 pixels of 4 bytes: blue, green, red, and how little of what lies behind it is seen."""
    sizes = struct.pack("<IiiHHIIiiII", header, 4, 1, 1, 32, 3, len(pixels), 0, 0, 0, 0)
    masks = struct.pack("<IIII", 0xFF0000, 0xFF00, 0xFF, alpha)
    head = (sizes + masks).ljust(header, b"\0") if header > 40 else sizes + masks[:12]
    return b"BM" + struct.pack("<IHHI", 14 + len(head) + len(pixels), 0, 0, 14 + len(head)) + head + pixels


@pytest.mark.parametrize("header", [56, 108, 124])
def test_clear_pixels_of_a_bmp_are_paper(header: int) -> None:
    assert decoded("x.bmp", masked_bmp(bytes([0, 0, 0, 255] * 2 + [0] * 8), header)).tolist() == [[0, 0, 255, 255]]


@pytest.mark.parametrize(("header", "alpha"), [(40, 0xFF000000), (124, 0)])
def test_bits_of_a_bmp_that_mean_nothing_make_nothing_clear(header: int, alpha: int) -> None:
    assert decoded("x.bmp", masked_bmp(bytes([0, 0, 0, 9, 255, 255, 255, 0] * 2), header, alpha)).tolist() == [
        [0, 255] * 2
    ]


def test_a_bmp_of_which_nothing_could_be_seen_is_as_its_colours() -> None:
    assert decoded("x.bmp", masked_bmp(bytes([0, 0, 0, 0, 255, 255, 255, 0] * 2))).tolist() == [[0, 255] * 2]


def test_a_clear_png_is_paper() -> None:
    assert decoded("x.png", cv2.imencode(".png", np.zeros((2, 3, 4), np.uint8))[1].tobytes()).min() == 255
