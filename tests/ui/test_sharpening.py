"""A heavy drawing is shown moved and scaled at once and sharp soon after; of an edit only its place is painted anew."""

import math
import random

import pytest
from PySide6.QtGui import QImage
from pytestqt.qtbot import QtBot

from app.drafting.document import Document
from app.model.curves import Arc, Curve, Line, Point
from app.model.job import Job
from app.model.part import Part
from app.ui.framework.theme import LIGHT
from app.ui.views.canvas.canvas import Canvas
from app.ui.views.canvas.view_transform import ViewTransform

EDITS = (
    "line 30,30 60,55",
    "select 1",
    "select 1 2",
    "delete 3",
    "move @3,2 4",
    "select none",
    "circle 40,40 7",
    "undo",
)


def tangle(count: int) -> Part:
    """Arcs and lines all over a plate of 100 mm."""
    rng = random.Random(7)
    curves: list[Curve] = []
    for number in range(count):
        x, y, a = rng.uniform(5, 95), rng.uniform(5, 95), rng.uniform(0, math.tau)
        r = rng.uniform(0.5, 5)
        start = (x + r * math.cos(a), y + r * math.sin(a))
        curves.append(
            Line((x, y), start)
            if number % 2
            else Arc(start, (x + r * math.cos(a + 2), y + r * math.sin(a + 2)), (x, y))
        )
    return Part().with_curves(curves, "0")


def shown(qtbot: QtBot, count: int) -> Canvas:
    canvas = Canvas(Document(Job(tangle(count))), LIGHT)
    qtbot.addWidget(canvas)
    canvas.resize(824, 624)
    canvas.show()
    canvas.set_view(ViewTransform(5.0, 124.0, 574.0))
    canvas.grab()
    qtbot.waitUntil(lambda: canvas.sharp)
    return canvas


@pytest.fixture
def heavy(qtbot: QtBot) -> Canvas:
    """A canvas on which painting is known to be slow."""
    canvas = shown(qtbot, 4000)
    assert canvas.heavy
    canvas.scene_ms = 1000.0
    return canvas


def anew(canvas: Canvas) -> QImage:
    """What the canvas shows when all of it is painted afresh at once."""
    other = Canvas(canvas.document, LIGHT)
    other.resize(canvas.size())
    other.set_view(canvas.view)
    return other.grab().toImage()


def test_a_heavy_scene_is_first_scaled_and_then_sharp(qtbot: QtBot, heavy: Canvas) -> None:
    before = heavy.grab().toImage()
    heavy.zoom_by(1.5)
    at_once = heavy.grab().toImage()
    assert not heavy.sharp
    assert at_once not in (before, anew(heavy))
    qtbot.waitUntil(lambda: heavy.sharp)
    assert heavy.grab().toImage() == anew(heavy)


def test_the_last_picture_lies_where_the_view_has_it(qtbot: QtBot, heavy: Canvas) -> None:
    before = heavy.grab().toImage()
    heavy.set_view(heavy.view.panned(40, -30))
    moved = heavy.grab().toImage()
    assert not heavy.sharp
    assert moved.copy(200, 100, 400, 300) == before.copy(160, 130, 400, 300)


def test_a_heavy_scene_that_was_moved_is_painted_with_the_same_pens(qtbot: QtBot, heavy: Canvas) -> None:
    heavy.set_view(heavy.view.panned(40, -30))
    heavy.grab()
    qtbot.waitUntil(lambda: heavy.sharp)
    assert heavy.grab().toImage() == anew(heavy)


def test_another_view_or_an_edit_begins_the_slices_again(qtbot: QtBot, heavy: Canvas) -> None:
    for _ in range(5):
        heavy.zoom_by(1.1)
        heavy.grab()
        heavy._grow(0.1)
    heavy.document.run("circle 50,50 30")
    heavy.grab()
    qtbot.waitUntil(lambda: heavy.sharp)
    assert heavy.grab().toImage() == anew(heavy)


def test_nothing_is_painted_for_a_hidden_widget(heavy: Canvas) -> None:
    heavy.zoom_by(1.5)
    heavy.grab()
    heavy.hide()
    assert heavy._growing is None


def test_a_light_scene_is_sharp_at_once(qtbot: QtBot) -> None:
    canvas = shown(qtbot, 40)
    canvas.scene_ms = 1000.0
    canvas.zoom_by(1.5)
    assert canvas.grab().toImage() == anew(canvas)


@pytest.mark.parametrize("count", [40, 4000])
def test_where_an_edit_was_is_painted_as_if_all_were(qtbot: QtBot, count: int) -> None:
    canvas = shown(qtbot, count)
    for line in EDITS:
        if line == "undo":
            canvas.document.undo()
        else:
            canvas.document.run(line)
        assert canvas.sharp, f"{line}: all of it is painted anew"
        assert canvas.grab().toImage() == anew(canvas), line


def test_a_change_of_the_layers_is_seen_everywhere(qtbot: QtBot) -> None:
    canvas = shown(qtbot, 40)
    canvas.document.run('colour 0 "#0072b2"')
    assert canvas.grab().toImage() == anew(canvas)


def around(canvas: Canvas, image: QImage, place: Point) -> QImage:
    """The 13 px round a place in mm."""
    at = canvas.view.to_screen(place).toPoint()
    return image.copy(at.x() - 6, at.y() - 6, 13, 13)


@pytest.mark.parametrize(
    "near",
    [ViewTransform(30.0, -1088.0, 1812.0), ViewTransform(8.0, 24.0, 724.0)],
    ids=["far smaller", "a little smaller"],
)
def test_zooming_out_shows_at_once_what_the_last_picture_did_not_reach(
    qtbot: QtBot, heavy: Canvas, near: ViewTransform
) -> None:
    far = heavy.view
    heavy.set_view(near)
    heavy.grab()
    heavy.document.run("line 0,97 100,97")
    qtbot.waitUntil(lambda: heavy.sharp and heavy._far.whole)
    heavy.scene_ms = 1000.0
    heavy.set_view(far)
    at_once, bare = heavy.grab().toImage(), Canvas(Document(Job(Part())), LIGHT)
    assert not heavy.sharp
    bare.resize(heavy.size())
    bare.set_view(far)
    paper = bare.grab().toImage()
    for place in ((60.0, 92.0), (60.0, 8.0), (33.0, 97.0)):
        assert around(heavy, at_once, place) != around(heavy, paper, place), place
