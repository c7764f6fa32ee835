"""The judge of curves: what it calls inside is inside by dense sampling, what it calls outside has a witness that
is.
"""

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from app.core.errors import GeometryError, ParameterError
from app.fitting.point_curves.space_curve import SpaceCurve, curve_of_motions, curve_of_nurbs, curve_of_points
from app.fitting.point_curves.spheroid import RevolvedOutline, lies_within
from app.fitting.point_curves.tube import ToleranceTube, TubeAnswer, TubeJudgement, judge
from app.geometry.arcs.bezier import elevated
from app.model.motion import MotionKind, Motions, Nurbs, Plane
from tests.examples import examples

Floats = NDArray[np.float64]
TOLERANCE = 0.05


def bezier(*pieces: list[list[float]]) -> SpaceCurve:
    control = np.concatenate([elevated(np.array([piece], float), 5) for piece in pieces])
    return SpaceCurve(control, np.zeros(len(control), np.int64))


def line(*points: list[float]) -> SpaceCurve:
    return curve_of_points(np.array(points, float))


def off_chords(places: Floats, points: Floats) -> Floats:
    """Distance of each place from the nearest chord, by the plain formula for each chord in turn."""
    least = np.full(len(places), np.inf)
    for a, b in pairwise(points):
        chord = b - a
        share = np.clip((places - a) @ chord / max(chord @ chord, 1e-300), 0, 1)
        least = np.minimum(least, np.linalg.norm(places - a - share[:, None] * chord, axis=1))
    return least


def assert_really_inside(
    curve: SpaceCurve, points: Floats, judgement: TubeJudgement, radius: float, samples: int = 400
) -> None:
    """By samples alone: stretch by stretch near its chord, feet near their points and in order, chords near the
    curve.
    """
    feet = judgement.feet
    assert feet is not None
    assert judgement.answer is TubeAnswer.INSIDE
    assert np.all(np.diff(feet) >= 0) and feet[0] == 0 and feet[-1] == len(curve)
    assert np.linalg.norm(curve.at(feet) - points, axis=1).max() <= radius + 1e-12
    worst = 0.0
    for i, (a, b) in enumerate(pairwise(feet)):
        places = curve.at(np.linspace(a, b, samples))
        worst = max(worst, float(off_chords(places, points[i : i + 2]).max()))
        chord = points[i] + (points[i + 1] - points[i]) * np.linspace(0, 1, 50)[:, None]
        step = float(np.linalg.norm(np.diff(places, axis=0), axis=1).max())
        assert np.min(np.linalg.norm(chord[:, None] - places[None], axis=2), axis=1).max() <= judgement.bound + step
    assert worst <= radius + 1e-12
    assert worst <= judgement.bound + 1e-12
    assert judgement.from_curve <= worst * (1 + 1e-3) + 1e-9 or judgement.from_curve <= judgement.bound
    assert judgement.bound <= max(judgement.from_curve, judgement.from_points) * (1 + 2e-3) + 1e-9 + curve.slack


@pytest.mark.parametrize(
    ("share", "answer"),
    [
        (0.9999, TubeAnswer.INSIDE),
        (1 - 1e-9, TubeAnswer.INSIDE),
        (1.0001, TubeAnswer.OUTSIDE),
        (1 + 1e-8, TubeAnswer.OUTSIDE),
    ],
)
def test_a_bulge_between_points_is_refused_as_soon_as_it_is_too_far(share: float, answer: TubeAnswer) -> None:
    top = share * TOLERANCE
    points = np.array([[0, 0, 0], [10, 0, 0], [20, 5, 0.0]])
    curve = bezier([[0, 0, 0], [5, 2 * top, 0], [10, 0, 0]], [[10, 0, 0], [15, 2.5, 0], [20, 5, 0]])
    judgement = judge(curve, points, ToleranceTube(TOLERANCE))
    assert judgement.answer is answer
    assert judgement.from_curve == pytest.approx(top, rel=1e-9)
    assert judgement.place == pytest.approx((5, top, 0), abs=1e-6)
    assert judgement.chord == 0


