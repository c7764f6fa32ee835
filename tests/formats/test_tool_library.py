"""Tool libraries: lossless to the last bit, errors with file, line and key, the starter libraries by their own rule."""

import math
from dataclasses import replace
from typing import Any

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from app.core.errors import InputError
from app.formats.tools.csv import read_tool_csv, write_tool_csv
from app.formats.tools.library import (
    HEADER,
    ToolLibrary,
    library_files,
    load_libraries,
    own_folder,
    read_library,
    write_library,
)
from app.model.tool import FeedRow, Tool
from app.model.tool_kind import ToolKind, shape_keys, tool_kinds
from tests.examples import examples

TEXT = st.text(
    st.characters(codec="utf-8", exclude_categories=["Cs", "Cc"], exclude_characters="\ufeff"), max_size=20
).map(str.strip)
LENGTH = st.floats(0, 500)
ANGLE = st.floats(0, 179).map(lambda degrees: math.radians(round(degrees, 6)))
FEEDS = st.lists(
    st.builds(
        FeedRow,
        TEXT.filter(lambda text: text and ":" not in text),
        st.floats(0.1, 2000),
        st.floats(1e-4, 5),
        st.floats(0.01, 1),
    ),
    max_size=3,
    unique_by=lambda row: row.material.casefold(),
)


@st.composite
def tools(draw: st.DrawFn) -> Tool:
    diameter, kind = draw(st.floats(0.05, 300)), draw(st.sampled_from(tool_kinds()))
    shape = {
        "corner_radius": st.floats(0, diameter * 0.49),
        "tip_diameter": st.floats(0, diameter * 0.99),
        "tip_angle": ANGLE,
    }
    heights = sorted(draw(st.lists(LENGTH, max_size=4)))
    values: dict[str, Any] = {key: draw(shape[key]) for key in sorted(shape_keys(kind))}
    values |= {key: draw(st.floats(1, 9999)) for key in ("spindle_speed", "feed_rate", "plunge_rate")}
    values |= {key: draw(LENGTH) for key in ("flute_length", "stick_out", "shank_diameter")} | {
        "length_offset": draw(st.floats(-500, 500))
    }
    values |= {
        "overall_length": draw(st.sampled_from([0.0, 500.0])),
        "flutes": draw(st.integers(1, 20)),
        "feeds": tuple(draw(FEEDS)),
    }
    holder = tuple((height, draw(LENGTH)) for height in [0.0, *heights]) if heights else ()
    return Tool(draw(st.integers(1, 9999)), diameter, kind, draw(TEXT), holder=holder, remark=draw(TEXT), **values)


LIBRARIES = st.builds(
    ToolLibrary, TEXT, st.lists(tools(), max_size=4, unique_by=lambda tool: tool.number).map(tuple), TEXT
)
SHARP = Tool(
    3,
    6.0,
    ToolKind.V,
    'the "sharp" one \\ 刃',
    1,
    18000.0,
    640.0,
    190.0,
    tip_angle=math.radians(60),
    tip_diameter=0.1,
    flute_length=5.2,
    overall_length=57.0,
    stick_out=21.0,
    shank_diameter=6.0,
    holder=((0.0, 10.0), (20.0, 10.0), (20.0, 21.5)),
    length_offset=-12.5,
    feeds=(FeedRow("aluminium", 250.0, 0.024), FeedRow("hard, dry wood; oak", 500.0, 0.06, 0.4)),
    remark="resharpened\ttwice",
)
FULL = ToolLibrary("Mine", (SHARP, Tool(7, 1 / 3)), "for the router")


@settings(deadline=None, max_examples=examples(60))
@example(FULL)
@given(LIBRARIES)
def test_a_library_is_read_back_to_the_last_bit(library):
    assert read_library("my.toml", write_library(library)) == library


def test_a_library_reads_well():
    text = write_library(FULL).decode()
    assert text.startswith(HEADER)
    assert "tip_angle = 60.0\n" in text
    assert "holder = [[0.0, 10.0], [20.0, 10.0], [20.0, 21.5]]\n" in text
    assert text.endswith("[[tool]]\nnumber = 7\ndiameter = 0.3333333333333333\n"), "what is as usual is left out"


