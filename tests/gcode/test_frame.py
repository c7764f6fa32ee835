"""The frame program: rapids alone, round the box, at clearance, with the tool's length and a spindle that stands
still.
"""

from __future__ import annotations

import numpy as np
import pytest

from app.core.errors import ParameterError
from app.gcode.interpreter.options import ReadOptions, ToolOffset
from app.gcode.interpreter.program import EventKind
from app.gcode.interpreter.reader import read_program
from app.gcode.posts import load_post, post_names
from app.gcode.rework.frame import JobFrame, frame_text
from app.gcode.timing.extent import NOWHERE, Extent
from app.model.motion import MotionKind
from app.model.part import Units
from tests.gcode.programs import job
from tests.gcode.rs274_oracle import canonical_calls

BOX = Extent((-12.5, 3.0, -4.0), (40.0, 33.25, 1.0))


@pytest.mark.parametrize("name", post_names())
@pytest.mark.parametrize("units", [Units.MM, Units.INCH], ids=["mm", "inch"])
@pytest.mark.parametrize("number", [0, 3])
def test_it_goes_round_the_box_and_does_nothing_else(name: str, units: Units, number: int) -> None:
    post = load_post(name)
    text = frame_text(JobFrame(BOX, 7.0, number), job(out_units=units), post)
    read = read_program(text.encode(), ReadOptions(dialect=post.dialect, tool_table={3: ToolOffset((0, 0, 50.0))}))
    assert read.problems == ()
    motions = read.motions
    assert set(motions.kind.tolist()) == {MotionKind.RAPID}
    assert not any(state.spindle or state.flood or state.mist for state in read.states)
    assert {event.kind for event in read.events} <= {EventKind.TOOL_CHANGE, EventKind.END}
    first = min(motions.known_from[:2])
    assert motions.known_from[2] < first
    round_ = slice(first, first + 5)
    assert np.allclose(motions.end[first - 1 : first + 5, 2], 7.0, atol=0.002)
    assert np.all(motions.end[first + 5 :, :2] == motions.end[first + 4, :2])
    corners = [(-12.5, 3.0), (40.0, 3.0), (40.0, 33.25), (-12.5, 33.25), (-12.5, 3.0)]
    assert motions.end[round_, :2] == pytest.approx(np.array(corners), abs=0.0015)
    changes = number and not post.file_per_tool
    assert [event.value for event in read.events if event.kind is EventKind.TOOL_CHANGE] == ([3.0] if changes else [])
    assert {read.states[k].length_offset for k in motions.state[round_].tolist()} == ({3} if changes else {0})


def test_linuxcnc_takes_it() -> None:
    calls = canonical_calls(frame_text(JobFrame(BOX, 7.0, 3), job(), load_post("linuxcnc")))
    assert [name for name, _ in calls if name.startswith(("STRAIGHT", "ARC"))] == ["STRAIGHT_TRAVERSE"] * 6
    assert "START_SPINDLE_CLOCKWISE" not in [name for name, _ in calls]


def test_nothing_to_go_round_is_told() -> None:
    with pytest.raises(ParameterError, match="Nothing is cut"):
        frame_text(JobFrame(NOWHERE, 5.0), job(), load_post("linuxcnc"))
