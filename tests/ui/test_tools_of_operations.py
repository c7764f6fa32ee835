"""Every kind of operation with every kind of tool: computed, or refused in one sentence, the same in the panel and by
computing.
"""

import math
from collections.abc import Iterator
from dataclasses import replace

import pytest
from PySide6.QtCore import QCoreApplication, QEvent
from PySide6.QtWidgets import QLabel

from app.core.errors import ParameterError
from app.drafting.document import Document
from app.model.job import Job, Stock
from app.model.operation import CutParameters
from app.model.operation_kinds import OPERATION_KINDS
from app.model.tool import Tool
from app.model.tool_kind import ToolKind
from app.ui.framework.computation import Computation, ComputationState
from app.ui.framework.labels import Elided
from app.ui.framework.worker import Worker
from app.ui.panels.side_panel import SidePanel
from app.ui.views.stages.film_set import FilmRequest, film_set_of
from app.usecases.making.bitmap_job import drawn_job
from app.usecases.pixels.options import BitmapSize
from tests.part_shapes import circle, layered_part, square

PART = layered_part({"a": [square(40), circle(3, 20, 20)]})
TOOLS = (
    Tool(1, 6.0),
    Tool(1, 6.0, ToolKind.BALL),
    Tool(1, 6.0, ToolKind.BULL, corner_radius=1.0),
    Tool(1, 6.0, ToolKind.V, tip_angle=math.radians(90)),
    Tool(1, 6.0, ToolKind.DRILL, tip_angle=math.radians(118)),
    Tool(1, 6.0, ToolKind.TAPER, tip_angle=math.radians(10), tip_diameter=2.0),
)
NO_MILL = (
    "T1 is a drill, which cannot cut sideways; a {} operation needs a mill: choose another tool, or make it a drill "
    "operation."
)
ALL_OFF = "every operation of the job is switched off, so nothing is cut; switch one on"


NO_CONE = (
    "T1 {} is a {} cutter; a {} operation needs a V cutter with its angle{}: choose another tool, or make this one a "
    "V cutter."
)
OTHER_TOOL = "T1 {} is a {}; a {} operation needs a {}: choose another tool, or give it another kind."
NOT_EXACTLY = {
    "face": "T1 {} leaves no level floor; take a flat or a bull-nose mill to face with.",
    "slot": "T1 {} makes no slot with straight walls and a level floor; take a flat mill, or follow the lines with a "
    "contour on the line.",
}
"""What the shape of a mill's end has no part in on pixels."""


def refused(word: str, tool: Tool) -> str:
    kind = OPERATION_KINDS[word]
    if kind.TOOL:
        return OTHER_TOOL.format(tool.label, tool.kind.value, word, kind.TOOL)
    if tool.kind is ToolKind.DRILL and not kind.DRILLS:
        return NO_MILL.format(word)
    if not kind.CARVES or tool.kind is ToolKind.V or (kind.CARVES_ROUND and tool.kind is ToolKind.BALL):
        return ""
    return NO_CONE.format(tool.label, tool.kind.value, word, " or a ball" if kind.CARVES_ROUND else "")


@pytest.mark.parametrize("way", ["exact", "pixels"])
@pytest.mark.parametrize("tool", TOOLS, ids=lambda tool: tool.kind.value)
@pytest.mark.parametrize("word", OPERATION_KINDS)
def test_it_is_computed_or_refused(qtbot, word, tool, way):
    job = Job(PART, (tool,), (OPERATION_KINDS[word](CutParameters(1)),), stock=Stock(above=0.5 * (word == "face")))
    computation = Computation(Document(job), worker := Worker(), lambda made: None)
    if way == "pixels":
        computation.pixels = job.part, drawn_job(job, BitmapSize(100)).part
    computation.start()
    qtbot.waitUntil(lambda: computation.state is not ComputationState.RUNNING, timeout=20_000)
    worker.finish()
    ends_well = {"face": tool.kind.level, "slot": tool.kind.square}.get(word, True)
    shape = NOT_EXACTLY[word].format(tool.label) if way == "exact" and not ends_well else ""
    assert computation.error == (refused(word, tool) or shape)
    assert computation.state is (ComputationState.FAILED if computation.error else ComputationState.CURRENT)


