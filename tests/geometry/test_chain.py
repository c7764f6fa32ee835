"""Chaining: loose, unordered, reversed, repeated and touching curves become contours, and faults are located."""

import math
from collections.abc import Callable, Sequence
from itertools import pairwise

import pytest

from app.geometry.arcs.arcs import equally_far
from app.geometry.chaining.chain import ChainingResult, chain
from app.geometry.chaining.pieces import pieces_from, within_reach
from app.model.curves import Arc, Circle, Curve, Ellipse, Line, Point, Spline, reversed_curve
from app.model.finding import Finding, FindingKind
from app.model.part import Entity

SQUARE = [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)]


def polygon(points: Sequence[Point]) -> list[Curve]:
    return [Line(a, b) for a, b in zip(points, [*points[1:], points[0]], strict=True)]


def moved(points: Sequence[Point], dx: float, dy: float) -> list[Point]:
    return [(x + dx, y + dy) for x, y in points]


def chained(curves: Sequence[Curve], join_tolerance: float = 0.01) -> ChainingResult:
    made = chain([Entity(k, curve) for k, curve in enumerate(curves, 1)], join_tolerance)
    for contour in made.contours:
        for a, b in pairwise(contour.primitives):
            assert a.end == b.start
        assert not contour.closed or contour.primitives[-1].end == contour.primitives[0].start
        for p in contour.primitives:
            assert not isinstance(p, Arc) or math.dist(p.start, p.centre) == pytest.approx(
                math.dist(p.end, p.centre), rel=1e-9
            )
    return made


def shape(made: ChainingResult) -> list[tuple[bool, int]]:
    return [(c.closed, len(c.primitives)) for c in made.contours]


def of_kind(made: ChainingResult, kind: FindingKind) -> list[Finding]:
    return [f for f in made.findings if f.kind is kind]


def test_nothing_gives_nothing() -> None:
    assert chained([]) == ChainingResult()


def test_loose_reversed_segments_in_any_order() -> None:
    a, b, c, d = polygon(SQUARE)
    made = chained([c, reversed_curve(a), d, reversed_curve(b)])
    assert shape(made) == [(True, 4)] and not made.findings
    assert sorted(made.contours[0].entity_ids) == [1, 2, 3, 4]
    assert made.contours[0].deviation == 0.0


def test_contours_come_in_the_order_of_drawing() -> None:
    first, second = polygon(moved(SQUARE, 50, 0)), polygon(SQUARE)
    made = chained([first[0], second[0], *second[1:], *first[1:], Circle((80, 80), 5)])
    assert [c.entity_ids[0] for c in made.contours] == [1, 2, 9]
    assert isinstance(made.contours[2].primitives[0], Circle)


def test_first_layer_names_the_contour() -> None:
    entities = [Entity(k, curve, f"L{k}") for k, curve in enumerate(polygon(SQUARE), 5)]
    (contour,) = chain(entities).contours
    assert contour.layer == "L5" and contour.entity_ids == (5, 6, 7, 8)


def test_gap_within_tolerance_is_closed_and_said() -> None:
    points = [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0), (0.0, 0.004)]
    made = chained([Line(a, b) for a, b in pairwise(points)])
    assert shape(made) == [(True, 4)]
    (gap,) = of_kind(made, FindingKind.GAP_CLOSED)
    assert not gap.counts and gap.amount == pytest.approx(0.004) and "(0.000, 0.002)" in gap.text
    assert made.contours[0].deviation == pytest.approx(0.002)


def test_open_contour_names_both_loose_ends() -> None:
    made = chained([Line((0, 0), (10, 0)), Line((10, 0), (10, 10)), Line((10, 10), (0, 0.12))])
    assert shape(made) == [(False, 3)]
    (found,) = of_kind(made, FindingKind.OPEN_CONTOUR)
    assert found.counts and found.amount == pytest.approx(0.12)
    assert "The contour on layer 0, 10 x 10 mm from (0.000, 0.000), is open by 0.12 mm" in found.text
    assert "(0.000, 0.000) and (0.000, 0.120)" in found.text
    assert "tolerance 0.2" in found.text
    assert shape(chained([Line((0, 0), (10, 0)), Line((10, 0), (10, 10)), Line((10, 10), (0, 0.12))], 0.2)) == [
        (True, 3)
    ]


