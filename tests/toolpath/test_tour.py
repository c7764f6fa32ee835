"""The tour between strokes: every stroke once, never longer than greedy, the shortest of all for a few, rules kept."""

from __future__ import annotations

import itertools
import math
import threading
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.core.errors import Cancelled, ParameterError
from app.core.progress import NO_PROGRESS, Progress
from app.formats.readers import read_drawing
from app.geometry.distance import DistanceField
from app.geometry.offset.offset import offset_levels
from app.geometry.primitives import lengths, pack
from app.model.job import Job
from app.model.moves import Purpose
from app.model.operation import Direction
from app.operations.compute import regions_of
from app.operations.contour.paths import contour_strokes
from app.operations.pocket.paths import pocket_distances, without_empty
from app.toolpath.build import Stroke
from app.toolpath.linking.link import LinkOptions, link
from app.toolpath.ordering.tour import _Tour, in_short_order
from tests.examples import examples

Before = list[tuple[int, int]]


def line(x0: float, y0: float, x1: float, y1: float, region: int = 0) -> Stroke:
    return Stroke(np.array([[x0, y0, x1, y1, 0.0, 0.0, 0.0, 0.0]]), np.array([Purpose.POCKET], np.uint8), region)


def random_strokes(seed: int, count: int, closed: bool) -> list[Stroke]:
    rng = np.random.default_rng(seed)
    begins = rng.integers(0, 100, (count, 2)).astype(float)  # whole numbers: ties and equal places too
    ends = begins if closed else rng.integers(0, 100, (count, 2)).astype(float)
    return [line(*a, *b, region=k) for k, (a, b) in enumerate(zip(begins, ends, strict=True))]


def travel_mm(strokes: Sequence[Stroke], start: tuple[float, float] = (0.0, 0.0)) -> float:
    """How far the tool travels from `start` through all strokes as they are, the way back not counted."""
    begins = np.array([stroke.rows[0, :2] for stroke in strokes]).reshape(-1, 2)
    ends = np.array([np.array(start), *(stroke.rows[-1, 2:4] for stroke in strokes)]).reshape(-1, 2)
    return float(np.hypot(*(begins - ends[:-1]).T).sum())


def greedy(strokes: list[Stroke], start: tuple[float, float], before: Before) -> float:
    """Travel of the greedy order, written down plainly."""
    left, at, total = set(range(len(strokes))), start, 0.0
    while left:
        free = [k for k in left if not any(b == k and a in left for a, b in before)]
        k = min(free, key=lambda k: (math.dist(at, strokes[k].start), k))
        total += math.dist(at, strokes[k].start)
        at = (strokes[k].rows[-1, 2], strokes[k].rows[-1, 3])
        left.remove(k)
    return total


@pytest.mark.parametrize("seed", range(6))
def test_the_greedy_order_goes_to_the_nearest_of_all_and_of_several_to_the_first(seed: int) -> None:
    """Looked for in buckets, against all places asked one by one."""
    rng = np.random.default_rng(seed)
    strokes = [
        *random_strokes(seed, 600, bool(seed % 2)),
        *[line(3, 3, 3, 3)] * 20,
        *[line(k, 500, k, 500) for k in range(9)],
    ]
    before = random_rules(seed, len(strokes), 40 * seed)
    tour = _Tour(strokes, tuple(rng.uniform(-300, 300, 2).tolist()), before, False)
    tour.begin_greedily(NO_PROGRESS)
    waits = np.bincount(np.array([b for _, b in set(before)], np.int64), minlength=len(strokes))
    ends, order = tour._ends, [0]
    while len(order) <= len(strokes):
        away = np.sqrt(((ends[1:, :2] - ends[order[-1], 2:]) ** 2).sum(axis=1))
        chosen = int(np.argmin(np.where(waits == 0, away, np.inf)))
        order.append(chosen + 1)
        waits[chosen] = -1
        for a, b in set(before):
            waits[b] -= a == chosen
    assert tour.order.tolist() == order


