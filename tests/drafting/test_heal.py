"""Faults of a drawing, and how they are mended."""

import math
import random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.core.errors import InputError
from app.drafting.commands.defects import DefectKind, curve_distance, find_defects
from app.drafting.document import Document
from app.model.curves import Arc, Circle, Line
from tests.drafting.documents import drawn
from tests.examples import examples


def kinds(document: Document, tolerance: float = 0.01) -> list[tuple[DefectKind, tuple[int, ...]]]:
    return [(fault.kind, fault.ids) for fault in find_defects(document.part, tolerance)]


def test_each_kind_is_found_with_its_place_and_its_size() -> None:
    document = drawn(
        "rect 0,0 60,40",
        "line 0,0 60,0",
        "line 100,0 100,0.005",
        "line 30,40 80,40",
        "line 80,40.004 80,20",
        "circle 5,5 2",
        "circle 5,5 2.003 cw",
    )
    faults = {fault.kind: fault for fault in find_defects(document.part, 0.01)}
    assert faults[DefectKind.TINY].ids == (6,) and faults[DefectKind.TINY].size == pytest.approx(0.005)
    assert [f.ids for f in find_defects(document.part, 0.01) if f.kind is DefectKind.DUPLICATE] == [(1, 5), (9, 10)]
    overlap, gap = faults[DefectKind.OVERLAP], faults[DefectKind.GAP]
    assert overlap.ids == (3, 7) and overlap.size == pytest.approx(30) and overlap.place == pytest.approx((45, 40))
    assert set(gap.ids) == {7, 8} and gap.size == pytest.approx(0.004) and gap.place == pytest.approx((80, 40.002))


@pytest.mark.parametrize(
    ("lines", "left", "reply"),
    [
        (["line 0,0 10,0", "line 10,0 0,0"], 1, "1 duplicate removed."),
        (["line 0,0 10,0", "line 2,0 5,0.005"], 1, "1 overlap removed."),
        (["circle 0,0 5", "arc 5,0 0,5 centre 0,0"], 1, "1 overlap removed."),
        (["spline 0,0 5,5 10,0 15,5", "spline 15,5 10,0 5,5 0,0"], 1, "1 duplicate removed."),
        (["ellipse 0,0 5,0 3", "ellipse 0,0 5,0 3 cw"], 1, "1 duplicate removed."),
        (["line 0,0 10,0", "line 0,1 10,1", "line 0,0 0,1", "arc 5,0 0,5 centre 0,0"], 4, "Nothing to mend."),
    ],
)
def test_what_is_drawn_twice_goes(lines: list[str], left: int, reply: str) -> None:
    document = drawn(*lines)
    assert document.run("heal 0.01") == reply
    assert len(document.part.entities) == left and not kinds(document)


def test_what_overlaps_on_a_layer_becomes_one() -> None:
    document = drawn(
        "line 0,0 10,0",
        "line 14,0 6,0.004",
        "line 13,0 40,0",
        "arc 5,100 -5,100 centre 0,100",
        "arc 0,105 0,95 centre 0,100",
        "arc 55,0 45,0 centre 50,0",
        "arc 45.5,2.179449471770337 55,0 centre 50,0 ",
    )
    assert document.run("heal 0.01") == "4 overlaps removed."
    assert {e.id for e in document.part.entities} == {3, 4, 7} and not kinds(document)
    assert document.part.curve(3) == Line((0, 0), (40, 0))
    assert document.part.curve(4) == Arc((5, 100), (0, 95), (0, 100))
    assert document.part.curve(7) == Circle((50, 0), 5)


def test_curves_that_end_on_an_overlap_keep_their_places() -> None:
    document = drawn("line 0,0 10,0", "line 6,0 14,0", "line 10,0 10,5", "line 30,5 30,0")
    assert document.run("heal 0.01") == "1 overlap removed."
    assert [document.part.curve(n) for n in (1, 2)] == [Line((0, 0), (10, 0)), Line((10, 0), (14, 0))]


def test_of_an_overlap_across_layers_the_rest_stays_and_joins() -> None:
    document = drawn(
        "line 0,0 10,0",
        "layer b",
        "line 6,0 14,0",
        "layer a",
        "arc 5,100 -5,100 centre 0,100",
        "layer b",
        "arc 0,105 0,95 centre 0,100",
    )
    document.run("heal 0.01")
    assert document.part.curve(2) == Line((10, 0), (14, 0))
    rest = document.part.curve(4)
    assert isinstance(rest, Arc) and rest.start == pytest.approx((-5, 100)) and rest.end == pytest.approx((0, 95))
    assert not kinds(document)