def test_arcs_stay_true_arcs_when_ends_move() -> None:
    slot = [
        Line((0, 0), (10, 0)),
        Arc((10, 0), (10, 4), (10, 2)),
        Line((10, 4.004), (0, 4)),
        Arc((0, 4), (0, 0.006), (0, 2.003)),
    ]
    made = chained(slot)
    assert shape(made) == [(True, 4)]
    assert made.contours[0].primitives[1] == slot[1]


def test_an_end_that_is_off_by_a_last_digit_makes_no_piece_of_its_own() -> None:
    first, last = (-377.5653106850218, -58.25467103385952), (-375.7437591865962, -360.1416533508884)
    a = Arc(first, (-413.75232919621806, -177.34749877837345), (-162.45616529030605, -188.66100939119747))
    b = Arc((a.end[0], math.nextafter(a.end[1], 0)), last, (-36.80808333735004, -194.3177646976095))
    assert shape(chained([a, b, Line(last, (0, 0)), Line((0, 0), first)])) == [(True, 4)]


def test_nearly_full_arc_is_bridged_not_bent() -> None:
    """The ends are 0.4 mm apart and each has to go 0.004 mm: moving them would shift the centre by a multiple of
    that.
    """
    a, b = (5 * math.cos(0.04), 5 * math.sin(0.04)), (5 * math.cos(0.04), -5 * math.sin(0.04))
    cap = Arc((b[0] + 0.008, b[1]), (a[0] + 0.008, a[1]), (a[0] - 0.2, 0.0))
    tilted = Arc((b[0] + 0.008, b[1] + 0.004), (a[0] - 0.004, a[1] + 0.004), (0.0, 0.0))
    tilted = Arc(tilted.start, tilted.end, _between(tilted, 0.3))
    for cover in (cap, tilted):
        made = chained([Arc(a, b, (0, 0)), cover])
        assert made.contours[0].closed
        large = max(
            (p for p in made.contours[0].primitives if isinstance(p, Arc)), key=lambda p: abs(p.sweep) * p.radius
        )
        assert math.dist(large.centre, (0, 0)) + abs(large.radius - 5) <= 0.012


def _between(arc: Arc, height: float) -> Point:
    """A centre equally far from both ends, `height` to the left of the chord."""
    dx, dy = arc.end[0] - arc.start[0], arc.end[1] - arc.start[1]
    length = math.hypot(dx, dy)
    return (arc.start[0] + arc.end[0]) / 2 - dy / length * height, (
        arc.start[1] + arc.end[1]
    ) / 2 + dx / length * height


def test_arc_whose_ends_meet_is_a_circle() -> None:
    made = chained([Arc((5, 0), (5 * math.cos(-0.001), 5 * math.sin(-0.001)), (0, 0))])
    assert made.contours[0].primitives == (Circle((0, 0), 5.0),) and made.contours[0].closed


def test_short_details_survive_a_wide_tolerance() -> None:
    """Segments shorter than the join tolerance are not swallowed where they are connected already."""
    fine = [
        (round(0.01 * math.cos(a) + 5, 6), round(0.01 * math.sin(a), 6)) for a in [math.tau * k / 12 for k in range(12)]
    ]
    assert shape(chained(polygon(fine), 0.05)) == [(True, 12)]


def test_ends_that_are_nearest_are_joined() -> None:
    comb = [
        Line((0, 0), (0, 10)),
        Line((0, 10.005), (0.02, 10.005)),
        Line((0.02, 10), (0.02, 0)),
        Line((0.02, -0.004), (0, -0.004)),
    ]
    assert shape(chained(comb)) == [(True, 4)]


def test_two_gaps_side_by_side_close_each_for_itself() -> None:
    left = [(10.0, 0.0), (0.0, 0.0), (0.0, 9.0), (10.0, 9.0), (10.0, 0.002)]
    right = [(10.007, 0.0), (20.0, 0.0), (20.0, 9.0), (10.007, 9.0), (10.007, 0.002)]
    made = chained([Line(a, b) for points in (left, right) for a, b in pairwise(points)])
    assert [c.entity_ids for c in made.contours] == [(1, 2, 3, 4), (5, 6, 7, 8)]


