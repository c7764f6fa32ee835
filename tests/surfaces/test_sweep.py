"""Swept and revolved surfaces: exact where they can be, within the tolerance where they turn."""

import math
from itertools import pairwise

import numpy as np
import pytest

from app.core.errors import GeometryError
from app.model.curves import Arc, Circle, Line
from app.model.part import Entity, Part
from app.model.scene_curves import CurveForm, SceneFiles, SectionCurve
from app.model.scene_shapes import ProfileOrientation, RevolvedShape, SweptShape
from app.surfaces.patches.section_curve import resolve
from app.surfaces.patches.sweep import TOLERANCE
from tests.surfaces.surface_places import NO_FILES, anywhere, built, curve, curve_places, no_data, places, spline_of

PROFILE = curve((0.0, -5.0, 0.0), (0.0, 0.0, 5.0), (0.0, 5.0, 0.0))
GUIDE = curve((0.0, 0.0, 0.0), (20.0, 5.0, 2.0), (40.0, 0.0, 5.0), (60.0, -8.0, 0.0), (70.0, -8.0, 4.0))
ROOT = 0.5**0.5
QUARTER = SectionCurve(
    ((30.0, 0.0, 0.0), (30.0, 30.0, 0.0), (0.0, 30.0, 0.0)), CurveForm.CONTROL, 2, weights=(1.0, ROOT, 1.0)
)
SLOT = Part(
    tuple(
        Entity(n, each)
        for n, each in enumerate(
            (
                Line((0.0, 10.0), (0.0, 20.0)),
                Arc((0.0, 20.0), (5.0, 25.0), (5.0, 20.0), False),
                Line((5.0, 25.0), (8.0, 25.0)),
                Circle((50.0, 50.0), 4.0),
            ),
            1,
        )
    )
)


def drawn(_: str) -> Part:
    return SLOT


SOURCES = SceneFiles(no_data, drawn)


def test_a_parallel_sweep_is_profile_plus_guide() -> None:
    surface = spline_of(SweptShape(PROFILE, GUIDE))
    u, v = np.random.default_rng(3).random((2, 200))
    profile, guide = resolve(PROFILE, NO_FILES).curve, resolve(GUIDE, NO_FILES).curve
    wanted = curve_places(profile, u) + curve_places(guide, v) - guide.points[0]
    assert np.abs(places(surface, u, v) - wanted).max() <= 1e-12 * 70


def test_a_profile_that_follows_a_circle_makes_a_torus() -> None:
    """About a plane curve the frame that turns least keeps upright, so the sweep is one of revolution."""
    profile = SectionCurve(((26.0, 0.0, 0.0), (30.0, 0.0, 6.0), (34.0, 0.0, 0.0)), CurveForm.CONTROL, 2)
    made = built(SweptShape(profile, QUARTER, ProfileOrientation.FOLLOW))
    found = anywhere(made.splines[0])
    turned = anywhere(spline_of(RevolvedShape(profile, turn_deg=(0.0, 90.0))))

    def sheet(rows: np.ndarray) -> np.ndarray:
        """2 x = 52 + 16 u - ..., so that z is a parabola in the distance from the axis."""
        out = np.hypot(rows[:, 0], rows[:, 1])
        return rows[:, 2] - 3 * (1 - ((out - 30) / 4) ** 2)

    assert np.abs(sheet(turned)).max() <= 1e-11
    assert np.abs(sheet(found)).max() <= 4 * TOLERANCE
    assert made.deviation == TOLERANCE


def test_a_profile_stays_rigid_and_square_to_a_bent_guide() -> None:
    made = built(SweptShape(PROFILE, GUIDE, ProfileOrientation.FOLLOW))
    guide = resolve(GUIDE, NO_FILES).curve
    breaks = np.unique(guide.knots)
    tangent = curve_places(guide, np.array([0.0, 1e-7]))
    lean = resolve(PROFILE, NO_FILES).curve.points @ np.diff(tangent, axis=0)[0] / 1e-7
    lean /= np.linalg.norm(np.diff(tangent, axis=0)) / 1e-7
    for surface, low, high in zip(made.splines, breaks[:-1], breaks[1:], strict=True):
        for v in np.linspace(0.01, 0.99, 9):
            row = places(surface, np.linspace(0, 1, 21), np.full(21, v))
            assert np.linalg.norm(row[0] - row[-1]) == pytest.approx(10, abs=4 * TOLERANCE)
            t = low + v * (high - low)
            places_near = curve_places(guide, np.array([t - 1e-6, t, t + 1e-6]))
            along = (places_near[2] - places_near[0]) / np.linalg.norm(places_near[2] - places_near[0])
            assert (row[0] - places_near[1]) @ along == pytest.approx(lean[0], abs=1e-4)