def test_every_point_may_be_met_and_the_curve_still_be_far_away_between() -> None:
    """Seventy-eight of 134 pieces of a real program were of this kind."""
    points = np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0.0]])
    curve = bezier([[0, 0, 0], [0.3, 3, 0], [0.7, 3, 0], [1, 0, 0]], [[1, 0, 0], [1.3, -3, 0], [1.7, -3, 0], [2, 0, 0]])
    judgement = judge(curve, points, ToleranceTube(TOLERANCE))
    assert judgement.answer is TubeAnswer.OUTSIDE
    assert judgement.from_curve == pytest.approx(2.25, rel=1e-6)


def test_order_counts() -> None:
    there_and_back = np.array([[0, 0, 0], [10, 0, 0], [0, 0, 0], [10, 0, 0.0]])
    assert judge(curve_of_points(there_and_back), there_and_back, ToleranceTube(TOLERANCE)).answer is TubeAnswer.INSIDE
    assert judge(line([0, 0, 0], [10, 0, 0]), there_and_back, ToleranceTube(TOLERANCE)).answer is TubeAnswer.OUTSIDE
    turned = there_and_back[:2][::-1].copy()
    assert judge(curve_of_points(turned), there_and_back[:2], ToleranceTube(TOLERANCE)).answer is TubeAnswer.OUTSIDE


@pytest.mark.parametrize(("radius", "answer"), [(0.026, TubeAnswer.INSIDE), (0.024, TubeAnswer.OUTSIDE)])
def test_a_step_back_needs_half_of_it_as_tolerance(radius: float, answer: TubeAnswer) -> None:
    points = np.array([[0, 0, 0], [5, 0, 0], [4.95, 0, 0], [10, 0, 0.0]])
    assert judge(line([0, 0, 0], [10, 0, 0]), points, ToleranceTube(radius)).answer is answer


def test_repeated_points_zigzags_and_tiny_steps_beside_long_ones_are_judged() -> None:
    repeated = np.array([[0, 0, 0], [1, 0, 0], [1, 0, 0], [1, 0, 0], [2, 0, 0.0]])
    assert judge(line([0, 0, 0], [2, 0, 0]), repeated, ToleranceTube(TOLERANCE)).answer is TubeAnswer.INSIDE
    zigzag = np.column_stack([np.arange(500) * 0.002, (np.arange(500) % 2) * 0.001, np.zeros(500)])
    ends = curve_of_points(zigzag[[0, -1]])
    assert judge(ends, zigzag, ToleranceTube(0.0011)).answer is TubeAnswer.INSIDE
    refused = judge(ends, zigzag, ToleranceTube(0.0004))
    assert refused.answer is TubeAnswer.OUTSIDE
    uneven = np.array([[0, 0, 0], [100, 0, 0], [100.001, 0, 0], [100.001, 100, 0.0]])
    assert judge(curve_of_points(uneven), uneven, ToleranceTube(1e-4)).answer is TubeAnswer.INSIDE


def test_once_round_is_not_twice_round() -> None:
    angle = np.linspace(0, 4 * np.pi, 2001)
    twice = np.column_stack([np.cos(angle), np.sin(angle), 0 * angle])
    assert judge(curve_of_points(twice), twice, ToleranceTube(0.01)).answer is TubeAnswer.INSIDE
    assert judge(curve_of_points(twice[:1001]), twice, ToleranceTube(0.01)).answer is TubeAnswer.OUTSIDE
    assert judge(curve_of_points(twice), twice[:1001], ToleranceTube(0.01)).answer is TubeAnswer.OUTSIDE


def motions(
    kind: MotionKind, start: list[float], end: list[float], centre: list[float], plane: Plane, turns: int = 1
) -> Motions:
    first, last, middle = (np.array([row], float) for row in (start, end, centre))
    whole = np.zeros(1, np.int32)
    words = np.array([kind], np.uint8), np.array([plane], np.uint8), np.array([turns], np.int32)
    return Motions(first, last, middle, *words, np.full(1, np.nan), whole, whole)


