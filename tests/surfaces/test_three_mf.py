"""3MF files, written here by the text of its specification: units, placement, components, damage."""

from __future__ import annotations

import io
import zipfile

import numpy as np
import pytest

from app.core.errors import InputError
from app.surfaces.meshes.read import read_mesh

CORNERS = ((0, 0, 0), (2, 0, 0), (0, 3, 0), (0, 0, 4))
FACES = ((0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3))
MESH = (
    "<mesh><vertices>"
    + "".join(f'<vertex x="{x}" y="{y}" z="{z}"/>' for x, y, z in CORNERS)
    + "</vertices><triangles>"
    + "".join(f'<triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in FACES)
    + "</triangles></mesh>"
)
SPACE = 'xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"'


def packed(objects: str, items: str, unit: str = "millimeter") -> bytes:
    model = f'<model unit="{unit}" {SPACE}><resources>{objects}</resources><build>{items}</build></model>'
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("[Content_Types].xml", "<Types/>")
        archive.writestr("3D/3dmodel.model", model)
    return data.getvalue()


ONE = f'<object id="1">{MESH}</object>'


def volume(triangles: np.ndarray) -> float:
    return float(np.sum(np.linalg.det(triangles)) / 6)


@pytest.mark.parametrize(("unit", "size"), [("millimeter", 1.0), ("inch", 25.4), ("micron", 0.001), ("foot", 304.8)])
def test_lengths_are_mm_whatever_the_unit(unit, size):
    triangles = read_mesh("a.3mf", packed(ONE, '<item objectid="1"/>', unit))
    assert volume(triangles) == pytest.approx(4.0 * size**3)


def test_items_and_components_are_placed_by_rows_times_matrices():
    turned = "0 1 0 -1 0 0 0 0 1 10 20 30"
    objects = f'{ONE}<object id="2"><components><component objectid="1" transform="{turned}"/></components></object>'
    triangles = read_mesh("a.3mf", packed(objects, '<item objectid="2" transform="2 0 0 0 2 0 0 0 2 1 1 1"/>'))
    x, y, z = triangles.reshape(-1, 3).T
    # a quarter turn takes (2, 3) to (-3, 2); then 10, 20, 30 are added; all of it twice as large, and 1 added
    assert (x.min(), x.max()) == (2 * (10 - 3) + 1, 2 * 10 + 1)
    assert (y.min(), y.max()) == (2 * 20 + 1, 2 * (20 + 2) + 1)
    assert (z.min(), z.max()) == (2 * 30 + 1, 2 * 34 + 1)
    assert volume(triangles) == pytest.approx(4.0 * 8)


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (b"PK nothing", "no 3MF file"),
        (packed(ONE, '<item objectid="7"/>'), "no 3MF file"),
        (packed(ONE.replace('v1="0"', 'v1="9"', 1), '<item objectid="1"/>'), "no 3MF file"),
        (packed(ONE.replace('v1="0"', 'v1="-1"', 1), '<item objectid="1"/>'), "no 3MF file"),
        (packed(ONE, '<item objectid="1"/>', "ell"), "'ell' is not known"),
        (packed(ONE, ""), "no triangle"),
        (packed('<object id="1"><component objectid="1"/></object>', '<item objectid="1"/>'), "in a circle"),
        (packed(ONE, '<item objectid="1"/>')[:-30], "no 3MF file"),
    ],
)
def test_what_is_damaged_is_refused_in_words(data, words):
    with pytest.raises(InputError, match=words) as caught:
        read_mesh("part.3mf", data)
    assert str(caught.value).startswith("part.3mf: ")
