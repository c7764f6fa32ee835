"""Which side of a surface is out, on solids whose volumes are known."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.surfaces.meshes.orientation import orient_outwards, winding_number
from tests.examples import examples
from tests.simulation.test_target import box
from tests.surfaces.solids import BLOCK_MM3, pocketed_block

Floats = np.ndarray


def volume(triangles: Floats) -> float:
    return float(np.einsum("ij,ij->", triangles[:, 0], np.cross(triangles[:, 1], triangles[:, 2]))) / 6


@given(st.integers(0, 10_000))
@settings(max_examples=examples(40), deadline=None)
def test_whichever_triangles_are_reversed_the_same_solid_comes_out(seed: int) -> None:
    rng, block = np.random.default_rng(seed), pocketed_block()
    reversed_ = rng.random(len(block)) < rng.random()
    wound = orient_outwards(np.where(reversed_[:, None, None], block[:, ::-1], block))
    assert wound.fault == "" and wound.shells == 1
    assert np.array_equal(wound.turned, reversed_)
    assert volume(wound.triangles) == pytest.approx(BLOCK_MM3)


def test_a_hollow_keeps_its_turn_to_what_it_is_in() -> None:
    hollow = np.concatenate([box((0, 0, 0), (10, 10, 10)), box((2, 2, 2), (5, 5, 5))[:, ::-1]])
    for given_, turned in ((hollow, 0), (hollow[:, ::-1], 24)):
        wound = orient_outwards(given_)
        assert (int(wound.turned.sum()), wound.shells) == (turned, 2)
        assert volume(wound.triangles) == pytest.approx(1000 - 27)


@pytest.mark.parametrize("wound_as", [(1, 1, 1), (1, -1, 1), (-1, -1, -1), (1, 1, -1), (-1, 1, -1)], ids=str)
def test_what_is_wholly_in_a_shell_is_a_hollow_and_what_is_in_that_is_metal(wound_as: tuple[int, int, int]) -> None:
    """Boxes of 10, 6 and 2 within one another, wound any way: 1000 - 216 + 8 mm3 of metal."""
    shells = (box((0, 0, 0), (10, 10, 10)), box((2, 2, 2), (8, 8, 8)), box((4, 4, 4), (6, 6, 6)))
    given_ = np.concatenate(
        [shell if sign > 0 else shell[:, ::-1] for shell, sign in zip(shells, wound_as, strict=True)]
    )
    wound = orient_outwards(given_)
    assert wound.fault == "" and volume(wound.triangles) == pytest.approx(1000 - 216 + 8)
    assert int(wound.turned.sum()) == 12 * sum(sign != right for sign, right in zip(wound_as, (1, -1, 1), strict=True))
    for place, turns in (((1, 1, 1), 1), ((3, 3, 3), 0), ((5, 5, 5), 1)):
        assert winding_number(wound.triangles, np.array(place, float)) == pytest.approx(turns, abs=1e-9)


def test_bodies_that_go_through_one_another_are_each_metal() -> None:
    """A boss that begins within an L and ends beside it: its corners are not all in it."""
    plate, wall, boss = box((0, 0, 0), (30, 20, 10)), box((0, 0, 2), (5, 20, 30)), box((12, 5, 4), (20, 15, 16))
    given_ = np.concatenate([plate, wall, boss])
    wound = orient_outwards(given_)
    assert wound.fault == "" and not wound.turned.any() and wound.shells == 3
    around = box((0, 0, 0), (30, 20, 30))  # holds all of it
    assert orient_outwards(np.concatenate([around, boss])).turned.sum() == 12


@pytest.mark.parametrize(
    "second", [((10, 10, 0), (20, 20, 10)), ((30, 0, 0), (40, 10, 10))], ids=["touch in an edge", "apart"]
)
def test_bodies_that_touch_or_not_are_each_turned_alone(
    second: tuple[tuple[float, float, float], tuple[float, float, float]],
) -> None:
    one, other = box((0, 0, 0), (10, 10, 10)), box(*second)
    wound = orient_outwards(np.concatenate([one, other[:, ::-1]]))
    assert wound.fault == "" and int(wound.turned.sum()) == 12
    assert volume(wound.triangles) == pytest.approx(2000)


def other_diagonal(triangles: Floats, x: float) -> Floats:
    """A box whose side at X is in the other two triangles."""
    side = np.all(triangles[..., 0] == x, axis=1)
    (a, b, c), other = triangles[side][0], triangles[side][1]
    lone = next(place for place in other if not any(np.array_equal(place, own) for own in (a, b, c)))
    shared = [any(np.array_equal(place, own) for own in other) for place in (a, b, c)]
    a, b, c = np.roll([a, b, c], -shared.index(False), axis=0)  # b and c are on the diagonal
    return np.concatenate([triangles[~side], [[a, b, lone], [a, lone, c]]])


LEFT, RIGHT = box((0, 0, 0), (10, 10, 10)), box((10, 0, 0), (20, 10, 10))
LIKE_LEFT = other_diagonal(LEFT, 10.0)


@given(st.sampled_from([LEFT, LIKE_LEFT]), st.integers(0, 10_000), st.sampled_from([1.0, 1 / 3, 25.4]))
@settings(max_examples=examples(40), deadline=None)
def test_bodies_that_share_a_side_are_one_whatever_its_diagonals_and_turns(
    left: Floats, seed: int, scale: float
) -> None:
    rng = np.random.default_rng(seed)
    given_ = np.concatenate([left, RIGHT]) * scale + scale / 7
    reversed_ = rng.random(len(given_)) < rng.random()
    wound = orient_outwards(np.where(reversed_[:, None, None], given_[:, ::-1], given_))
    assert wound.fault == "" and (wound.shells, len(wound.triangles)) == (1, 20)
    assert volume(wound.triangles) == pytest.approx(2000 * scale**3)
    assert not np.any(wound.turned & ~reversed_) and int(wound.turned.sum()) >= int(reversed_.sum()) - 4


def test_sides_that_only_nearly_touch_are_kept() -> None:
    """The left body's side has a dent of 0.1 mm where the right one's is flat: that is a hollow between them."""
    tip, ring = np.array([9.9, 5, 5]), [(10, 0, 0), (10, 10, 0), (10, 10, 10), (10, 0, 10)]
    dent = np.array([[ring[k], ring[(k + 1) % 4], tip] for k in range(4)], float)
    left = np.concatenate([LEFT[~np.all(LEFT[..., 0] == 10, axis=1)], dent])
    wound = orient_outwards(np.concatenate([left, RIGHT]))
    assert wound.fault == "" and volume(wound.triangles) == pytest.approx(2000 - 100 * 0.1 / 3)
    assert orient_outwards(np.concatenate([left, RIGHT[:, ::-1]])).fault == "its triangles do not agree on an inside"


def test_bodies_side_by_side_are_each_whole_where_their_sides_differ() -> None:
    for second in (box((10, 2, 2), (20, 8, 8)), box((10, 0, 0), (20, 10, 5)), box((2, 2, 10), (8, 8, 14))):
        wound = orient_outwards(np.concatenate([LEFT, second[:, ::-1]]))
        assert wound.fault == "" and wound.shells == 2 and int(wound.turned.sum()) == 12
        assert volume(wound.triangles) == pytest.approx(1000 + volume(second))


def test_a_missing_triangle_is_told_with_its_place() -> None:
    wound = orient_outwards(pocketed_block()[1:])
    assert wound.fault == "3 of its edges belong to one triangle only"
    assert wound.place is not None and wound.place[2] == -10.0


def test_a_strip_with_one_side_only_has_no_inside() -> None:
    """A torus whose tube is turned half a turn the wrong way: a Klein bottle, closed, with one side."""
    n, m = 12, 8

    def place(i: int, j: int) -> tuple[float, float, float]:
        # the last ring meets the first one mirrored
        a, b = (
            2 * math.pi * i / n,
            2 * math.pi * ((m - j if i >= n else j) % m) / m,
        )
        a = 0.0 if i >= n else a
        return ((3 + math.cos(b)) * math.cos(a), (3 + math.cos(b)) * math.sin(a), math.sin(b))

    quads = [(place(i, j), place(i + 1, j), place(i + 1, j + 1), place(i, j + 1)) for i in range(n) for j in range(m)]
    wound = orient_outwards(np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]))
    assert wound.fault == "it has one side only, like a twisted strip"


def test_a_surface_that_encloses_nothing_is_none() -> None:
    flat = np.array([[[0, 0, 0], [1, 0, 0], [0, 1, 0]]], float)
    assert orient_outwards(np.concatenate([flat, flat[:, ::-1]])).fault == "its triangles enclose nothing"
    assert orient_outwards(np.zeros((2, 3, 3))).fault == "its triangles enclose nothing"


def test_the_winding_number_is_one_in_metal_and_nothing_beside_it() -> None:
    block = pocketed_block()
    for place, expected in (((5, 5, -5), 1), ((20, 15, -5), 1), ((20, 15, -2), 0), ((50, 15, -5), 0)):
        assert winding_number(block, np.array(place, float)) == pytest.approx(expected, abs=1e-9)
        assert winding_number(block[:, ::-1], np.array(place, float)) == pytest.approx(-expected, abs=1e-9)