@pytest.fixture(scope="module")
def panel_and_document(qapp) -> Iterator[tuple[SidePanel, Document]]:
    """A panel that is there already when a job is loaded, as in the window."""
    document = Document(Job(PART))
    panel = SidePanel(document)
    panel.show()
    yield panel, document
    panel.hide()
    panel.deleteLater()


@pytest.mark.parametrize("tool", TOOLS, ids=lambda tool: tool.kind.value)
@pytest.mark.parametrize("word", OPERATION_KINDS)
def test_the_panel_marks_the_tool_at_once(panel_and_document, word, tool):
    panel, document = panel_and_document
    document.load(Job(PART, (tool,), (OPERATION_KINDS[word](CutParameters(1)),)))
    reason = panel.operation_form.tool.reason
    assert (reason.text(), reason.isVisible()) == (refused(word, tool), bool(refused(word, tool)))
    QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)  # rows of the list before
    (in_list,) = [label for label in panel.operations.findChildren(Elided) if label.text() == f"T1 {tool.label}"]
    assert in_list.property("role") == ("error" if refused(word, tool) else "muted")


def test_computing_says_why_not_once_above_the_view_and_in_the_findings(qtbot, wiring):
    window, drill = wiring.window_, Tool(1, 6.0, ToolKind.DRILL)
    wiring.document.load(Job(PART, (drill,), (OPERATION_KINDS["pocket"](CutParameters(1)),)))
    wiring.compute()
    qtbot.waitUntil(lambda: wiring.computation.state is ComputationState.FAILED, timeout=20_000)
    assert window.notice.text.text() == NO_MILL.format("pocket")
    assert window.status.message.toolTip() == "Could not be computed"
    assert window.status.badge.text() == "Could not be computed"
    window.canvas.hovered.emit("Part")
    window.canvas.hovered.emit("")
    assert window.status.message.toolTip() == "Could not be computed"
    wiring.display_controller.open_findings()
    assert NO_MILL.format("pocket") in [label.text() for label in window.findings_list.findChildren(QLabel)]


@pytest.mark.parametrize("pixels", [False, True], ids=["exact", "pixels"])
def test_all_operations_off_is_said_whichever_way(qtbot, pixels):
    job = Job(PART)
    job = replace(job, operations=tuple(replace(each, cut=replace(each.cut, enabled=False)) for each in job.operations))
    computation = Computation(Document(job), worker := Worker(), lambda made: None)
    if pixels:
        computation.pixels = job.part, drawn_job(job, BitmapSize(100)).part
    computation.start()
    qtbot.waitUntil(lambda: computation.state is ComputationState.FAILED, timeout=20_000)
    worker.finish()
    assert ALL_OFF in computation.error
    with pytest.raises(ParameterError, match=ALL_OFF):
        film_set_of(FilmRequest(job, BitmapSize(100)))


def test_a_tool_that_does_not_fit_into_its_row_is_said_in_fewer_words_and_not_cut_off(qtbot):
    label = Elided("T121 Long flat 2 mm", shorter=("T121 2 mm", "T121"))
    qtbot.addWidget(label)
    width = label.fontMetrics().horizontalAdvance
    for room, shown in (
        ("T121 Long flat 2 mm", "T121 Long flat 2 mm"),
        ("T121 Long fl", "T121 2 mm"),
        ("T121 ", "T121"),
    ):
        label.resize(width(room), 20)
        assert label.shown == shown
    label.resize(width("T121") - 1, 20)
    assert label.shown.endswith("…")
    label.resize(width("…"), 20)
    assert label.shown == "", "nothing rather than dots alone"
