"""Each tool cuts with its own length: what the control takes off after every change."""

from __future__ import annotations

from itertools import groupby

import pytest

from app.gcode.interpreter.options import ReadOptions, ToolOffset
from app.gcode.interpreter.reader import read_program
from app.gcode.posts import load_post
from app.model.part import Units
from tests.gcode.one_file import write_program
from tests.gcode.programs import Path, job, two_tools
from tests.gcode.rs274_oracle import canonical_calls


def there_and_back() -> Path:
    """T1, T2, and T1 again."""
    path = two_tools()
    path.tool, path.operation = 1, 0
    return path.into_work(10, 10).line(12, 10, -1).out_of_work()


@pytest.mark.parametrize("units", [Units.MM, Units.INCH])
def test_linuxcnc_takes_the_length_of_each_tool(units: Units) -> None:
    lengths = {1: 38.1, 2: 25.4}
    text = write_program(there_and_back().program(), job(out_units=units), load_post("linuxcnc")).text
    calls = canonical_calls(text, lengths)
    names = [name for name, _ in calls]
    changes = [k for k, name in enumerate(names) if name == "CHANGE_TOOL"]
    taken = []
    for k in changes:
        at = names.index("USE_TOOL_LENGTH_OFFSET", k)
        assert "STRAIGHT_TRAVERSE" not in names[k:at] and "STRAIGHT_FEED" not in names[k:at], "nothing moves before"
        taken.append(float(calls[at][1][0].split()[2]) * units.value)
    assert taken == pytest.approx([38.1, 25.4, 38.1], abs=0.005)


@pytest.mark.parametrize("name", ["fanuc", "haas", "mach3"])
def test_the_others_name_the_tools_own_row(name: str) -> None:
    table = {1: ToolOffset((0.0, 0.0, 38.1)), 2: ToolOffset((0.0, 0.0, 25.4))}
    post = load_post(name)
    nc = write_program(there_and_back().program(), job(), post)
    read = read_program(nc.text.encode(), ReadOptions(dialect=post.dialect, tool_table=table))
    assert read.problems == ()
    rows = [k for k, line in enumerate(read.motions.line) if line not in nc.home_lines]
    cutting = [(read.states[state].tool, read.states[state].length_offset) for state in read.motions.state[rows]]
    assert [key for key, _ in groupby(cutting)] == [(1, 1), (2, 2), (1, 1)]
    heights = read.motions.end[rows, 2].round(6)
    assert (min(heights), max(heights)) == (-2.0, 5.0), "the tip is where the path is, whatever the length"
