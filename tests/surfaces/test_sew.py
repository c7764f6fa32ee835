"""Surfaces that rounding has torn: the same volume comes out; what is really open stays so."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from app.surfaces.meshes.orientation import orient_outwards
from app.surfaces.meshes.sew import sew_mesh
from tests.examples import examples
from tests.surfaces.solids import BLOCK_MM3, pocketed_block
from tests.surfaces.test_winding import volume

BLOCK = pocketed_block()


def parted(triangle: int, side: int, shares: list[float]) -> np.ndarray:
    """The block with corners on one side of one triangle, which its neighbour there does not have."""
    a, b, c = np.roll(BLOCK[triangle], -side, axis=0)
    line = [a, *(a + (b - a) * share for share in sorted(shares)), b]
    return np.concatenate([np.delete(BLOCK, triangle, axis=0), [[p, q, c] for p, q in pairwise(line)]])


def single(triangles: np.ndarray) -> np.ndarray:
    """Triangles as a file has them."""
    return np.asarray(triangles.astype(np.float32).astype(np.float64))


@given(
    st.integers(0, 27),
    st.integers(0, 2),
    st.lists(st.floats(0.05, 0.95), min_size=1, max_size=4, unique=True),
    st.floats(-200, 200),
    st.booleans(),
)
@example(0, 0, [0.05, 0.05000000000000001], 0.0, True)
@settings(max_examples=examples(60), deadline=None)
def test_a_corner_on_an_edge_opens_nothing(
    triangle: int, side: int, shares: list[float], away: float, reverse: bool
) -> None:
    torn = single(parted(triangle, side, shares) * 0.7 + away)
    wound = orient_outwards(torn[:, ::-1] if reverse else torn)
    assert wound.fault == ""
    assert volume(wound.triangles) == pytest.approx(BLOCK_MM3 * 0.7**3, abs=1e-6 * 28 * 21 * max(abs(away), 40))
    some = sum(len(np.unique(each, axis=0)) == 3 for each in torn)  # two corners may be one in the file
    assert int(wound.turned.sum()) == (some if reverse else 0)


@given(st.integers(0, 10_000))
@settings(max_examples=examples(30), deadline=None)
def test_corners_that_differ_in_the_last_digit_are_one(seed: int) -> None:
    rng = np.random.default_rng(seed)
    torn = single((BLOCK * 0.37 + [10.1, 7.7, 3.3]) * (1 + rng.uniform(-1, 1, BLOCK.shape) * 2**-24))
    wound = orient_outwards(torn)
    assert wound.fault == "" and len(wound.triangles) == 28
    assert volume(wound.triangles) == pytest.approx(BLOCK_MM3 * 0.37**3, rel=1e-5)


def test_what_is_closed_stays_as_it_is_to_the_bit() -> None:
    found = sew_mesh(BLOCK)
    assert found is not None and np.array_equal(found.triangles, BLOCK)


def test_gaps_that_are_wider_than_rounding_stay_open() -> None:
    gap = BLOCK.copy()
    gap[3, 0, 2] += 1e-4
    for torn in (gap, BLOCK[1:], np.concatenate([parted(5, 0, [0.5])[:-1], BLOCK[:0]])):
        assert sew_mesh(torn) is None
        assert "belong to one triangle only" in orient_outwards(torn).fault


@pytest.mark.parametrize("spread", [1.0, 1e-9])
def test_triangles_without_order_are_refused_soon(spread: float) -> None:
    """Nearly all places within reach of one another, in a soup or in a heap: what damage makes of a file."""
    import time

    rng = np.random.default_rng(2)
    soup = spread * rng.random((3300, 3, 3))
    soup[0] = [[0, 0, 0], [1, 0, 0], [0, 1, 1]]
    begin = time.process_time()
    assert "belong to one triangle only" in orient_outwards(soup).fault
    assert time.process_time() - begin < 5.0
