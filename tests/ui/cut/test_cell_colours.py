"""What the colours of the metal tell."""

from dataclasses import replace

import numpy as np
import pytest
from PySide6.QtGui import QColor

from app.ui.framework.theme import DARK, LIGHT
from app.ui.views.cut.cell_colours import OUT_OF_REACH, STOCK, CutColourBy, cell_colours, possible
from app.ui.views.cut.cut_picture import CutMoves, CutPicture
from app.ui.views.cut.relief import relief
from app.ui.views.cut.theme_colours import colormap_of
from app.ui.views.nc.painting.motion_layer import tool_colour
from tests.ui.cut.pictures import INKS

MOVE = np.array([[-1, 0], [1, 2]], np.int32)
MOVES = CutMoves(np.array([10, 20, 30], np.int32), np.array([5, 2, 5], np.int32), np.array([0, 1, 1], np.int32))


def picture(**more):
    return CutPicture(np.array([[0.0, -1.0], [-2.0, -4.0]], np.float32), 0.0, 0.0, 1.0, -10.0, 0.0, **more)


def test_only_what_is_known_is_offered_and_the_rest_is_metal():
    assert possible(picture()) == (CutColourBy.METAL, CutColourBy.DEPTH)
    assert set(possible(picture(move=MOVE, moves=MOVES))) == set(CutColourBy) - {CutColourBy.DEVIATION}
    made = cell_colours(picture(), CutColourBy.DEVIATION, INKS)
    assert made.values.tolist() == [[STOCK, 0], [0, 0]]
    assert tuple(made.key.palette[0, :3]) == INKS.metal


def test_depth_runs_from_the_top_to_the_deepest_cell():
    made = cell_colours(picture(), CutColourBy.DEPTH, INKS)
    assert made.values.tolist() == [[STOCK, round(253 * 0.75)], [round(253 * 0.5 + 0.01), 0]]
    assert [tick.text for tick in made.key.ticks] == ["-4.000", "-3.000", "-2.000", "-1.000", "0.000"]
    assert tuple(made.key.palette[0, :3]) == INKS.depth[-1]


def test_tools_and_surfaces_have_a_colour_each_and_a_name():
    made = cell_colours(picture(move=MOVE, moves=MOVES), CutColourBy.TOOL, INKS)
    assert made.values.tolist() == [[STOCK, 0], [1, 0]]
    assert [name for _, name in made.key.names] == ["T5", "T2"]  # in the order of their first move
    surfaces = cell_colours(picture(move=MOVE, moves=MOVES), CutColourBy.SURFACE, INKS)
    assert surfaces.values.tolist() == [[STOCK, 0], [1, 1]]


def test_tools_have_other_places_in_the_cycle_where_contours_have_theirs():
    made = cell_colours(picture(move=MOVE, moves=replace(MOVES, inks={5: 0, 2: 2})), CutColourBy.TOOL, INKS)
    assert made.key.names == ((INKS.tools[0], "T5"), (INKS.tools[2], "T2"))
    assert [tuple(made.key.palette[place, :3]) for place in (0, 1)] == [INKS.tools[0], INKS.tools[2]]


@pytest.mark.parametrize("theme", [LIGHT, DARK], ids=["light", "dark"])
def test_a_tool_has_the_colour_that_it_has_in_the_nc_view(theme):
    """Tools of the text were green and orange, and green and pink in the cut."""
    of_cells = colormap_of(theme).tools
    assert [QColor(*of_cells[k % len(of_cells)]) for k in range(20)] == [tool_colour(k, theme) for k in range(20)]


def test_order_of_moves_is_told_by_their_lines():
    made = cell_colours(picture(move=MOVE, moves=MOVES), CutColourBy.MOVE, INKS)
    assert made.values[0, 0] == STOCK
    assert made.values[0, 1] < made.values[1, 0] < made.values[1, 1]
    assert (made.key.ticks[0].text, made.key.ticks[-1].text) == ("line 10", "line 30")


@pytest.mark.parametrize(
    ("deviation", "colour"), [(0.0, INKS.right), (0.009, INKS.right), (3.0, INKS.left), (-3.0, INKS.gouge)]
)
def test_deviation_within_tolerance_is_plain_and_the_worst_has_the_full_colour(deviation, colour):
    values = np.array([[3.0, deviation], [-3.0, 0.0]], np.float32)
    made = cell_colours(picture(deviation=values), CutColourBy.DEVIATION, INKS)
    assert np.allclose(made.key.palette[made.values[0, 1], :3], colour, atol=1)


def test_a_small_gouge_is_not_taken_for_right_beside_a_large_one():
    values = np.array([[-3.0, -0.012], [0.012, 3.0]], np.float32)
    made = cell_colours(picture(deviation=values), CutColourBy.DEVIATION, INKS)
    small, left = (made.key.palette[made.values[place], :3].astype(int) for place in ((0, 1), (1, 0)))
    assert small[0] - small[2] > 30
    assert left[2] - left[0] > 30


def test_what_no_tool_reaches_is_told_apart_from_what_is_left():
    values = np.array([[0.0, 1.0], [1.0, 0.0]], np.float32)
    made = cell_colours(
        picture(deviation=values, unreachable=values.astype(bool) & [[True, True], [False, True]]),
        CutColourBy.DEVIATION,
        INKS,
    )
    assert made.values[0, 1] == OUT_OF_REACH
    assert made.values[1, 0] < OUT_OF_REACH
    assert made.values[0, 0] == STOCK


def test_normals_are_those_of_the_slope():
    y, x = np.mgrid[0:40, 0:50].astype(np.float32) * np.float32(0.1)
    root = relief(0.8 * x - 0.4 * y, 0.1)[..., :2].astype(float) / 127 - 128 / 127
    normal = root * np.abs(root)
    assert np.allclose(normal[..., 0] / normal[..., 1], -2.0, rtol=0.05)
    assert np.all(normal[..., 0] < 0)


def test_corners_are_darker_and_planes_are_not():
    x = np.arange(128, dtype=np.float32)[None] * np.ones((128, 1), np.float32)
    assert np.all(relief(0.05 * x, 0.1)[..., 2][20:-20, 20:-20] >= 253)
    step = np.where(x < 64, np.float32(0.0), np.float32(-5.0))
    light = relief(step, 0.1)[..., 2]
    assert light[64, 68] < 200
    assert light[64, 120] > 250
    assert np.all(light[40:90, 20:60] == 255)


def test_a_channel_of_another_size_is_refused():
    with pytest.raises(ValueError, match="another size"):
        picture(move=np.zeros((3, 3), np.int32))