@pytest.mark.parametrize("plane", list(Plane))
@pytest.mark.parametrize("turns", [1, 3])
def test_helices_in_every_plane_are_their_closed_form(plane: Plane, turns: int) -> None:
    u, v, w = plane.axes
    start, end, centre = [0.0] * 3, [0.0] * 3, [0.0] * 3
    start[u], end[v], end[w] = 30.0, 30.0, 7.0
    helix = motions(MotionKind.ARC_CCW, start, end, centre, plane, turns)
    curve = curve_of_motions(helix)
    sweep = math.pi / 2 + math.tau * (turns - 1)
    at = np.linspace(0, 1, 100_001)
    exact = np.zeros((len(at), 3))
    exact[:, u], exact[:, v], exact[:, w] = 30 * np.cos(sweep * at), 30 * np.sin(sweep * at), 7 * at
    assert np.abs(curve.at(at * len(curve)) - exact).max() <= curve.slack


def test_an_arc_and_its_chords_are_apart_by_the_sagitta() -> None:
    arc = motions(MotionKind.ARC_CW, [-20, 0, 5], [20, 0, 5], [0, 0, 5], Plane.XY)
    angle = np.pi - np.linspace(0, np.pi, 41)
    points = np.column_stack([20 * np.cos(angle), 20 * np.sin(angle), np.full(41, 5.0)])
    sagitta = 20 * (1 - math.cos(np.pi / 80))
    judgement = judge(curve_of_motions(arc), points, ToleranceTube(TOLERANCE))
    assert judgement.bound == pytest.approx(sagitta, rel=1e-3)
    assert_really_inside(curve_of_motions(arc), points, judgement, TOLERANCE)
    assert judge(curve_of_motions(arc), points, ToleranceTube(sagitta * 0.9999)).answer is TubeAnswer.OUTSIDE
    assert judge(curve_of_motions(arc), points, ToleranceTube(sagitta * 1.0001)).answer is TubeAnswer.INSIDE


def test_a_curve_with_weights_is_judged_too() -> None:
    half = math.sqrt(0.5)
    quarter = Nurbs(
        np.array([[10, 0, 0], [10, 10, 0], [0, 10, 0.0]]), np.array([1, half, 1]), np.array([0.0, 0, 0, 1, 1, 1]), 2
    )
    angle = np.linspace(0, np.pi / 2, 200)
    points = np.column_stack([10 * np.cos(angle), 10 * np.sin(angle), 0 * angle])
    judgement = judge(curve_of_nurbs(quarter), points, ToleranceTube(1e-3))
    assert judgement.answer is TubeAnswer.INSIDE
    assert judgement.bound == pytest.approx(10 * (1 - math.cos(np.pi / 796)), rel=0.2)


def test_a_barrel_is_narrow_at_the_points_and_wide_between() -> None:
    points = np.array([[0, 0, 0], [10, 0, 0.0]])
    for middle, answer in ((0.0501, TubeAnswer.INSIDE), (0.0499, TubeAnswer.OUTSIDE)):
        curve = bezier([[0, 0, 0], [5, 0.1, 0], [10, 0, 0]])
        assert judge(curve, points, ToleranceTube(0.001, middle)).answer is answer
    beside = bezier([[0, 0.002, 0], [5, 0.002, 0], [10, 0.002, 0]])
    assert judge(beside, points, ToleranceTube(0.001, 0.05)).answer is TubeAnswer.OUTSIDE
    assert judge(beside, points, ToleranceTube(0.002001, 0.05)).answer is TubeAnswer.INSIDE


