"""The path that is painted is the path that the program moves: arcs in every plane, helices, splines, jumps."""

import math

import numpy as np
import pytest

from app.gcode.interpreter.notes_operation import contour_motions
from app.gcode.interpreter.options import ReadOptions
from app.gcode.interpreter.program import ModalState, NcProgram
from app.gcode.interpreter.reader import read_program
from app.model.motion import MotionKind, Nurbs, Plane
from app.ui.framework.theme import LIGHT
from app.ui.views.canvas.painting.curve_path import ELEMENT
from app.ui.views.nc.line_marks import CUT, line_marks
from app.ui.views.nc.motion_hover import describe_motion, nearest_motion, outline
from app.ui.views.nc.motion_shapes import CONTOUR_INK, MotionLineStyle, ViewSide, shape_motions, tool_inks
from app.ui.views.nc.painting.motion_layer import MotionLayer, MotionPaint
from tests.ui.nc.hand_made import motions_of, program_of

CCW, CW, LINE, RAPID = MotionKind.ARC_CCW, MotionKind.ARC_CW, MotionKind.LINE, MotionKind.RAPID


@pytest.mark.parametrize("plane", list(Plane))
@pytest.mark.parametrize("kind", [CW, CCW])
def test_full_circle_in_each_plane_keeps_its_radius(plane, kind):
    u, v, w = plane.axes
    start, centre = np.zeros(3), np.zeros(3)
    start[u], centre[v] = 3.0, 4.0
    start[w] = centre[w] = 1.0
    shapes = shape_motions(NcProgram(motions_of([(kind, start, 1, {"centre": centre, "plane": plane})], start)))
    points = outline(shapes, 0)
    assert np.allclose(np.linalg.norm(points - centre, axis=1), 5.0, atol=3e-5)
    assert np.allclose(points[:, w], 1.0)
    assert np.allclose(points[-1], start)
    before, after = points[0] - centre, points[1] - centre
    turn = before[u] * after[v] - before[v] * after[u]
    assert (turn > 0) == (kind == CCW)


def test_helix_climbs_evenly_through_all_its_turns():
    rows = [(CCW, (5.0, 0.0, 6.0), 1, {"centre": (0.0, 0.0, 0.0), "turns": 3})]
    shapes = shape_motions(NcProgram(motions_of(rows, (5.0, 0.0, 0.0))))
    points = outline(shapes, 0)
    angle = np.unwrap(np.arctan2(points[:, 1], points[:, 0]))
    assert angle[-1] == pytest.approx(3 * math.tau)
    assert np.allclose(points[:, 2], angle / (3 * math.tau) * 6.0, atol=1e-3)
    assert shapes.length[0] == pytest.approx(math.hypot(3 * math.tau * 5, 6))


def test_spline_runs_through_its_ends_and_its_middle():
    curve = Nurbs(
        np.array([[0, 0, 0], [5, 10, 0], [10, 0, 0]], float), np.ones(3), np.array([0, 0, 0, 1, 1, 1], float), 2
    )
    motions = motions_of([(MotionKind.SPLINE, (10.0, 0.0, 0.0), 1)])
    object.__setattr__(motions, "splines", {0: curve})
    points = outline(shape_motions(NcProgram(motions)), 0)
    assert np.allclose(points[0], (0, 0, 0))
    assert np.allclose(points[-1], (10, 0, 0))
    assert np.min(np.linalg.norm(points - (5, 5, 0), axis=1)) < 1e-9


def test_looks_tell_rapids_plunges_and_cuts():
    shapes = shape_motions(
        program_of(
            [
                (RAPID, (0, 0, 5), 1),
                (LINE, (0, 0, -1), 2),
                (LINE, (9, 0, -1), 3),
                (LINE, (9, 0, 5), 4),
                (LINE, (9, 5, 0), 5),
            ]
        )
    )
    assert shapes.look.tolist() == [
        MotionLineStyle.RAPID,
        MotionLineStyle.PLUNGE,
        MotionLineStyle.CUT,
        MotionLineStyle.CUT,
        MotionLineStyle.CUT,
    ]


def test_elements_begin_anew_after_a_gap_and_after_a_jump():
    motions = motions_of([(LINE, (1, 0, 0), 1), (LINE, (2, 0, 0), 2), (LINE, (3, 0, 0), 3)])
    motions.start.setflags(write=True)
    motions.start[2] = (2, 7, 0)
    elements, at = shape_motions(NcProgram(motions)).elements(np.arange(3), ViewSide.XY)
    assert elements["kind"].tolist() == [0, 1, 1, 0, 1]
    assert elements.dtype == ELEMENT
    assert at.tolist() == [0, 2, 3, 5]
    assert (elements["x"][3], elements["y"][3]) == (2, 7)


def test_lines_of_loops_find_all_their_motions():
    shapes = shape_motions(
        program_of([(LINE, (1, 0, 0), 5), (LINE, (2, 0, 0), 6), (LINE, (3, 0, 0), 5), (LINE, (4, 0, 0), 9)])
    )
    assert shapes.of_rows(4, 4).tolist() == [0, 2]
    assert shapes.of_rows(4, 5).tolist() == [0, 2, 1]
    assert shapes.of_rows(6, 7).tolist() == []
    assert shapes.before_row(6) == 1
    assert shapes.before_row(3) is None


