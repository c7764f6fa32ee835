"""The legend over the canvas: however many tools there are, what it says is read whole."""

from dataclasses import replace

import pytest
from PySide6.QtCore import QSize
from PySide6.QtWidgets import QHBoxLayout, QLabel, QWidget

from app.model.job import Job
from app.model.operation import CutParameters, RestOperation
from app.model.part import Part
from app.model.tool import Tool
from app.model.vcarve_operation import VcarveOperation
from app.ui.framework.give_way import give_way
from app.ui.framework.legend import LegendSheet
from app.ui.framework.samples import PathLineKind
from app.ui.framework.view import View
from app.ui.views.canvas.legend import Legend
from tests.ui.conftest import WAIT_MS


@pytest.mark.parametrize("count", [1, 2, 5, 40])
def test_a_long_list_of_tools_is_read_whole_in_the_legend(wiring, count):
    job: Job = wiring.document.job
    pocket = next(each for each in job.operations if each.CLEARS)
    tools = tuple(Tool(200 + k, diameter=3.0) for k in range(count))
    operations = tuple(replace(pocket, cut=replace(pocket.cut, tool=tool.number)) for tool in tools)
    wiring.document.change_job("Tools", replace(job, tools=tools, operations=operations))
    legend = wiring.window_.views.legend
    legend.show()
    wiring.window_.lay_out_now()
    row = legend.rows[PathLineKind.POCKET]
    assert row.label.fontMetrics().horizontalAdvance(row.label.text()) <= row.label.width(), row.label.text()
    assert all(f"T{tool.number}" in row.toolTip() for tool in tools)


def test_the_legend_is_wider_where_names_of_tools_want_it_but_not_without_end(qtbot):
    parent = QWidget()
    qtbot.addWidget(parent)
    legend, job = Legend(parent), Job(Part())
    usual = legend.width()
    rests = tuple(RestOperation(CutParameters(number)) for number in (121, 123, 11))
    legend.show_job(replace(job, operations=rests))
    assert legend.rows[PathLineKind.REST].label.text() == "Rest T121 T123 T11" and legend.width() >= usual
    legend.show_job(replace(job, operations=tuple(RestOperation(CutParameters(200 + k)) for k in range(30))))
    assert legend.rows[PathLineKind.REST].label.text().endswith("…") and legend.width() < 1.4 * usual
    legend.show_job(replace(job, operations=rests[:1]))
    assert legend.width() == usual


def test_a_line_is_named_after_the_one_kind_that_is_drawn_with_it(wiring):
    legend, job = wiring.window_.views.legend, wiring.document.job
    legend.show_job(replace(job, operations=(VcarveOperation(CutParameters(1)),)))
    assert legend.rows[PathLineKind.REST].label.text() == "V-carve T1"
    both = (VcarveOperation(CutParameters(1)), RestOperation(CutParameters(2)))
    legend.show_job(replace(job, operations=both))
    assert legend.rows[PathLineKind.REST].label.text() == "Rest T1 T2"


def test_a_legend_folds_where_it_would_hide_the_picture_and_may_be_unfolded_there(qtbot):
    parent = QWidget()
    qtbot.addWidget(parent)
    sheet = LegendSheet(parent, QLabel("Legend"), 180)
    sheet.add(QLabel("Pocket"))
    sheet.fit_contents()
    sheet.fit_into(QSize(900, 600))
    assert not sheet.fold.isChecked()
    sheet.fit_into(QSize(400, 600))
    assert sheet.fold.isChecked()
    sheet.fold.setChecked(False)
    sheet.fit_into(QSize(410, 600))
    assert not sheet.fold.isChecked(), "the user wants to see it"
    sheet.fit_into(QSize(900, 600))
    sheet.fit_into(QSize(400, 600))
    sheet.fit_into(QSize(900, 600))
    assert not sheet.fold.isChecked()


def test_a_row_gives_way_until_nothing_lies_over_one_another(qtbot):
    parent = QWidget()
    qtbot.addWidget(parent)
    row = QHBoxLayout(parent)
    labels = [QLabel("x") for _ in range(3)]
    for label in labels:
        label.setFixedWidth(100)
        row.addWidget(label)
    row.setSpacing(0)
    row.setContentsMargins(0, 0, 0, 0)
    parent.show()
    for room, shown in ((300, 3), (299, 2), (150, 1), (50, 1), (250, 2), (400, 3)):
        give_way(row, labels[:2], room)
        assert sum(not label.isHidden() for label in labels) == shown


def test_a_part_is_fitted_into_the_middle_of_what_is_free(qtbot, wiring):
    window, canvas = wiring.window_, wiring.window_.canvas

    def off_centre(free_right: float) -> float:
        """Return how far the part's middle is from the middle of the free width, px."""
        qtbot.waitUntil(lambda: canvas._glide.state() is not canvas._glide.State.Running, timeout=WAIT_MS)
        middle = canvas.view.to_screen((40.0, 25.0)).x()
        return middle - (canvas.area.left() + free_right) / 2

    wiring.run("rect 0,0 80,50")
    qtbot.waitUntil(lambda: canvas.picture.box is not None, timeout=WAIT_MS)
    canvas.fit()
    assert off_centre(canvas.area.right()) == pytest.approx(0.0, abs=1.0)
    wiring.display_controller.show_view(View.PATHS)
    window.views.show_missing("", "", shows_paths=True)
    assert off_centre(window.views.legend.geometry().left()) == pytest.approx(0.0, abs=10.0), "beside the legend"
    wiring.display_controller.show_view(View.DRAW)
    assert off_centre(canvas.area.right()) == pytest.approx(0.0, abs=1.0)
    canvas.zoom_by(2.0)
    looked_at = canvas.view
    wiring.display_controller.show_view(View.PATHS)
    window.views.show_missing("", "", shows_paths=True)
    assert canvas.view == looked_at, "what a person chose to look at stays"
