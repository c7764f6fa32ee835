"""A motion done in part: straight ones, arcs of any plane and of more than a turn, splines."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.geometry.arcs.nurbs import flattened_all
from app.model.motion import MotionKind, Motions, Nurbs, Plane
from app.model.motion_part import part_of, place_on
from app.model.motion_path import arc_paths, lengths
from tests.simulation.courses import arc, polyline

ARCS = {
    "quarter": arc((3, 0, 1), (0, 3, 1), (0, 0, 1)),
    "clockwise": arc((3, 0, 1), (0, 3, 1), (0, 0, 1), ccw=False),
    "whole": arc((3, 0, 1), (3, 0, 1), (0, 0, 1)),
    "helix": arc((3, 0, 1), (3, 0, -2), (0, 0, 1), turns=3),
    "spiral": arc((3, 0, 1), (0, 3.01, 1), (0, 0, 1)),
    "upright": arc((3, 2, 0), (0, 2, 3), (0, 2, 0), Plane.ZX, ccw=False),
}
SHARE = st.floats(0.001, 0.999)


@pytest.mark.parametrize("name", ARCS)
@settings(deadline=None)
@given(share=SHARE)
def test_a_part_of_an_arc_is_an_arc_on_it(name: str, share: float) -> None:
    whole, part = ARCS[name], part_of(ARCS[name], 0, share)
    want = arc_paths(whole).points(np.linspace(0, share, 50))[0]
    assert np.abs(arc_paths(part).points(np.linspace(0, 1, 50))[0] - want).max() < 1e-9
    assert lengths(part)[0] == pytest.approx(share * lengths(whole)[0], rel=2e-3)  # a spiral grows
    assert np.array_equal(place_on(whole, 0, share), part.end[-1])


@settings(deadline=None)
@given(share=SHARE)
def test_a_part_of_a_line(share: float) -> None:
    way = polyline([(0, 0, 0), (1, 2, 3), (5, 2, 3)])
    assert place_on(way, 1, share) == pytest.approx((1 + 4 * share, 2, 3))
    assert part_of(way, 1, share).start[0].tolist() == [1, 2, 3]


@settings(deadline=None)
@given(share=SHARE)
def test_a_part_of_a_spline_is_chords_along_it(share: float) -> None:
    curve = Nurbs(
        np.array([[0.0, 0, 0], [1, 3, -1], [4, 3, -1], [6, 0, 0]]), np.ones(4), np.array([0.0, 0, 0, 0, 1, 1, 1, 1]), 3
    )
    one = polyline([(0, 0, 0), (6, 0, 0)])
    way = Motions(
        one.start,
        one.end,
        one.centre,
        np.array([MotionKind.SPLINE], np.uint8),
        one.plane,
        one.turns,
        one.feed,
        one.line,
        one.state,
        {0: curve},
    )
    part = part_of(way, 0, share)
    assert np.array_equal(part.start[1:], part.end[:-1])
    assert set(part.kind.tolist()) == {MotionKind.LINE}
    t = share
    want = 3 * (1 - t) ** 2 * t * curve.points[1] + 3 * (1 - t) * t**2 * curve.points[2] + t**3 * curve.points[3]
    assert np.abs(part.end[-1] - want).max() < 1e-3
    fine = flattened_all([curve], 1e-6)[0]
    assert max(np.min(np.linalg.norm(fine - place, axis=1)) for place in part.end) < 0.05


def test_nothing_and_everything() -> None:
    way = polyline([(0, 0, 0), (1, 2, 3)])
    assert len(part_of(way, 0, 0.0)) == 0
    assert place_on(way, 0, 0.0).tolist() == [0, 0, 0]
    assert place_on(way, 0, 1.0).tolist() == [1, 2, 3]


@pytest.mark.parametrize("share", [1 / 3, 2 / 3, 0.5])
def test_whole_turns_of_a_helix_are_not_lost(share: float) -> None:
    part = part_of(ARCS["helix"], 0, share)
    assert lengths(part)[0] == pytest.approx(share * lengths(ARCS["helix"])[0], rel=1e-6)
