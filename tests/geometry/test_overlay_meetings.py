"""Contours that meet in every way that is hard to decide: nothing is lost, nothing crashes, no curve is of no
length.
"""

from __future__ import annotations

import math
from itertools import islice

import numpy as np
import pytest

from app.core import tolerances
from app.geometry.chaining.chain import contacts, crossings
from app.geometry.even_odd import even_odd
from app.geometry.outlines import nest, nested, polygon_contour
from app.geometry.overlay import overlay as overlay_net
from app.geometry.overlay.overlay import without_crossings, without_outlines
from app.geometry.primitives import contour_rows, curve_rows, lengths, row_curve, signed_area
from app.model.curves import Arc, Line
from app.model.part import Contour
from tests.geometry.meeting_shapes import KINDS, OFFSETS, Pose, any_case, box, disc, lattice, side_by_side

SHARE = 7
"""Of kinds times offsets, one in so many is tried in every run."""

SIDE_BY_SIDE = 20
"""Cases in one drawing: most of the time of a case goes into calls, whatever they are given."""

TINY = 1e-3
"""mm; a piece shorter than this says nothing of whether curves cross by more than 1 um."""


def lens(r: float, s: float, gap: float) -> float:
    """What two circles that cross share."""
    a, b = (math.acos((gap**2 + p**2 - q**2) / (2 * gap * p)) for p, q in ((r, s), (s, r)))
    return r * r * (a - math.sin(2 * a) / 2) + s * s * (b - math.sin(2 * b) / 2)


def region_area(contours: tuple[Contour, ...]) -> float:
    """The area of the regions that contours bound, and of what is too thin to be one."""
    nesting = nested(contours)
    kept = sum(signed_area(contour_rows(contour)) for region in nesting.regions for contour in region.contours)
    return kept + sum(abs(signed_area(contour_rows(contour))) for contour in nesting.thin)


def assert_whole(shapes: list[Contour], cases: int = 1) -> tuple[Contour, ...]:
    """Assert that an overlay of shapes has lost nothing, and is fit to go on with; of several cases side by side, that
    all have lost together no more than one of them may.
    """
    drawn = even_odd(shapes)
    made = without_crossings(shapes)
    allowed = drawn.length * tolerances.WELD / cases
    assert made.findings == ()
    assert even_odd(made.contours).area == pytest.approx(drawn.area, abs=allowed)
    assert region_area(made.contours) == pytest.approx(drawn.area, abs=allowed)
    for contour in made.contours:
        ends = [curve.end for curve in contour.primitives]
        assert [curve.start for curve in contour.primitives] == ends[-1:] + ends[:-1]
        assert len(ends) == 1 or all(curve.start != curve.end for curve in contour.primitives)
    rows = np.concatenate([np.zeros((0, 8)), *map(contour_rows, made.contours)])
    small = rows[lengths(rows) < TINY, :2]
    for finding in crossings(made.contours):
        if finding.counts:
            assert any(math.dist((finding.x or 0, finding.y or 0), place) < 2 * TINY for place in small), finding.text
    return made.contours


def assert_all_whole(cases: list[list[Contour]]) -> list[Contour]:
    """Assert the same of cases side by side in one drawing, a third of the time; return what is left of them.

    Where they lose more together than one may, each is looked at by itself.
    """
    placed = side_by_side(cases)
    shapes = [shape for case in placed for shape in case]
    try:
        return list(assert_whole(shapes, len(cases)))
    except AssertionError:
        return [left for case in placed for left in assert_whole(case)]


@pytest.mark.parametrize("kind", list(KINDS))
def test_kinds_of_contact(kind: str) -> None:
    for e in OFFSETS[list(KINDS).index(kind) % SHARE :: SHARE]:
        assert_whole(KINDS[kind](e))


@pytest.mark.exhaustive
def test_kinds_of_contact_at_all_offsets() -> None:
    for kind in KINDS:
        for e in OFFSETS:
            assert_whole(KINDS[kind](e))


@pytest.mark.parametrize(
    "seeds", [(0, 200), *(pytest.param((first, 5000), marks=pytest.mark.exhaustive) for first in range(1, 21))]
)
def test_any_contact_in_any_pose(seeds: tuple[int, int]) -> None:
    """All together 100,000 cases; each in its own pose in the first 5,200, then side by side."""
    first, count = seeds
    cases = (any_case(np.random.default_rng((first, k))) for k in range(count))
    for case in islice(cases, count if first <= 1 else 0):
        assert_whole(case)
    while several := list(islice(cases, SIDE_BY_SIDE)):
        assert_all_whole(several)


@pytest.mark.parametrize(
    "seeds", [(0, 50), *(pytest.param((first, 500), marks=pytest.mark.exhaustive) for first in range(1, 9))]
)
def test_lattices(seeds: tuple[int, int]) -> None:
    for k in range(seeds[1]):
        assert_whole(lattice(np.random.default_rng((seeds[0], k))))


