"""Files of triangles: binary and text STL to the last bit, and whatever is cut off or no file is told in one
sentence.
"""

import struct
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


@pytest.mark.parametrize("end", [b"\r\n", b"\r", b" "])
def test_lines_of_a_text_end_in_any_way_or_not_at_all(end: bytes) -> None:
    assert np.array_equal(read_mesh("a.stl", text(BLOCK).replace(b"\n", end)), BLOCK)


@pytest.mark.parametrize(
    "faces",
    [
        b"f 1/1/1 2/1/1 3/1/1 4/1/1",
        b"f 1/1 2/1 3/1 4/1",
        b"f 1/1/1 2/1/1 3/1/1\nf 1//1 3//1 4//1",
        b"f -4/-1/-1 -3/-1/-1 -2/-1/-1 \\\n-1/-1/-1",
        b"mtllib no.mtl\nusemtl steel\nf 1 2 3\nusemtl brass\nf 1/1/1 3/1/1 4/1/1",
    ],
)
def test_faces_of_an_obj_file_may_have_textures_normals_and_materials(faces: bytes) -> None:
    # a library for pictures, which is not there, was asked for: the whole file was told to be damaged
    corners = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0.5 0.5\nvn 0 0 1\n"
    square = [[(0, 0, 0), (1, 0, 0), (1, 1, 0)], [(0, 0, 0), (0, 1, 0), (1, 1, 0)]]
    found = read_mesh("a.obj", corners + faces + b"\n").tolist()
    assert sorted(sorted(map(tuple, triangle)) for triangle in found) == sorted(map(sorted, square))


@pytest.mark.parametrize(("across", "up"), [(b"s", b"t"), (b"u", b"v"), (b"texture_u", b"texture_v")])
def test_corners_of_a_ply_file_may_have_places_in_a_texture(across: bytes, up: bytes) -> None:
    header = b"ply\nformat ascii 1.0\ncomment TextureFile a.png\nelement vertex 3\n"
    columns = b"".join(b"property float %s\n" % name for name in (b"x", b"y", b"z", across, up))
    faces = b"element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    rows = b"0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n3 0 1 2\n"
    assert np.array_equal(read_mesh("a.ply", header + columns + faces + rows), [[[0, 0, 0], [1, 0, 0], [1, 1, 0]]])


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


def test_nothing_complains_beside_the_sentence(capfd: pytest.CaptureFixture[str]) -> None:
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


CORNERS_OF_L = ((0, 0), (4, 0), (4, 1), (1, 1), (1, 4), (0, 4))
"""Of a face that bends inwards at (1, 1), 7 mm2."""


def sizes(triangles: np.ndarray) -> tuple[float, float]:
    """Return the area seen from above, and the volume in a closed surface."""
    sides = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    return float(np.abs(sides[:, 2]).sum() / 2), float(np.linalg.det(triangles).sum() / 6)


@pytest.mark.parametrize("first", range(6))
@pytest.mark.parametrize("across", [(0, 1, 2), (1, 2, 0), (2, 0, 1)])
def test_faces_that_bend_inwards_cover_what_they_bound(first: int, across: tuple[int, int, int]) -> None:
    """A fan of their corners covered up to 9 mm2 beside an L, so that metal stood where there is none."""
    corners = CORNERS_OF_L[first:] + CORNERS_OF_L[:first]
    floor, top = ([(x, y, z) for x, y in corners] for z in (0, 2))
    rows = [[each[axis] for axis in across] for each in floor + top]
    places = "".join("v {} {} {}\n".format(*each) for each in rows)
    sides = "".join(f"f {k + 1} {(k + 1) % 6 + 1} {(k + 1) % 6 + 7} {k + 7}\n" for k in range(6))
    triangles = read_mesh("a.obj", (places + "f 6 5 4 3 2 1\nf 7 8 9 10 11 12\n" + sides).encode())
    back = triangles[..., [across.index(axis) for axis in range(3)]]
    assert len(triangles) == 20 and sizes(back) == pytest.approx((14.0, 14.0))


def test_corners_count_from_the_place_before_their_face() -> None:
    """They counted from the end of the file, and both faces were the second one."""
    text = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 0 0 5\nv 1 0 5\nv 0 1 5\nf\t-3\t-2\t-1\r\n"
    assert read_mesh("a.obj", text)[:, 0, 2].tolist() == [0.0, 5.0]
    with pytest.raises(InputError, match="damaged"):
        read_mesh("a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n")


def ply(faces: list[list[int]], order: str) -> bytes:
    """Return a PLY file of faces between the corners of the L, in a text or in bytes."""
    header = (
        f"ply\nformat {order} 1.0\ncomment made by hand\nelement vertex 6\nproperty float x\nproperty double y\n"
        f"property uchar red\nproperty float z\nelement face {len(faces)}\nproperty list uchar int vertex_indices\n"
        "property uchar flag\nelement edge 1\nproperty int a\nend_header\n"
    )
    sign = {"binary_little_endian": "<", "binary_big_endian": ">"}.get(order)
    if sign is None:
        rows = [f"{x} {y} 7 0" for x, y in CORNERS_OF_L] + [
            f"{len(each)} {' '.join(map(str, each))} 1" for each in faces
        ]
        return (header + "\n".join([*rows, "3"]) + "\n").encode()
    packed = b"".join(struct.pack(f"{sign}fdBf", x, y, 7, 0) for x, y in CORNERS_OF_L)
    packed += b"".join(struct.pack(f"{sign}B{len(each)}iB", len(each), *each, 1) for each in faces)
    return header.encode() + packed + struct.pack(f"{sign}i", 3)


@pytest.mark.parametrize("order", ["ascii", "binary_little_endian", "binary_big_endian"])
@pytest.mark.parametrize("faces", [[[1, 2, 3, 4, 5, 0]], [[2, 3, 4, 5, 0, 1]], [[0, 1, 2, 3], [3, 4, 5], [0, 3, 5]]])
def test_faces_of_a_ply_file_in_any_order_of_bytes(order: str, faces: list[list[int]]) -> None:
    assert sizes(read_mesh("a.ply", ply(faces, order)))[0] == pytest.approx(7.0)
    for size in (len(ply(faces, order)) - 6, 300, 40):
        with pytest.raises(InputError):
            read_mesh("a.ply", ply(faces, order)[:size])
    with pytest.raises(InputError, match="damaged"):
        read_mesh("a.ply", ply([[0, 1, 6]], order))


@pytest.mark.parametrize("count", [0, 5, 27])
@pytest.mark.parametrize("header", [b"", b"solid made by somebody"])
def test_triangles_behind_those_that_are_counted_are_told(count: int, header: bytes) -> None:
    """They were left out, without a word."""
    data = stl(BLOCK, header)
    with pytest.raises(InputError, match=f"counts {count} triangles, and it holds 28"):
        read_mesh("a.stl", data[:80] + struct.pack("<I", count) + data[84:])
    assert len(read_mesh("a.stl", data + b"colours of somebody")) == 28


def test_a_facet_of_a_text_has_three_corners() -> None:
    """Of one with two and one with four, two others were made."""
    facets = text(BLOCK).split(b"endloop")
    corner = facets[1][facets[1].index(b"vertex") :].splitlines()[0]
    facets[1] = facets[1].replace(corner, b"", 1)
    facets[2] += corner + b"\n"
    with pytest.raises(InputError, match="other than three corners"):
        read_mesh("a.stl", b"endloop".join(facets))
    assert len(read_mesh("a.stl", b"\xef\xbb\xbf" + text(BLOCK))) == 28