def test_spans_of_a_sweep_join() -> None:
    made = built(SweptShape(PROFILE, GUIDE, ProfileOrientation.FOLLOW)).splines
    assert len(made) > 1
    for before, after in pairwise(made):
        assert np.abs(before.points[:, -1] - after.points[:, 0]).max() <= 1e-9


def test_a_guide_with_a_corner_is_an_error_that_says_where() -> None:
    corner = curve((0.0, 0.0, 0.0), (20.0, 0.0, 0.0), (20.0, 20.0, 0.0), degree=1)
    message = r"^Surface one: The guide of a sweep has a corner at 20, 0, 0; round it, or keep the profile parallel\.$"
    with pytest.raises(GeometryError, match=message):
        built(SweptShape(PROFILE, corner, ProfileOrientation.FOLLOW))
    assert built(SweptShape(PROFILE, corner)).splines


def test_a_drawn_profile_keeps_its_arcs_when_it_is_revolved() -> None:
    profile = SectionCurve(drawing="slot.draw", x_axis=(0.0, 0.0, 1.0), y_axis=(1.0, 0.0, 0.0))
    made = built(RevolvedShape(profile), sources=SOURCES)
    found = anywhere(made.splines[0], 1000)
    out, high = np.hypot(found[:, 0], found[:, 1]), found[:, 2]
    on_arc = (high > 1e-9) & (high < 5 - 1e-9) & (out > 20)
    assert on_arc.sum() > 100
    assert np.abs(np.hypot(out - 20, high - 5) - 5)[on_arc].max() <= 1e-12 * 25
    assert np.abs(high[(out < 20 - 1e-9)]).max() <= 1e-12 * 25
    assert made.deviation == 0


def test_a_drawn_circle_is_round() -> None:
    ring = resolve(SectionCurve(drawing="slot.draw", number=2), SOURCES).curve
    found = curve_places(ring, np.linspace(0, 1, 100))
    assert np.abs(np.hypot(found[:, 0] - 50, found[:, 1] - 50) - 4).max() <= 1e-12 * 75


def test_the_contour_must_be_there() -> None:
    with pytest.raises(GeometryError, match=r"a\.draw has 2 contours there, so none with number 3; use 1 to 2\."):
        built(RevolvedShape(SectionCurve(drawing="a.draw", number=3)), sources=SOURCES)
    with pytest.raises(GeometryError, match=r"a\.draw has no contour on layer walls; curves are on 0\."):
        built(RevolvedShape(SectionCurve(drawing="a.draw", layer="walls")), sources=SOURCES)


@pytest.mark.parametrize("turn", [(0.0, 360.0), (-30.0, 200.0), (10.0, 11.0)])
def test_a_revolved_profile_keeps_its_distance_from_the_axis(turn: tuple[float, float]) -> None:
    profile = curve((10.0, 0.0, 0.0), (14.0, 0.0, 5.0), (11.0, 0.0, 10.0))
    surface = spline_of(RevolvedShape(profile, (0.0, 0.0, 0.0), (0.0, 0.0, 2.0), turn))
    u, v = np.random.default_rng(5).random((2, 300))
    found, wanted = places(surface, u, v), curve_places(resolve(profile, NO_FILES).curve, u)
    assert np.abs(np.hypot(found[:, 0], found[:, 1]) - wanted[:, 0]).max() <= 1e-12 * 14
    assert np.abs(found[:, 2] - wanted[:, 2]).max() <= 1e-12 * 14
    ends = places(surface, np.zeros(2), np.array([0.0, 1.0]))
    for end, angle in zip(ends, turn, strict=True):
        assert end[:2] == pytest.approx([10 * math.cos(math.radians(angle)), 10 * math.sin(math.radians(angle))])
