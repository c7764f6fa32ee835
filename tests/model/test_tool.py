"""Tools: every range says what is wrong with a value, kinds have only what belongs to them, feeds follow from chip
loads.
"""

import math
from dataclasses import replace

import pytest

from app.core.errors import ParameterError
from app.model.tool import FeedRow, Tool
from app.model.tool_kind import ToolKind, tool_kinds

BULL = Tool(
    3,
    12.0,
    ToolKind.BULL,
    corner_radius=1.0,
    flute_length=26.0,
    overall_length=83.0,
    stick_out=40.0,
    shank_diameter=12.0,
)
V = Tool(4, 6.0, ToolKind.V, tip_angle=math.radians(60), tip_diameter=0.1)
ALUMINIUM = FeedRow("aluminium", surface_speed=200.0, feed_per_tooth=0.05, plunge_share=0.25)


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"number": 0}, "number 0 is out of range"),
        ({"diameter": 0.0}, "diameter is 0 mm"),
        ({"flutes": 0}, "flutes is 0"),
        ({"corner_radius": 6.0}, "less than half the diameter, 6 mm"),
        ({"corner_radius": -1.0}, "corner radius is -1 mm"),
        ({"corner_radius": math.nan}, "corner radius is nan mm"),
        ({"flute_length": 84.0}, "not be more than the overall length, 83 mm"),
        ({"stick_out": 90.0}, "stick out is 90 mm"),
        ({"shank_diameter": 1e4}, "less than 10000 mm"),
        ({"length_offset": math.inf}, "length offset is inf mm"),
        ({"tip_angle": 1.0}, "kind bull has no tip angle"),
        ({"holder": ((1.0, 10.0), (5.0, 10.0))}, "begin with 0"),
        ({"holder": ((0.0, 10.0), (5.0, 10.0), (4.0, 12.0))}, "not fall"),
        ({"holder": ((0.0, 10.0),)}, "two points"),
        ({"holder": ((0.0, 10.0), (math.nan, 12.0))}, "radius from 0"),
        ({"feeds": (ALUMINIUM, replace(ALUMINIUM, material="ALUMINIUM"))}, "aluminium are given twice"),
    ],
)
def test_a_value_out_of_its_range_is_told(change, told):
    with pytest.raises(ParameterError, match=told):
        replace(BULL, **change)


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"tip_angle": math.pi}, "tip angle is 180 degrees"),
        ({"tip_diameter": 6.0}, "less than the diameter"),
        ({"corner_radius": 0.1}, "kind v has no corner radius"),
    ],
)
def test_a_pointed_tool_is_checked(change, told):
    with pytest.raises(ParameterError, match=told):
        replace(V, **change)


@pytest.mark.parametrize(
    "change",
    [
        {"material": " "},
        {"surface_speed": 0.0},
        {"feed_per_tooth": math.nan},
        {"feed_per_tooth": 101.0},
        {"plunge_share": 1.01},
    ],
)
def test_feeds_out_of_range_are_refused(change):
    with pytest.raises(ParameterError):
        replace(ALUMINIUM, **change)


def test_another_kind_leaves_what_it_does_not_have():
    assert BULL.as_kind(ToolKind.FLAT).corner_radius == 0
    assert V.as_kind(ToolKind.DRILL) == replace(V, kind=ToolKind.DRILL, tip_diameter=0.0)
    assert all(BULL.as_kind(kind).as_kind(kind).kind is kind for kind in tool_kinds())


def test_speed_and_feeds_come_from_surface_speed_and_chip_load():
    made = replace(BULL, flutes=4).in_material(ALUMINIUM)
    assert made.spindle_speed == pytest.approx(1000 * 200 / (math.pi * 12))
    assert made.feed_rate == pytest.approx(made.spindle_speed * 4 * 0.05)
    assert made.plunge_rate == pytest.approx(made.feed_rate / 4)


def test_a_slow_spindle_keeps_the_chip_load():
    small = Tool(1, 1.0).in_material(ALUMINIUM, most_rpm=18000.0)
    assert (small.spindle_speed, small.feed_rate) == (18000.0, pytest.approx(18000 * 2 * 0.05))