@settings(max_examples=examples(150), deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(2, 12), st.sampled_from([0.02, 0.05, 0.3]))
def test_what_is_called_inside_is_inside(seed: int, count: int, radius: float) -> None:
    rng = np.random.default_rng(seed)
    points = np.cumsum(rng.normal(0, 1, (count, 3)) * rng.choice([0.01, 0.3, 3]), axis=0)
    control = points[:-1, None] + (points[1:] - points[:-1])[:, None] * np.linspace(0, 1, 6)[None, :, None]
    control = control + rng.normal(0, radius * rng.uniform(0.05, 1.2), control.shape)
    control[:, 0], control[:, -1] = points[:-1], points[1:]
    control[1:, 0] = control[:-1, -1] = points[1:-1] + rng.normal(0, radius / 4, (count - 2, 3))
    curve = SpaceCurve(np.ascontiguousarray(control), np.zeros(len(control), np.int64))
    judgement = judge(curve, points, ToleranceTube(radius))
    if judgement.answer is TubeAnswer.INSIDE:
        assert_really_inside(curve, points, judgement, radius)
    else:
        given_feet = np.arange(count, dtype=float)
        worst = max(
            float(off_chords(curve.at(np.linspace(a, a + 1, 2000)), points[int(a) : int(a) + 2]).max())
            for a in given_feet[:-1]
        )
        worst = max(worst, float(np.linalg.norm(curve.at(given_feet) - points, axis=1).max()))
        assert worst > radius * (1 - 1e-6), "the obvious feet would have done"


@settings(max_examples=examples(60), deadline=None)
@given(st.integers(0, 2**32 - 1), st.floats(0.1, 2.0))
def test_spheroids_and_signs_agree(seed: int, size: float) -> None:
    rng = np.random.default_rng(seed)
    points = np.cumsum(rng.normal(0, 1, (4, 3)), axis=0)
    control = points[:-1, None] + (points[1:] - points[:-1])[:, None] * np.linspace(0, 1, 6)[None, :, None]
    control[:, 1:-1] += rng.normal(0, 0.05 * size, (3, 4, 3))
    curve = SpaceCurve(np.ascontiguousarray(control), np.zeros(3, np.int64))
    feet = np.arange(4.0)
    for tube in (ToleranceTube(0.05), ToleranceTube(0.02, 0.08)):
        end, middle = tube.radius, tube.widest
        outline = RevolvedOutline(
            lambda share, end=end, middle=middle: math.sqrt(end**2 + 4 * (middle**2 - end**2) * share * (1 - share))
        )  # type: ignore[misc]
        answer, at = lies_within(curve, points, outline, feet)
        if answer is TubeAnswer.INSIDE:
            assert judge(curve, points, tube, feet).answer is TubeAnswer.INSIDE
        elif answer is TubeAnswer.OUTSIDE:
            chord = min(int(at), 2)
            places = curve.at(np.linspace(chord, chord + 1, 5000))
            assert off_chords(places, points[chord : chord + 2]).max() > end * (1 - 1e-6)


def test_answers_stay_under_rotation_scale_and_reversal() -> None:
    rng = np.random.default_rng(7)
    points = np.cumsum(rng.normal(0, 1, (9, 3)), axis=0)
    control = points[:-1, None] + (points[1:] - points[:-1])[:, None] * np.linspace(0, 1, 6)[None, :, None]
    control[:, 1:-1] += rng.normal(0, 0.02, (8, 4, 3))
    turn, _ = np.linalg.qr(rng.normal(0, 1, (3, 3)))
    bound = judge(SpaceCurve(control, np.zeros(8, np.int64)), points, ToleranceTube(1.0)).bound
    for changed, path, size in (
        (control @ turn, points @ turn, 1.0),
        (control * 25.4, points * 25.4, 25.4),
        (control[::-1, ::-1], points[::-1], 1.0),
    ):
        curve = SpaceCurve(np.ascontiguousarray(changed), np.zeros(8, np.int64))
        assert judge(curve, np.ascontiguousarray(path), ToleranceTube(1.0 * size)).bound == pytest.approx(
            bound * size, rel=2e-3
        )


def test_bad_input_is_named() -> None:
    with pytest.raises(ParameterError, match="radius -1 mm"):
        ToleranceTube(-1)
    with pytest.raises(ParameterError, match="barrel"):
        ToleranceTube(0.1, 0.05)
    with pytest.raises(GeometryError, match="fewer than two"):
        judge(line([0, 0, 0], [1, 0, 0]), np.zeros((1, 3)), ToleranceTube(1))
    with pytest.raises(GeometryError, match="finite"):
        judge(line([0, 0, 0], [1, 0, 0]), np.array([[0, 0, 0], [np.nan, 0, 0]]), ToleranceTube(1))
