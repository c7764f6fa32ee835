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


def several(models: dict[str, str], main: str = "") -> bytes:
    """Return a file of several models; without `main` nothing tells which one is built."""
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w", zipfile.ZIP_DEFLATED) as archive:
        if main:
            kind = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"
            archive.writestr(
                "_rels/.rels", f'<Relationships><Relationship Type="{kind}" Target="/{main}"/></Relationships>'
            )
        for path, model in models.items():
            archive.writestr(path, model)
    return data.getvalue()


def model(objects: str, items: str = "", unit: str = "millimeter") -> str:
    production = 'xmlns:p="http://schemas.microsoft.com/3dmanufacturing/production/2015/06"'
    return f'<model unit="{unit}" {SPACE} {production}><resources>{objects}</resources><build>{items}</build></model>'


OTHER = '<component p:path="/3D/Objects/object_1.model" objectid="1" transform="1 0 0 0 1 0 0 0 1 {} 0 0"/>'


@pytest.mark.parametrize("main", ["", "3D/plate.model"])
def test_parts_may_lie_in_models_of_their_own(main):
    """As slicers of today write each part; the same number is another object in another model."""
    components = f'<object id="1"><components>{OTHER.format(10)}{OTHER.format(20)}</components></object>'
    first = model(components, '<item objectid="1"/>')
    inner = model(
        f'<object id="1"><components><component objectid="7"/></components></object><object id="7">{MESH}</object>'
    )
    data = several({main or "3D/3dmodel.model": first, "3D/Objects/object_1.model": inner}, main)
    triangles = read_mesh("a.3mf", data)
    assert volume(triangles) == pytest.approx(8.0) and triangles[..., 0].max() == 22.0


def test_an_item_may_build_another_model_and_a_main_model_is_told_by_its_relation():
    built = model("", '<item p:path="/3D/b.model" objectid="1"/>')
    data = several({"3D/3dmodel.model": model(ONE), "3D/a.model": built, "3D/b.model": model(ONE)}, "3D/a.model")
    assert volume(read_mesh("a.3mf", data)) == pytest.approx(4.0)


def test_what_holds_a_part_while_it_is_printed_is_none_of_it():
    items = '<item objectid="1"/><item objectid="2"/>'
    for kind in ("support", "solidsupport", "other"):
        assert len(read_mesh("a.3mf", packed(f'{ONE}<object id="2" type="{kind}">{MESH}</object>', items))) == 4
    assert len(read_mesh("a.3mf", packed(f'{ONE}<object id="2" type="surface">{MESH}</object>', items))) == 8


def test_items_that_a_slicer_has_set_aside_are_not_built():
    items = '<item objectid="1" printable="1"/><item objectid="1" printable="0" transform="1 0 0 0 1 0 0 0 1 50 0 0"/>'
    assert len(read_mesh("a.3mf", packed(ONE, items))) == 4


def test_models_of_several_units_are_refused():
    first = model(f'<object id="2"><components>{OTHER.format(0)}</components></object>', '<item objectid="2"/>')
    data = several({"3D/3dmodel.model": first, "3D/Objects/object_1.model": model(ONE, unit="inch")})
    with pytest.raises(InputError, match="different units"):
        read_mesh("a.3mf", data)
