"""A tool from the side: what is told is drawn where it is, what is not told is made up so that it looks like a tool."""

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from app.model.tool import Tool
from app.model.tool_kind import ToolKind, tool_kinds
from app.simulation.cutter import cutter_of
from app.ui.views.cut.tool_outline import ToolPart, outline_of
from tests.examples import examples

HOLDER = ((0.0, 10.0), (20.0, 10.0), (20.0, 16.0), (32.0, 16.0))
SHAPES = {
    ToolKind.FLAT: {},
    ToolKind.BALL: {},
    ToolKind.BULL: {"corner_radius": 1.2},
    ToolKind.V: {"tip_angle": 1.2, "tip_diameter": 0.4},
    ToolKind.DRILL: {"tip_angle": 2.0},
    ToolKind.TAPER: {"tip_angle": 0.3, "tip_diameter": 1.5},
    ToolKind.REAMER: {},
    ToolKind.TAP: {"tip_diameter": 4.2},
    ToolKind.THREAD_MILL: {},
}


def made(kind=ToolKind.FLAT, **more):
    return Tool(1, 6.0, kind, **SHAPES[kind], **more)


def parts(outline):
    return {stretch.part: stretch.points for stretch in outline.stretches}


@pytest.mark.parametrize("kind", [kind for kind in tool_kinds() if not kind.threads])
def test_the_end_is_the_cutter_that_the_engine_cuts_with(kind):
    tool = made(kind, flute_length=30.0)
    points, cutter = parts(outline_of(tool))[ToolPart.CUTTING], cutter_of(tool)
    below = points[(points[:, 1] < tool.radius - 1e-6) | (points[:, 0] == 0.0)]
    assert np.allclose(cutter.heights(below[:, 1])[below[:, 1] > 0], below[below[:, 1] > 0, 0], atol=1e-9)
    between = np.linspace(0.0, tool.radius - 1e-6, 400)
    side = points[np.append(True, np.diff(points[:, 1]) > 0)]
    gap = np.interp(between, side[:, 1], side[:, 0]) - cutter.heights(between)
    assert np.all(gap > -1e-9), "chords of a convex end lie inside it"
    at = np.interp(cutter.heights(between), points[:, 0], points[:, 1])
    inside = between > points[points[:, 0] == 0.0, 1].max()
    assert np.max(np.abs(at - between)[inside], initial=0.0) < 0.02 * tool.radius


@pytest.mark.parametrize("kind", [ToolKind.TAP, ToolKind.THREAD_MILL])
def test_teeth_that_cut_a_thread_stand_out_of_the_core_that_clears(kind):
    tool = made(kind, flute_length=30.0)
    points = parts(outline_of(tool))[ToolPart.CUTTING]
    assert cutter_of(tool).radius == pytest.approx(2.1) and points[:, 1].max() == pytest.approx(3.0)


def test_flutes_shank_and_holder_are_where_the_tool_says():
    outline = outline_of(
        made(ToolKind.BALL, flute_length=14.0, overall_length=60.0, stick_out=28.0, shank_diameter=8.0, holder=HOLDER)
    )
    found = parts(outline)
    assert list(found) == [ToolPart.CUTTING, ToolPart.SHANK, ToolPart.HOLDER]
    assert found[ToolPart.CUTTING][-1].tolist() == [14.0, 3.0]
    assert found[ToolPart.SHANK].tolist() == [[14.0, 3.0], [14.0, 4.0], [28.0, 4.0]]
    assert found[ToolPart.HOLDER].tolist() == [[28.0, 4.0], *[[28.0 + h, r] for h, r in HOLDER], [60.0, 0.0]]
    assert (outline.height, outline.widest) == (60.0, 16.0)


def test_what_is_not_told_is_made_up():
    bare = parts(outline_of(made()))
    assert bare[ToolPart.CUTTING][-1].tolist() == [18.0, 3.0] and bare[ToolPart.SHANK].tolist() == [
        [18.0, 3.0],
        [36.0, 3.0],
        [36.0, 0.0],
    ]
    short = parts(outline_of(made(stick_out=20.0)))
    assert short[ToolPart.CUTTING][-1, 0] == pytest.approx(12.0) and short[ToolPart.SHANK][-1].tolist() == [20.0, 0.0]
    assert outline_of(made(overall_length=50.0, stick_out=20.0)).height == 50.0
    held = parts(outline_of(made(holder=HOLDER)))
    assert held[ToolPart.HOLDER][0].tolist() == [24.0, 3.0]


def test_a_cones_flutes_end_with_it_and_known_ones_end_on_it():
    cone = 2.8 / math.tan(0.6)
    found = parts(outline_of(made(ToolKind.V)))
    assert found[ToolPart.CUTTING][-1] == pytest.approx((cone, 3.0))
    cut_short = parts(outline_of(made(ToolKind.V, flute_length=2.0, shank_diameter=4.0)))
    border = (2.0, 0.2 + 2.0 * math.tan(0.6))
    assert cut_short[ToolPart.CUTTING][-1] == pytest.approx(border) and cut_short[ToolPart.SHANK][0] == pytest.approx(
        border
    )
    assert cut_short[ToolPart.SHANK][1] == pytest.approx((cone, 3.0)) and cut_short[ToolPart.SHANK][2] == pytest.approx(
        (cone, 2.0)
    )


LENGTHS = st.one_of(st.just(0.0), st.floats(0.5, 90.0))


@settings(max_examples=examples(200), deadline=None)
@given(st.sampled_from(tool_kinds()), LENGTHS, LENGTHS, LENGTHS, LENGTHS, st.sampled_from([(), HOLDER]))
@example(ToolKind.BALL, 0.0, 0.0, 1.5, 0.0, HOLDER)
def test_every_tool_is_one_closed_outline(kind, flutes, overall, stick_out, shank, holder):
    most = overall or 1e9
    tool = made(
        kind,
        flute_length=min(flutes, most),
        overall_length=overall,
        stick_out=min(stick_out, most),
        shank_diameter=shank,
        holder=holder,
    )
    outline = outline_of(tool)
    points = [stretch.points for stretch in outline.stretches]
    assert points[0][0].tolist() == [0.0, 0.0] and points[-1][-1, 1] == 0.0
    for below, above in pairwise(points):
        assert below[-1].tolist() == above[0].tolist()
    together = np.vstack(points)
    assert np.all(np.diff(together[:, 0]) >= -1e-9) and np.all(together[:, 1] >= 0.0)
    assert all(len(part) > 1 and np.all(np.any(np.diff(part, axis=0) != 0, axis=1)) for part in points)
    assert [stretch.part for stretch in outline.stretches] == sorted(stretch.part for stretch in outline.stretches)
    assert outline.stretches[0].part is ToolPart.CUTTING
    assert (outline.stretches[-1].part is ToolPart.HOLDER) == bool(holder)
