"""What is measured: against numbers known in closed form, and the drawing stays as it is."""

import math

import pytest

from app.core.errors import InputError
from app.drafting.commands.measure import Measurements, measures
from app.drafting.document import Document


def measured(*lines: str) -> Measurements:
    document = Document()
    for line in lines:
        document.run(line)
    return measures({e.id: e.curve for e in document.part.entities})


@pytest.mark.parametrize(
    ("lines", "length", "area", "centroid"),
    [
        (["rect 10,20 70,60"], 200, 2400, (40, 40)),
        (["line 0,0 30,0 0,30 close"], 60 + 30 * math.sqrt(2), 450, (10, 10)),
        (["circle 5,7 10"], 20 * math.pi, 100 * math.pi, (5, 7)),
        (["line -10,0 10,0", "arc 10,0 -10,0 centre 0,0"], 20 + 10 * math.pi, 50 * math.pi, (0, 40 / (3 * math.pi))),
        (["line -10,0 10,0", "arc -10,0 10,0 centre 0,0 cw"], 20 + 10 * math.pi, 50 * math.pi, (0, 40 / (3 * math.pi))),
        (
            ["rect 0,0 60,40", "circle 10,10 5"],
            200 + 10 * math.pi,
            2400 - 25 * math.pi,
            ((2400 * 30 - 250 * math.pi) / (2400 - 25 * math.pi), (2400 * 20 - 250 * math.pi) / (2400 - 25 * math.pi)),
        ),
        (["rect 0,0 10,10", "rect 20,0 30,10"], 80, 200, (15, 5)),
        (["rect 0,0 30,30", "rect 5,5 25,25", "rect 10,10 20,20"], 240, 900 - 400 + 100, (15, 15)),
        (["ellipse 0,0 50,0 30 cw"], 255.2699886340, 1500 * math.pi, (0, 0)),
        (["line 0,0 30,40"], 50, 0, None),
    ],
)
def test_lengths_areas_and_centroids(
    lines: list[str], length: float, area: float, centroid: tuple[float, float] | None
) -> None:
    found = measured(*lines)
    assert found.length == pytest.approx(length, abs=1e-6)
    assert found.area == pytest.approx(area, abs=1e-9)
    assert found.centroid is None if centroid is None else found.centroid == pytest.approx(centroid, abs=1e-4)


def test_the_replies() -> None:
    document = Document()
    document.run_script("rect 10,20 70,60\ncircle 0,0 5\n")
    before, names = document.part, document.history_names
    assert document.run("measure 0,0 3,4") == "Distance 5.000 mm, across 3.000, up 4.000, angle 53.130°."
    assert document.run("measure 5") == (
        "1 curve: length 31.416 mm, radius 5.000, area 78.540 mm², centroid 0.000,0.000, "
        "extent 10.000 by 10.000 mm from -5.000,-5.000 to 5.000,5.000."
    )
    document.run("select 1-2")
    assert (
        document.run("measure")
        == "2 curves: length 100.000 mm, extent 60.000 by 40.000 mm from 10.000,20.000 to 70.000,60.000."
    )
    assert document.part is before and document.history_names == names and document.last_point == (0, 0)


def test_two_points_may_be_relative_and_named() -> None:
    document = Document()
    document.run_script("let p = 10,10\nline 0,0 9,0 as edge\n")
    assert document.run("measure p @3,4").startswith("Distance 5.000")
    assert document.run("measure finish(edge) p").startswith("Distance 10.050")


def test_nothing_to_measure_is_told() -> None:
    with pytest.raises(InputError, match="select what to measure"):
        Document().run("measure")
    with pytest.raises(InputError, match="no entity 7"):
        Document().run("measure 7")