def shortest(strokes: list[Stroke], start: tuple[float, float], before: Before, reversible: bool) -> float:
    """Travel of the shortest order, by trying all."""
    best = math.inf
    for order in itertools.permutations(range(len(strokes))):
        if any(order.index(a) > order.index(b) for a, b in before):
            continue
        for ways in itertools.product((False, True) if reversible else (False,), repeat=len(strokes)):
            at, total = np.array(start), 0.0
            for k, way in zip(order, ways, strict=True):
                a, b = strokes[k].rows[0, :2], strokes[k].rows[-1, 2:4]
                total += float(np.hypot(*((b if way else a) - at)))
                at = a if way else b
            best = min(best, total)
    return best


def random_rules(seed: int, count: int, how_many: int) -> Before:
    """Pairs that some order keeps."""
    rng = np.random.default_rng(seed)
    order = rng.permutation(count)
    pairs = np.sort(rng.integers(0, count, (how_many, 2)), axis=1)
    return [(int(order[a]), int(order[b])) for a, b in pairs if a != b]


def check(strokes: list[Stroke], start: tuple[float, float], before: Before, reversible: bool) -> float:
    """Every stroke once, rules kept, not longer than greedy; returns the travel."""
    found = in_short_order(strokes, start, before=before, reversible=reversible)
    place = {stroke.region: k for k, stroke in enumerate(found)}
    assert sorted(place) == list(range(len(strokes)))
    assert all(place[a] < place[b] for a, b in before)
    for stroke in found:
        own = strokes[stroke.region]
        if reversible and not np.array_equal(stroke.rows, own.rows):
            assert not own.closed
            assert np.array_equal(stroke.rows[0, :4], own.rows[0, [2, 3, 0, 1]])
        else:
            assert stroke is own
    travel = travel_mm(found, start)
    assert travel <= greedy(strokes, start, before) + 1e-9
    return travel


def test_nothing_is_no_tour_and_one_stroke_is_itself() -> None:
    assert in_short_order([]) == ()
    stroke = line(1, 2, 3, 4)
    assert in_short_order([stroke]) == (stroke,)


def test_greedy_walks_into_the_trap_and_the_tour_does_not() -> None:
    strokes = [line(x, 0, x, 0, region=k) for k, x in enumerate((1.0, -1.1, 3.0, -8.0))]  # 1, -1.1, 3, -8 is 18.2 mm
    assert check(strokes, (0, 0), [], False) == pytest.approx(3 + 11)


@settings(max_examples=examples(40), deadline=None)
@given(st.integers(0, 10**6), st.integers(1, 6), st.booleans(), st.integers(0, 4))
def test_a_few_strokes_are_in_the_shortest_order(seed: int, count: int, closed: bool, how_many: int) -> None:
    strokes, before = random_strokes(seed, count, closed), random_rules(seed, count, how_many)
    assert check(strokes, (5, 5), before, False) == pytest.approx(shortest(strokes, (5, 5), before, False))


@settings(max_examples=examples(15), deadline=None)
@given(st.integers(0, 10**6), st.integers(1, 5), st.integers(0, 2))
def test_a_few_strokes_that_may_be_turned_are_in_the_shortest_order(seed: int, count: int, how_many: int) -> None:
    strokes, before = random_strokes(seed, count, False), random_rules(seed, count, how_many)
    assert check(strokes, (5, 5), before, True) == pytest.approx(shortest(strokes, (5, 5), before, True))


def test_eight_strokes_are_in_the_shortest_order() -> None:
    strokes = random_strokes(8, 8, False)
    assert check(strokes, (0, 0), [], False) == pytest.approx(shortest(strokes, (0, 0), [], False))


@settings(max_examples=examples(20), deadline=None)
@given(st.integers(0, 10**6), st.integers(10, 120), st.booleans(), st.booleans(), st.integers(0, 60))
def test_many_strokes(seed: int, count: int, closed: bool, reversible: bool, how_many: int) -> None:
    strokes = random_strokes(seed, count, closed)
    check(strokes, (50, 50), random_rules(seed, count, how_many), reversible)


