"""What stands beside a program that is not the job's."""

import pytest

from app.core.progress import Progress
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
