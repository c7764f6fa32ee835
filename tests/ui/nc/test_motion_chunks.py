"""What is painted: contours in dashes that go on from block to block, and no way to a place that only the machine
knows.
"""

from dataclasses import replace

import numpy as np
import pytest
from PySide6.QtCore import QRectF
from PySide6.QtGui import QImage, QPainter

from app.gcode.interpreter.dialect import Dialect
from app.gcode.interpreter.notes_operation import contour_motions
from app.gcode.interpreter.options import ReadOptions
from app.gcode.interpreter.reader import read_program
from app.model.motion_path import anchored
from app.ui.framework.theme import LIGHT
from app.ui.views.canvas.view_transform import ViewTransform
from app.ui.views.nc.motion_hover import describe_motion, nearest_motion
from app.ui.views.nc.motion_shapes import MotionLineStyle, ViewSide, shape_motions
from app.ui.views.nc.painting.motion_chunks import contour_chunks
from app.ui.views.nc.painting.motion_layer import MotionColourBy, MotionLayer, MotionPaint
from app.ui.views.nc.state_words import state_items

START = "G21 G90\nT1 M6\nG0 X0 Y5 Z5\nG1 Z0 F100\n"


def shapes_of(text, dialect=Dialect.LINUXCNC):
    program = read_program(text.encode(), ReadOptions(dialect))
    assert program.error is None
    program = replace(program, motions=anchored(program.motions))
    return shape_motions(program, contour_motions(text.encode(), program))


def row_of_pixels(shapes, colour=MotionColourBy.TOOL, y=5.0):
    """Which pixels of the row at y of a picture 10 px to a mm are painted, x from 0.5 to 39.5 mm."""
    image = QImage(400, 100, QImage.Format.Format_RGB32)
    image.fill(0xFFFFFF)
    painter = QPainter(image)
    MotionLayer(shapes, ViewSide.XY).paint(
        painter, ViewTransform(10.0, 0.0, 100.0), (0, 0, 40, 10), MotionPaint(LIGHT, colour)
    )
    painter.end()
    line = round(100 - 10 * y)
    return np.array([any(image.pixel(x, line + d) & 0xFFFFFF != 0xFFFFFF for d in (-1, 0)) for x in range(5, 395)])


def runs(on):
    """Lengths of the stretches of equal values, without the first and the last."""
    edges = np.flatnonzero(np.diff(on.astype(int)))
    return np.diff(edges)


@pytest.mark.parametrize("colour", list(MotionColourBy))
@pytest.mark.parametrize("step", [40.0, 0.5, 0.13])
def test_a_contour_is_dashed_evenly_whatever_its_blocks(colour, step):
    ends = np.minimum(np.arange(1, round(40 / step) + 1) * step, 40)
    blocks = "".join(
        f"G{1 if k % 3 else 2} X{x:.3f} Y5{'' if k % 3 else ' R9999'}\n" for k, x in enumerate(ends.tolist())
    )
    on = row_of_pixels(shapes_of(f"{START}(Contour T1: depth 1 mm)\n{blocks}M2\n"), colour)
    lengths = runs(on)
    assert len(lengths) > 60
    assert lengths.max() <= 8
    assert lengths.min() >= 2


def test_a_pocket_is_solid():
    assert row_of_pixels(shapes_of(f"{START}(Pocket T1: depth 1 mm)\nG1 X40\nM2\n")).all()


def test_a_second_pass_keeps_the_dashes_of_the_first():
    contour = "(Contour T1: depth 1 mm)\n"
    again = "G1 X20\nX40\nG0 Z5\nY9\nX0\nY5\nG1 Z-1\n" * 5 + "G1 X20\nX40\n"
    once = row_of_pixels(shapes_of(START + contour + "G1 X40\nM2\n"))
    assert (row_of_pixels(shapes_of(START + contour + again + "M2\n")) == once).mean() > 0.97


def test_passes_without_a_lift_between_keep_the_dashes_of_the_first():
    contour, loop = "(Contour T1: depth 1 mm)\n", "G1 X20 Y5\nX40\nY6.37\nX0\nY5\n"
    ramp = "G1 X13 Y5\n"
    once = row_of_pixels(shapes_of(START + contour + loop + "M2\n"))
    down = row_of_pixels(shapes_of(START + contour + ramp + "X0\n" + loop * 7 + "M2\n"))
    assert (down[170:] == once[170:]).mean() > 0.97


