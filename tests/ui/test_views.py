"""The views in the middle of the window."""

import pytest
from PySide6.QtCore import Qt

from app.drafting.document import Document
from app.ui.framework.fade import FADE_MS
from app.ui.framework.samples import PathLineKind
from app.ui.framework.theme import LIGHT
from app.ui.framework.view import View, ViewPage
from app.ui.shell.view_stack import ViewStack
from app.ui.views.canvas.canvas import Canvas
from app.ui.views.canvas.modes import PathColourBy


@pytest.fixture
def views(qtbot):
    document = Document()
    document.run("circle 50,50 20")
    canvas = Canvas(document, LIGHT)
    made = ViewStack(canvas)
    drawn = ViewPage(canvas, canvas)
    made.take_pages({View.DRAW: drawn, View.PATHS: drawn, View.NC: ViewPage(made.nc, made.nc)})
    qtbot.addWidget(made)
    made.resize(900, 600)
    made.show()
    return made


def test_view_that_is_left_fades_and_is_gone_soon(qtbot, views):
    before = views.grab().toImage()
    views.show_view(View.NC)
    assert views.currentWidget() is views.nc
    assert views.fade.isVisible()
    assert views.fade.testAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
    qtbot.waitUntil(lambda: not views.fade.isVisible(), timeout=FADE_MS * 10)
    assert views.grab().toImage() != before
    views.show_view(View.NC)
    assert not views.fade.isVisible()


def test_what_is_fitted_keeps_clear_of_the_legend(qtbot, views):
    views.canvas.fit_to((0.0, 0.0, 200.0, 50.0))
    views.show_view(View.PATHS)
    views.show_missing("", "", shows_paths=True)
    qtbot.waitUntil(lambda: views.canvas._glide.state() is not views.canvas._glide.State.Running)
    right = views.canvas.view.to_screen((200.0, 0.0)).x()
    assert right < views.width() - views.legend.width()


def test_what_is_missing_hides_nothing_of_the_drawing(qtbot, views):
    views.canvas.fit_to(views.canvas.picture.box)
    views.show_view(View.PATHS)
    views.show_missing("There are no tool paths yet.", "Compute  F5", False)
    box = views.canvas.picture.box
    assert box is not None and views.empty.isVisible()
    qtbot.waitUntil(lambda: views.canvas.view.to_screen((box[2], 50.0)).x() < views.empty.x())
    views.show_view(View.NC)
    views.show_missing("There is no NC program yet.", "Compute  F5", False)
    assert abs(views.empty.geometry().center().x() - views.rect().center().x()) <= 1, "nothing is behind it"


def test_legend_closes_up_when_an_entry_goes(views):
    legend = views.legend
    views.show_view(View.PATHS)
    legend.show_remainders({PathLineKind.LEFT: True, PathLineKind.UNREACHABLE: True})
    views.show_missing("", "", shows_paths=True)
    tall = legend.height()
    legend.show_remainders({PathLineKind.LEFT: False, PathLineKind.UNREACHABLE: False})
    assert legend.height() == tall - 2 * legend.rows[PathLineKind.LEFT].height()


def test_legend_folds_where_there_is_no_room_for_it(qtbot, views):
    views.show_view(View.PATHS)
    views.show_missing("", "", shows_paths=True)
    legend = views.legend
    assert not legend.fold.isChecked()
    views.resize(900, 220)
    assert legend.fold.isChecked()
    views.resize(900, 600)
    assert not legend.fold.isChecked()
    qtbot.mouseClick(legend.fold, Qt.MouseButton.LeftButton)
    views.resize(900, 590)
    assert legend.fold.isChecked()


def test_samples_are_grey_while_colours_tell_the_region(qtbot, views):
    views.show_view(View.PATHS)
    views.show_missing("", "", shows_paths=True)
    line = views.legend.rows[PathLineKind.POCKET].line

    def middle():
        return line.grab().toImage().pixelColor(line.width() // 2, line.height() // 2).name()

    before = middle()
    qtbot.mouseClick(views.legend.colour.buttons[PathColourBy.REGION], Qt.MouseButton.LeftButton)
    assert middle() != before
    qtbot.mouseClick(views.legend.colour.buttons[PathColourBy.TOOL], Qt.MouseButton.LeftButton)
    assert middle() == before
