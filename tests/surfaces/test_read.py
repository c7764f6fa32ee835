"""Files of triangles: binary and text STL to the last bit, and whatever is cut off or no file is told in one
sentence.
"""

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.core.errors import InputError
from app.simulation.field.solid import read_solid
from app.surfaces.meshes.read import read_mesh
from tests.examples import examples
from tests.surfaces.solids import pocketed_block, stl

BLOCK = pocketed_block()
DATA = stl(BLOCK)


def text(triangles: np.ndarray) -> bytes:
    lines = ["solid block"]
    for triangle in triangles.tolist():
        lines += [
            "facet normal 0 0 0",
            "outer loop",
            *(f"vertex {x} {y} {z}" for x, y, z in triangle),
            "endloop",
            "endfacet",
        ]
    return "\n".join([*lines, "endsolid block", ""]).encode()


def test_both_kinds_hold_the_same_triangles() -> None:
    for data in (DATA, stl(BLOCK, b"solid made by somebody"), text(BLOCK), DATA + b"more"):
        assert np.array_equal(read_mesh("a.stl", data), BLOCK)


@pytest.mark.parametrize("size", [84, 90, 134, 1000, len(DATA) - 1])
@pytest.mark.parametrize("header", [b"", b"solid made by somebody"])
def test_a_file_that_was_cut_off_says_so(size: int, header: bytes) -> None:
    with pytest.raises(InputError) as told:
        read_mesh("a.stl", stl(BLOCK, header)[:size])
    said = str(told.value)
    assert said.startswith("a.stl: ") and "charset" not in said
    assert f"{size:,} bytes of the {len(DATA):,} that its 28 triangles take" in said or size == 84


def test_a_text_that_was_cut_off_says_so() -> None:
    with pytest.raises(InputError, match="cut off after 5 triangles"):
        read_mesh("a.stl", text(BLOCK).partition(b"endsolid")[0][: text(BLOCK[:5]).index(b"endsolid")])


@given(st.binary(max_size=400), st.sampled_from(["a.stl", "a.obj", "a.ply"]), st.booleans())
@settings(max_examples=examples(150), deadline=None)
def test_any_bytes_are_triangles_or_one_sentence(data: bytes, name: str, spoiled: bool) -> None:
    if spoiled:
        data = DATA[: 3 * len(data)] + data
    try:
        assert read_mesh(name, data).shape[1:] == (3, 3)
    except InputError as error:
        assert str(error).startswith(f"{name}: ") and "\n" not in str(error)


def test_a_library_does_not_complain_beside_the_sentence(capfd: pytest.CaptureFixture[str]) -> None:
    ply = b"ply\nformat ascii 1.0\nelement vertex 9\nend_header\n1 2"
    for name, data in (("a.ply", ply), ("a.obj", b"v 1 2\nf 1 2 3\n"), ("a.stl", b"x")):
        with pytest.raises(InputError):
            read_mesh(name, data)
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("far", [1e308, 1e20, float("nan"), float("inf")])
@pytest.mark.parametrize("read", [read_mesh, read_solid])
def test_a_corner_that_is_no_place_of_a_part_is_told(far: float, read: Callable[[str, bytes], object]) -> None:
    """Of a solid too: beyond them sewing counted with numbers that are none."""
    block = BLOCK.copy()
    block[3, 1, 0] = far
    with pytest.raises(InputError, match=r"^a\.stl: a corner of a triangle is no number, or far out of range"):
        read("a.stl", text(block))


def test_an_edge_too_short_to_have_a_length_is_no_error_of_ours() -> None:
    block = BLOCK.copy()
    block[14, 0] = (1e-300, 30.0, -10.0)
    with (
        np.errstate(invalid="raise", divide="raise"),
        pytest.raises(InputError, match="the solid's surface is not closed"),
    ):
        read_solid("a.stl", text(block))
