"""Lofted and ruled surfaces hold their sections."""

import numpy as np
import pytest
from scipy.spatial import KDTree

from app.core.errors import GeometryError
from app.formats.scene.toml import sources_of
from app.model.scene_curves import CurveForm, SectionCurve, Spacing
from app.model.scene_shapes import LoftShape, RuledShape
from app.surfaces.patches.nurbs_curve import unit_knots
from app.surfaces.patches.section_curve import resolve, resolve_all
from tests.surfaces.surface_places import NO_FILES, built, curve, curve_places, places, spline_of

EVEN = tuple(
    curve((0.0, y, 0.0), (5.0, y, 3.0 + y / 4), (9.0, y, 3.0), (14.0, y, 0.0)) for y in (0.0, 4.0, 9.0, 12.0, 20.0)
)
MIXED = (
    curve((0.0, 0.0, 0.0), (6.0, 0.0, 3.0), (12.0, 0.0, 0.0)),
    curve((0.0, 5.0, 0.0), (3.0, 5.0, 4.0), (8.0, 5.0, 1.0), (12.0, 5.0, 2.0), (14.0, 5.0, 0.0)),
    curve((0.0, 9.0, 0.0), (6.0, 9.0, 5.0), (12.0, 9.0, 0.0), degree=1),
    curve((0.0, 14.0, 0.0), (6.0, 14.0, 5.0), (12.0, 14.0, 0.0), form=CurveForm.CONTROL, weights=(1.0, 0.7, 1.0)),
)


@pytest.mark.parametrize("sections", [EVEN, MIXED], ids=["alike", "mixed"])
@pytest.mark.parametrize("degree", [1, 2, 3])
def test_a_loft_passes_through_its_sections(sections: tuple[SectionCurve, ...], degree: int) -> None:
    surface = spline_of(LoftShape(sections, degree))
    at = np.linspace(0, 1, 101)
    for section, resolved in zip(sections, resolve_all(sections, NO_FILES), strict=True):
        y = section.points[0][1]
        wanted = curve_places(resolved.curve, resolved.curve.knots[0] + at * np.ptp(resolved.curve.knots))
        across = _parameter_at(surface, y)
        assert np.abs(places(surface, at, np.full(101, across)) - wanted).max() <= 1e-9


def _parameter_at(surface: object, y: float) -> float:
    """Every section lies in a plane of one y, which rises across the loft."""
    low, high = 0.0, 1.0
    for _ in range(200):
        middle = (low + high) / 2
        found = places(surface, np.zeros(1), np.array([middle]))[0, 1]  # type: ignore[arg-type]
        low, high = (middle, high) if found < y else (low, middle)
    return low if abs(places(surface, np.zeros(1), np.array([low]))[0, 1] - y) < 1e-12 else high  # type: ignore[arg-type]


@pytest.mark.parametrize("sections", [EVEN, MIXED], ids=["alike", "mixed"])
def test_points_of_tables_are_on_the_loft(sections: tuple[SectionCurve, ...]) -> None:
    surface = spline_of(LoftShape(sections))
    for section in sections:
        if section.form is CurveForm.THROUGH:
            at = _parameter_at(surface, section.points[0][1])
            row = places(surface, np.linspace(0, 1, 20001), np.full(20001, at))
            assert KDTree(row).query(np.array(section.points))[0].max() <= 1e-3


def test_tables_of_as_many_points_add_no_knots() -> None:
    surface = spline_of(LoftShape(EVEN))
    assert surface.points.shape[:2] == (4, 5)


def test_closed_sections_and_closed_lofts_are_smooth_at_their_seams() -> None:
    rings = tuple(
        curve(
            *(
                (np.cos(a) * (30 + 5 * np.cos(b)), np.sin(a) * (30 + 5 * np.cos(b)), 5 * np.sin(b))
                for b in np.arange(6)
            ),
            closed=True,
        )
        for a in np.arange(8) * np.pi / 4
    )
    surface = spline_of(LoftShape(rings, closed=True))
    at, step = np.linspace(0, 1, 30), 1e-5
    for u, v in ((0 * at, at), (at, 0 * at)):
        turned = u.any()
        across = np.array([0.0, step, -step, -2 * step]) % 1.0
        rows = [places(surface, u if turned else 0 * at + c, 0 * at + c if turned else v) for c in across]
        first, last = rows[1] - rows[0], rows[2] - rows[3]
        size = np.linalg.norm(first, axis=1).max()
        assert np.abs(first - last).max() <= 0.01 * size
        closing = places(surface, u if turned else 0 * at + 1, 0 * at + 1 if turned else v)
        assert np.abs(closing - rows[0]).max() <= 1e-9


