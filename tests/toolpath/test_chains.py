"""Chains: every run once, whole, along ways that keep off the walls, and few of them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.core import tolerances
from app.geometry.distance import DistanceField
from app.geometry.offset.offset import offset_levels
from app.geometry.outlines import nest, polygon_contour
from app.geometry.primitives import lengths, pack, points_at
from app.model.moves import Purpose
from app.model.part import Contour
from app.toolpath.build import Stroke
from app.toolpath.linking.chains import Corridor, chains
from app.toolpath.linking.rest_runs import RingChunks, RingRun
from app.toolpath.rest_material import CutGround
from tests import plain_distance
from tests.examples import examples
from tests.part_shapes import circle, random_part, square


def prepared(
    contours: list[Contour], radius: float, cut: list[tuple[np.ndarray, float]]
) -> tuple[RingChunks, Corridor]:
    primitives = pack(nest(contours))
    levels = offset_levels(primitives, [radius + k * radius / 4 for k in range(9)], frame=True)
    return RingChunks.of(levels, radius / 4), Corridor(
        DistanceField.of(primitives.rows), radius, CutGround.of(cut), radius
    )


def scattered(chunks: RingChunks, count: int, seed: int) -> list[RingRun]:
    """Some runs, none of which share a row."""
    rng = np.random.default_rng(seed)
    found = []
    for start in np.unique(rng.integers(0, max(1, len(chunks.rows) // 12), count)) * 12:
        ring = int(chunks.ring[start])
        found.append(RingRun(int(start), int(min(rng.integers(1, 12), chunks.first[ring + 1] - start))))
    return found


def check(
    strokes: tuple[Stroke, ...], chunks: RingChunks, runs: list[RingRun], contours: list[Contour], radius: float
) -> None:
    asked = sum(float(chunks.size[run.chunk : run.chunk + run.count].sum()) for run in runs)
    cut = sum(float(lengths(stroke.rows)[stroke.purpose == Purpose.POCKET].sum()) for stroke in strokes)
    assert cut == pytest.approx(asked, rel=1e-9)
    for stroke in strokes:
        assert np.array_equal(stroke.rows[1:, :2], stroke.rows[:-1, 2:4])
        for part in np.linspace(0, 1, 21):
            points = points_at(stroke.rows, np.full(len(stroke.rows), part))
            assert plain_distance.distance(points, contours).min() >= radius - tolerances.LEVEL
    middles = np.concatenate([points_at(stroke.rows, np.full(len(stroke.rows), 0.5)) for stroke in strokes])
    assert plain_distance.inside(middles, contours).all()


def test_runs_in_one_room_are_one_chain() -> None:
    contours = [square(40), circle(4, 12, 12), circle(4, 28, 28)]
    chunks, corridor = prepared(contours, 1.5, [])
    found = scattered(chunks, 25, 1)
    strokes = chains(chunks, found, corridor, 200.0)
    check(strokes, chunks, found, contours, 1.5)
    assert len(strokes) == 1


def test_runs_of_rooms_apart_are_not_joined() -> None:
    contours = [square(20), square(20, 22)]
    chunks, corridor = prepared(contours, 1.5, [])
    found = scattered(chunks, 25, 2)
    strokes = chains(chunks, found, corridor, 200.0)
    check(strokes, chunks, found, contours, 1.5)
    assert len(strokes) == 2


def test_the_tool_lifts_where_the_way_is_too_long() -> None:
    corridor_part = [polygon_contour([(0, 0), (200, 0), (200, 5), (0, 5)])]
    chunks, corridor = prepared(corridor_part, 1.5, [])
    first = [k for k in range(len(chunks.rows)) if chunks.level[chunks.ring[k]] == 0]
    ends = [min(first, key=lambda k: chunks.rows[k, 0]), max(first, key=lambda k: chunks.rows[k, 0])]
    found = [RingRun(k, 2) for k in ends]
    assert len(chains(chunks, found, corridor, 50.0)) == 2
    assert len(chains(chunks, found, corridor, 500.0)) == 1


def test_a_chain_begins_on_ground_that_is_cut() -> None:
    contours = [square(30)]
    middle = np.array([[10.0, 15.0, 20.0, 15.0, 0.0, 0.0, 0.0, 0.0]])
    chunks, corridor = prepared(contours, 1.0, [(middle, 12.5)])
    corner = int(np.argmin(np.hypot(*chunks.rows[:, :2].T)))
    (stroke,) = chains(chunks, [RingRun(corner, 3)], corridor, 200.0)
    assert DistanceField.of(middle).nearest(np.array([stroke.start]))[0][0] <= 11.5
    assert stroke.purpose[0] == Purpose.LINK


def test_a_whole_ring_is_a_run() -> None:
    chunks, corridor = prepared([square(20)], 1.5, [])
    count = int(chunks.first[1])
    (stroke,) = chains(chunks, [RingRun(0, count)], corridor, 100.0)
    assert stroke.closed and lengths(stroke.rows).sum() == pytest.approx(4 * 17)


@settings(max_examples=examples(8), deadline=None)
@given(st.integers(0, 10**6))
def test_random_parts(seed: int) -> None:
    contours, _ = random_part(seed - seed % 5 + seed % 3)
    radius = float(np.random.default_rng(seed).uniform(0.4, 1.5))
    chunks, corridor = prepared(contours, radius, [])
    if not len(chunks.rows):
        return
    found = scattered(chunks, 15, seed)
    check(chains(chunks, found, corridor, 300.0), chunks, found, contours, radius)


@settings(max_examples=examples(8), deadline=None)
@given(st.integers(0, 10**6), st.floats(5.0, 300.0))
def test_runs_keep_their_sense_and_the_tool_lifts_no_more_often_for_it(seed: int, longest: float) -> None:
    contours = [square(40), circle(4, 12, 12), circle(4, 28, 28)]
    chunks, corridor = prepared(contours, 1.5, [])
    found = scattered(chunks, 25, seed)
    senses = np.random.default_rng(seed).integers(-1, 2, len(found))
    sensed = [replace(run, sense=int(sense)) for run, sense in zip(found, senses, strict=True)]
    strokes = chains(chunks, sensed, corridor, longest)
    check(strokes, chunks, found, contours, 1.5)
    assert len(strokes) <= len(chains(chunks, found, corridor, longest))
    rows = np.concatenate([stroke.rows[stroke.purpose == Purpose.POCKET] for stroke in strokes])
    for run in sensed:
        first = chunks.path(run.chunk, run.count, backwards=run.sense < 0)[0]
        there = (np.abs(rows[:, :4] - first[:4]) < 1e-9).all(axis=1).any()
        assert there or run.sense == 0


def test_a_chain_begins_on_cut_ground_even_against_its_sense() -> None:
    """A dead end: only its mouth is near what is cut."""
    slot = [polygon_contour([(0, 0), (60, 0), (60, 3.2), (0, 3.2)])]
    mouth = np.array([[1.6, 1.6, 5.0, 1.6, 0.0, 0.0, 0.0, 0.0]])
    chunks, corridor = prepared(slot, 1.5, [(mouth, 3.0)])
    side = [k for k in range(len(chunks.rows)) if abs(chunks.rows[k, 1] - 1.5) < 1e-9 and 10 < chunks.rows[k, 0] < 55]
    for sense in (1, -1):
        (stroke,) = chains(chunks, [RingRun(side[0], len(side), sense)], corridor, 20.0)
        assert stroke.start[0] < 7


def test_a_straight_way_is_clear_only_beyond_the_radius_of_every_wall() -> None:
    _, corridor = prepared([square(40), circle(4, 20, 20)], 1.5, [])
    off = np.array([5.6, 5.5, 5.4, 1.0])  # from the circle's centre; 5.5 is just clear
    ways = np.stack([np.full(4, 3.0), 20 - off, np.full(4, 37.0), 20 - off], 1)
    assert corridor.clear(ways).tolist() == [True, True, False, False]
    rows = np.hstack([ways, np.zeros((4, 4))])
    assert corridor.clear_rows(rows).tolist() == [True, True, False, False]
    arcs = np.array([[20 + r, 20, 20 - r, 20 + 1e-9, 20, 20, r, 1.0] for r in (5.6, 5.5, 5.4)])
    assert corridor.clear_rows(arcs).tolist() == [True, True, False]
