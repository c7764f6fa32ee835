"""Small files that would take gigabytes, minutes, or end in words of Python: refused in one sentence, at once."""

import struct
import time
import zlib

import numpy as np
import pytest

from app.core.errors import HitofudeError, InputError
from app.formats.drawing_account import MOST_CURVES
from app.formats.dxf.load import load
from app.formats.dxf.splines import MOST_POINTS
from app.formats.job.toml import read_job
from app.formats.project.project import project_drawing
from app.formats.svg.svg import read_svg
from app.formats.svg.xml import MOST_USES
from app.formats.tools.files import read_tools
from app.geometry.arcs.arcs import lines_and_arcs
from app.model.curves import Spline
from app.raster.picture import read_picture
from app.raster.picture_options import PictureOptions
from app.simulation.heights_file import read_heights


def chunk(kind: bytes, body: bytes, length: int | None = None) -> bytes:
    return (
        struct.pack(">I", len(body) if length is None else length)
        + kind
        + body
        + struct.pack(">I", zlib.crc32(kind + body))
    )


def png(pixels: bytes, end: bytes = chunk(b"IEND", b"")) -> bytes:
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 8, 8, 8, 0, 0, 0, 0)) + pixels + end


WHOLE = chunk(b"IDAT", zlib.compress((b"\0" + b"\xff\x00" * 4) * 8))


@pytest.mark.parametrize(
    "data",
    [
        png(chunk(b"IDAT", b"abc", 0xFFFFFFF0)),
        png(chunk(b"zTXt", b"abc", 0xFFFFFFF0) + WHOLE),
        png(WHOLE, chunk(b"IEND", b"", 12)),
        png(WHOLE)[:-2],
    ],
)
def test_a_png_whose_chunk_is_longer_than_the_file_is_not_decoded(data: bytes) -> None:
    with pytest.raises(InputError, match=r"^p\.png: .* cannot be decoded: its part '\w+' at byte \d+ reaches beyond"):
        read_picture("p.png", data, PictureOptions(pitch=0.1))


def test_a_sound_png_is_read_with_what_lies_behind_its_end() -> None:
    assert read_picture("p.png", png(WHOLE) + b"more", PictureOptions(pitch=0.1)).gray.shape == (8, 8)


def npy(header: bytes, body: bytes = b"") -> bytes:
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header + body


WHERE = b'{"x0": 0, "y0": 0, "pitch": 1}'


@pytest.mark.parametrize(
    "header",
    [
        b"{'descr': '<f4', 'fortran_order': False, 'shape': (400000000, 400000000), }\n",
        b"{'descr': '<f4', 'fortran_order': False, 'shape': (" + b"9" * 400 + b", 2), }\n",
        b"{'descr': '<f4', 'fortran_order': False, 'shape': (" + b"9" * 4400 + b", 2), }\n",
        b"{'descr': '<f4', 'fortran_order': False, 'shape': (-1, 2), }\n",
        b"{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }\n",
        b"{'descr': '<f4', 'fortran_order': False, 'shape': (2, 2\n",
        b"{'descr': 'O', 'fortran_order': False, 'shape': (2, 2), }\n",
        b"((((((((((\n",
        b"'''\n",
        b"\x00\xff",
        b"",
    ],
)
def test_a_stock_with_an_absurd_header_is_refused_in_one_sentence(header: bytes) -> None:
    with pytest.raises(InputError) as caught:
        read_heights("s.npy", npy(header, np.ones(4, np.float32).tobytes()), WHERE)
    text = str(caught.value)
    assert text.startswith("s.npy: this is no field of heights") and "\n" not in text and len(text) < 300


def test_a_sound_stock_is_read() -> None:
    data = npy(b"{'descr': '<f4', 'fortran_order': False, 'shape': (2, 2), }\n", np.ones(4, np.float32).tobytes())
    assert read_heights("s.npy", data, WHERE).workpiece.heights.shape == (2, 2)


@pytest.mark.parametrize("digits", [20, 400, 4301, 100_000])
@pytest.mark.parametrize("key", ["[[tool]]\nnumber = {}", "[[tool]]\ndiameter = {}", "[stock]\nthickness = {}"])
def test_endless_whole_numbers_in_a_job_are_refused_in_one_sentence(key: str, digits: int) -> None:
    with pytest.raises(InputError) as caught:
        read_job("j.toml", key.format("9" * digits).encode())
    assert str(caught.value).startswith("j.toml:") and "64 bits" in str(caught.value) and len(str(caught.value)) < 300


@pytest.mark.parametrize("digits", [20, 400, 4301])
def test_endless_whole_numbers_in_tools_and_projects_are_refused(digits: int) -> None:
    with pytest.raises(InputError, match="64 bits"):
        read_tools("t.toml", f"[[tool]]\nnumber = {'9' * digits}\n".encode())
    with pytest.raises(InputError, match="64 bits"):
        project_drawing(f'format = "hitofude"\nversion = 1\n[part]\nused_id = 1{"0" * digits}\n'.encode(), "p.hito")


def spline_dxf(count: int) -> bytes:
    lines = ["0", "SECTION", "2", "ENTITIES", "0", "SPLINE", "8", "0", "100", "AcDbSpline", "70", "8", "71", "3"]
    lines += ["72", str(count + 4), "73", str(count)]
    for k in [0] * 4 + list(range(1, count - 3)) + [count - 3] * 4:
        lines += ["40", str(k)]
    for k in range(count):
        lines += ["10", str(k), "20", "0", "30", "0"]
    return "\n".join([*lines, "0", "ENDSEC", "0", "EOF"]).encode()


