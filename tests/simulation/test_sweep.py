"""Heights against brute force, for every cutter along lines, plunges, arcs and helices.

And what order, splitting, direction and leaving out cells must not change.
"""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.ndimage import maximum_filter, minimum_filter

from app.model.motion import Floats, Motions, Plane
from app.model.motion_path import arc_paths
from app.simulation.cutter import Cutter
from app.simulation.field.workpiece import Heights, Workpiece
from app.simulation.sweeps.course import TrimOptions
from app.simulation.sweeps.pieces import helix_chord
from tests.examples import examples
from tests.simulation.courses import CUTTERS, arc, box_piece, cells_of, cut, cut_apart, joined, motions_of, polyline
from tests.simulation.reference import Path, field, line, slopes

TRACED = TrimOptions(trace=True)
WALL = 50.0
"""A cell where a micrometre to the side changes the height by more than this much of it lies on a wall."""


def excess(piece: Workpiece, motions: Motions, paths: Sequence[Path], cutter: Cutter, count: int = 60) -> Floats:
    """How far heights are from brute force, in units of what is allowed, at some cells that are not on a wall."""
    cells = cells_of(piece)
    got = cut(piece, motions, cutter).heights.ravel().astype(float)
    touched = np.flatnonzero(got < 0)
    chosen = np.random.default_rng(len(motions)).permutation(len(cells))[: count // 4]
    chosen = np.concatenate([chosen, touched[:: max(1, len(touched) // count)]])
    moves = [(cutter, path) for path in paths]
    want = field(moves, cells[chosen], 0.0, piece.floor)
    steep = slopes(moves, cells[chosen], want, 0.0, piece.floor)
    assert np.mean(steep > WALL) < 0.2
    return np.where(steep > WALL, 0.0, np.abs(got[chosen] - want) / (5e-6 * (1 + steep)))


def walk(seed: int, count: int, step: float, steep: float) -> Floats:
    rng = np.random.default_rng(seed)
    places = np.cumsum(rng.normal(size=(count, 3)) * [step, step, step * steep], axis=0)
    places[:, :2] = (places[:, :2] + 8) % 16 - 8
    places[:, 2] = -6 + 5 * np.sin(places[:, 2] / 5)
    return places


def lines(places: Floats) -> list[Path]:
    return [line(a, b) for a, b in pairwise(places)]


def arc_path(motions: Motions) -> Path:
    arcs = arc_paths(motions)
    return lambda t: arcs.points(np.ravel(t))[0].reshape(*np.shape(t), 3)


PLUNGES = np.array(
    [
        [-5, -5, 2],
        [-5, -5, -3],
        [5, -5, -3],
        [5, -5, -3],
        [5, 5, -3],
        [-5, 5, -6],
        [-5, 5, 3],
        [0, 0, 3],
        [0, 0, -9],
        [0.3, 0, -2],
    ]
)
WALKS = {
    "gentle walk": walk(1, 12, 2.0, 0.3),
    "steep walk": walk(2, 12, 2.0, 3.0),
    "short steps": walk(3, 24, 0.2, 0.5),
    "plunges": PLUNGES,
}


@pytest.mark.parametrize("cutter", CUTTERS)
@pytest.mark.parametrize("name", WALKS)
def test_lines_are_exact(cutter: str, name: str) -> None:
    assert excess(box_piece(cells=48), polyline(WALKS[name]), lines(WALKS[name]), CUTTERS[cutter]).max() <= 1


ARCS = {
    "level": arc((5, 0, -3), (-3, 4, -3), (0, 0, -3)),
    "full circle": arc((5, 0, -3), (5, 0, -3), (0, 0, -3), ccw=False),
    "radii that differ": arc((5, 0, -3), (-3.0003, 4.0001, -3), (0, 0, -3)),
    "smaller than the cutter": arc((1, 0, -3), (-0.6, 0.8, -3), (0, 0, -3)),
    "of a kilometre": arc((-8, -2, -3), (8, -2, -3), (0, -1e6, -3), ccw=False),
    "helix": arc((4, 0, 0), (4, 0, -6), (0, 0, 0), turns=2),
    "G18": arc((-5, 1, -6), (5, 2, -6), (0, 1, -6), Plane.ZX, ccw=False),
    "G19": arc((1, -5, -1), (2, 5, -1), (1, 0, -1), Plane.YZ),
}


@pytest.mark.parametrize("cutter", CUTTERS)
@pytest.mark.parametrize("name", ARCS)
def test_arcs_are_exact(cutter: str, name: str) -> None:
    piece = box_piece(cells=48)
    most = 1 + (helix_chord(piece.grid.pitch) / 5e-6 if name == "helix" else 0)
    assert excess(piece, ARCS[name], [arc_path(ARCS[name])], CUTTERS[cutter], 40).max() <= most


@pytest.mark.parametrize("cutter", ["v", "blunt v", "drill", "taper"])
def test_a_slope_like_the_flank_is_exact(cutter: str) -> None:
    places = np.array([[-4.0, 0, -1], [0, 0, -1 - 4 * CUTTERS[cutter].slope], [4, 1, -1 - 4 * CUTTERS[cutter].slope]])
    places[1:, 2] = np.maximum(places[1:, 2], -25)
    assert excess(box_piece(cells=48), polyline(places), lines(places), CUTTERS[cutter]).max() <= 1


place = st.tuples(st.floats(-8, 8), st.floats(-8, 8), st.floats(-9, 1))


@settings(max_examples=examples(25), deadline=None)
@given(st.lists(place, min_size=2, max_size=6), st.sampled_from(sorted(CUTTERS)))
def test_any_polyline_is_exact(places: list[tuple[float, float, float]], cutter: str) -> None:
    corners = np.array(places)
    assert excess(box_piece(cells=32), polyline(corners), lines(corners), CUTTERS[cutter], 24).max() <= 1


def differ(first: Heights, second: Heights) -> int:
    """Count cells that differ, but for those within a cell of a wall, where rounding decides; of these only few may."""
    one, two = first.astype(float), second.astype(float)
    steps = maximum_filter(one, 3) - minimum_filter(one, 3)
    apart = np.abs(one - two) > 1e-5 * (1 + steps / 0.1)
    assert np.mean(np.abs(one - two) > 1e-3) < 1e-3
    return int(np.count_nonzero(apart & (maximum_filter(steps, 3) < 1.0)))


def raster(degrees: float) -> Floats:
    """A zigzag over hills, its lines turned."""
    rng = np.linspace(-9, 9, 60)
    places = np.array([(x if k % 2 == 0 else -x, y) for k, y in enumerate(np.arange(-8, 8, 0.7)) for x in rng])
    places += [0.0317, 0.0173]  # no cell lies on the rim of a line
    turn = np.radians(degrees)
    turned = places @ np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
    return np.column_stack([turned, -4 + 1.5 * np.sin(turned[:, 0] / 2) * np.cos(turned[:, 1] / 3)])


SHARP = (
    np.random.default_rng(8)
    .uniform((-9, -9, -9), (9, 9, 0), (60, 3))
    .round(1)[np.random.default_rng(9).integers(0, 60, 300)]
)
REDUCED = {
    "rough walk": walk(5, 400, 0.8, 1.0),
    "smooth walk": np.repeat(walk(6, 200, 0.3, 0.2), 2, axis=0)[1:],
    "sharp": SHARP,
    "valley": np.array([[k * 0.05 - 5.0117, 0.2 * k % 0.3 + 0.0071, -5 + abs(k - 100) * 0.03] for k in range(200)]),
    **{f"raster {a}": raster(a) for a in (0.0, 30.0, 45.0, 90.0)},
}


@pytest.mark.parametrize("cutter", CUTTERS)
@pytest.mark.parametrize("name", REDUCED)
def test_what_is_not_evaluated_is_not_missed(cutter: str, name: str) -> None:
    piece, motions = box_piece(cells=290), polyline(REDUCED[name])
    whole = cut_apart(piece, motions, CUTTERS[cutter], TRACED)
    assert differ(whole.heights, cut(piece, motions, CUTTERS[cutter]).heights) == 0
    traced = cut(piece, motions, CUTTERS[cutter], TRACED)
    assert differ(whole.heights, traced.heights) == 0
    assert traced.volume == pytest.approx(whole.volume, abs=2e-3)
    assert np.abs(traced.engaged - whole.engaged).max() <= 4 + 0.01 * whole.engaged.max()


@pytest.mark.parametrize("cutter", CUTTERS)
def test_order_changes_no_bit_and_direction_next_to_nothing(cutter: str) -> None:
    places = walk(7, 60, 1.5, 0.6)
    start, end = places[:-1], places[1:]
    piece, shuffle = box_piece(cells=300), np.random.default_rng(0).permutation(len(start))
    cutter_ = CUTTERS[cutter]
    inorder = cut_apart(piece, motions_of(start, end), cutter_, TRACED)
    shuffled = cut_apart(piece, motions_of(start[shuffle], end[shuffle]), cutter_)
    back = cut(piece, motions_of(end[::-1], start[::-1]), cutter_)
    assert np.array_equal(inorder.heights, shuffled.heights)
    assert differ(inorder.heights, back.heights) == 0


def test_shuffled_chains_keep_every_bit() -> None:
    chains = [polyline(walk(seed, 30, 0.5, 0.5)) for seed in range(8)]
    piece = box_piece(cells=300)
    for cutter in ("ball", "bull"):
        first = cut(piece, joined(chains), CUTTERS[cutter]).heights
        assert np.array_equal(first, cut(piece, joined(chains[::-1]), CUTTERS[cutter]).heights)


@pytest.mark.parametrize("cutter", CUTTERS)
def test_splitting_changes_nothing(cutter: str) -> None:
    places = walk(11, 20, 3.0, 0.5)
    fractions = np.sort(np.random.default_rng(1).uniform(0, 1, 6))
    halves = [places[:1]] + [np.vstack([a + (b - a) * f for f in (*fractions, 1.0)]) for a, b in pairwise(places)]
    piece = box_piece(cells=300)
    whole, split = (cut(piece, polyline(p), CUTTERS[cutter]).heights for p in (places, np.vstack(halves)))
    assert differ(whole, split) == 0
