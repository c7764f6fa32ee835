"""The bar beside each line tells what the line moves."""

import pytest

from app.gcode.interpreter.reader import read_program
from app.model.motion import MotionKind
from app.ui.framework.theme import LIGHT
from app.ui.views.nc.line_marks import CUT, NOTHING, PLUNGE, RAPID, kind_of, line_marks
from app.ui.views.nc.motion_shapes import shape_motions
from app.ui.views.nc.painting.motion_layer import MotionColourBy, motion_colour, tool_colour
from app.ui.views.nc.painting.text_painter import LINE_PX
from app.ui.views.nc.program_text import program_text
from app.ui.views.nc.text_view import NcTextView

PROGRAM = (
    b"G21 G90 G17\nT2 M6\nG0 X0 Y0 Z5\nG1 Z-1 F100\nX40\nG0 Z5\nT1 M6\nG0 X0\nG1 Z-1\nG3 X0 Y20 J10\nG1 X9 Z5\nM2\n"
)


@pytest.fixture
def looks():
    shapes = shape_motions(read_program(PROGRAM))
    assert shapes.program.error is None
    return line_marks(12, shapes)


def test_lines_tell_rapids_plunges_and_the_order_of_their_tool(looks):
    assert looks.by_tool.tolist() == [
        NOTHING,
        NOTHING,
        RAPID,
        PLUNGE,
        CUT,
        RAPID,
        NOTHING,
        RAPID,
        PLUNGE,
        CUT + 1,
        CUT + 1,
        NOTHING,
    ]


def test_lines_tell_the_kind_of_motion(looks):
    assert kind_of(int(looks.by_motion[9])) is MotionKind.ARC_CCW
    assert kind_of(int(looks.by_motion[10])) is MotionKind.LINE


@pytest.mark.parametrize(
    ("colour", "row", "expected"),
    [
        (MotionColourBy.TOOL, 4, tool_colour(0, LIGHT)),
        (MotionColourBy.TOOL, 9, tool_colour(1, LIGHT)),
        (MotionColourBy.TOOL, 2, LIGHT.rapid),
        (MotionColourBy.MOTION, 9, motion_colour(MotionKind.ARC_CCW, LIGHT)),
        (MotionColourBy.MOTION, 3, LIGHT.plunge),
        (MotionColourBy.TOOL, 0, LIGHT.canvas),
    ],
)
def test_bars_are_painted(qtbot, looks, colour, row, expected):
    view = NcTextView()
    qtbot.addWidget(view)
    view.resize(400, 14 * LINE_PX)
    view.show_text(program_text(PROGRAM))
    view.show_looks(looks)
    view.set_colour(colour)
    assert view.grab().toImage().pixelColor(13, row * LINE_PX + LINE_PX // 2) == expected