def test_two_circles_that_overlap_by_a_nanometre_are_both_there() -> None:
    for e in (1e-6, 1e-9, 1e-12, 3.3e-5):
        parts = assert_whole([disc(0, 0, 10), disc(20 - e, 0, 10)])
        assert region_area(parts) == pytest.approx(200 * math.pi - 2 * lens(10, 10, 20 - e), abs=1e-4)


def test_three_edges_on_one_another_count_once() -> None:
    for e in (0.0, 1e-9, 1e-6):
        parts = assert_whole([box(0, 0, 10, 10), box(0, e, 10, 10 + e), box(5, 0, 15, 10)])
        assert region_area(parts) == pytest.approx(100, abs=1e-4)


def test_a_pencil_of_circles_keeps_its_hole() -> None:
    shapes = [
        disc(-2095.854983085781, 2678.7072964098247, 10),
        disc(-2098.607161309485, 2682.881684391909, 5),
        disc(-2099.708032599171, 2684.551439584213, 3),
    ]
    regions = nest(assert_whole(shapes))
    assert sum(signed_area(contour_rows(c)) for region in regions for c in region.contours) == pytest.approx(
        84 * math.pi, abs=1e-4
    )


def test_curves_that_cross_beside_a_corner_both_go_through_it() -> None:
    """The corner lies WELD from the circle, give or take the last digit: the crossing is at the corner, the circle is
    just not.
    """
    corners = [
        (1734.6730329374907, 823.7700234533081),
        (1719.6730319374908, 823.7700236033081),
        (1719.6730318374907, 813.7700246033081),
        (1734.6730328374908, 813.7700244533081),
    ]
    assert_whole([disc(1734.6730323042011, 818.7700224533081, 5), polygon_contour(corners)])


def test_a_slit_goes_and_a_wall_stays() -> None:
    """An edge that runs forth and back within one area separates nothing; one between two areas does."""
    bridged = assert_whole(KINDS["hole by a bridge"](0.0))
    assert sorted(abs(signed_area(contour_rows(part))) for part in bridged) == pytest.approx([100, 400])
    assert len(assert_whole([box(0, 0, 10, 10), box(10, 0, 20, 10)])) == 2


def test_contours_that_meet_nobody_come_back_as_they_were_drawn() -> None:
    alone = [disc(100, 100, 5), polygon_contour([(200, 0), (210, 0), (205, 9)])]
    parts = without_crossings([alone[0], disc(0, 0, 10), disc(15, 0, 10), alone[1]]).contours
    assert parts[0] is alone[0] and parts[-1] is alone[1]


def test_a_smooth_joint_that_misses_by_a_hair_is_no_meeting() -> None:
    lift = 3e-10
    right, left = Arc((10, lift), (10, 4 - lift), (10, 2)), Arc((0, 4), (0, 0), (0, 2))
    slot = Contour((Line((0, 0), (10, lift)), right, Line((10, 4 - lift), (0, 4)), left))
    assert without_crossings([slot]).contours[0] is slot


def test_points_nearer_to_one_another_than_the_length_that_is_merged_do_not_all_become_one() -> None:
    """2,000 steps of 0.7 um along one side of a square that another one crosses."""
    fine = [(10 - 7e-7 * k, 10.0) for k in range(2000)]
    shapes = [polygon_contour([(0, 0), (10, 0), *fine, (0, 10)]), box(9.9992, 5, 15, 15)]
    parts = assert_whole(shapes)
    assert region_area(parts) == pytest.approx(100 + 50 + 10 * 0.0008 - 2 * 5 * 0.0008, abs=1e-4)


@pytest.mark.parametrize("kind", list(KINDS)[::4])
def test_the_area_is_the_same_wherever_it_lies(kind: str) -> None:
    shapes = KINDS[kind](3.3e-6)
    first = region_area(without_crossings(shapes).contours)
    length = even_odd(shapes).length
    for pose in (Pose(0.3), Pose(math.pi / 4, 500, -200), Pose(2.0, -3000, 1000)):
        again = region_area(without_crossings([pose.of(shape) for shape in shapes]).contours)
        assert again == pytest.approx(first, abs=2 * length * tolerances.WELD)


def test_the_same_twice_is_the_same_and_what_is_made_stays_what_it_is() -> None:
    for kind in list(KINDS)[::3]:
        shapes = KINDS[kind](1e-4)
        parts = without_crossings(shapes)
        assert without_crossings(shapes) == parts
        again = without_crossings(parts.contours).contours
        assert ends(again) == ends(parts.contours)


def ends(contours: tuple[Contour, ...]) -> list[tuple[object, ...]]:
    """Both ends of all curves; centres of arcs move by their last digit when they become rows."""
    return sorted(tuple(sorted((curve.start, curve.end))) for contour in contours for curve in contour.primitives)