def test_copies_do_not_keep_ends_from_meeting() -> None:
    edges = polygon(SQUARE)
    off = Line((10.004, 0.003), (10.003, 9.998))
    assert shape(chained([edges[0], off, off, edges[2], edges[3]])) == [(True, 4)]


@pytest.mark.parametrize("copy", [lambda c: c, reversed_curve], ids=["same", "reversed"])
def test_repeated_edge_is_left_out(copy: object) -> None:
    edges = polygon(SQUARE)
    made = chained([*edges, copy(edges[2])])  # type: ignore[operator]
    assert shape(made) == [(True, 4)]
    (found,) = of_kind(made, FindingKind.OVERLAP)
    assert not found.counts and found.amount == pytest.approx(10) and found.entity_ids == (3, 5) and found.y == 10


def test_everything_drawn_twice() -> None:
    halves = [Arc((20, 0), (24, 0), (22, 0)), Arc((24, 0), (20, 0), (22, 0))]
    edges = [*polygon(SQUARE), Circle((5, 5), 2), *halves, Ellipse((40, 0), (5, 0), 0.5)]
    made = chained([*edges, *[reversed_curve(e) for e in reversed(edges)]])
    assert [c.closed for c in made.contours] == [True] * 4
    assert len(of_kind(made, FindingKind.OVERLAP)) == 8 and not any(f.counts for f in made.findings)


def test_repeated_edge_that_is_slightly_off() -> None:
    made = chained([*polygon(SQUARE), Line((10.003, 0.002), (10.002, 10.004))])
    assert shape(made) == [(True, 4)] and len(of_kind(made, FindingKind.OVERLAP)) == 1


@pytest.mark.parametrize("off", [1e-6, 1e-4, 0.002, 0.006])
def test_outlines_drawn_twice_a_little_apart(off: float) -> None:
    """Rectangles and circles alike: even-odd would take the one for nothing and mill the inside of the other."""
    edges = [*polygon(SQUARE), Circle((5, 5), 2)]
    again = [*polygon(moved(SQUARE, off, off)), Circle((5 + off, 5), 2 + off / 2)]
    for copy in (again, [reversed_curve(c) for c in again[::-1]]):
        made = chained([*edges, *copy])
        assert [c.entity_ids for c in made.contours] == [(1, 2, 3, 4), (5,)]
        assert {f.kind for f in made.findings} == {FindingKind.OVERLAP} and not any(f.counts for f in made.findings)


def test_outline_drawn_twice_a_little_apart_with_other_corners() -> None:
    split = [(0.004, 0.0), (5.0, 0.0), (10.004, 0.0), (10.004, 10.0), (0.004, 10.0)]
    made = chained([*polygon(SQUARE), *polygon(split)])
    assert shape(made) == [(True, 4)] and "drawn twice" in made.findings[0].text and not made.findings[0].counts


def test_part_of_an_outline_drawn_twice_a_little_apart() -> None:
    edges = polygon(SQUARE)
    off = polygon(moved(SQUARE, 0.002, 0.002))
    for again in (off[:2], off[1:], off[:1], [reversed_curve(c) for c in off[:3]]):
        made = chained([*edges, *again])
        assert [c.entity_ids for c in made.contours] == [(1, 2, 3, 4)]
        assert len(of_kind(made, FindingKind.OVERLAP)) == len(again) and not any(f.counts for f in made.findings)


def test_open_chain_drawn_twice_a_little_apart_is_one() -> None:
    made = chained([*polygon(SQUARE)[:3], *polygon(moved(SQUARE, 0.002, -0.002))[:3]])
    assert shape(made) == [(False, 3)]


@pytest.mark.parametrize("width", [0.012, 0.05])
def test_walls_of_a_thin_feature_stay_two(width: float) -> None:
    thin = [(0.0, 0.0), (10.0, 0.0), (10.0, width), (0.0, width)]
    for join_tolerance in (0.01, 0.2):
        made = chained(polygon(thin), join_tolerance)
        assert shape(made) == [(True, 4)] and not made.findings
        rings = chained([Circle((0, 0), 5), Circle((0, 0), 5 + width)], join_tolerance)
        assert len(rings.contours) == 2 and not rings.findings