@pytest.mark.parametrize(
    ("side", "at", "found"),
    [(ViewSide.XY, (5, 0.2), 0), (ViewSide.XZ, (10.1, 2), 1), (ViewSide.YZ, (3, 5.1), 2), (ViewSide.XY, (5, 3), None)],
)
def test_nearest_motion_as_seen_from_a_side(side, at, found):
    shapes = shape_motions(program_of([(LINE, (10, 0, 0), 1), (LINE, (10, 0, 5), 2), (LINE, (10, 6, 5), 3)]))
    assert nearest_motion(shapes, side, at, 0.5) == found


def test_of_motions_on_one_another_the_nearest_to_the_eye_is_picked():
    shapes = shape_motions(program_of([(LINE, (10, 0, 0), 1), (LINE, (10, 0, -5), 2), (LINE, (0, 0, -5), 3)]))
    assert nearest_motion(shapes, ViewSide.XY, (5, 0), 0.5) == 0


def test_arc_is_found_on_its_curve_only():
    shapes = shape_motions(NcProgram(motions_of([(CCW, (-5, 0, 0), 1, {"centre": (0, 0, 0)})], (5, 0, 0))))
    assert nearest_motion(shapes, ViewSide.XY, (3.536, 3.536), 0.01) == 0
    assert nearest_motion(shapes, ViewSide.XY, (3.536, -3.536), 0.5) is None


def test_a_motion_is_told_in_words():
    program = program_of([(RAPID, (3, 4, 0), 7), (LINE, (3, 4, -2), 8)], (ModalState(tool=3),))
    shapes = shape_motions(program)
    assert describe_motion(shapes, 0) == "Rapid · line 7 · T3 · 5.000 mm · Z 0.000"
    assert describe_motion(shapes, 1) == "Line · line 8 · T3 · F 600 · 2.000 mm · Z 0.000 to -2.000"


def test_picture_of_a_read_program_reaches_as_far_as_its_arcs():
    program = read_program(b"G21 G90 G17\nG0 X0 Y0 Z0\nG2 X0 Y0 I10 J0 F100\nM2\n")
    box = MotionLayer(shape_motions(program), ViewSide.XY).box
    assert box == pytest.approx((0, -10, 20, 10), abs=0.3)


def test_a_program_without_motions_has_a_picture():
    picture = MotionLayer(shape_motions(read_program(b"(nothing)\n")), ViewSide.YZ)
    assert picture.box is None


def test_contours_have_the_colour_of_the_paths_view_whatever_tool_cuts_them():
    text = "G21 G90\nT1 M6\n(Pocket T1: depth 1 mm)\nG1 X1 F100\n(Contour T1: depth 1 mm)\nG1 X2\n"
    text += "T2 M6\n(Rest T2: depth 1 mm)\nG1 X3\nT3 M6\n(Contour T3: depth 1 mm)\nG1 X4\nM2\n"
    program = read_program(text.encode(), ReadOptions())
    shapes = shape_motions(program, contour_motions(text.encode(), program))
    assert tool_inks(shapes) == {1: 0, 2: 2, 3: CONTOUR_INK}
    cuts = [3, 5, 8, 11]
    assert [code - CUT for code in line_marks(13, shapes).by_tool[cuts].tolist()] == [0, CONTOUR_INK, 2, CONTOUR_INK]
    assert LIGHT.tools[:3] == (LIGHT.pocket, LIGHT.contour, LIGHT.rest)


def test_a_second_tool_for_contours_alone_has_its_own_colour_in_text_picture_and_cut():
    """Text and picture had both in that of contours, while the cut told them apart."""
    text = "G21 G90\nT1 M6\n(Contour T1: depth 1 mm)\nG1 X1 F100\nT2 M6\n(Contour T2: depth 1 mm)\nG1 X3\nM2\n"
    program = read_program(text.encode(), ReadOptions())
    shapes = shape_motions(program, contour_motions(text.encode(), program))
    inks = tool_inks(shapes)
    assert inks == {1: CONTOUR_INK, 2: 0}
    assert [code - CUT for code in line_marks(8, shapes).by_tool[[3, 6]].tolist()] == [inks[1], inks[2]]
    key = MotionLayer(shapes, ViewSide.XY).key(MotionPaint(LIGHT))
    assert [row.colour for row in key] == [LIGHT.tools[inks[1]], LIGHT.tools[inks[2]]]


def test_a_tool_has_the_colour_that_it_has_in_the_cut_in_the_text_of_each_file():
    """Of a program with a file for each tool each text began with the first colour."""
    texts = [f"G21 G90\nT{number} M6\nG1 X{number} F100\nM2\n".encode() for number in (1, 2)]
    files = [shape_motions(read_program(text, ReadOptions())) for text in texts]
    assert tool_inks(*files) == {1: 0, 2: 1}
    assert [line_marks(4, each, files=files).by_tool[2] - CUT for each in files] == [0, 1]


def test_a_program_that_does_not_tell_its_contours_has_the_cycle_of_tools():
    text = b"G21 G90\nT4 M6\nG1 X1 F100\nT2 M6\nG1 X2\nM2\n"
    assert tool_inks(shape_motions(read_program(text, ReadOptions()))) == {4: 0, 2: 1}
