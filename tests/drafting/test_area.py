"""What closed contours enclose."""

import math

import pytest

from app.drafting.curves.area import enclosed_area
from app.drafting.document import Document


def curves(*lines: str) -> list:
    document = Document()
    for line in lines:
        document.run(line)
    return [e.curve for e in document.part.entities]


@pytest.mark.parametrize(
    ("lines", "area"),
    [
        (["circle 100,50 3"], 9 * math.pi),
        (["circle 100,50 3 cw"], 9 * math.pi),
        (["rect 500,500 560,540"], 2400),
        (["rect 0,0 60,40 round 10"], 2400 - 100 * (4 - math.pi)),
        (["slot 0,0 20,0 6"], 120 + 9 * math.pi),
        (["ellipse 7,8 17,8 4"], 40 * math.pi),
        (["ellipse 7,8 17,8 4 from 0 to 180", "line 17,8 -3,8"], 20 * math.pi),
        (["arc 10,0 -10,0 centre 0,0 cw", "line 10,0 -10,0"], 50 * math.pi),
        (["spline degree 1 0,0 10,0 10,5 0,5 0,0"], 50),
        (["spline degree 2 0,0 5,10 10,0", "line 0,0 10,0"], 100 / 3),
        (["line 0,0 10,0", "line 0,0 0,10", "line 10,0 0,10"], 50),
    ],
)
def test_area_is_exact_in_whatever_order_and_direction(lines: list[str], area: float) -> None:
    assert enclosed_area(curves(*lines)) == pytest.approx(area, rel=1e-12)
    document = Document()
    for line in lines:
        document.run(line)
    document.run("reverse 1")
    assert enclosed_area([e.curve for e in document.part.entities][::-1]) == pytest.approx(area, rel=1e-12)


def test_a_smooth_closed_spline_is_what_many_chords_enclose() -> None:
    from app.geometry.sample import spline_points

    (curve,) = curves("spline 0,0 10,2 12,9 3,11 close")
    import numpy as np

    points = spline_points(curve, np.linspace(curve.knots[0], curve.knots[-1], 200_001))
    x, y = points.T
    chords = abs(np.sum(x[:-1] * y[1:] - x[1:] * y[:-1])) / 2
    assert enclosed_area([curve]) == pytest.approx(chords, rel=1e-8)


@pytest.mark.parametrize(
    "lines",
    [
        [],
        ["line 0,0 10,0"],
        ["line 0,0 10,0", "line 10,0 0,10"],
        ["circle 0,0 1", "circle 9,9 1"],
        ["rect 0,0 1,1", "rect 5,5 6,6"],
        ["rect 0,0 10,10", "line 0,0 10,10"],
        ["spline degree 1 0,0 10,0 10,5 0,0 weights 1 2 1 1"],
    ],
)
def test_what_is_not_one_contour_has_none(lines: list[str]) -> None:
    assert enclosed_area(curves(*lines)) is None
