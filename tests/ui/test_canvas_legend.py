"""The legend over the canvas: however many tools there are, what it says is read whole."""

from dataclasses import replace

import pytest

from app.model.job import Job
from app.model.tool import Tool
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
