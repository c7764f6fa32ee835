"""The Stages view on the texts B to E: chosen at its head, played, and written."""

import json

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from app.core.resources import resource
from app.model.part import Units
from app.model.tool_kind import ToolKind
from app.ui.framework.view import View
from tests.ui.conftest import WAIT_MS
from tests.ui.nc.opened import open_file

LEFT = Qt.MouseButton.LeftButton
LONG_MS = 6 * WAIT_MS


def show_text(qtbot, wiring, letter):
    """Choose a text with the mouse, and wait for its film."""
    wiring.display_controller.show_view(View.STAGES)
    stages = wiring.window_.views.stages
    QTest.mouseClick(stages.texts.buttons[letter], LEFT)
    qtbot.waitUntil(lambda: not wiring.film_controller.worker.busy, timeout=LONG_MS)
    return stages


def test_a_text_is_chosen_at_the_head_and_its_steps_are_shown(qtbot, wiring):
    stages = show_text(qtbot, wiring, "E")
    window, films = wiring.window_, stages.films
    assert films.isVisible() and not stages.pixels.isVisible()
    assert window.film_panel.isVisible() and not window.stages_panel.isVisible() and not window.views.empty.isVisible()
    assert films.film.text.value == "E" and films.rail.count() == len(films.film.steps) and films.picture.shows
    assert window.film_panel.title.text() == "figure 2  The points"
    image = films.picture.grab().toImage()
    white = sum(image.pixelColor(x, image.height() // 2).lightness() > 250 for x in range(0, image.width(), 7))
    assert white > 0.9 * len(range(0, image.width(), 7)), "lines on white paper"
    qtbot.keyClick(films.picture, Qt.Key.Key_End)
    assert films.at == len(films.film.steps) - 1 and "proven" in window.film_panel.figures
    qtbot.keyClick(films.picture, Qt.Key.Key_Left)
    assert films.step.number == "figure 8" and "spare" in window.film_panel.figures
    QTest.mouseClick(stages.texts.buttons["A"], LEFT)
    assert not films.isVisible() and stages.pixels.isVisible() and not window.film_panel.isVisible()
    assert window.views.empty.isVisible(), "nothing is drawn, and the stages of a drawing say so"


@pytest.mark.exhaustive
def test_all_steps_are_written(qtbot, wiring, tmp_path):
    stages = show_text(qtbot, wiring, "E")
    wiring.film_controller.save(tmp_path)
    qtbot.waitUntil(lambda: not wiring.film_controller.worker.busy, timeout=LONG_MS)
    assert stages.films.film is not None and str(tmp_path) in wiring.window_.status.message.text()
    told, count = json.loads((tmp_path / "film.json").read_text()), len(stages.films.film.steps)
    assert len(told["steps"]) == count == len(list(tmp_path.glob("*.svg"))) == len(list(tmp_path.glob("*.png")))
    wiring.film_controller.save(tmp_path / "nowhere")
    qtbot.waitUntil(lambda: not wiring.film_controller.worker.busy, timeout=LONG_MS)
    assert stages.films.film is not None, "what was shown stays"
    assert "is no folder" in wiring.window_.notice.text.text()


@pytest.mark.exhaustive
def test_what_the_text_has_stands_beside(qtbot, wiring):
    stages = show_text(qtbot, wiring, "C")
    panel = wiring.window_.film_panel
    stages.films.show_step(5)
    assert panel.title.text().startswith("(f)") and "CR12" in panel.table.text() and "mm" in panel.settled.text()


def test_a_film_is_made_of_ones_own_program_or_says_what_is_missing(qtbot, wiring):
    stages = show_text(qtbot, wiring, "D")
    panel = wiring.window_.film_panel
    assert stages.films.film.source == "facets.ngc"
    QTest.mouseClick(panel.source.buttons[True], LEFT)
    assert stages.films.film is None and "Open one in NC" in wiring.window_.views.empty.sentence.text()
    assert not wiring.window_.views.empty.button.isVisible(), "computing again does not open a program"
    open_file(qtbot, wiring, resource("samples", "points.ngc"))
    wiring.display_controller.show_view(View.STAGES)
    qtbot.waitUntil(lambda: not wiring.film_controller.worker.busy, timeout=LONG_MS)
    assert stages.films.film is not None and stages.films.film.source == "points.ngc"


def test_a_program_that_was_said_to_be_in_inches_is_shown_as_large_as_it_is(qtbot, wiring, tmp_path):
    """Films of curves read its bytes as mm, 25.4 times too small, while NC and Cut showed it in inches."""
    program = tmp_path / "nobody_said.ngc"
    program.write_text("G90 G17 G94\nG0 X0 Y0 Z.2\nG1 Z-.1 F10\nX1 Y.1\nX2 Y.4\nX3 Y.9\nX4 Y1.6\nG0 Z.2\nM2\n")
    nc = open_file(qtbot, wiring, program)
    QTest.mouseClick(wiring.window_.notice.buttons[1], LEFT)
    qtbot.waitUntil(lambda: nc.shown.source.units is Units.INCH, timeout=WAIT_MS)
    stages = show_text(qtbot, wiring, "D")
    QTest.mouseClick(wiring.window_.film_panel.source.buttons[True], LEFT)
    qtbot.waitUntil(lambda: not wiring.film_controller.worker.busy, timeout=LONG_MS)
    film = stages.films.film
    assert film is not None, wiring.window_.views.empty.sentence.text()
    tried = next(step for step in film.steps if step.number == "S115")
    assert next(each.value for each in tried.figures if each.name == "off here") > 1.0, "of inches, not of mm"


@pytest.mark.exhaustive
def test_text_b_shows_wedges_and_tries_several_sizes_of_facets(qtbot, wiring):
    stages = show_text(qtbot, wiring, "B")
    panel = wiring.window_.film_panel
    stages.films.show_step(5)
    assert panel.title.text().startswith("S105") and "published: 2 w" in panel.figures["d"].text()
    stages.films.show_step(6)
    assert "16.83 s" in panel.table.text()


def test_a_program_that_does_not_tell_its_tool_is_said_where_and_then_shown(qtbot, wiring, tmp_path):
    """The window has no command line: text B takes the tools that Cut was told."""
    program = tmp_path / "bare.ngc"
    program.write_text("G21 G90 G17\nT1 M6\nG0 X0 Y0 Z5\nG1 Z-1 F200\nX20\nX20 Y10 Z-2\nG0 Z5\nM2\n")
    open_file(qtbot, wiring, program)
    panel, window = wiring.window_.film_panel, wiring.window_
    stages = show_text(qtbot, wiring, "B")
    QTest.mouseClick(panel.source.buttons[True], LEFT)
    qtbot.waitUntil(lambda: not wiring.film_controller.worker.busy, timeout=LONG_MS)
    said = window.views.empty.sentence.text()
    assert "T1 cuts from here on" in said and "Ctrl+K" in said and "--" not in said
    wiring.display_controller.show_view(View.NC)
    QTest.mouseClick(window.views.nc.path_head.cut, LEFT)
    qtbot.waitUntil(window.cut_form.isVisible, timeout=LONG_MS)
    window.cut_form.tools[1].kind.chosen.emit(ToolKind.BALL)
    QTest.mouseClick(window.cut_form.cut, LEFT)
    qtbot.waitUntil(lambda: not wiring.cut_controller.foreign_worker.busy, timeout=LONG_MS)
    wiring.display_controller.show_view(View.STAGES)
    qtbot.waitUntil(lambda: not wiring.film_controller.worker.busy, timeout=LONG_MS)
    assert stages.films.film is not None and stages.films.film.source == "bare.ngc"


def test_a_long_sentence_in_the_place_of_a_film_is_broken_into_lines(qtbot, wiring, tmp_path):
    """It was one line, cut off at the view's edge."""
    program = tmp_path / "flat.ngc"
    program.write_text("(T1 D=6 flat)\nG21 G90 G17\nT1 M6\nG0 X0 Y0 Z5\nG1 Z-1 F200\nX20\nG0 Z5\nM2\n")
    open_file(qtbot, wiring, program)
    wiring.window_.resize(1280, 800)
    show_text(qtbot, wiring, "D")
    QTest.mouseClick(wiring.window_.film_panel.source.buttons[True], LEFT)
    qtbot.waitUntil(lambda: not wiring.film_controller.worker.busy, timeout=LONG_MS)
    empty, picture = wiring.window_.views.empty, wiring.window_.views.stages.picture
    assert empty.isVisible() and "such as the sample" in empty.sentence.text()
    assert empty.width() <= picture.width() and empty.sentence.height() > 1.5 * empty.sentence.fontMetrics().height()
