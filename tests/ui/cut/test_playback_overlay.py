"""Tool, cells that change and facets in the Cut view: what is shown, and when it is painted."""

from dataclasses import replace

import numpy as np
import pytest

from app.model.tool import Tool
from app.model.tool_kind import ToolKind
from app.simulation.gpu.wedges_picture import wedges_picture
from app.ui.framework.theme import DARK, LIGHT
from app.ui.views.cut.cell_colours import CutColourBy
from app.ui.views.cut.cell_patch import patch_of
from app.ui.views.cut.rendering.cut_scene import CutScene
from app.ui.views.cut.view import CutView
from tests.ui.cut.made_up import made_up
from tests.ui.cut.pictures import without_a_screen
from tests.ui.cut.test_cut_view import on_screen, pixels

BALL = Tool(
    1, 6.0, ToolKind.BALL, flute_length=12.0, stick_out=25.0, shank_diameter=6.0, holder=((0.0, 9.0), (15.0, 9.0))
)
TIP = (34.0, 50.0, -9.0)


@pytest.fixture
def view(qtbot):
    without_a_screen().release()
    made = CutView()
    qtbot.addWidget(made)
    made.resize(900, 600)
    made.set_theme(LIGHT)
    made.show()
    picture = made_up(200)
    made.show_cut(replace(picture, heights=picture.heights.copy(), values={}))
    qtbot.waitUntil(lambda: made.render_scheduler.fine, timeout=20_000)
    return made


def rest(qtbot, view):
    qtbot.waitUntil(lambda: view.render_scheduler.fine, timeout=20_000)
    return pixels(view)


def at(image, view, place, aside=0):
    point = on_screen(view, place)
    return image[point.y(), point.x() + aside]


@pytest.mark.exhaustive
def test_the_tool_is_shown_in_the_colour_of_its_cuts_by_day_and_by_night(qtbot, view):
    middle = (TIP[0], TIP[1], TIP[2] + 6.0)
    bare = rest(qtbot, view)
    for number, theme in ((1, LIGHT), (2, LIGHT), (2, DARK)):
        view.set_theme(theme)
        view.playback.show_tool(replace(BALL, number=number), TIP)
        shown = at(rest(qtbot, view), view, middle, 4)
        ink = np.array(theme.tools[number - 1].getRgb()[:3])
        assert np.argmax(shown) == np.argmax(ink) and np.argmin(shown) == np.argmin(ink)
    view.set_theme(LIGHT)
    view.playback.show_tool(None, None)
    assert np.array_equal(rest(qtbot, view), bare)


@pytest.mark.exhaustive
def test_a_tool_that_moves_sixty_times_a_second_is_painted_coarsely_and_finely_once_it_rests(qtbot, view):
    stirred, rested, painted = [], [], []
    view.render_scheduler.stirred.connect(lambda: stirred.append(True))
    view.render_scheduler.rested.connect(lambda: rested.append(True))
    view.render_scheduler._rest.setInterval(
        60_000
    )  # however busy the machine is, it does not rest before it is told to
    paint = view.render_scheduler.paint
    view.render_scheduler.surface._paint = lambda scene: (painted.append(view.render_scheduler.due), paint(scene))
    for k in range(40):
        for part in (0.0, 0.25, 0.5, 0.75):
            view.playback.show_tool(BALL, (TIP[0] + 0.1 * (k + part), TIP[1], TIP[2]))
        qtbot.wait(16)
        assert not view.render_scheduler.fine
    assert 5 < sum(painted) <= 41, "one coarse picture a turn of the event loop, not one a call"
    assert not stirred and not rested, "the view was not moved: no finer look is given up or begun"
    view.render_scheduler._rest.start(0)
    qtbot.waitUntil(lambda: view.render_scheduler.fine, timeout=20_000)
    assert len(rested) == 1
    count = len(painted)
    view.playback.show_tool(BALL, view.playback.tip)
    qtbot.wait(200)
    assert view.render_scheduler.fine and not any(painted[count:])