def test_gaps_are_closed_half_way_and_arcs_keep_their_sweep() -> None:
    document = drawn("line 0,0 10,0", "line 10.006,0 10,10", "arc 10,10.004 0,20.004 centre 0,10.004")
    assert document.run("heal 0.01") == "2 gaps closed."
    a, b, c = (document.part.curve(n) for n in (1, 2, 3))
    assert a.end == b.start == (10.003, 0) and b.end == c.start == pytest.approx((10, 10.002))
    document.undo()
    assert document.part.curve(1) == Line((0, 0), (10, 0))


def test_where_a_tiny_curve_was_its_neighbours_meet() -> None:
    document = drawn("line 0,0 10,0 10.004,0.003 20,10")
    assert document.run("heal 0.01") == "1 tiny curve removed, 1 gap closed."
    assert [e.id for e in document.part.entities] == [1, 3] and document.part.curve(1).end == document.part.curve(
        3
    ).start


def test_ends_farther_than_the_tolerance_stay_apart_and_nothing_moves_farther() -> None:
    document = drawn("line 0,0 10,0", "line 10.02,0 20,5", "arc 0,50 0,50.02 centre 5,50.01", "line 0,50.028 -5,60")
    before = {e.id: e.curve for e in document.part.entities}
    document.run("heal 0.01")
    assert all(curve_distance(before[e.id], e.curve) <= 0.01 for e in document.part.entities)
    assert document.part.curve(1) == before[1]


def test_only_what_is_named_or_can_be_reached_is_mended() -> None:
    document = drawn("line 0,0 10,0", "line 0,0 10,0", "layer b", "line 0,5 9,5", "line 0,5 9,5", "lock b")
    assert kinds(document) == [(DefectKind.DUPLICATE, (1, 2))]
    assert document.run("heal 0.01 3 4") == "Nothing to mend."
    document.run("heal 0.01")
    assert [e.id for e in document.part.entities] == [1, 3, 4]


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("heal 0", "greater than 0"),
        ("heal 11", "at most 10"),
        ("heal 0.1 99", "no entity 99"),
        ("heal", "too early"),
    ],
)
def test_what_cannot_be_is_told(line: str, says: str) -> None:
    with pytest.raises(InputError, match=says):
        drawn("line 0,0 1,1").run(line)


def test_many_ends_at_one_place_and_many_copies_are_no_trap() -> None:
    document = drawn("line 0,0 50,0", "array polar 0,0 3000 1", "circle 200,0 5", "array 40 40 @0,0 3001")
    assert len([1 for kind, _ in kinds(document, 0.001) if kind is DefectKind.DUPLICATE]) == 1599
    document.run("heal 0.001")
    assert len(document.part.entities) == 3001


@settings(max_examples=examples(30), deadline=None)
@given(st.integers(0, 10**6))
def test_a_mended_drawing_has_no_faults_and_nothing_moved_far(seed: int) -> None:
    chance = random.Random(seed)
    document = Document()
    for _ in range(12):
        x, y = (
            chance.randint(0, 4) * 10 + chance.uniform(-0.004, 0.004),
            chance.randint(0, 4) * 10 + chance.uniform(-0.004, 0.004),
        )
        turn = chance.choice((0, 90, 180, 270))
        line = f"line {x},{y} {x + 10 * math.cos(math.radians(turn))},{y + 10 * math.sin(math.radians(turn))}"
        document.run(line if chance.random() < 0.8 else f"arc {x},{y} {x + 10},{y} radius {chance.choice((5, 10, 20))}")
    before = {e.id: e.curve for e in document.part.entities}
    document.run("heal 0.02")
    for entity in document.part.entities:
        if isinstance(entity.curve, Line):
            for point in (entity.curve.start, entity.curve.end):
                assert min(_from_line(was, point) for was in before.values() if isinstance(was, Line)) <= 0.02 + 1e-9
    again = document.part
    assert (
        document.run("heal 0.02") == "Nothing to mend."
        or document.part == again
        or len(document.part.entities) <= len(again.entities)
    )


def _from_line(line: Line, point: tuple[float, float]) -> float:
    (x, y), (ex, ey) = line.start, line.end
    share = ((point[0] - x) * (ex - x) + (point[1] - y) * (ey - y)) / math.dist(line.start, line.end) ** 2
    share = min(max(share, 0.0), 1.0)
    return math.dist(point, (x + share * (ex - x), y + share * (ey - y)))