GOOD = b"""format = 1
[[tool]]
number = 1
diameter = 6

[[tool]]
number = 2
diameter = 3
kind = "v"
tip_angle = 60
[[tool.feeds]]
material = "wood"
surface_speed = 500
feed_per_tooth = 0.02
[[tool.feeds]]
material = "steel"
surface_speed = 90
feed_per_tooth = 0.01
"""


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        (b"format = 1", b"", "my.toml:1: format is missing; add a whole number"),
        (b"format = 1", b"format = 2", "my.toml:1: format is 2"),
        (b"diameter = 3", b"", "my.toml:6: tool[2].diameter is missing"),
        (b"diameter = 3", b'diameter = "3"', "my.toml:8: tool[2].diameter is '3'; expected is a number"),
        (b"diameter = 3", b"diameter = 0", "my.toml:6: T2: diameter is 0 mm"),
        (b"diameter = 3", b"diameter = nan", "my.toml:8: tool[2].diameter is nan"),
        (b'"v"', b'"cone"', "my.toml:9: tool[2].kind is 'cone'; expected is 'flat', 'ball'"),
        (b"tip_angle = 60", b"angle = 60", "my.toml:10: tool[2].angle is not known"),
        (b"tip_angle = 60", b"corner_radius = 1", "kind v has no corner radius"),
        (
            b"tip_angle = 60",
            b"holder = [[0, 10], [5]]",
            "my.toml:10: tool[2].holder is [5]; expected is a list of 2 numbers",
        ),
        (
            b"tip_angle = 60",
            b"holder = 5",
            "my.toml:10: tool[2].holder is 5; expected is a list, and in it a list of 2 numbers each time",
        ),
        (b"surface_speed = 90", b"surface_speed = 'fast'", "my.toml:17: tool[2].feeds[2].surface_speed is 'fast'"),
        (b"surface_speed = 90", b"surface_speed = 0", "my.toml:15: Surface speed for steel is 0 m/min"),
        (b'"steel"', b'"Wood"', "my.toml:6: T2: feeds for wood are given twice"),
        (b"number = 2", b"number = 1", "my.toml: T1 is there 2 times"),
        (b"[[tool]]\nnumber = 1\ndiameter = 6", b"tool = 5\n[[x]]", "is no TOML file|not known"),
        (b"[[tool]]", b"[[tool", "my.toml: this is no TOML file"),
    ],
)
def test_what_is_wrong_is_told_with_file_line_and_key(old, new, told):
    assert len(read_library("my.toml", GOOD).tools) == 2
    with pytest.raises(InputError) as error:
        read_library("my.toml", GOOD.replace(old, new))
    assert any(part in str(error.value) for part in told.split("|")), str(error.value)


def test_the_users_libraries_stand_beside_those_that_ship_and_hide_their_namesakes():
    assert list(library_files()) == ["metric-drills", "metric-mills", "threads-and-reamers"]
    own_folder().mkdir(parents=True)
    (own_folder() / "metric-drills.toml").write_bytes(write_library(FULL))
    (own_folder() / "broken.toml").write_bytes(b"format = 9")
    libraries, problems = load_libraries()
    assert libraries["metric-drills"] == FULL
    assert list(libraries) == ["metric-drills", "metric-mills", "threads-and-reamers"]
    assert len(problems) == 1
    assert problems[0].startswith("broken.toml:1: format is 9")


def test_the_starter_libraries_hold_to_the_rule_that_they_state():
    libraries, problems = load_libraries()
    assert problems == ()
    shipped = [tool for library in libraries.values() for tool in library.tools]
    assert len({tool.number for tool in shipped}) == len(shipped), "both can be put in one job"
    assert {tool.kind for tool in shipped} == set(tool_kinds())
    for tool in shipped:
        assert [row.material for row in tool.feeds] == ["aluminium", "wood", "plastics", "steel"]
        meant = tool.in_material(tool.feeds[0], most_rpm=18000.0)
        assert tool.spindle_speed == pytest.approx(meant.spindle_speed, abs=51)
        assert tool.feed_rate == pytest.approx(meant.feed_rate, rel=0.03, abs=6)
        assert tool.plunge_rate == pytest.approx(meant.plunge_rate, rel=0.03, abs=6)
        tip = tool.tip_diameter if tool.kind is ToolKind.TAPER else tool.diameter
        assert all(0.002 * tip <= row.feed_per_tooth <= max(0.021 * tip, 0.0101) for row in tool.feeds), tool.name
        assert tool.flute_length <= tool.overall_length


@settings(deadline=None, max_examples=examples(60))
@example(FULL, ",")
@example(FULL, ";")
@given(LIBRARIES, st.sampled_from([",", ";"]))
def test_a_spreadsheet_is_read_back(library, mark):
    read, passed = read_tool_csv("my.csv", write_tool_csv(library, mark))
    assert passed == ()
    for meant, made in zip(library.tools, read.tools, strict=True):
        assert replace(made, feeds=()) == replace(meant, feeds=())
        assert sorted(made.feeds, key=str) == sorted(meant.feeds, key=str)
