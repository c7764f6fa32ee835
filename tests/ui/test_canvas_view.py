"""Where the drawing lies on the screen, what its raster and rulers say, and that every curve is painted true."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PySide6.QtCore import QPointF, QRectF
from PySide6.QtGui import QPainterPath

from app.geometry.sample import sample, spline_points
from app.model.curves import Arc, Circle, Curve, Ellipse, Line, Spline
from app.model.part import Part
from app.ui.views.canvas.painting.curve_path import chain_path, curve_path
from app.ui.views.canvas.painting.grid import _text_at, grid_steps
from app.ui.views.canvas.painting.part_layer import PartLayer
from app.ui.views.canvas.snap import Snap, SnapKind, best, snaps_of, to_grid
from app.ui.views.canvas.view_transform import LARGEST_SCALE, ViewTransform, fitted, nice_step

AREA = QRectF(24, 24, 800, 600)
SCALES = st.floats(0.01, 1000)
PLACES = st.floats(-500, 500)


@given(SCALES, PLACES, PLACES)
def test_screen_and_world_are_inverse_and_y_runs_up(scale: float, x: float, y: float) -> None:
    view = ViewTransform(scale, 123.0, 456.0)
    assert view.to_world(view.to_screen((x, y))) == pytest.approx((x, y), abs=1e-6)
    assert view.to_screen((x, y + 1)).y() < view.to_screen((x, y)).y()
    assert view.transform().map(QPointF(x, y)) == view.to_screen((x, y))


@given(SCALES, st.floats(0.1, 10), PLACES, PLACES)
def test_zooming_keeps_the_point_under_the_mouse(scale: float, factor: float, x: float, y: float) -> None:
    view, at = ViewTransform(scale, 10.0, 20.0), QPointF(x, y)
    assert view.zoomed(factor, at).to_world(at) == pytest.approx(view.to_world(at), abs=1e-6)


def test_zoom_ends_where_numbers_would() -> None:
    assert ViewTransform(10.0).zoomed(1e9, QPointF()).scale == LARGEST_SCALE


def test_fitted_shows_the_whole_box_in_the_middle() -> None:
    view = fitted((10.0, 20.0, 110.0, 40.0), AREA)
    assert view.to_world(AREA.center()) == pytest.approx((60, 30))
    assert view.scale == pytest.approx(7.2)


def test_a_glide_begins_here_and_ends_there_on_the_straight_way() -> None:
    a, b = ViewTransform(5.0, 100.0, 300.0), fitted((10, 10, 20, 20), AREA)
    assert a.towards(b, 1.0, AREA) == b
    begin = a.towards(b, 0.0, AREA)
    assert (begin.scale, begin.ox, begin.oy) == pytest.approx((a.scale, a.ox, a.oy))
    scales = [a.towards(b, k / 10, AREA).scale for k in range(11)]
    assert scales == sorted(scales)
    same = ViewTransform(5.0, 150.0, 310.0)
    assert a.towards(same, 0.5, AREA).ox == pytest.approx(125.0)


@pytest.mark.parametrize(
    ("least", "step"), [(1.0, 1.0), (1.1, 2.0), (2.5, 5.0), (7.0, 10.0), (0.03, 0.05), (140.0, 200.0)]
)
def test_steps_are_one_two_five(least: float, step: float) -> None:
    assert nice_step(least) == pytest.approx(step)


@given(st.floats(0.001, 20000))
def test_the_raster_stays_readable_at_every_zoom(scale: float) -> None:
    minor, major = grid_steps(ViewTransform(scale))
    assert major * scale >= 99.9
    assert minor * scale >= 19.9
    assert major / minor == pytest.approx(round(major / minor))


@pytest.mark.parametrize(
    ("value", "major", "text"),
    [(20.0, 20.0, "20"), (-0.5, 0.5, "\u22120.5"), (5.0, 20.0, ""), (0.30000000000000004, 0.1, "0.3")],
)
def test_rulers_write_round_numbers(value: float, major: float, text: str) -> None:
    assert _text_at(value, major) == text


CURVES: list[Curve] = [
    Line((1, 2), (5, -3)),
    Arc((10, 0), (0, 10), (0, 0)),
    Arc((10, 0), (0, 10), (0, 0), ccw=False),
    Circle((3, 4), 25),
    Circle((3, 4), 2, ccw=False),
    Ellipse((1, 1), (6, 2), 0.4),
    Ellipse((0, 0), (5, 0), 0.5, 0.3, 2.0, ccw=False),
    Spline(3, ((0, 0), (1, 5), (4, 5), (6, 0), (9, 3)), (0, 0, 0, 0, 0.5, 1, 1, 1, 1)),
    Spline(2, ((1, 0), (1, 1), (0, 1)), (0, 0, 0, 1, 1, 1), (1, math.sqrt(0.5), 1)),
    Spline(1, ((0, 0), (3, 1), (5, 0)), (0, 0, 0.5, 1, 1)),
]


def points_of(path: QPainterPath) -> np.ndarray:
    """Points along the cubics of a path, by Bernstein polynomials."""
    elements = [path.elementAt(k) for k in range(path.elementCount())]
    found, at, k = [], None, 0
    t = np.linspace(0, 1, 12)[:, None]
    while k < len(elements):
        here = np.array([elements[k].x, elements[k].y])
        if elements[k].isCurveTo():
            b, c = (np.array([elements[k + n].x, elements[k + n].y]) for n in (1, 2))
            found.append((1 - t) ** 3 * at + 3 * t * (1 - t) ** 2 * here + 3 * t**2 * (1 - t) * b + t**3 * c)
            at, k = c, k + 3
            continue
        if elements[k].isLineTo():
            found.append(at + (here - at) * t)
        at, k = here, k + 1
    return np.concatenate(found)


def dense(curve: Curve) -> np.ndarray:
    """Points of a curve, so near one another that their chords do not matter."""
    return spline_points(curve, np.linspace(0, 1, 3001)) if isinstance(curve, Spline) else sample(curve)


@pytest.mark.parametrize("curve", CURVES, ids=lambda c: type(c).__name__)
def test_every_curve_is_painted_true_to_its_shape(curve: Curve) -> None:
    painted, true = points_of(curve_path(curve)), dense(curve)
    size = float(np.ptp(true, axis=0).max())
    a, d = true[:-1], np.diff(true, axis=0)
    share = np.clip(((painted[:, None] - a) * d).sum(-1) / np.maximum((d * d).sum(-1), 1e-30), 0, 1)
    away = np.hypot(*np.moveaxis(a + share[..., None] * d - painted[:, None], -1, 0)).min(axis=1)
    assert away.max() < 2e-4 * size
    if isinstance(curve, Arc | Circle):
        off = np.abs(np.hypot(*(painted - curve.centre).T) - curve.radius)
        assert off.max() < 5e-6 * curve.radius
    assert painted[0] == pytest.approx(curve.start)
    assert painted[-1] == pytest.approx(curve.end)


def test_curves_that_meet_are_painted_as_one_stroke() -> None:
    path = curve_path(
        Line((0, 0), (5, 0)), Line((5, 0), (5, 5)), Circle((20, 0), 3), Line((23, 0), (30, 0)), Line((40, 0), (50, 0))
    )
    assert [k for k in range(path.elementCount()) if path.elementAt(k).isMoveTo()] == [0, 3, 28, 30]


def test_a_chain_is_one_outline_that_can_be_filled() -> None:
    path = QPainterPath()
    chain_path((Line((0, 0), (10, 0)), Arc((10, 0), (0, 10), (0, 0)), Line((0, 10), (0, 0))), path)
    assert path.contains(QPointF(5, 5))
    assert not path.contains(QPointF(8, 8))
    assert sum(path.elementAt(k).isMoveTo() for k in range(path.elementCount())) == 1


def test_snap_points_of_each_curve() -> None:
    curves = (Line((0, 0), (10, 0)), Circle((50, 50), 5), Arc((90, 0), (100, 10), (90, 10)))
    found = [snap for curve in curves for snap in snaps_of(curve)]
    kinds = {kind: [snap.point for snap in found if snap.kind == kind] for kind in SnapKind}
    assert kinds[SnapKind.END] == [(0, 0), (10, 0), (90, 0), (100, 10)]
    assert kinds[SnapKind.MIDDLE][0] == (5, 0)
    assert kinds[SnapKind.MIDDLE][1] == pytest.approx((90 + 10 * math.sqrt(0.5), 10 - 10 * math.sqrt(0.5)))
    assert kinds[SnapKind.CENTRE] == [(50, 50), (90, 10)]
    assert kinds[SnapKind.QUADRANT][:4] == [(55, 50), (50, 55), (45, 50), (50, 45)]


def test_ends_win_over_what_is_a_little_nearer() -> None:
    points = snaps_of(Line((0, 0), (1, 0)))
    assert best(points, (0.3, 0.0), 1.0) == Snap((0, 0), SnapKind.END)
    assert best(points, (0.5, 0.0), 0.4) == Snap((0.5, 0), SnapKind.MIDDLE)
    assert best(points, (0.5, 5.0), 1.0) is None


@pytest.mark.parametrize(
    "curve",
    [
        Line((0, 0), (10, 0)),
        Circle((50, 50), 5),
        Arc((10, 0), (8, 6), (0, 0)),
        Arc((8, 6), (10, 0), (0, 0), ccw=False),
        Ellipse((3, 4), (20, 7), 0.37),
        Ellipse((3, 4), (20, 7), 0.37, 0.3, 2.0),
    ],
)
def test_every_point_of_a_curve_is_found_where_it_is_be_it_off_the_curve(curve: Curve) -> None:
    picture = PartLayer()
    picture.update(Part().with_curves([curve], "0"))
    for snap in snaps_of(curve):
        assert snap in picture.near_points(snap.point, 1e-9)
    assert picture.near_points((-500.0, 0.0), 1.0) == []


@given(st.floats(-1000, 1000), st.sampled_from([0.01, 0.05, 0.1, 0.25, 1.0, 5.0, 20.0]))
def test_the_grid_gives_clean_numbers(x: float, step: float) -> None:
    value = to_grid((x, 0.0), step)[0]
    assert abs(value - x) <= step / 2 + 1e-9
    assert len(repr(value)) <= 9
