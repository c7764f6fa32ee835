"""Figure 11 in the window: measured on the die or on one's own program, with the reason where the old way is slower."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from app.exhibits.figure_eleven import FigureOptions, HeightMethod, figure_eleven, why_slower
from tests import raster_program as made
from tests.ui.nc.opened import open_file
from tests.ui.stages.test_text_films import LEFT, LONG_MS, show_text


def measured(qtbot, wiring):
    form = wiring.window_.film_panel.figure_eleven
    form.cells.show_value(256)
    QTest.mouseClick(form.measure, LEFT)
    qtbot.waitUntil(lambda: not wiring.figure_eleven.worker.busy, timeout=3 * LONG_MS)
    return form


@pytest.mark.exhaustive
def test_figure_eleven_is_measured_on_ones_own_program(qtbot, wiring, tmp_path) -> None:
    show_text(qtbot, wiring, "B")
    panel = wiring.window_.film_panel
    assert panel.figure_eleven.isVisible()
    QTest.mouseClick(panel.source.buttons[True], LEFT)
    form = measured(qtbot, wiring)
    assert "Open one in NC" in form.why.text() and not form.table.isVisible()
    path = tmp_path / "raster.ngc"
    path.write_text(made.text(made.rows(wide=8.0, deep=3.0)))
    open_file(qtbot, wiring, path)
    form = measured(qtbot, wiring)
    assert "raster.ngc" in form.table.text() and "record" in form.table.text() and form.table.text().count(" s&") >= 2
    show_text(qtbot, wiring, "E")
    assert not panel.figure_eleven.isVisible() and form.table.textFormat() == Qt.TextFormat.RichText


def test_where_the_published_way_is_slower_the_reason_has_numbers() -> None:
    figure = figure_eleven(FigureOptions(("A",), 64, 1))
    [row] = figure.rows
    told = list(why_slower(figure))
    if HeightMethod.PUBLISHED not in row.seconds:
        assert "was not measured" in told[0]
        return
    row.seconds[HeightMethod.PUBLISHED] = 3 * row.seconds[HeightMethod.RECORD]
    row.seconds[HeightMethod.PLAIN] = 9 * row.seconds[HeightMethod.RECORD]
    [said] = why_slower(figure)
    assert "3.0 times the record way" in said and f"{row.polygons.drawn:,} facets" in said and "4,096 cells" in said
    assert figure.renderer in said and said in figure.text()
    row.seconds[HeightMethod.PUBLISHED] = 0.5 * row.seconds[HeightMethod.RECORD]
    assert not list(why_slower(figure))
