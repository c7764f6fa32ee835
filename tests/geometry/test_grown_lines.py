"""What lies within a distance of lines: closed forms of single ones, and random ones against polygons."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
import shapely

from app.geometry.even_odd import even_odd
from app.geometry.offset.offset import grown_lines
from app.geometry.primitives import contour_rows, sample
from app.model.curves import Arc, Circle, Line
from app.model.part import Contour
from tests.examples import examples


def way(*points: tuple[float, float]) -> Contour:
    ends = [(float(x), float(y)) for x, y in points]
    return Contour(tuple(Line(a, b) for a, b in pairwise(ends)), ends[0] == ends[-1])


HALF = 1.5
ARC = Contour((Arc((10.0, 0.0), (0.0, 10.0), (0.0, 0.0), True),), False)
FORMS = {
    "line": ([way((0, 0), (10, 0))], 10 * 2 * HALF + math.pi * HALF**2),
    "slanted": ([way((3, 1), (7.2, -4.6))], 7 * 2 * HALF + math.pi * HALF**2),
    "arc": ([ARC], math.pi / 2 * 10 * 2 * HALF + math.pi * HALF**2),
    "ring": ([Contour((Circle((4.0, 4.0), 10.0),))], math.pi * ((10 + HALF) ** 2 - (10 - HALF) ** 2)),
    "disc": ([Contour((Circle((4.0, 4.0), 1.0),))], math.pi * (1 + HALF) ** 2),
    "square": ([way((0, 0), (10, 0), (10, 10), (0, 10), (0, 0))], 40 * 2 * HALF + math.pi * HALF**2 - 4 * HALF**2),
    "cross": ([way((0, 0), (10, 0)), way((5, -5), (5, 5))], 2 * (30 + math.pi * HALF**2) - 4 * HALF**2),
    "tee": ([way((0, 0), (10, 0)), way((5, 0), (5, 9))], 30 + math.pi * HALF**2 + 7.5 * 3 + math.pi * HALF**2 / 2),
    "twice": ([way((0, 0), (10, 0)), way((10, 0), (0, 0))], 30 + math.pi * HALF**2),
}


@pytest.mark.parametrize("name", FORMS)
def test_areas_are_those_of_closed_forms(name: str) -> None:
    lines, area = FORMS[name]
    assert even_odd(grown_lines(lines, HALF)).area == pytest.approx(area, rel=1e-9)


def test_lines_that_lie_upon_one_another_for_a_part_have_fine_chords() -> None:
    grown = grown_lines([way((0, 0), (10, 0)), way((5, 0), (15, 0))], HALF)
    assert even_odd(grown).area == pytest.approx(45 + math.pi * HALF**2, rel=1e-4)


def assert_grown(lines: list[Contour], distance: float) -> None:
    made = shapely.Polygon()
    for contour in grown_lines(lines, distance):
        made = made.symmetric_difference(shapely.Polygon(sample(contour_rows(contour), 1e-6)))
    drawn = [np.vstack([sample(rows, 1e-6), rows[-1:, 2:4]]) for rows in map(contour_rows, lines)]
    around = shapely.union_all([shapely.LineString(each).buffer(distance, quad_segs=400) for each in drawn])
    off = made.symmetric_difference(around)
    assert off.area < 3e-6 * distance * around.length + 1e-6
    assert off.buffer(-1e-4).is_empty


@pytest.mark.parametrize("seed", range(examples(60)))
def test_random_lines_and_arcs_are_grown_as_polygons_are(seed: int) -> None:
    rng = np.random.default_rng(seed)
    lines = [way(*rng.uniform(0, 30, (int(rng.integers(2, 7)), 2)).tolist()) for _ in range(int(rng.integers(1, 4)))]
    for _ in range(int(rng.integers(0, 3))):
        x, y, r, a, b = (*rng.uniform(5, 25, 2), rng.uniform(2, 12), *rng.uniform(0, math.tau, 2))
        ends = [(x + r * math.cos(t), y + r * math.sin(t)) for t in (a, b)]
        lines.append(Contour((Arc(*ends, (x, y), bool(rng.integers(2))),), False))
    if rng.integers(2):
        lines.append(Contour((Circle((float(rng.uniform(5, 25)), 15.0), float(rng.uniform(1, 9))),)))
    assert_grown(lines, float(rng.uniform(0.2, 4.0)))
