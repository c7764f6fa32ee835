"""What stands beside a program that is not the job's, and with which tools that is read."""

import pytest

from app.core.progress import Progress
from app.gcode.interpreter.options import ReadOptions
from app.gcode.interpreter.reader import read_program
from app.model.job import Job
from app.model.part import Part
from app.model.tool import Tool
from app.ui.views.nc.controller import tool_table
from app.ui.views.nc.motion_shapes import ViewSide
from app.ui.views.nc.program_panel import FACTS, ProgramPanel
from app.ui.views.nc.program_reader import ProgramSource, read_shown

PROGRAM = b"""(T1 flat 6 mm)
G21 G90 G17
T1 M6
S1000 M3
G0 X0 Y0 Z5
G1 Z-2 F100
G1 X30 F600
G1 X30 Y40
T7 M6
G0 Z5
G0 X-100 Y0
G1 Z-1 F100
M2
"""


@pytest.fixture
def panel(qtbot) -> ProgramPanel:
    made = ProgramPanel()
    qtbot.addWidget(made)
    return made


def test_it_tells_control_size_time_and_tools(panel):
    shown = read_shown(ProgramSource("part.nc", data=PROGRAM), ViewSide.XY, Progress())
    panel.show_program(shown)
    told = {name: panel.facts[name].text() for name in FACTS}
    assert told["Name"] == "part.nc" and told["Control"].endswith("(by its looks)")
    assert (told["Cuts in X"], told["Cuts in Y"]) == ("-100.000 … 30.000 mm", "0.000 … 40.000 mm")
    assert told["Cuts in Z"] == "-2.000 … 5.000 mm", "a plunge begins where the rapid ends"
    assert int(told["Motions"]) == len(shown.shapes)
    assert panel.tools == ["flat 6 mm", "not described"]


def test_nothing_of_the_program_before_stands_while_another_is_read(panel):
    panel.show_program(read_shown(ProgramSource("part.nc", data=PROGRAM), ViewSide.XY, Progress()))
    panel.show_program(None)
    assert not any(value.text() for value in panel.facts.values()) and panel.tools == []


def test_a_program_with_tools_that_the_job_has_not_is_read():
    job = Job(Part(), tools=(Tool(5, diameter=3.0),))
    options = ReadOptions(tool_table=tool_table(job))
    program = read_program(b"G21 G90 G17\nG0 Z5\nG43 H1\nG1 X30 F600\nM2\n", options)
    assert program.error is None and len(program.motions) >= 2
    compensated = b"G21 G90 G17\nT%d M6\nG0 X-9 Y0\nG41 D%d\nG1 X0 F100\nG1 X30 F600\nG40\nM2\n"
    assert read_program(compensated % (5, 5), options).error is None
    assert "needs the diameter of tool 1" in str(read_program(compensated % (1, 1), options).error)