def test_cells_that_change_are_shown_and_kept(qtbot, view):
    before = rest(qtbot, view)
    heights, colours = view.model.picture.heights.copy(), view.model.picture.values[CutColourBy.METAL].copy()
    place = (slice(10, 30), slice(120, 190))
    heights[place], colours[place] = -6.0, 0
    view.model.picture.move[place] = 0
    view.render_scheduler.patch(patch_of(heights, colours, view.model.picture.pitch, place))
    after = rest(qtbot, view)
    assert np.any(after != before)
    assert view.cut_input.probe(view.rect().center().toPointF()) is not None
    assert np.array_equal(view.model.picture.heights, heights)
    view.render_scheduler.renew()
    assert np.array_equal(rest(qtbot, view), after)
    view.set_colour(CutColourBy.DEPTH)
    qtbot.waitUntil(
        lambda: view.model.colour_shown in view.model.picture.values and view.render_scheduler.fine, timeout=20_000
    )
    assert view.model.picture.values[CutColourBy.DEPTH][20, 150] != view.model.picture.values[CutColourBy.DEPTH][5, 150]


def test_cells_and_colours_that_change_together_are_those_of_the_picture(qtbot, view):
    heights, colours = view.model.picture.heights.copy(), view.model.picture.values[CutColourBy.METAL].copy()
    place = (slice(10, 30), slice(120, 190))
    heights[place], colours[place] = -6.0, 0
    view.render_scheduler.patch(patch_of(heights, colours, view.model.picture.pitch, place))
    view.model.picture.move[place] = 0
    view.set_colour(CutColourBy.TOOL)
    qtbot.waitUntil(lambda: CutColourBy.TOOL in view.model.picture.values, timeout=20_000)
    shown = rest(qtbot, view)
    view.render_scheduler.renew()
    assert np.array_equal(rest(qtbot, view), shown)


def test_wedges_have_a_row_for_a_tool_and_are_off_at_first(qtbot, view):
    row = view.legend.wedges
    assert not row.isVisible() and not row.isChecked()
    bare = rest(qtbot, view)
    tips = np.array([[20.0, 30.0, -6.0], [30.0, 32.0, -7.0], [34.0, 44.0, -8.0], TIP])
    view.playback.show_wedges(wedges_picture(tips, BALL))
    assert row.label.text() == "Wedges  d = 0.38 mm" and "facets of d = 0.38 mm" in row.toolTip()
    assert np.array_equal(rest(qtbot, view)[:, :600], bare[:, :600])
    view.playback.show_tool(BALL, TIP)
    assert row.isVisible() and view.legend.geometry().contains(row.mapTo(view, row.rect().bottomRight()))
    without = rest(qtbot, view)
    told = []
    view.legend.wedges_switched.connect(told.append)
    row.click()
    assert told == [True]
    shown = rest(qtbot, view)
    assert np.count_nonzero(np.abs(shown - without)[:, :600].max(axis=2) > 20) > 300
    view.playback.show_wedges(None)
    assert np.array_equal(rest(qtbot, view)[:, :600], without[:, :600])
    view.playback.show_tool(replace(BALL, kind=ToolKind.FLAT), TIP)
    assert row.isVisible(), "every cutter has facets"
    view.playback.show_tool(None, None)
    assert not row.isVisible()


def test_a_new_scene_shows_all_of_it_again(qtbot, view):
    heights, colours = view.model.picture.heights.copy(), view.model.picture.values[CutColourBy.METAL].copy()
    place = (slice(10, 30), slice(120, 190))
    heights[place], colours[place] = -6.0, 0
    tips = np.array([[20.0, 30.0, -6.0], [30.0, 32.0, -7.0], TIP])
    view.playback.show_tool(BALL, TIP)
    view.playback.show_wedges(wedges_picture(tips, BALL))
    view.legend.wedges.click()
    view.render_scheduler.patch(patch_of(heights, colours, view.model.picture.pitch, place))
    before = rest(qtbot, view)
    surface = view.render_scheduler.surface
    with surface._context:
        surface._scene.release()
        surface._scene = CutScene(surface._context)
    view.render_scheduler.renew()
    assert np.array_equal(rest(qtbot, view), before)