def test_thin_tongue_of_an_outline_with_gaps_stays() -> None:
    """Narrower than the tolerance, but what joins its walls says that they are two."""
    points = [
        (0.0, 0.0),
        (5.0, 0.0),
        (5.0, -9.0),
        (5.008, -9.0),
        (5.008, 0.0),
        (10.0, 0.0),
        (10.0, 10.0),
        (0.0, 10.0),
        (0.0, 0.004),
    ]
    made = chained([Line(a, b) for a, b in pairwise(points)])
    assert shape(made) == [(True, 8)]


def test_lens_between_the_same_points_is_no_repeat() -> None:
    lens = [Line((0, 0), (10, 0)), Arc((10, 0), (0, 0), (5, -100.0), True)]
    assert shape(chained(lens, 0.2)) == [(True, 2)]


def test_wall_of_two_outlines_is_kept() -> None:
    made = chained([*polygon(SQUARE), *polygon(moved(SQUARE, 10, 0))])
    assert shape(made) == [(True, 4), (True, 4)]
    (found,) = of_kind(made, FindingKind.OVERLAP)
    assert not found.counts and "share" in found.text


def test_line_inside_another_is_left_out() -> None:
    made = chained([*polygon(SQUARE), Line((2, 0), (6, 0))])
    assert shape(made) == [(True, 4)]
    assert of_kind(made, FindingKind.OVERLAP)[0].amount == pytest.approx(4)


def test_arc_inside_another_is_left_out() -> None:
    half = Arc((5, 0), (-5, 0), (0, 0))
    piece = Arc((3.0, 4.0), (-3.0, 4.0), (0, 0))
    made = chained([half, Line((-5, 0), (5, 0)), piece])
    assert shape(made) == [(True, 2)]
    assert of_kind(made, FindingKind.OVERLAP)[0].amount == pytest.approx(2 * 5 * math.atan2(3, 4))


def test_partial_overlap_counts_and_is_located() -> None:
    made = chained([Line((0, 0), (6, 0)), Line((5, 0), (10, 0)), *polygon(SQUARE)[1:]])
    (found,) = of_kind(made, FindingKind.OVERLAP)
    assert found.counts and found.amount == pytest.approx(1) and (found.x, found.y) == (5.5, 0)
    assert of_kind(made, FindingKind.OPEN_CONTOUR)


def test_circle_and_two_half_circles() -> None:
    made = chained([Circle((0, 0), 5), Arc((5, 0), (-5, 0), (0, 0)), Arc((-5, 0), (5, 0), (0, 0))])
    assert shape(made) == [(True, 1)]
    assert "drawn twice" in of_kind(made, FindingKind.OVERLAP)[0].text


def test_mirrored_twin_in_the_same_box_is_another_contour() -> None:
    made = chained([*polygon([(0, 0), (10, 0), (0, 10)]), *polygon([(10, 10), (0, 10), (10, 0)])])
    assert [c.closed for c in made.contours] == [True, True]


def test_two_outlines_that_touch_at_a_corner_stay_two() -> None:
    made = chained([*polygon(SQUARE), *polygon(moved(SQUARE, 10, 10))])
    assert [c.entity_ids for c in made.contours] == [(1, 2, 3, 4), (5, 6, 7, 8)]
    (touch,) = of_kind(made, FindingKind.SELF_INTERSECTION)
    assert not touch.counts and (touch.x, touch.y) == (10, 10)


def test_spur_leaves_the_loop_closed() -> None:
    made = chained([Line((15, 15), (10, 10)), *polygon(SQUARE)])
    assert shape(made) == [(False, 1), (True, 4)]
    (branch,) = of_kind(made, FindingKind.SELF_INTERSECTION)
    assert branch.counts and "3 ends meet at (10.000, 10.000)" in branch.text
    assert set(branch.entity_ids) == {1, 3, 4}


