"""Every sample drawing, written as SVG and as DXF and read again."""

import pytest

from app.formats.dxf.dxf import read_dxf
from app.formats.dxf.write import DxfVersion, dxf_bytes
from app.formats.readers import read_drawing
from app.formats.svg.svg import read_svg
from app.formats.svg.write import svg_bytes
from app.geometry.chaining.chain import chain
from app.model.part import Part
from tests.conftest import ROOT
from tests.formats.drawn_parts import apart

SAMPLES = sorted(
    path for path in (ROOT / "tests" / "data").glob("*/*") if path.suffix in (".dxf", ".svg") and path.stem != "complex"
)
SAME = 1e-9


@pytest.fixture(params=SAMPLES, ids=lambda path: path.name)
def part(request: pytest.FixtureRequest) -> Part:
    return read_drawing(request.param.name, request.param.read_bytes()).part


def test_svg_keeps_all(part: Part) -> None:
    written = svg_bytes(part)
    drawing = read_svg(written.data)
    before = [entity for layer in part.layers for entity in part.entities if entity.layer == layer.name]
    assert not written.converted and drawing.part.layers == part.layers
    assert max(apart(a.curve, b.curve) for a, b in zip(before, drawing.part.entities, strict=True)) <= SAME


def test_dxf_keeps_all(part: Part) -> None:
    written = dxf_bytes(part, DxfVersion.R2018)
    drawing = read_dxf(written.data)
    assert (
        not written.converted
        and not written.renamed
        and drawing.part.layers[1:]
        == tuple(layer for layer in part.layers if layer.name != drawing.part.layers[0].name)
    )
    assert max(apart(a.curve, b.curve) for a, b in zip(part.entities, drawing.part.entities, strict=True)) <= SAME


def test_r12_keeps_the_contours(part: Part) -> None:
    written = dxf_bytes(part, DxfVersion.R12)
    before, after = (chain(p.entities).contours for p in (part, read_dxf(written.data).part))
    assert all(0 < kind.deviation <= 1e-3 for kind in written.converted)
    assert [contour.closed for contour in before] == [contour.closed for contour in after]
