"""Bodies that touch in part of a side or go through one another: what bounds their metal together, and how deep a cut
lies in it, in closed form.
"""

import json
import math
import threading
from pathlib import Path

import numpy as np
import pytest

from app.cli.main import main
from app.core.errors import Cancelled
from app.core.progress import Progress
from app.simulation.field.solid import SolidStock, read_solid
from app.simulation.field.triangle_tree import TriangleTree
from app.surfaces.meshes.orientation import winding_number
from app.verify.solid_depth import CutColumns, DepthInSolid, outer_faces
from tests.simulation.test_target import box
from tests.surfaces.solids import bossed_block, stl

BASE = ((0.0, 0.0, -20.0), (40.0, 30.0, -10.0))
OTHERS = {
    "on it": (((10, 8, -10), (30, 22, 0)), 4480),
    "flush in a corner": (((0, 0, -10), (20, 14, 0)), 4480),
    "flush in two": (((0, 0, -10), (20, 30, 0)), 4800),
    "half beside it": (((30, 10, -10), (50, 20, 0)), 4600),
    "at its side": (((40, 10, -18), (60, 40, -12)), 5360),
    "through it": (((30, 10, -15), (50, 20, 0)), 4700),
    "below it": (((5, 5, -30), (35, 25, -20)), 3800 + 2 * 50 * 10),
    "in a corner only": (((40, 30, -10), (60, 40, 0)), 3800 + 1000),
    "apart": (((50, 0, -20), (60, 10, -10)), 3800 + 600),
}


def area(triangles: np.ndarray) -> float:
    return float(np.linalg.norm(np.cross(*(triangles[:, k] - triangles[:, 0] for k in (1, 2))), axis=1).sum() / 2)


def turned(triangles: np.ndarray, radians: float) -> np.ndarray:
    """About Z and X, and rounded as an STL file rounds."""
    c, s = math.cos(radians), math.sin(radians)
    return triangles @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]]) @ np.array([[1, 0, 0], [0, c, s], [0, -s, c]])


@pytest.mark.parametrize("radians", [0.0, 0.3, 1.1])
@pytest.mark.parametrize("where", OTHERS)
def test_the_area_that_bounds_two_boxes_together(where: str, radians: float) -> None:
    other, expected = OTHERS[where]
    both = turned(np.concatenate([box(*BASE), box(*other)]).astype(float), radians)
    found = outer_faces(read_solid("a.stl", stl(both)))
    assert area(found) == pytest.approx(expected, abs=2e-3)


Corners = tuple[tuple[int, int, int], tuple[int, int, int]]
SIDE = 8
"""Of the cube that boxes of whole millimetres lie in."""


def random_boxes(seed: int) -> list[Corners]:
    """Two to five, none of them within another: that would be a hollow."""
    rng = np.random.default_rng(seed)
    found: list[Corners] = []
    while len(found) < 2 + seed % 4:
        low = rng.integers(0, SIDE - 1, 3)
        high = rng.integers(low + 1, SIDE + 1)
        new = (tuple(low.tolist()), tuple(high.tolist()))
        if not any(_within(new, old) or _within(old, new) for old in found):
            found.append(new)
    return found


def _within(one: Corners, other: Corners) -> bool:
    return all(other[0][k] <= one[0][k] and one[1][k] <= other[1][k] for k in range(3))


def depths_disagree(boxes: list[Corners], radians: float, seed: int) -> float:
    """By how much the distance to the faces is not that to the nearest empty millimetre, at places in metal."""
    cells = np.zeros((SIDE + 2,) * 3, bool)
    for low, high in boxes:
        cells[tuple(slice(a + 1, b + 1) for a, b in zip(low, high, strict=True))] = True
    rng, full, empty = np.random.default_rng(seed), np.argwhere(cells) - 1, np.argwhere(~cells) - 1.0
    places = full[rng.integers(len(full), size=50)] + rng.random((50, 3))
    off = np.maximum(np.maximum(empty - places[:, None], places[:, None] - empty - 1), 0)
    solid = read_solid("a.stl", stl(turned(np.concatenate([box(*each) for each in boxes]).astype(float), radians)))
    faces = outer_faces(solid) if solid.shells > 1 else solid.triangles
    found = TriangleTree.of(faces).distances(turned(places, radians))
    return float(np.abs(found - np.linalg.norm(off, axis=2).min(axis=1)).max())


SLIVERS = [
    [((2, 3, 0), (4, 5, 7)), ((2, 5, 1), (3, 7, 7)), ((3, 2, 3), (4, 6, 8))],
    [((3, 1, 1), (6, 8, 5)), ((6, 5, 2), (8, 7, 8)), ((6, 3, 0), (7, 5, 8)), ((2, 1, 0), (3, 2, 3))],
    [((3, 6, 4), (6, 7, 7)), ((2, 5, 6), (6, 8, 7)), ((1, 4, 1), (7, 6, 6))],
]
"""Where faces of others come through a hair beside an edge: strips as wide as files round were taken for free ones."""


@pytest.mark.parametrize("boxes", SLIVERS)
def test_strips_as_wide_as_files_round_are_no_faces(boxes: list[Corners]) -> None:
    assert depths_disagree(boxes, 1.1, 0) < 1e-4