@pytest.mark.exhaustive
def test_the_search_alone_finds_the_shortest_order_of_a_few(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("app.toolpath.ordering.tour._FEW", 0)
    monkeypatch.setattr("app.toolpath.ordering.tour._BASE", 100_000)
    for seed in range(12):
        strokes, before = random_strokes(seed, 6, seed % 2 == 0), random_rules(seed, 6, seed % 4)
        assert check(strokes, (5, 5), before, False) == pytest.approx(shortest(strokes, (5, 5), before, False))
        if seed < 3:
            assert check(strokes, (5, 5), before, True) == pytest.approx(shortest(strokes, (5, 5), before, True))


def test_places_on_a_grid_are_nearly_as_short_as_can_be() -> None:
    strokes = [line(x, y, x, y, region=20 * x + y) for x in range(20) for y in range(20)]
    assert check(strokes, (0, 0), [], False) <= 1.02 * 399


def test_what_frees_the_part_is_cut_last() -> None:
    strokes = [*random_strokes(3, 60, True), line(50, 50, 50, 50, region=60)]
    found = in_short_order(strokes, before=[(k, 60) for k in range(60)])
    assert found[-1].region == 60


def test_the_same_strokes_give_the_same_order() -> None:
    strokes = random_strokes(4, 300, False)
    assert [s.region for s in in_short_order(strokes)] == [s.region for s in in_short_order(strokes)]


def test_a_stroke_that_is_turned_is_the_same_path() -> None:
    arc = Stroke(
        np.array([[0.0, 0, 5, 0, 0, 0, 0, 0], [5, 0, 5, 2, 5, 1, 1, 1]]),
        np.array([Purpose.POCKET, Purpose.LINK], np.uint8),
        0,
        np.array([-1.0, -2.0]),
    )
    (found,) = in_short_order([arc], (5.0, 2.0), reversible=True)
    assert found.start == (5.0, 2.0) and tuple(found.rows[-1, 2:4]) == (0.0, 0.0)
    assert found.purpose.tolist() == [Purpose.LINK, Purpose.POCKET]
    assert found.least_z is not None and found.least_z.tolist() == [-2.0, -1.0]
    assert lengths(found.rows).sum() == pytest.approx(lengths(arc.rows).sum())


@pytest.mark.parametrize("before", [[(0, 1), (1, 0)], [(1, 1)], [(0, 3)], [(-1, 0)]])
def test_rules_that_nothing_keeps_are_refused(before: Before) -> None:
    with pytest.raises(ParameterError):
        in_short_order(random_strokes(1, 3, True), before=before)


@pytest.mark.parametrize("count", [3, 50, 2000])
def test_it_stops_when_asked(count: int) -> None:
    stop = threading.Event()
    stop.set()
    with pytest.raises(Cancelled):
        in_short_order(random_strokes(1, count, True), progress=Progress(cancelled=stop))


def test_it_stops_in_the_middle() -> None:
    stop = threading.Event()
    progress = Progress(lambda fraction, _: stop.set() if fraction > 0.5 else None, stop)
    with pytest.raises(Cancelled):
        in_short_order(random_strokes(1, 200, False), progress=progress)


def drawn_strokes(path: Path, radius: float) -> tuple[tuple[Stroke, ...], tuple[Stroke, ...]]:
    """Contour strokes of a tool, and pocket strokes of one three times as large behind it."""
    drawing = read_drawing(path.name, path.read_bytes(), None, ())
    regions, _ = regions_of(Job(drawing.part))
    primitives = pack(regions)
    field = DistanceField.of(primitives.rows)
    rings = offset_levels(primitives, [radius], frame=True)[0].rings
    levels = without_empty(offset_levels(primitives, pocket_distances(4 * radius, 3 * radius, field), frame=True))
    return contour_strokes(rings, Direction.CLIMB), link(levels, field, LinkOptions(Direction.CLIMB))


@pytest.mark.parametrize(
    ("name", "radius", "share"),
    [
        pytest.param("complex.dxf", 0.5, 0.9, marks=pytest.mark.exhaustive),
        ("gear.dxf", 0.5, 1.0),
        ("apu-mount.dxf", 1.5, 0.98),
    ],
)
def test_real_drawings_take_less_travel(data: Path, name: str, radius: float, share: float) -> None:
    for strokes in drawn_strokes(data / "dxf" / name, radius):
        plain, ours = greedy(list(strokes), (0.0, 0.0), []), travel_mm(in_short_order(strokes))
        print(
            f"{name}: {len(strokes)} strokes, greedy {plain:.1f} mm, tour {ours:.1f} mm, {ours / max(plain, 1e-9):.3f}"
        )
        assert ours <= plain + 1e-9
        assert len(strokes) < 10 or ours <= share * plain
