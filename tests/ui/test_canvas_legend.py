"""The legend over the canvas: however many tools there are, what it says is read whole."""

from dataclasses import replace

import pytest

from app.model.job import Job
from app.model.tool import Tool
from app.ui.framework.samples import PathLineKind
from app.ui.framework.view import View
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


def test_a_part_is_fitted_into_the_middle_of_what_is_free(qtbot, wiring):
    window, canvas = wiring.window_, wiring.window_.canvas

    def off_centre(free_right: float) -> float:
        """Return how far the part's middle is from the middle of the free width, px."""
        qtbot.waitUntil(lambda: canvas._glide.state() is not canvas._glide.State.Running, timeout=WAIT_MS)
        middle = canvas.view.to_screen((40.0, 25.0)).x()
        return middle - (canvas.area.left() + free_right) / 2

    wiring.run("rect 0,0 80,50")
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
