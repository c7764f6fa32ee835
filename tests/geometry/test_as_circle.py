"""What counts as a circle: drawn as one, by arcs, or by many short chords; and what does not."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest

from app.geometry.as_circle import as_circle
from app.geometry.outlines import polygon_contour, reversed_contour
from app.model.part import Contour
from tests.part_shapes import bulged, circle

CENTRE, RADIUS = (17.3, -4.1), 3.0


def on_circle(angles: np.ndarray, radius: float = RADIUS, decimals: int = 9) -> list[tuple[float, float]]:
    return [
        (round(CENTRE[0] + radius * math.cos(a), decimals), round(CENTRE[1] + radius * math.sin(a), decimals))
        for a in angles
    ]


def regular(count: int, turn: float = 0.3) -> np.ndarray:
    return turn + np.arange(count) * math.tau / count


def by_bulges(count: int, decimals: int) -> Contour:
    bulge = round(math.tan(math.tau / count / 4), 6)
    return bulged([(x, y, bulge) for x, y in on_circle(regular(count), decimals=decimals)])


def of_beziers(each: int) -> Contour:
    """Four cubics, as drawing programs write circles, each in chords of equal parameter: 0.03 % off at most."""
    k, t = 4 / 3 * math.tan(math.pi / 8), np.linspace(0, 1, each, endpoint=False)[:, None]
    corners = [(math.cos(a), math.sin(a)) for a in np.arange(5) * math.pi / 2]
    parts = [
        (1 - t) ** 3 * np.array([[ax, ay]])
        + 3 * t * (1 - t) ** 2 * np.array([[ax - k * ay, ay + k * ax]])
        + 3 * t * t * (1 - t) * np.array([[bx + k * by, by - k * bx]])
        + t**3 * np.array([[bx, by]])
        for (ax, ay), (bx, by) in pairwise(corners)
    ]
    return polygon_contour(
        [(CENTRE[0] + RADIUS * x, CENTRE[1] + RADIUS * y) for x, y in np.concatenate(parts).tolist()]
    )


CIRCLES = {
    "a circle": circle(RADIUS, *CENTRE),
    "two bulges": by_bulges(2, 4),
    "four bulges": by_bulges(4, 3),
    "many bulges": by_bulges(36, 3),
    **{
        f"{count} chords, {decimals} decimals": polygon_contour(on_circle(regular(count), decimals=decimals))
        for count in (12, 16, 64, 500)
        for decimals in (2, 3, 9)
    },
    "a shorter chord at the end": polygon_contour(on_circle(np.arange(0, math.tau, 0.1))),
    "Bezier curves in chords": of_beziers(12),
}
OTHERS = {
    **{f"{count} corners": polygon_contour(on_circle(regular(count))) for count in (3, 4, 6, 8, 10, 11)},
    "a flat on a shaft": polygon_contour(on_circle(np.linspace(0.2, math.tau - 0.2, 60))),
    "a flat across arcs": bulged(
        [(*on_circle(np.array([0.2]))[0], math.tan((math.tau - 0.4) / 4)), (*on_circle(np.array([-0.2]))[0], 0)]
    ),
    "an ellipse": polygon_contour([(10 * math.cos(a), 9.9 * math.sin(a)) for a in regular(64)]),
    "a star": polygon_contour([on_circle(np.array([a]), RADIUS - 0.1 * (k % 2))[0] for k, a in enumerate(regular(40))]),
    "a square in short lines": polygon_contour(
        [
            *((k, 0) for k in range(10)),
            *((10, k) for k in range(10)),
            *((10 - k, 10) for k in range(10)),
            *((0, 10 - k) for k in range(10)),
        ]
    ),
    "twice round": polygon_contour(on_circle(np.linspace(0, 2 * math.tau, 80, endpoint=False))),
    "forth and back": polygon_contour(on_circle(np.concatenate([np.linspace(0, 5, 50), np.linspace(4.9, 0.1, 49)]))),
    "a lens": bulged([(0, 0, 0.4), (10, 0, 0.4)]),
    "very small and coarse": polygon_contour(
        [(round(0.3 * math.cos(a), 1), round(0.3 * math.sin(a), 1)) for a in regular(12)]
    ),
}


@pytest.mark.parametrize("back", [False, True], ids=["ccw", "cw"])
@pytest.mark.parametrize("name", CIRCLES)
def test_circles(name: str, back: bool) -> None:
    found = as_circle(reversed_contour(CIRCLES[name]) if back else CIRCLES[name])
    assert found is not None
    assert math.dist(found.centre, CENTRE) < 0.005
    assert found.radius == pytest.approx(RADIUS, abs=0.005)


@pytest.mark.parametrize("name", OTHERS)
def test_what_is_no_circle(name: str) -> None:
    assert as_circle(OTHERS[name]) is None


def test_an_open_line_is_none() -> None:
    assert as_circle(Contour(polygon_contour(on_circle(regular(64))).primitives[:-1], closed=False)) is None
