"""A kind of tool that is registered from outside is offered, shown and drawn by the window like any other."""

from collections.abc import Iterator

import numpy as np
import pytest

from app.core.resources import resource
from app.drafting.document import Document
from app.model.job import Job
from app.model.part import Part
from app.model.tool import Tool
from app.model.tool_kind import ToolKind, register, withdraw
from app.simulation.cutter import cutter_of
from app.ui.framework.icons import IconLabel
from app.ui.panels.changes import Subject, SubjectKind
from app.ui.panels.side_panel import SidePanel
from app.ui.panels.tool_kinds import icon_of, listed_kinds
from app.ui.views.cut.setup_form import ToolFields
from app.ui.views.cut.tool_outline import ToolPart, outline_of
from app.ui.views.surfaces.scene_fields import tool_fields
from tests.model.test_tool_kind import DRUM, MILL


@pytest.fixture(autouse=True)
def registered() -> Iterator[None]:
    register(DRUM)
    yield
    withdraw(DRUM)


def test_the_form_of_a_tool_offers_it_and_shows_its_numbers(qtbot) -> None:
    document = Document(Job(Part()))
    panel = SidePanel(document)
    qtbot.addWidget(panel)
    panel.show()
    panel.choose(Subject(SubjectKind.TOOL, 1))
    form = panel.tool_form
    at = form.kind.box.findText("Drum mill")
    assert at == listed_kinds().index(DRUM)
    form.kind.box.activated.emit(at)
    assert document.job.tools[0].kind is DRUM
    shown = {name for name in ("corner", "angle", "tip") if getattr(form, name).isVisible()}
    assert shown == {"tip"}
    assert icon_of(DRUM) in {label.name for label in panel.tools.findChildren(IconLabel)}


@pytest.mark.parametrize(
    ("like", "traits"),
    [
        (ToolKind.FLAT, {"level": True, "square": True}),
        (ToolKind.BULL, {"level": True}),
        (ToolKind.BALL, {}),
        (ToolKind.DRILL, {"drills": True}),
        (ToolKind.V, {"keys": frozenset({"tip_angle"})}),
    ],
)
def test_without_an_icon_of_its_own_it_has_that_of_the_kind_most_like_it(like: ToolKind, traits: dict) -> None:
    kind = ToolKind("other", "Other", like.profile, **traits)
    assert icon_of(kind) == icon_of(like)
    assert resource("icons", f"{icon_of(kind)}.svg").is_file()


def test_its_outline_is_the_cutter_that_the_engine_cuts_with() -> None:
    section = outline_of(MILL).stretches[0]
    assert section.part is ToolPart.CUTTING
    end = section.points[section.points[:, 0] <= 3.0]
    assert end[1] == pytest.approx((0.0, 2.0)) and end[-1] == pytest.approx((3.0, 5.0))
    assert np.allclose(cutter_of(MILL).heights(end[1:-1, 1]), end[1:-1, 0], atol=1e-9)


def test_the_set_up_of_a_cut_and_a_scene_offer_it(qtbot) -> None:
    fields = ToolFields(1, Tool(1, 10.0))
    qtbot.addWidget(fields)
    fields.kind.box.activated.emit(fields.kind.box.findText("Drum mill"))
    assert fields.tool == Tool(1, 10.0, DRUM, tip_diameter=2.5)
    kind = next(field for field in tool_fields(Tool(1, 10.0)) if field.name == "Kind")
    assert ("drum", "Drum mill") in kind.choices
    assert kind.changes("drum")[("tip_diameter",)] == 2.5
