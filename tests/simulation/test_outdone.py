"""Motions that another one outdoes: which they are in closed form, and that heights without them are the same."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.model.motion import MotionKind, Motions
from app.simulation.sweeps.course import Course, Rapids, TrimOptions
from app.simulation.sweeps.sweeps import superseded
from app.simulation.sweeps.tile_kernels import ASKS, CUTS
from app.simulation.sweeps.trim import trim
from tests.examples import examples
from tests.simulation.courses import CUTTERS, arc, box_piece, joined, motions_of, polyline


def _outdone(motions: Motions, asks: tuple[int, ...] = (), tools: tuple[int, ...] = ()) -> list[int]:
    does = np.full(len(motions), CUTS, np.uint8)
    does[list(asks)] = ASKS
    cutter = np.array(tools, np.int32) if tools else np.zeros(len(motions), np.int32)
    return np.flatnonzero(superseded(motions, cutter, does)).tolist()


def _helix(turns: int, fall: float = 1.0) -> Motions:
    """Half turns down from Z 0."""
    ends = [((2.0, 0.0) if k % 2 == 0 else (-2.0, 0.0)) + (-fall * k / 2,) for k in range(2 * turns + 1)]
    return joined([arc(a, b, (0.0, 0.0, a[2])) for a, b in pairwise(ends)])


def test_of_a_helix_the_last_turn_stays() -> None:
    assert _outdone(_helix(5)) == list(range(8))


def test_of_passes_the_deepest_stays_whichever_way_and_whenever_it_goes() -> None:
    deep, middle, high = [((0.0, 0.0, z), (5.0, 3.0, z)) for z in (-3.0, -2.0, -1.0)]
    passes = motions_of([middle[0], deep[1], high[0]], [middle[1], deep[0], high[1]])
    assert _outdone(passes) == [0, 2]


def test_passes_that_cross_both_stay() -> None:
    falling, rising = ((0.0, 0.0, -1.0), (5.0, 0.0, -2.0)), ((0.0, 0.0, -2.0), (5.0, 0.0, -1.0))
    assert _outdone(motions_of([falling[0], rising[0]], [falling[1], rising[1]])) == []


def test_of_motions_that_are_alike_one_stays() -> None:
    assert len(_outdone(polyline([(0, 0, -1), (5, 0, -1), (0, 0, -1), (5, 0, -1)]))) == 2


def test_an_arc_and_its_way_back_are_one_and_the_rest_of_its_circle_another() -> None:
    out, back = arc((2, 0, -1), (-2, 0, -1), (0, 0, -1)), arc((-2, 0, -1), (2, 0, -1), (0, 0, -1), ccw=False)
    rest = arc((-2, 0, -1), (2, 0, -1), (0, 0, -1))
    assert len(_outdone(joined([out, back]))) == 1
    assert _outdone(joined([out, rest])) == []


def test_one_turn_more_is_another_way() -> None:
    once, twice = arc((2, 0, -1), (2, 0, -2), (0, 0, -1)), arc((2, 0, -1), (2, 0, -2), (0, 0, -1), turns=2)
    assert _outdone(joined([once, twice])) == []


def test_a_rapid_that_asks_between_them_sees_both() -> None:
    passes = polyline([(0, 0, -1), (5, 0, -1), (5, 0, 5), (0, 0, 5), (0, 0, -2), (5, 0, -2)])
    assert _outdone(passes) == [0, 2]
    assert _outdone(passes, asks=(2,)) == []


def test_another_tool_is_another_way() -> None:
    passes = motions_of([(0.0, 0.0, -1.0), (0.0, 0.0, -2.0)], [(5.0, 0.0, -1.0), (5.0, 0.0, -2.0)])
    assert _outdone(passes, tools=(0, 1)) == []


def test_nothing_of_nothing() -> None:
    assert _outdone(Motions.none()) == []


_PLACES = st.tuples(st.integers(-2, 2), st.integers(-2, 2), st.integers(-4, 1)).map(
    lambda at: (2.0 * at[0], 2.0 * at[1], 0.5 * at[2])
)


@pytest.mark.parametrize("kind", ["flat", "ball", "v"])
@given(places=st.lists(_PLACES, min_size=2, max_size=20), rapid=st.integers(0, 19))
@settings(max_examples=examples(60), deadline=None)
def test_heights_and_rapids_in_metal_are_the_same_without_them(
    kind: str, places: list[tuple[float, float, float]], rapid: int
) -> None:
    motions = polyline(places)
    kinds = motions.kind.copy()
    kinds[rapid % len(kinds)] = MotionKind.RAPID
    course = Course(motions_of(motions.start, motions.end), np.ones(len(kinds), np.int32))
    course = Course(Motions(**{**vars(course.motions), "kind": kinds}), course.tool)
    piece, cutters = box_piece(), {1: CUTTERS[kind]}
    for rapids in Rapids:
        every, fewer = (trim(piece, course, cutters, TrimOptions(rapids, trace=trace)) for trace in (True, False))
        assert np.allclose(every.heights, fewer.heights, atol=2e-5)
        assert [(hit.motion, hit.cells) for hit in every.rapids] == [(hit.motion, hit.cells) for hit in fewer.rapids]