@pytest.mark.parametrize("seeds", [range(12), pytest.param(range(12, 400), marks=pytest.mark.exhaustive)])
def test_depths_in_boxes_that_touch_and_overlap_in_every_way(seeds: range) -> None:
    angles = (0.0, 0.3, 1.1)
    wrong = {seed: depths_disagree(random_boxes(seed), angles[seed % 3], seed) for seed in seeds}
    assert {seed: off for seed, off in wrong.items() if off > 1e-4} == {}


def test_a_hollow_keeps_its_faces() -> None:
    hollow = box((5, 5, -18), (10, 10, -12)).astype(float)
    both = np.concatenate([box(*BASE).astype(float), hollow[:, ::-1]])
    assert area(outer_faces(read_solid("a.stl", stl(both)))) == pytest.approx(3800 + 2 * (25 + 30 + 30), abs=1e-6)


def test_balls_that_go_through_one_another() -> None:
    """Against the solid angles in which each sees places all over the other."""
    from trimesh.creation import icosphere

    balls = [np.array(icosphere(subdivisions=2, radius=8.0).triangles) + [x, 0.3 * x, 0.1] for x in (0.0, 9.0)]
    found = outer_faces(SolidStock(np.concatenate(balls), shells=2))
    rng, expected, error = np.random.default_rng(0), 0.0, 0.0
    for mine, its in (balls, balls[::-1]):
        size = np.linalg.norm(np.cross(*(mine[:, k] - mine[:, 0] for k in (1, 2))), axis=1) / 2
        pick = rng.choice(len(mine), 1500, p=size / size.sum())
        places = np.einsum("nk,nkj->nj", rng.dirichlet([1, 1, 1], 1500), mine[pick])
        free = np.array([abs(winding_number(its, place)) < 0.5 for place in places])
        expected += float(size.sum() * free.mean())
        error += float(size.sum() * math.sqrt(free.mean() * (1 - free.mean()) / 1500))
    assert area(found) == pytest.approx(expected, abs=4 * error)
    assert area(found) < sum(map(area, balls)) - 100


def test_a_cut_through_the_side_in_which_bodies_touch_is_as_deep_as_in_one_body() -> None:
    """Down the middle of the upper one into the lower: deepest where the lower one's underside and the rim of the side
    in which they touch are as far, (z + 20)^2 = 7^2 + (z + 10)^2.
    """
    both = read_solid("a.stl", stl(np.concatenate([box(*BASE), box((10, 8, -10), (30, 22, 0))]).astype(float)))
    column = CutColumns(np.array([[20.0, 15.0]]), np.array([-13.0]), np.array([0.0]))
    assert DepthInSolid(both).of(column)[0] == pytest.approx(20 - 12.55, abs=2e-5)


DEEP = "G21 G90 G94 G17\nT1 M6\nS1000 M3\nG0 Z5\nX0 Y0\nG1 Z-13 F300\nG0 Z5\nM2\n"


@pytest.mark.exhaustive
def test_cut_says_the_same_of_two_bodies_that_touch_and_of_one(tmp_path: Path) -> None:
    (tmp_path / "one.stl").write_bytes(stl(bossed_block()))
    two = np.concatenate([box((-20, -15, -20), (20, 15, -10)), box((-10, -7, -10), (10, 7, 0))]).astype(float)
    (tmp_path / "two.stl").write_bytes(stl(two))
    (tmp_path / "a.ngc").write_text(DEEP)
    told = []
    for name in ("one", "two"):
        setup = ["--tool=1=flat:6", "--stock=-20,-15,-20,20,15,0", "--grid=48", "--quiet"]
        against = ["--against", str(tmp_path / f"{name}.stl"), "--report", str(tmp_path / "r.json")]
        assert main(["cut", str(tmp_path / "a.ngc"), *setup, *against]) == 1
        told.append(json.loads((tmp_path / "r.json").read_text()))
    one, two_bodies = told
    assert one["gouge"]["max_mm"] == pytest.approx(7.45, abs=1e-3)
    for key in ("gouge", "left", "certificate"):
        assert _numbers(two_bodies[key]) == pytest.approx(_numbers(one[key]), abs=1e-3)


def _numbers(of: object) -> list[float]:
    if isinstance(of, dict):
        return [number for each in of.values() for number in _numbers(each)]
    if isinstance(of, list):
        return [number for each in of for number in _numbers(each)]
    return [float(of)] if isinstance(of, int | float) else []


def many_balls(side: int) -> SolidStock:
    """Balls on a grid, each through its neighbours."""
    from trimesh.creation import icosphere

    ball = np.array(icosphere(subdivisions=2, radius=5.0).triangles)
    places = np.random.default_rng(1).uniform(-0.3, 0.3, (side * side, 3))
    places[:, 0] += np.repeat(np.arange(side), side) * 8.0
    places[:, 1] += np.tile(np.arange(side), side) * 8.0
    return SolidStock(np.concatenate([ball + place for place in places]), shells=side * side)


def test_it_tells_how_far_it_is_and_can_be_stopped() -> None:
    told: list[float] = []
    outer_faces(many_balls(4), Progress(lambda fraction, text: told.append(fraction)))
    assert told == sorted(told)
    assert len({round(each, 1) for each in told}) >= 3
    stop = threading.Event()

    def after_a_while(fraction: float, text: str) -> None:
        if fraction > 0.2:
            stop.set()

    with pytest.raises(Cancelled):
        outer_faces(many_balls(4), Progress(after_a_while, stop))
