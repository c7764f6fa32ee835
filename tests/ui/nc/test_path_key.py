"""The key says what lines mean, and after a fit it never lies on what is cut."""

import pytest
from PySide6.QtCore import QRectF

from app.gcode.interpreter.notes_operation import contour_motions
from app.gcode.interpreter.reader import read_program
from app.model.motion import MotionKind
from app.ui.framework.theme import DARK, LIGHT
from app.ui.views.nc.motion_shapes import ViewSide, shape_motions
from app.ui.views.nc.painting.motion_layer import MotionColourBy, MotionLayer, MotionPaint
from app.ui.views.nc.painting.path_key import KeyCorner, KeyMark, beside_key, cuts_within, key_place, key_size
from app.ui.views.nc.path_view import PathView
from tests.ui.nc.hand_made import program_of

RAPID, LINE, CCW = MotionKind.RAPID, MotionKind.LINE, MotionKind.ARC_CCW
FRAME = b"G21 G90\nT1 M6\nG0 X0 Y0 Z5\nG1 Z-1 F100\nX80\nY80\nX0\nY0\nM2\n"
TRIANGLE = b"G21 G90\nT1 M6\nG0 X0 Y0 Z5\nG1 Z-1 F100\nX80\nY80\nX0 Y0\nM2\n"
TWO = (
    b"G21 G90\n(T1 flat 6 mm)\nT1 M6\n(Pocket T1: depth 1 mm)\nG1 X0 Y0 Z0 F100\nX9\n(Contour T1: depth 1 "
    b"mm)\nY9\nG2 X0 Y0 R20\nM2\n"
)


def picture_of(data, side=ViewSide.XY):
    program = read_program(data)
    return MotionLayer(shape_motions(program, contour_motions(data, program)), side)


def rectangle(view):
    """Where the key is, in mm."""
    return view.view.world_box(key_place(key_size(view._key()), view.area, view.corner))


@pytest.fixture
def view(qtbot):
    made = PathView()
    qtbot.addWidget(made)
    return made


@pytest.mark.parametrize("data", [FRAME, TRIANGLE, TWO])
@pytest.mark.parametrize("size", [(220, 160), (260, 400), (460, 460), (900, 300)])
@pytest.mark.parametrize("side", list(ViewSide))
def test_no_cut_is_under_the_key_after_a_fit(view, data, size, side):
    view.resize(*size)
    picture = picture_of(data, side)
    view.show_pictures(picture)
    view.fit_now()
    assert not cuts_within(picture.shapes, side, rectangle(view))
    view.resize(size[1] + 60, size[0] + 60)
    assert not cuts_within(picture.shapes, side, rectangle(view)), "the key does not follow a new size"


def test_the_key_goes_to_the_corner_that_is_free(view):
    view.resize(300, 300)
    view.show_pictures(picture_of(TRIANGLE))
    view.fit_now()
    assert view.corner is KeyCorner.TOP_LEFT


def test_a_key_without_lines_takes_no_room():
    area = QRectF(0, 0, 300, 200)
    assert beside_key(key_size([]), area) == (area, area)


@pytest.mark.parametrize(
    ("box", "within"),
    [
        ((4, 4, 6, 6), True),
        ((0, 6, 3, 9), False),
        ((-1, -1, 11, 11), True),
        ((10.1, 0, 12, 20), False),
        ((-6, 12, -4, 22), False),
    ],
)
def test_a_slanting_line_comes_only_into_boxes_on_its_way(box, within):
    shapes = shape_motions(program_of([(RAPID, (0, 20, 5), 1), (RAPID, (0, 0, 0), 2), (LINE, (10, 10, 0), 3)]))
    assert cuts_within(shapes, ViewSide.XY, box) is within


@pytest.mark.parametrize(
    ("box", "within"),
    [((-1, -1, 1, 1), False), ((4.5, -1, 5.5, 1), True), ((3.8, 3.8, 6, 6), False), ((3, 3, 4, 4), True)],
)
def test_a_circle_is_where_its_line_is(box, within):
    shapes = shape_motions(program_of([(RAPID, (5, 0, 0), 1), (CCW, (5, 0, 0), 2, {"centre": (0, 0, 0)})]))
    assert cuts_within(shapes, ViewSide.XY, box) is within


@pytest.mark.parametrize("theme", [LIGHT, DARK])
def test_the_key_tells_contours_by_their_dashes(theme):
    rows = picture_of(TWO).key(MotionPaint(theme))
    assert [(row.words, row.mark is KeyMark.DASHES) for row in rows] == [
        ("T1 flat 6 mm", False),
        ("T1 flat 6 mm, contour", True),
    ]
    rows = picture_of(TWO).key(MotionPaint(theme, MotionColourBy.MOTION))
    assert [(row.words, row.mark is KeyMark.DASHES) for row in rows] == [
        ("G1 line", False),
        ("G2 clockwise", False),
        ("Contour", True),
    ]
