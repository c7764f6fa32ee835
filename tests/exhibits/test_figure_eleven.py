"""The published comparison as a table: what is in it, that it computes what it says, and how it stops."""

import threading

import moderngl
import numpy as np
import pytest

from app.core.errors import Cancelled, HitofudeError
from app.core.progress import Progress
from app.exhibits.die_programs import PROGRAMS, block, die, finishing
from app.exhibits.figure_eleven import FigureOptions, HeightMethod, figure_eleven
from app.simulation.engines import Graphics
from app.simulation.sweeps.trim import trim
from tests.exhibits.plain import plain_heights

SMALL = FigureOptions(("A",), 64, 1)


@pytest.mark.parametrize("name", PROGRAMS)
def test_the_programs_are_what_they_are_called(name: str) -> None:
    program = PROGRAMS[name]
    places = finishing(program)
    assert len(places) == program.moves + 1
    assert len(np.unique(places[:, 1])) == program.lines
    left = trim(block(128), program.course(), program.cutters).heights
    cells = (np.arange(128) + 0.5) * 100 / 128
    over = left - die(*np.meshgrid(cells, cells))
    assert over.min() > -0.05 and np.median(over) < 0.05


def test_the_plain_way_leaves_what_the_engine_of_record_leaves() -> None:
    program = PROGRAMS["A"]
    assert np.abs(plain_heights(program, 96) - trim(block(96), program.course(), program.cutters).heights).max() < 1e-5


def test_the_table_has_every_way_and_says_who_draws() -> None:
    figure = figure_eleven(SMALL)
    (row,) = figure.rows
    assert set(row.seconds) == set(HeightMethod) and min(row.seconds.values()) > 0
    assert row.apart[HeightMethod.QUADS].largest < 1e-4 and row.apart[HeightMethod.PLAIN].largest < 1e-4
    assert 1e-4 < row.apart[HeightMethod.PUBLISHED].largest < 5 * row.error
    assert row.polygons.spheres > row.polygons.wedges > row.polygons.drawn
    ratio = row.ratio(HeightMethod.PUBLISHED, HeightMethod.QUADS)
    assert ratio == row.seconds[HeightMethod.PUBLISHED] / row.seconds[HeightMethod.QUADS]
    text, data = figure.text(), figure.report()
    assert figure.renderer in text and f"{data['threads']} threads" in text
    assert ("(software)" in text) is data["software"]
    for word in (
        "9,542",
        "5 mm",
        "64 x 64 cells",
        "16.83 s",
        "195 MHz",
        f"{row.polygons.drawn:,}",
        f"{row.seconds[HeightMethod.RECORD]:.3f} s",
    ):
        assert word in text
    assert data["programs"][0]["moves"] == 9542 and data["programs"][0]["ratios"]["published_by_quads"] == ratio


def test_without_opengl_its_columns_are_empty() -> None:
    def none() -> moderngl.Context:
        raise HitofudeError("There is no OpenGL 3.3 here.")

    figure = figure_eleven(SMALL, graphics=Graphics(none))
    assert set(figure.rows[0].seconds) == {HeightMethod.PLAIN, HeightMethod.RECORD}
    assert "There is no OpenGL 3.3 here." in figure.text() and figure.report()["renderer"] is None


def test_it_stops_when_asked_and_tells_how_far_it_is() -> None:
    told: list[float] = []
    stop = threading.Event()

    def listen(fraction: float, text: str) -> None:
        told.append(fraction)
        if fraction > 0.5:
            stop.set()

    with pytest.raises(Cancelled):
        figure_eleven(FigureOptions(("A",), 64, 3), Progress(listen, stop))
    assert told == sorted(told) and len(told) > 10