def test_the_same_section_twice_is_an_error() -> None:
    with pytest.raises(GeometryError, match=r"^Surface one: Sections 2 and 3 of a loft are the same; take one out\.$"):
        built(LoftShape((EVEN[0], EVEN[1], EVEN[1], EVEN[2])))


def test_lines_of_a_ruled_surface_are_straight() -> None:
    surface = spline_of(RuledShape(MIXED[0], MIXED[3]))
    at = np.linspace(0, 1, 40)
    low, middle, high = (places(surface, at, np.full(40, v)) for v in (0.0, 0.3, 1.0))
    ends = [resolve(each, NO_FILES).curve for each in (MIXED[0], MIXED[3])]
    for row, end in zip((low, high), ends, strict=True):
        assert np.abs(row - curve_places(end, at)).max() <= 1e-9
    assert np.linalg.norm(np.cross(middle - low, high - low), axis=1).max() <= 1e-9


def test_knots_go_from_0_to_1() -> None:
    surface = spline_of(LoftShape(MIXED))
    for knots in (surface.knots_u, surface.knots_v):
        assert np.array_equal(knots, unit_knots(knots))


def test_sources_read_drawings_by_name() -> None:
    asked = []

    def data(name: str) -> bytes:
        asked.append(name)
        return b"circle 0,0 5\n"

    part = sources_of(data).part("ring.draw")
    assert asked == ["ring.draw"]
    assert len(part.entities) == 1


@pytest.mark.parametrize("degree", [1, 2, 3, 4, 5, 9])
@pytest.mark.parametrize("count", [3, 4, 5, 12])
@pytest.mark.parametrize("form", CurveForm)
def test_closed_curves_close_whatever_their_degree(degree: int, count: int, form: CurveForm) -> None:
    ring = curve(
        *((9 * np.cos(a), 5 * np.sin(a), np.sin(2 * a)) for a in np.arange(count) * 2 * np.pi / count),
        closed=True,
        degree=degree,
        form=form,
    )
    made = resolve(ring, NO_FILES).curve
    assert (made.degree > 1) == (degree > 1)
    found = curve_places(made, np.array([0.0, 1e-6, 1 - 1e-6, 1.0]))
    assert found[0] == pytest.approx(found[3], abs=1e-9)
    if made.degree > 1:
        assert found[1] - found[0] == pytest.approx(found[3] - found[2], abs=1e-9)
    if form is CurveForm.THROUGH:
        rows = curve_places(made, np.linspace(0, 1, 40001))
        assert KDTree(rows).query(np.array(ring.points))[0].max() <= 2e-3


def test_a_closed_control_polygon_of_degree_2_is_the_even_spline() -> None:
    """A square of control points makes a closed curve that touches the middles of its sides."""
    square = curve(
        (0.0, 0.0, 0.0),
        (2.0, 0.0, 0.0),
        (2.0, 2.0, 0.0),
        (0.0, 2.0, 0.0),
        closed=True,
        degree=2,
        form=CurveForm.CONTROL,
    )
    found = curve_places(resolve(square, NO_FILES).curve, np.array([0.0, 0.25, 0.5, 0.75]))
    assert sorted(map(tuple, found.round(12).tolist())) == [(0, 1, 0), (1, 0, 0), (1, 2, 0), (2, 1, 0)]


@pytest.mark.parametrize(("spacing", "share"), [(Spacing.CENTRIPETAL, 1 / 3), (Spacing.CHORD_LENGTH, 1 / 5)])
def test_parameters_are_spaced_by_chords_or_by_their_roots(spacing: Spacing, share: float) -> None:
    bent = curve((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (1.0, 4.0, 0.0), degree=2, spacing=spacing)
    found = curve_places(resolve(bent, NO_FILES).curve, np.array([share]))
    assert found[0] == pytest.approx([1, 0, 0], abs=1e-12)
