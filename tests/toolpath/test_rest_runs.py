"""Which pieces of rings clear what is left: found exactly, all of it, and no more than needed."""

from __future__ import annotations

import numpy as np
import pytest

from app.core.progress import NO_PROGRESS
from app.geometry.distance import DistanceField
from app.geometry.offset.offset import offset_levels
from app.geometry.outlines import nest
from app.geometry.primitives import lengths, pack
from app.toolpath.linking.rest_runs import RestCells, RingChunks, runs
from app.toolpath.machining_areas import MachiningArea
from app.toolpath.rest_material import LEAST, CentreReach, CutGround, core_cells, suspects
from tests.part_shapes import circle, square


def line(x0: float, y0: float, x1: float, y1: float) -> np.ndarray:
    return np.array([[x0, y0, x1, y1, 0.0, 0.0, 0.0, 0.0]])


def sheet_of(size: float) -> MachiningArea:
    regions = nest([square(size)])
    primitives = pack(regions)
    return MachiningArea(
        regions, primitives, DistanceField.of(primitives.rows), np.zeros(len(primitives.rows), np.bool_)
    )


def test_depth_in_what_is_left_is_the_least_of_all_cutters() -> None:
    ground = CutGround.of([(line(0, 0, 10, 0), 2.0), (line(0, 5, 10, 5), 0.5)])
    points = np.array([[5.0, 1.0], [5.0, 3.0], [5.0, 5.0], [-6.0, 0.0], [5.0, 50.0]])
    assert ground.depth(points, 9.0) == pytest.approx([-1.0, 1.0, -0.5, 4.0, 9.0])


def test_a_disc_is_held_by_what_one_path_has_cut_and_by_no_two_together() -> None:
    ground = CutGround.of([(line(0, 0, 10, 0), 2.0), (line(0, 5, 10, 5), 0.5), (line(0, 1, 10, 1), 2.0)])
    points = np.array([[5.0, 1.5], [5.0, 1.4], [5.0, 5.375], [5.0, -1.625], [5.0, 2.6]])
    assert ground.holds(points, 0.5).tolist() == [True, True, False, False, False]
    assert ground.holds(points, 0.1).tolist() == [True, True, True, True, True]
    assert ground.holds(points, 3.0).tolist() == [False] * 5


def test_without_paths_all_is_left() -> None:
    ground = CutGround.of([])
    assert ground.depth(np.zeros((2, 2)), 3.0) == pytest.approx([3.0, 3.0])
    assert not ground.in_air(line(0, 0, 1, 0), 1.0).any()


def test_a_cutter_within_a_wider_path_cuts_air() -> None:
    ground = CutGround.of([(line(0, 0, 10, 0), 2.0)])
    rows = np.concatenate([line(2, 1, 3, 1), line(2, 1.001, 3, 1.001), line(9.5, 0, 11.2, 0), line(2, 0.9, 3, 1.1)])
    assert ground.in_air(rows, 1.0).tolist() == [True, False, False, False]


@pytest.mark.parametrize(
    ("width", "seen"), [(0.0, False), (LEAST, False), (3 * LEAST, True), (0.05, True), (2.0, True)]
)
def test_a_strip_is_found_when_a_disc_fits_in_it(width: float, seen: bool) -> None:
    """Two paths side by side leave a strip of so many mm between them."""
    ground = CutGround.of([(line(-5, 5, 25, 5), 5.0), (line(-5, 15 + width, 25, 15 + width), 5.0)])
    reach = CentreReach(sheet_of(20), 1.0, 1.0, 1 / 16)
    found = suspects(ground, reach, np.zeros((0, 8)), NO_PROGRESS)
    assert bool(len(core_cells(ground, reach, found))) is seen


def test_all_cells_are_near_a_run_and_runs_are_short() -> None:
    radius = 1.0
    primitives = pack(nest([square(30), circle(5, 15, 15)]))
    chunks = RingChunks.of(offset_levels(primitives, [radius + k * radius / 4 for k in range(12)]), radius / 4)
    x, y = np.meshgrid(np.arange(2.0, 28.0, 0.125), np.arange(2.0, 3.3, 0.125))
    cells = RestCells.of(np.stack([x.ravel(), y.ravel()], 1), chunks.rows, 0.9)
    found = runs(chunks, np.ones(len(chunks.rows), np.bool_), cells, CentreReach(sheet_of(30), radius, radius, 1 / 16))
    path = np.concatenate([chunks.path(run.chunk, run.count) for run in found])
    assert np.all(DistanceField.of(path).nearest(cells.centres)[0] <= cells.need)
    assert lengths(path).sum() < 1.2 * 26  # one run along a strip that is less than a cutter wide


def test_pieces_of_one_row_come_back_as_that_row() -> None:
    chunks = RingChunks.of(offset_levels(pack(nest([circle(10)])), [1.0]), 0.5)
    whole = chunks.path(0, len(chunks.rows))
    assert lengths(whole).sum() == pytest.approx(2 * np.pi * 9) and len(whole) <= 4
    seam = chunks.path(len(chunks.rows) - 2, 4)
    assert np.array_equal(seam[1:, :2], seam[:-1, 2:4]) and chunks.after(len(chunks.rows) - 2, 4) == 2
    assert np.array_equal(chunks.path(3, 4, backwards=True)[0, :2], chunks.path(3, 4)[-1, 2:4])