def test_bar_between_two_loops_leaves_both_closed() -> None:
    made = chained([Line((10, 10), (20, 20)), *polygon(SQUARE), *polygon(moved(SQUARE, 20, 20))])
    assert shape(made) == [(False, 1), (True, 4), (True, 4)]


def test_dividing_line_leaves_the_outline() -> None:
    made = chained(
        [
            Line((5, 0), (5, 10)),
            Line((0, 0), (5, 0)),
            Line((5, 0), (10, 0)),
            Line((10, 0), (10, 10)),
            Line((10, 10), (5, 10)),
            Line((5, 10), (0, 10)),
            Line((0, 10), (0, 0)),
        ]
    )
    assert shape(made) == [(False, 1), (True, 6)]
    assert len([f for f in of_kind(made, FindingKind.SELF_INTERSECTION) if f.counts]) == 2


def test_curves_become_lines_and_arcs_with_their_deviation() -> None:
    curve = Spline(3, ((0, 0), (0, 20), (10, 20), (10, 0)), (0, 0, 0, 0, 1, 1, 1, 1))
    made = chained([Line((10, 0), (0, 0)), curve])
    assert made.contours[0].closed and len(made.contours[0].primitives) > 10
    assert 0 < made.contours[0].deviation <= 1e-3


def test_curves_without_length_are_named() -> None:
    made = chained(
        [
            *polygon(SQUARE),
            Line((3, 3), (3, 3)),
            Circle((1, 1), 1e-9),
            Line((0, math.nan), (1, 1)),
            Line((0, 0), (1e300, 1)),
        ]
    )
    assert shape(made) == [(True, 4)]
    assert [f.entity_ids for f in of_kind(made, FindingKind.TINY_ENTITY)] == [(5,), (6,), (7,), (8,)]


def test_many_faults_are_counted_not_listed() -> None:
    made = chained([Arc((5.0 * k, 0), (5.0 * k, 0.1), (5.0 * k - 2, 0.05), False) for k in range(300)])
    found = of_kind(made, FindingKind.OPEN_CONTOUR)
    assert len(found) == 21 and "280 more" in found[-1].text and found[-1].counts


def test_lines_that_bound_nothing_are_one_line_a_layer_with_the_way_out() -> None:
    centre = [Entity(k, Line((0, 3.0 * k), (10 + k, 3.0 * k)), "Centre lines") for k in range(1, 29)]
    (found,) = chain([*centre, Entity(99, Circle((0, 0), 1), "0")]).findings
    assert found.text == (
        "Layer Centre lines has 28 lines that bound nothing, the longest 38 x 0 mm at (0.000, 84.000). "
        'Complete them, or leave the layer out: --skip-layer "Centre lines".'
    )
    assert found.counts and len(found.entity_ids) == 28
    (among,) = chain([*centre, Entity(99, Circle((0, 0), 1), "Centre lines")]).findings
    assert "draw them on a layer of their own, which --skip-layer leaves out" in among.text


def test_the_nearest_other_end_is_what_an_advice_is_about() -> None:
    """Two halves of an outline: one gap is closed, the ends at the other are 0.0113 mm apart; each half is open by 40
    mm as a whole.
    """
    half = [Line((0, 0), (40, 0)), Line((40, 0), (40, 30))]
    other = [Line((40, 30.0113), (0, 30)), Line((0, 30), (0, 0.0)), Line((60, 60), (130, 60))]
    found = of_kind(chained([*half, *other]), FindingKind.OPEN_CONTOUR)
    assert len(found) == 2 and found[0].amount == pytest.approx(0.0113)
    assert "Join with tolerance 0.02" in found[0].text and "(40.000, 30.011)" in found[0].text
    assert "Complete it" in found[1].text and "olerance" not in found[1].text
    assert [c.closed for c in chained([*half, *other], 0.02).contours] == [True, False]


@pytest.mark.parametrize(("gap", "advised"), [(0.12, "0.2"), (4.0, "5"), (9.9, "10"), (10.5, ""), (60.0, "")])
def test_no_tolerance_is_advised_that_is_not_allowed(gap: float, advised: str) -> None:
    made = chained([Line((0, 0), (1000, 0)), Line((1000, 0), (1000, 1000)), Line((1000, 1000), (0, gap))])
    (found,) = of_kind(made, FindingKind.OPEN_CONTOUR)
    assert f"Join with tolerance {advised} or" in found.text if advised else "olerance" not in found.text


