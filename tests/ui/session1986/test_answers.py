"""Answers are checked, and make a job that differs from what it was in nothing but what was asked."""

from dataclasses import replace

import pytest

from app.core.errors import InputError
from app.model.contour_operation import ContourOperation
from app.model.job import Job
from app.model.operation import CutParameters, PocketOperation
from app.model.part import Part
from app.model.tool import Tool
from app.model.tool_kind import ToolKind
from app.ui.views.session1986.answers import EnteredOffsets, amount, job_of, offered
from app.ui.views.session1986.draft import ShapeDraft
from app.ui.views.session1986.screen import BOTTOM, TOP


def test_the_job_s_own_tools_are_offered() -> None:
    job = Job(
        Part(),
        (Tool(7, 8.0), Tool(9, 2.0)),
        (ContourOperation(CutParameters(9)), PocketOperation(CutParameters(7), 6.0)),
    )
    assert offered(job) == EnteredOffsets(1.0, 4.0, 2.0)
    assert offered(replace(job, operations=())) == EnteredOffsets(1.5, 3.0, 3.0)


def test_amounts_know_units_and_their_range() -> None:
    assert amount("1/8IN", 1, 5) == pytest.approx(3.175)
    assert amount(" 2.5 ", 1, 5) == 2.5
    for text in ("", "abc", "0", "5.01", "-2", "1 2"):
        with pytest.raises(InputError, match=r"^\? "):
            amount(text, 1, 5)


@pytest.mark.parametrize(("low", "high"), [(0.27607, 44.8614), (1e-3, 5.7239), (12345.678, 23456.789)])
def test_the_limits_that_are_told_are_allowed(low: float, high: float) -> None:
    with pytest.raises(InputError) as told:
        amount("0", low, high)
    words = str(told.value).split()
    for limit in (words[-4], words[-2]):
        assert amount(limit, low, high) == float(limit)


def test_an_unchanged_answer_keeps_the_tool_as_it_is() -> None:
    ball = Tool(1, 6.0, ToolKind.BALL, "my ball", feed_rate=321)
    job = Job(Part(), (ball, Tool(2, 3.0), Tool(5, 1.0)))
    made = job_of(job, EnteredOffsets(1.25, 3.0, 3.0))
    assert made.tool(1) is ball and made.tool(5) == Tool(5, 1.0)
    assert (made.tool(2).diameter, made.tool(2).kind) == (2.5, ToolKind.FLAT)
    assert made.operations[0] == PocketOperation(CutParameters(1), None)
    assert offered(made) == EnteredOffsets(1.25, 3.0, 3.0)


def test_everything_but_tools_and_operations_stays() -> None:
    cut = CutParameters(1, depth=7.0, stepdown=1.5, stock_to_leave=0.3, enabled=False)
    job = Job(
        Part(name="p"),
        operations=(PocketOperation(cut), PocketOperation(CutParameters(2))),
        safe_z=9.0,
        exact_path=True,
    )
    made = job_of(job, EnteredOffsets(1.5, 4.0, 5.0))
    assert replace(made, tools=job.tools, operations=job.operations) == job
    assert [type(each) for each in made.operations] == [PocketOperation, ContourOperation]
    pocket = made.operations[0]
    assert (pocket.stepover, pocket.cut.depth, pocket.cut.stock_to_leave, pocket.cut.enabled) == (3.0, 7.0, 0.0, True)


def test_one_tool_for_both_becomes_two() -> None:
    job = Job(Part(), (Tool(4, 5.0),), (PocketOperation(CutParameters(4)), ContourOperation(CutParameters(4))))
    made = job_of(job, EnteredOffsets(1.0, 2.5, 2.5))
    assert [made.tool(each.cut.tool).radius for each in made.operations] == [2.5, 1.0]
    assert len({tool.number for tool in made.tools}) == 2


def test_a_draft_is_drawn_in_words_and_grows_with_what_is_drawn() -> None:
    draft = ShapeDraft()
    assert draft.point((300, 200)) == "50,10.5"
    assert draft.run("LINE 10,10 60,10 60,40 CLOSE").startswith("Line, 3 sides")
    picture = draft.picture()
    assert picture[302, 40:240].all() and not picture[303].any()
    with pytest.raises(InputError, match="not known here"):
        draft.run("EXPORT X")
    with pytest.raises(InputError, match="Column"):
        draft.run("CIRCLE 1,X 2")
    assert len(draft.part.entities) == 3
    draft.run("CIRCLE 200,100 90")
    assert draft.frame.pitch > 0.5
    rows = draft.picture().any(axis=1).nonzero()[0]
    assert rows[0] >= TOP and rows[-1] < BOTTOM
    draft.run("CLEAR")
    assert not draft.part.entities
    draft.run("UNDO")
    assert len(draft.part.entities) == 4
