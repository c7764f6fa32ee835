"""How a tool is held, in its form: what is typed and chosen comes into the job, and what is missing is said."""

from dataclasses import replace

import numpy as np
import pytest
from PySide6.QtGui import QImage

from app.drafting.document import Document
from app.formats.tools.holders import named_holders, outline_of
from app.model.job import Job
from app.model.part import Part
from app.ui.panels.changes import Subject, SubjectKind
from app.ui.panels.side_panel import SidePanel
from app.ui.panels.tool_assembly_group import OWN, UNKNOWN, ToolAssemblyGroup
from tests.ui.fields_typed import enter


@pytest.fixture
def document() -> Document:
    return Document(Job(Part()))


@pytest.fixture
def group(qtbot, document) -> ToolAssemblyGroup:
    panel = SidePanel(document)
    qtbot.addWidget(panel)
    panel.show()
    panel.choose(Subject(SubjectKind.TOOL, 1))
    panel.tool_form.hold.group.fold.setChecked(True)
    return panel.tool_form.hold


def choose(group: ToolAssemblyGroup, text: str) -> None:
    at = group.holder.box.findText(text)
    assert at >= 0
    group.holder.box.setCurrentIndex(at)
    group.holder.box.activated.emit(at)


def test_lengths_are_typed_with_units_and_emptied_again(qtbot, document, group) -> None:
    enter(qtbot, group.flutes, "15")
    enter(qtbot, group.shank, "1/4in")
    enter(qtbot, group.stick_out, "30")
    tool = document.job.tool(1)
    assert (tool.flute_length, tool.shank_diameter, tool.stick_out) == (15.0, pytest.approx(6.35), 30.0)
    enter(qtbot, group.stick_out, "unknown")
    assert document.job.tool(1).stick_out == 0.0


def test_a_holder_is_chosen_by_name_and_taken_away(document, group) -> None:
    assert group.holder.box.currentText() == UNKNOWN
    choose(group, "ER20")
    assert document.job.tool(1).holder == outline_of("ER20")
    assert "Tell the stick-out too" in group.words.text()
    assert group.group.summary.text() == "ER20"
    choose(group, UNKNOWN)
    assert document.job.tool(1).holder == ()


def test_an_outline_of_its_own_stays_until_another_is_chosen(document, group) -> None:
    tool = replace(document.job.tool(1), holder=((0.0, 11.0), (30.0, 12.0)), stick_out=25.0)
    document.change_job("Hold it", replace(document.job, tools=(tool, *document.job.tools[1:])))
    assert group.holder.box.currentText() == OWN
    assert "must stick out" in group.words.text()
    assert group.group.summary.text() == "its own outline, 25 mm out"
    choose(group, "ER11")
    assert group.holder.box.findText(OWN) == -1


def test_every_named_holder_is_offered(group) -> None:
    assert [group.holder.box.itemText(k) for k in range(group.holder.box.count())] == [
        UNKNOWN,
        *(each.name for each in named_holders()),
    ]


def test_the_drawing_shows_the_holder(document, group) -> None:
    def ink() -> int:
        image = group.picture.grab().toImage().convertToFormat(QImage.Format.Format_Grayscale8)
        pixels = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), image.bytesPerLine())[
            :, : image.width()
        ]
        return int(np.sum(pixels != pixels[-1, -1]))

    bare = ink()
    choose(group, "ER20")
    assert ink() > bare + 500