def test_ends_of_different_curves_are_named_with_their_distance() -> None:
    made = chained([Line((0, 0), (40, 0)), Line((40.5, 0), (80, 30)), Line((200, 0), (200, 50))])
    found = of_kind(made, FindingKind.OPEN_CONTOUR)
    assert (
        "its loose end at (40.000, 0.000) is 0.5 mm from that of another at (40.500, 0.000). Join with tolerance 0.5"
        in found[0].text
    )


def test_flat_arc_with_a_far_centre_closes_its_outline() -> None:
    edges = polygon(SQUARE)
    made = chained([Arc((0, 0), (10, 0), (5, 2.5e9)), *edges[1:]])
    assert made.contours[0].closed and not made.findings and made.contours[0].primitives[0] == edges[0]
    assert made.contours[0].deviation == pytest.approx(1e-4)


def test_arc_is_as_far_away_as_its_points_not_its_centre() -> None:
    rising = Arc((0, 0), (2e5, 0), (1e5, math.sqrt(2e9**2 - 1e10)))
    assert within_reach(rising)
    left, right = (-1e5, 9.5e5), (1e5, 9.5e5)
    assert within_reach(Arc(left, right, (0, 9.5e5))) and not within_reach(Arc(right, left, (0, 9.5e5)))


def bow(first: float, last: float, radius: float = 30.0) -> Arc:
    start, end = ((radius * math.cos(math.radians(a)), radius * math.sin(math.radians(a))) for a in (first, last))
    return Arc(start, end, equally_far(start, end, (0.0, 0.0)))


@pytest.mark.parametrize("turn", [lambda c: c, reversed_curve], ids=["same", "reversed"])
def test_arcs_of_one_circle_that_overlap_at_loose_ends_become_one_outline(turn: Callable[[Curve], Curve]) -> None:
    for a, b in ((bow(0, 200), bow(180, 360)), (bow(0, 200), bow(180, 380)), (bow(180, 360), bow(0, 200))):
        made = chained([a, turn(b)])
        assert shape(made) == [(True, 2)] and made.contours[0].deviation < 1e-9
        assert sum(abs(p.sweep) for p in made.contours[0].primitives if isinstance(p, Arc)) == pytest.approx(math.tau)
        (found,) = made.findings
        assert found.kind is FindingKind.OVERLAP and not found.counts and "cut to where the other ends" in found.text


def test_overlapping_arcs_with_another_end_there_are_not_cut() -> None:
    made = chained([bow(0, 200), bow(180, 360), Line(bow(0, 200).end, (0, 0))])
    assert any(f.counts and f.kind is FindingKind.OVERLAP for f in made.findings)
    made = chained([bow(0, 200), bow(180, 360, 30.01)], 0.001)
    assert not made.contours[0].closed


def test_many_curves_become_what_each_becomes_alone_and_keep_their_order() -> None:
    """Ninety ellipses and lines, two of which cannot be read and one of which has no length."""
    curves: list[Curve] = [
        Ellipse((20.0 * k, 0.0), (3.0 + 0.01 * k, 1.0), 0.4) if k % 3 else Line((20.0 * k, 5.0), (20.0 * k + 4, 6.0))
        for k in range(120)
    ]
    curves[7], curves[64] = Ellipse((2e6, 0.0), (3.0, 0.0), 0.5), Ellipse((math.nan, 0.0), (3.0, 0.0), 0.5)
    curves[99] = Line((1.0, 1.0), (1.0, 1.0))
    entities = [Entity(k, curve) for k, curve in enumerate(curves, 1)]
    pieces, findings = pieces_from(entities)
    alone = [pieces_from([entity]) for entity in entities]
    assert pieces == [piece for each in alone for piece in each.pieces]
    assert findings == [finding for each in alone for finding in each.findings]
    assert (len(pieces), len(findings)) == (117, 3)
