"""The legend over the canvas: however many tools there are, what it says is read whole."""

from dataclasses import replace

import pytest
from PySide6.QtCore import QSize
from PySide6.QtWidgets import QHBoxLayout, QLabel, QWidget

from app.model.job import Job
from app.model.tool import Tool
from app.ui.framework.give_way import give_way
from app.ui.framework.legend import LegendSheet
from app.ui.framework.samples import PathLineKind


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