def test_passes_without_a_lift_between_are_cut_alike():
    """Fine pens count dashes in steps of pixels along the longer axis: only paths cut alike have them alike."""
    turns = np.linspace(0, 2 * np.pi, 201)[1:]
    blocks = [f"G1 X{10 * np.cos(t):.3f} Y{10 * np.sin(t):.3f}\n" for t in turns]
    ramp, loop = "".join(blocks[:25]) + "X10 Y0\n", "".join(blocks)
    text = f"G21 G90\nT1 M6\nG0 X10 Y0 Z5\nG1 Z0 F100\n(Contour T1: depth 1 mm)\n{ramp}{loop * 3}M2\n"
    shapes = shapes_of(text)
    rows = np.flatnonzero(shapes.look == MotionLineStyle.CONTOUR)
    begins = [round(each.begins_at, 6) for each in contour_chunks(shapes, ViewSide.XY, rows, by_kind=False).chunks]
    assert begins[-9:-6] == begins[-6:-3] == begins[-3:] and begins[-3] == 0 < begins[-2] < begins[-1]


def test_a_pass_over_tabs_keeps_the_dashes_of_those_above():
    contour = "(Contour T1: depth 1 mm)\n"
    tabs = "G1 X12.7\nZ1\nX17.9\nZ0\nX31.1\nZ1\nX33\nZ0\nX40\n"
    once = row_of_pixels(shapes_of(START + contour + "G1 X12.7\nX17.9\nX31.1\nX33\nX40\nM2\n"))
    both = f"G1 X12.7\nX17.9\nX31.1\nX33\nX40\nG0 Z5\nY9\nX0\nY5\nG1 Z0\n{tabs}"
    assert (row_of_pixels(shapes_of(START + contour + both + "M2\n")) == once).mean() > 0.97


HOMING = "G21 G90\nG0 X1 Y1 Z5\nG1 Z0 F100\nX9 Z1\n{home}\nG0 X9 Y9\nG1 Z1\nX0 Y9 Z1\nM30\n"


@pytest.mark.parametrize(
    ("home", "dialect", "sides"),
    [
        ("G53 G0 Z0", Dialect.LINUXCNC, (ViewSide.XZ, ViewSide.YZ)),
        ("G28 X4 Y4 Z7", Dialect.LINUXCNC, tuple(ViewSide)),
        ("G91 G28 Z0.\nG90", Dialect.FANUC, (ViewSide.XZ, ViewSide.YZ)),
        ("G30 X3 Y3 Z7", Dialect.LINUXCNC, tuple(ViewSide)),
    ],
)
def test_ways_to_the_machines_home_and_back_are_not_painted(home, dialect, sides):
    text = HOMING.format(home=home) if dialect is not Dialect.FANUC else HOMING.replace(" Z5", " Z5.").format(home=home)
    shapes = shapes_of(text, dialect)
    away = shapes.program.homeward[-1]
    assert shapes.length[away] == 0
    for side in ViewSide:
        seen = MotionLayer(shapes, side).shapes.seen(side).tolist()
        assert (away not in seen) == (side in sides)
        assert set(range(away)) <= {*seen, *shapes.program.homeward}
        assert len(shapes) - 1 in seen
    assert "to the machine's home" in describe_motion(shapes, away)


def test_the_box_of_the_picture_has_only_places_of_the_part():
    shapes = shapes_of("G21 G90\nG0 X10 Y10 Z5\nG1 Z0 F100\nX20\nG28 X11 Y11 Z5\nG0 X20 Y20\nG1 X10\nM2\n")
    assert MotionLayer(shapes, ViewSide.XY).box == pytest.approx((10, 10, 20, 20))
    assert nearest_motion(shapes, ViewSide.XY, (5, 5), 0.5) is None


def test_the_strip_says_that_it_goes_home():
    shapes = shapes_of(HOMING.format(home="G53 G0 Z0"))
    words = [f"{item.name} {item.value}".strip() for item in state_items(shapes, 4)]
    assert "to the machine's home" in words
    assert "Z home" in words
    assert "X 9.000" in words
    assert "Z 1.000" in [f"{item.name} {item.value}" for item in state_items(shapes, 6)]


def test_only_some_motions_are_painted():
    shapes = shapes_of(f"{START}G1 X20\nX40\nM2\n")
    painted = MotionLayer(shapes, ViewSide.XY, np.array([3]))
    assert painted.box == pytest.approx((20, 5, 40, 5))
    assert painted.some
    assert not MotionLayer(shapes, ViewSide.XY, np.array([], np.int64)).some
    assert QRectF(*painted._chunks[MotionColourBy.TOOL].boxes[0].tolist()).left() == 20