@pytest.mark.parametrize("size", [1e-9, 3e-8, 1e-7, 1e-6])
def test_specks_are_no_trouble(size: float) -> None:
    """Shapes as small as what is merged, with something real beside them."""
    specks = [
        disc(0, 0, 10 * size),
        disc(12 * size, 0, 10 * size),
        box(0, 0, 9 * size, 4 * size),
        box(0, 0, size, 20 * size),
    ]
    for shapes in (specks, [*specks, box(5, 5, 9, 9)]):
        made = without_crossings(shapes)
        assert made.findings == () and even_odd(made.contours).area == pytest.approx(even_odd(shapes).area, abs=1e-6)
        for few, outlines in ((shapes[:1], shapes[1:2]), (shapes[-1:], shapes[:1])):
            assert without_outlines(few, outlines).findings == ()


def test_outlines_are_taken_out_whole() -> None:
    for kind in KINDS:
        for e in (0.0, 1e-12, -3.3e-7, 1e-6, -1e-4):
            first, *outlines = KINDS[kind](e)
            plain = without_crossings([first]).contours
            held = [part for outline in outlines for part in without_crossings([outline]).contours]
            made = without_outlines(plain, held)
            expected = even_odd(plain, held)
            assert made.findings == ()
            assert region_area(made.contours) == pytest.approx(expected.area, abs=expected.length * tolerances.WELD), (
                kind,
                e,
            )


def test_outlines_round_and_within_areas_that_they_do_not_touch() -> None:
    plate, hole, inner = box(0, 0, 100, 100), disc(30, 30, 20), disc(30, 30, 5)
    made = without_outlines(
        [plate, hole, inner], [disc(80, 80, 10), disc(30, 30, 8), disc(30, 42, 2), disc(200, 0, 5)]
    ).contours
    assert made[:2] == (plate, hole)
    assert region_area(made) == pytest.approx(10000 - 400 * math.pi - 100 * math.pi)


def test_a_touch_is_within_reach_of_both_curves() -> None:
    """An arc so short that its sagitta is below the width of a touch reaches no farther than its ends."""
    angle = 3.8e-3 / 5
    arc = np.array(curve_rows(Arc((0.0, -5.0), (5 * math.sin(angle), -5 * math.cos(angle)), (0, 0))))
    line = np.array([[-0.01, -5.0000004, 0.01, -5.0000004, 0, 0, 0, 0]])
    moved = line + [[-7.5e-4, 0, -7.5e-4, 0, 0, 0, 0, 0]]
    for rows in (np.vstack([arc, line]), np.vstack([arc, moved])):
        points, _, _ = contacts(rows, np.array([0]), np.array([1]))
        assert (points[:, 0] > -1e-6).all()


def test_circles_inside_one_another_touch_however_alike() -> None:
    for e in (0.0, 4e-7, -4e-7):
        (found,) = crossings([disc(0, 0, 10), disc(0.01 + e, 0, 9.99)])
        assert not found.counts and (found.x, found.y) == pytest.approx((10, 0), abs=0.3)


def test_an_arc_without_a_length_is_refused() -> None:
    with pytest.raises(Exception, match="begins where it ends"):
        curve_rows(Arc((1, 2), (1, 2), (0, 0)))
    with pytest.raises(Exception, match="begins where it ends"):
        row_curve(np.array([1.0, 2, 1, 2, 0, 0, 5, 1]))


def test_a_lost_loop_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = overlay_net.loops_along
    monkeypatch.setattr(overlay_net, "loops_along", lambda *given: whole(*given)[1:])
    (found,) = without_crossings([disc(0, 0, 10), disc(15, 0, 10)]).findings
    moon = 100 * math.pi - lens(10, 10, 15)
    assert found.counts and found.amount == pytest.approx(moon) and f"{moon:.4f} mm2 too small" in found.text
    assert without_outlines([box(0, 0, 9, 9)], [box(5, 5, 20, 20)]).findings


@pytest.mark.parametrize("seeds", [(40, 120), pytest.param((41, 3000), marks=pytest.mark.exhaustive)])
def test_an_overlay_of_its_own_outcome_changes_nothing_but_by_what_is_merged(seeds: tuple[int, int]) -> None:
    """Centres of arcs may change in their last digits, and what is just not thinner than WELD may go when it is looked
    at again.

    By the even-odd rule two areas together are what only one of them has.
    """
    first, count = seeds
    cases = (any_case(np.random.default_rng((first, k))) for k in range(count))
    while several := list(islice(cases, SIDE_BY_SIDE)):
        once = assert_all_whole(several)
        again = assert_whole(once)
        both = even_odd([*once, *again])
        assert both.area <= both.length / 2 * tolerances.WELD / len(several)
