"""The tool's form proposes speed and feeds for the stock's material, says why, and Ctrl+Z takes them back."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt

from app.drafting.document import Document
from app.model.job import Job
from app.model.part import Part
from app.ui.framework.catalogue import set_language
from app.ui.panels.changes import Subject, SubjectKind
from app.ui.panels.side_panel import SidePanel


@pytest.fixture
def document() -> Document:
    return Document(Job(Part()))


@pytest.fixture
def form(qtbot, document):
    panel = SidePanel(document)
    qtbot.addWidget(panel)
    panel.show()
    panel.choose(Subject(SubjectKind.TOOL, 1))
    yield panel.tool_form
    set_language("en")


def choose(field, text: str) -> None:
    at = field.box.findText(text)
    assert at >= 0, text
    field.box.setCurrentIndex(at)
    field.box.activated.emit(at)


def test_a_material_a_machine_and_a_click(qtbot, document, form) -> None:
    group = form.proposal
    assert not group.button.isEnabled()
    assert "made of" in group.button.toolTip()
    choose(group.stock, "Softwood")
    assert document.job.stock.material == "softwood"
    choose(group.machine, "Small router")
    qtbot.mouseClick(group.button, Qt.MouseButton.LeftButton)
    tool = document.job.tool(1)
    assert (tool.spindle_speed, tool.feed_rate) == (16660.0, 3998.0), "the router feeds at 4000 at most"
    assert tool.feeds[0].material == "softwood"
    assert form.speed.number == 16660.0
    assert "1000 x 450 / (pi x 6)" in form.speed.toolTip()
    assert "lowered to 16660" in form.speed.toolTip()
    assert "16660 rpm x 2 x 0.12" in form.feed.toolTip()
    assert "40 %" in form.plunge.toolTip()
    assert "Small router feeds at 4000" in group.limits.text()
    qtbot.mouseClick(group.button, Qt.MouseButton.LeftButton)
    assert "router charts" in form.feed.toolTip(), "once more says the same"
    document.undo()
    document.undo()
    assert document.job.tool(1).feed_rate == 600.0
    assert form.feed.toolTip() == "", "a number that nobody proposed has no reason"
    assert group.limits.text() == ""


def test_another_number_takes_the_reason_away(qtbot, document, form) -> None:
    choose(form.proposal.stock, "Aluminium")
    qtbot.mouseClick(form.proposal.button, Qt.MouseButton.LeftButton)
    assert form.feed.toolTip()
    form.feed.edit.setFocus()
    form.feed.edit.selectAll()
    qtbot.keyClicks(form.feed.edit, "500")
    qtbot.keyClick(form.feed.edit, Qt.Key.Key_Return)
    assert document.job.tool(1).feed_rate == 500.0
    assert form.feed.toolTip() == ""


def test_every_reason_is_told_in_japanese(qtbot, document, form) -> None:
    set_language("ja")
    for material in ("Softwood", "Mild steel"):
        choose(form.proposal.stock, material)
        for machine in ("Any", "Small router", "Bench mill"):
            choose(form.proposal.machine, machine)
            qtbot.mouseClick(form.proposal.button, Qt.MouseButton.LeftButton)
            told = [form.speed.toolTip(), form.feed.toolTip(), form.plunge.toolTip()]
            for line in "\n".join(told).splitlines():
                assert any("\u3040" <= letter <= "\u9fff" for letter in line), line
