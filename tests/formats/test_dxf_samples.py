"""The drawings of tests/data: what is in them, counted by hand or in closed form, through reading and chaining."""

import math
import time
from pathlib import Path

import pytest

from app.formats.drawing import Drawing
from app.formats.readers import read_drawing
from app.geometry.chaining.chain import ChainingResult, chain
from app.geometry.primitives import contour_rows, lengths, signed_area
from app.model.finding import FindingKind
from app.model.part import Units


def read(data: Path, name: str) -> Drawing:
    return read_drawing(name, (data / "dxf" / name).read_bytes())


def chained(drawing: Drawing, join_tolerance: float = 0.01) -> ChainingResult:
    made = chain([entity for entity in drawing.part.entities if not entity.lettering], join_tolerance)
    for contour in made.contours:
        assert all(a.end == b.start for a, b in zip(contour.primitives, contour.primitives[1:], strict=False))
        assert not contour.closed or contour.primitives[-1].end == contour.primitives[0].start
        assert contour.deviation <= 1e-3
    return made


COUNTS = {
    # name: entities, closed contours, open contours, units
    "fig2.dxf": (20, 3, 0, Units.MM),
    "complex.dxf": (9203, 401, 0, Units.MM),
    "gear.dxf": (364, 2, 0, Units.MM),
    "apu-mount.dxf": (44, 19, 0, Units.INCH),
    "LM2.dxf": (304, 40, 0, Units.MM),  # without the strokes of its letters
    "insert.dxf": (12, 2, 2, Units.MM),
    "POLI-ALL210_12.dxf": (85, 12, 18, Units.MM),
    "forms.dxf": (191, 40, 0, Units.MM),
    "genshi.dxf": (15, 1, 0, Units.MM),
    "broken_loop.dxf": (5, 0, 1, Units.MM),
}


@pytest.mark.parametrize("name", COUNTS)
def test_contours(data: Path, name: str) -> None:
    drawing = read(data, name)
    made = chained(drawing)
    closed = sum(contour.closed for contour in made.contours)
    drawn = sum(not entity.lettering for entity in drawing.part.entities)
    assert (drawn, closed, len(made.contours) - closed, drawing.part.units) == COUNTS[name]


def test_every_shared_drawing_is_here(shared: Path, data: Path) -> None:
    for path in [*shared.glob("data/dxf/*.dxf"), *shared.glob("bench/*.dxf")]:
        assert (data / "dxf" / path.name).read_bytes() == path.read_bytes()


def test_fig2_areas(data: Path) -> None:
    """The outline's two half discs of radius 8, one out and one in, cancel; the shoelace sum of the corners is left."""
    corners = [
        (6, 6),
        (60, 6),
        (68, 14),
        (68, 60),
        (60, 60),
        (60, 70),
        (28, 70),
        (20, 76),
        (6, 76),
        (6, 50),
        (14, 44),
        (14, 34),
        (6, 28),
    ]
    shoelace = (
        sum(x0 * y1 - x1 * y0 for (x0, y0), (x1, y1) in zip(corners, [*corners[1:], corners[0]], strict=True)) / 2
    )
    areas = [abs(signed_area(contour_rows(c))) for c in chained(read(data, "fig2.dxf")).contours]
    assert areas == pytest.approx([shoelace, 24 * 24 / 2, math.pi * 144])


def test_gear_is_an_outline_and_a_bore(data: Path) -> None:
    made = chained(read(data, "gear.dxf"))
    assert sorted(entity for contour in made.contours for entity in contour.entity_ids) == list(range(1, 365))
    assert not [f for f in made.findings if f.counts]


def test_inch_drawing_is_in_mm(data: Path) -> None:
    """The bracket is 7.9 x 4.5 inch."""
    rows = [contour_rows(c) for c in chained(read(data, "apu-mount.dxf")).contours]
    width = max(r[:, [0, 2]].max() for r in rows) - min(r[:, [0, 2]].min() for r in rows)
    assert width == pytest.approx(7.9 * 25.4, rel=0.01)


def test_plate_leaves_out_dimensions_and_has_points_and_its_texts_in_strokes(data: Path) -> None:
    drawing = read(data, "LM2.dxf")
    assert drawing.left_out == (("DIMENSION", 22),) and len(drawing.part.notes) == 31
    (text,) = [found.text for found in drawing.findings if "text" in found.text]
    assert text == (
        "5 texts are read as curves to machine: 5 in the engraving face, for font standard is not installed here; "
        "leave them out with --skip-type TEXT."
    )
    assert {entity.layer for entity in drawing.part.entities if entity.lettering} == {"GRAVIRANJE"}
    assert {layer.name for layer in drawing.part.layers} >= {"0", "HOLES", "GRAVIRANJE", "IZREZ"}
    circles = [c for c in chained(drawing).contours if len(c.primitives) == 1]
    assert len(circles) == 36


def test_inserted_blocks_are_copies(data: Path) -> None:
    sizes = [float(lengths(contour_rows(c)).sum()) for c in chained(read(data, "insert.dxf")).contours]
    assert sizes[:2] == pytest.approx(sizes[2:])


def test_glyph_of_splines_is_closed_within_a_micrometre(data: Path) -> None:
    drawing = read(data, "genshi.dxf")
    made = chained(drawing)
    assert 0 < made.contours[0].deviation <= 1e-3
    assert [f.amount for f in drawing.findings if f.kind is FindingKind.TINY_ENTITY] == [1]


def test_broken_loop_names_its_ends_and_its_overlap(data: Path) -> None:
    made = chained(read(data, "broken_loop.dxf"))
    (gap,) = [f for f in made.findings if f.kind is FindingKind.OPEN_CONTOUR]
    assert gap.counts and gap.amount == pytest.approx(0.1) and "(1.000, 0.000) and (1.100, 0.000)" in gap.text
    (overlap,) = [f for f in made.findings if f.kind is FindingKind.OVERLAP]
    assert overlap.counts and overlap.entity_ids == (1, 5) and overlap.amount == pytest.approx(0.1)
    assert "from (1.000, 0.000) to (1.100, 0.000)" in overlap.text


@pytest.mark.parametrize("tolerance", [0.1, 0.2])
def test_broken_loop_is_merged_by_a_join_tolerance(data: Path, tolerance: float) -> None:
    made = chain(read(data, "broken_loop.dxf").part.entities, tolerance)
    (loop,) = made.contours
    assert loop.closed and abs(signed_area(contour_rows(loop))) == pytest.approx(8)
    assert not [f for f in made.findings if f.counts]


def test_the_largest_is_read_and_chained_in_time(data: Path) -> None:
    """About 0.15 s and 0.3 s of processor time; the bounds leave room for busy machines."""
    content = (data / "dxf" / "complex.dxf").read_bytes()
    read_drawing("complex.dxf", content)
    started = time.process_time()
    drawing = read_drawing("complex.dxf", content)
    read_at = time.process_time()
    chain(drawing.part.entities)
    assert read_at - started < 1.0 and time.process_time() - read_at < 1.5