def test_a_spline_of_too_many_points_is_refused_before_it_is_read() -> None:
    data = spline_dxf(MOST_POINTS + 1)
    begun = time.process_time()
    with pytest.raises(
        InputError, match=rf"^s\.dxf:5: a spline has {MOST_POINTS + 1} points; {MOST_POINTS} are the most"
    ):
        load(data, "s.dxf")
    assert time.process_time() - begun < 5


def test_a_spline_takes_time_by_its_points_and_not_by_their_square() -> None:
    """4,000 points took four times as long as 2,000 and 31 s at 10,000; the directions of all joints are now worked out
    together.
    """
    count = 8000
    knots = (0.0,) * 4 + tuple(map(float, range(1, count - 3))) + (count - 3.0,) * 4
    begun = time.process_time()
    made = lines_and_arcs(Spline(3, tuple((0.01 * k, 0.0) for k in range(count)), knots))
    assert time.process_time() - begun < 8 and made.deviation <= 1e-3
    assert made.primitives[0].start == (0, 0) and made.primitives[-1].end == pytest.approx((79.99, 0))


def test_entities_that_are_used_without_end_are_refused() -> None:
    def svg(count: int) -> bytes:
        head = '<!DOCTYPE svg [<!ENTITY e "1 2 ">]><svg xmlns="http://www.w3.org/2000/svg" width="9mm" height="9mm">'
        return f'{head}<polyline points="0 0 {"&e;" * count} 5 5"/></svg>'.encode()

    begun = time.process_time()
    with pytest.raises(InputError, match=rf"^x\.svg: entities are used 200000 times, and {MOST_USES} are the most"):
        read_svg(svg(200_000), "x.svg")
    assert time.process_time() - begun < 2
    assert read_svg(svg(MOST_USES), "x.svg").part.entities[0].curve.start == pytest.approx((0, 9))


def test_a_wrong_value_is_shown_in_sixty_letters() -> None:
    with pytest.raises(HitofudeError) as caught:
        read_tools("t.toml", f'[[tool]]\nnumber = "{"x" * 3069}"\n'.encode())
    assert len(str(caught.value)) < 200


@pytest.mark.parametrize(
    "where",
    [
        b'{"x0": 1%s, "y0": 0, "pitch": 1}' % (b"0" * 400),
        b'{"x0": 0, "y0": 0, "pitch": 1, "floor": 1%s}' % (b"0" * 400),
        b'{"x0": 0, "y0": 0, "pitch": 1, "floor": NaN}',
        b'{"x0": 0, "y0": 1e300, "pitch": 1}',
        b"[" * 100_000,
    ],
)
def test_a_stock_whose_place_is_absurd_is_refused_in_one_sentence(where: bytes) -> None:
    data = npy(b"{'descr': '<f4', 'fortran_order': False, 'shape': (2, 2), }\n", np.ones(4, np.float32).tobytes())
    with pytest.raises(InputError, match=r"^s\.npy: this is no field of heights") as caught:
        read_heights("s.npy", data, where)
    assert len(str(caught.value)) < 300


def test_heights_beyond_what_is_kept_of_them_are_refused() -> None:
    """Heights are kept as float32, in which 1e300 is infinite."""
    data = npy(b"{'descr': '<f8', 'fortran_order': False, 'shape': (1, 1), }\n", np.array([1e300]).tobytes())
    with pytest.raises(InputError, match=r"numbers up to 1e\+06 mm"):
        read_heights("s.npy", data, WHERE)


def test_a_polyline_of_too_many_points_is_refused_before_it_is_read() -> None:
    """A million took nine seconds and half a gigabyte to be refused, for the rows and columns of blocks that it had
    not.
    """
    points = "".join(f"10\n{k}\n20\n0\n" for k in range(MOST_CURVES + 1))
    data = f"0\nSECTION\n2\nENTITIES\n0\nLWPOLYLINE\n8\n0\n90\n{MOST_CURVES + 1}\n{points}0\nENDSEC\n0\nEOF\n".encode()
    begun = time.process_time()
    with pytest.raises(
        InputError, match=rf"^p\.dxf:5: a polyline has {MOST_CURVES + 1} points; {MOST_CURVES} are the most"
    ):
        load(data, "p.dxf")
    assert time.process_time() - begun < 3


def beziers(count: int) -> bytes:
    """A path of Béziers, one after another, that stays within 1 mm."""
    data = "".join(f"c{k % 7 / 100} .1 .1-.1{'-' * (k % 2)}.05 .0{k % 5}" for k in range(count))
    return f'<svg xmlns="http://www.w3.org/2000/svg" width="9mm" height="9mm"><path d="M0 0{data}"/></svg>'.encode()


def test_a_curve_of_too_many_beziers_is_refused_before_all_of_them_are_read() -> None:
    """Half a million took a minute, and then nobody has seen the end of what follows them within a micrometre."""
    begun = time.process_time()
    with pytest.raises(InputError, match=rf"^x\.svg:1: a curve has more than {MOST_POINTS} points; split it"):
        read_svg(beziers(500_000), "x.svg")
    assert time.process_time() - begun < 4
    drawn, closing = read_svg(beziers(MOST_POINTS // 3), "x.svg").part.entities
    assert isinstance(drawn.curve, Spline) and len(drawn.curve.control_points) == MOST_POINTS // 3 * 3 + 1
    assert closing.curve.start == drawn.curve.end
