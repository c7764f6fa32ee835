"""The Stages view with mouse and keys."""

import time
from dataclasses import replace

import numpy as np
import pytest
from PySide6.QtCore import QPoint, QPointF, QRect, QSize, Qt
from PySide6.QtGui import QGuiApplication, QWheelEvent
from PySide6.QtWidgets import QApplication

from app.core.settings import ThemeChoice
from app.model.curve_selectors import CurveNumber
from app.raster.frame import PixelCode
from app.raster.steps import STEPS
from app.ui.framework.theme import LIGHT
from app.ui.framework.view import View
from app.ui.views.stages.code_colours import step_colours
from app.ui.views.stages.film_player import SPEEDS
from app.ui.views.stages.painting.pixel_painter import LETTER_PX, RASTER_PX
from app.ui.views.stages.panel import BY_THE_RULE, FillRules, StagesPanel
from app.ui.views.stages.step_notes import note
from tests.ui.conftest import WAIT_MS
from tests.ui.fields_typed import enter
from tests.ui.stages.conftest import show_stages

LEFT = Qt.MouseButton.LeftButton
STAR = (
    "line 71.97,51.1 88.07,62.27 68.48,61.94 76.83,79.66 60.04,69.56 58.41,89.1 "
    "48.9,71.97 37.73,88.07 38.06,68.48 20.34,76.83 30.44,60.04 71.97,51.1"
)


def screen(view, row, col):
    """Where a pixel's middle lies on the screen."""
    x, y = view.pixels.pixels.frame.to_mm(np.array([(col + 0.5, row + 0.5)]))[0].tolist()
    return view.pixels.view.to_screen((x, y)).toPoint()


def test_an_empty_drawing_says_what_is_missing(wiring):
    wiring.display_controller.show_view(View.STAGES)
    assert wiring.window_.views.empty.isVisible() and "Nothing is drawn" in wiring.window_.views.empty.sentence.text()
    assert not wiring.window_.stages_panel.isVisible()


def test_the_tab_between_draw_and_paths_shows_the_first_step(qtbot, staged):
    window = staged.window_
    assert list(window.top_bar.tabs)[:3] == ["view_draw", "view_stages", "view_paths"]
    view = window.views.stages
    assert window.views.currentWidget() is view and window.stages_panel.isVisible() and not window.panel.isVisible()
    assert view.still.number == 110 and view.rail.numbers[:3] == (110, 120, 201) and view.rail.numbers[-1] == 407
    assert window.stages_panel.title.text() == "110  Show the shape"
    qtbot.keyClick(window, Qt.Key.Key_1, Qt.KeyboardModifier.ControlModifier)
    assert window.panel.isVisible() and not window.stages_panel.isVisible()
    qtbot.keyClick(window, Qt.Key.Key_2, Qt.KeyboardModifier.ControlModifier)
    assert staged.display_controller.view is View.STAGES


def test_keys_step_and_the_rail_ticks_what_was_reached(qtbot, staged):
    view = staged.window_.views.stages
    for key, number in (
        (Qt.Key.Key_Right, 120),
        (Qt.Key.Key_Right, 201),
        (Qt.Key.Key_Left, 120),
        (Qt.Key.Key_End, 407),
        (Qt.Key.Key_Home, 110),
        (Qt.Key.Key_PageDown, 201),
        (Qt.Key.Key_PageDown, 301),
        (Qt.Key.Key_PageUp, 201),
    ):
        qtbot.keyClick(view.pixels, key)
        assert view.still.number == number, key
    assert view.rail.now == 201 and view.rail.reached == {110, 120}
    item = view.rail.item(view.rail.numbers.index(206))
    qtbot.mouseClick(view.rail.viewport(), LEFT, pos=view.rail.visualItemRect(item).center())
    assert view.still.number == 206 and view.player.place.text().startswith("8 of ")
    assert staged.window_.stages_panel.sentence.text() == view.still.sentence


def test_space_plays_to_the_end_and_pauses(qtbot, staged):
    view = staged.window_.views.stages
    view.player.speed.setCurrentIndex(SPEEDS.index(60))
    seen = []
    view.shown.connect(lambda: seen.append(view.at))
    qtbot.keyClick(view.pixels, Qt.Key.Key_Space)
    assert view.player.playing
    qtbot.waitUntil(lambda: len(seen) > 6, timeout=WAIT_MS)
    qtbot.keyClick(view.pixels, Qt.Key.Key_Space)
    assert not view.player.playing and seen == sorted(seen)
    view.show_stage(len(view.film) - 3)
    qtbot.mouseClick(view.player.play, LEFT)
    qtbot.waitUntil(lambda: not view.player.playing, timeout=WAIT_MS)
    assert view.at == len(view.film) - 1
    qtbot.keyClick(view.pixels, Qt.Key.Key_Space)
    staged.display_controller.show_view(View.DRAW)
    assert not view.player.playing


@pytest.mark.exhaustive
def test_pixels_have_their_codes_colours_and_say_what_they_are(qtbot, staged):
    view = staged.window_.views.stages
    view.show_stage(view.film.seek_step(206, -1))
    row, col = np.argwhere(view.plane == PixelCode.R)[0].tolist()
    view.pixels.zoom_by(4.0, QPointF(screen(view, row, col)))
    image = view.pixels.grab().toImage()
    inks = step_colours(LIGHT, 206)
    for code in (PixelCode.R, PixelCode.TRACED, PixelCode.EMPTY):
        window = np.argwhere(view.plane == code)
        places = [screen(view, *place) for place in window.tolist()]
        inside = next(
            p for p in places if 40 < p.x() < view.pixels.width() // 2 and 40 < p.y() < view.pixels.height() - 20
        )
        assert image.pixelColor(inside + QPoint(-1, -1)).name() == inks[code].name(), code
    qtbot.mouseMove(view.pixels, screen(view, row, col))
    assert staged.window_.status.message.text() == f"Column {col}, row {row}: R, must not count"
    x, y = view.pixels.pixels.frame.to_mm(np.array([(col + 0.5, row + 0.5)]))[0]
    assert float(staged.window_.status.place_x.text()[2:]) == pytest.approx(x, abs=view.pixels.pixels.frame.pitch)
    assert float(staged.window_.status.place_y.text()[2:]) == pytest.approx(y, abs=view.pixels.pixels.frame.pitch)


def test_wheel_zooms_at_the_mouse_f_fits_the_middle_button_pans(qtbot, staged):
    pixels = staged.window_.views.stages.pixels
    at, before = QPointF(300.0, 200.0), pixels.view
    pixels.wheelEvent(
        QWheelEvent(
            at,
            pixels.mapToGlobal(at),
            QPoint(),
            QPoint(0, 240),
            Qt.MouseButton.NoButton,
            Qt.KeyboardModifier.NoModifier,
            Qt.ScrollPhase.NoScrollPhase,
            False,
        )
    )
    assert pixels.view.scale > before.scale * 1.3
    assert pixels.view.to_world(at) == pytest.approx(before.to_world(at))
    held = pixels.view.to_world(QPointF(200, 150))
    qtbot.mousePress(pixels, Qt.MouseButton.MiddleButton, pos=QPoint(200, 150))
    qtbot.mouseMove(pixels, QPoint(260, 190))
    qtbot.mouseRelease(pixels, Qt.MouseButton.MiddleButton, pos=QPoint(260, 190))
    assert pixels.view.to_world(QPointF(260, 190)) == pytest.approx(held, abs=0.05)
    qtbot.keyClick(pixels, Qt.Key.Key_F)
    qtbot.waitUntil(lambda: pixels.view == before, timeout=WAIT_MS)


def test_raster_and_letters_come_when_pixels_are_large(qtbot, staged):
    view = staged.window_.views.stages
    view.show_stage(view.film.seek_step(208, -1))
    pixels, pitch = view.pixels, view.pixels.pixels.frame.pitch
    row, col = np.argwhere(view.plane == PixelCode.INSIDE)[500].tolist()

    def colours(px):
        """How many colours there are in and round one pixel of this size on the screen."""
        at = QPointF(screen(view, row, col))
        pixels.zoom_by(px / (pitch * pixels.view.scale), at)
        middle, half = screen(view, row, col), round(px * 0.7)
        image = pixels.grab().toImage()
        return len(
            {image.pixel(middle.x() + dx, middle.y() + dy) for dx in range(-half, half) for dy in range(-half, half)}
        )

    assert colours(RASTER_PX - 2) == 1
    small, large = colours(RASTER_PX + 3), colours(LETTER_PX + 6)
    assert 1 < small < large


def test_a_chain_is_lit_from_the_list_and_from_the_picture(qtbot, staged):
    window, view = staged.window_, staged.window_.views.stages
    chains = window.stages_panel.chains
    view.show_stage(view.film.seek_step(203, -1))
    assert chains.list.count() == len(view.still.chains) == 3
    dark = view.pixels.grab().toImage()
    qtbot.mouseClick(chains.list.viewport(), LEFT, pos=chains.list.visualItemRect(chains.list.item(1)).center())
    assert chains.text.toPlainText() == view.still.chains[1].text()
    assert view.pixels.grab().toImage() != dark
    row, col = view.still.chains[2].pixels()[3].tolist()
    qtbot.mouseClick(view.pixels, LEFT, pos=screen(view, row, col))
    assert chains.list.currentRow() == 2 and chains.text.toPlainText() == view.still.chains[2].text()
    qtbot.mouseClick(chains.copy, LEFT)
    assert QGuiApplication.clipboard().text().splitlines() == [chain.text() for chain in view.still.chains]
    view.show_stage(view.film.seek_step(204, -1))
    assert chains.list.count() == 0 and "traces no line" in chains.text.placeholderText()


def test_published_rules_are_marked_where_they_err_and_counted(qtbot, wiring):
    wiring.run(STAR)
    wiring.display_controller.show_view(View.STAGES)
    show_stages(qtbot, wiring)
    panel, view = wiring.window_.stages_panel, wiring.window_.views.stages
    assert "Always right" in panel.wrong.text()
    qtbot.mouseClick(panel.rules.buttons[FillRules.PUBLISHED], LEFT)
    qtbot.waitUntil(lambda: wiring.stages_controller.reel.request.published, timeout=WAIT_MS)
    view.show_stage(view.film.seek_step(208, -1))
    count = int(np.count_nonzero(view.still.wrong))
    assert (
        count > 100
        and f"{count} pixels wrongly" in panel.wrong.text()
        and f"err in {count} pixels" in panel.sentence.text()
    )
    row, col = np.argwhere(view.still.wrong)[count // 2].tolist()
    view.pixels.zoom_by(5.0, QPointF(screen(view, row, col)))
    assert view.pixels.grab().toImage().pixelColor(screen(view, row, col)).name() == LIGHT.gouge.name()

    def told() -> bool:
        """Whether the pixel under the mouse is told, once no step has news of its own."""
        for away in (40, 0):
            qtbot.mouseMove(view.pixels, screen(view, row, col) - QPoint(away, 0))
        return wiring.window_.status.message.text().endswith("!, wrong as published")

    qtbot.waitUntil(told, timeout=WAIT_MS)
    qtbot.mouseClick(panel.rules.buttons[FillRules.SETTLED], LEFT)
    qtbot.waitUntil(lambda: not wiring.stages_controller.reel.request.published, timeout=WAIT_MS)
    assert view.still.number == 208 and view.still.wrong is None


def test_the_first_step_says_how_large_this_memory_is(qtbot, staged):
    panel, view = staged.window_.stages_panel, staged.window_.views.stages
    assert "The screen has 400 by 400 points. " in panel.notes.text()
    enter(qtbot, panel.points, "200")
    qtbot.waitUntil(lambda: view.film is not None and view.film.shape == (200, 200), timeout=WAIT_MS)
    assert "The screen has 200 by 200 points; in 1986 it had 400 by 400. " in panel.notes.text()
    panel.show_still(view.still)
    assert "{" not in "".join(note(number, (3, 4)) for number in STEPS)
    assert "has 4 by 3 points" in note(110, (3, 4)), "columns by rows"


def test_classes_show_under_fitted_lines_until_these_are_seen_apart(qtbot, staged):
    view = staged.window_.views.stages
    view.show_stage(view.film.seek_step(406, -1))
    view.pixels.fit_now()

    def darkest(box):
        """The least brightness in a square of the screen."""
        image = view.pixels.grab(box).toImage()
        return min(image.pixelColor(x, y).value() for x in range(image.width()) for y in range(image.height()))

    row, col = np.argwhere(view.plane == PixelCode.CIRCLE)[0].tolist()
    around = QRect(screen(view, row, col) - QPoint(6, 6), QSize(13, 13))
    fitted = darkest(around)
    assert fitted > 100, "no ink over the colours"
    view.pixels.zoom_by(10.0, QPointF(screen(view, row, col)))
    near = QRect(screen(view, row, col) - QPoint(40, 40), QSize(81, 81))
    assert darkest(near) < LIGHT.ink.value() + 25 < fitted


def test_chain_code_is_seen_without_scrolling_in_the_smallest_window(staged):
    window = staged.window_
    assert (window.width(), window.height()) == (1280, 800)
    view, panel = window.views.stages, window.stages_panel
    for number in (203, 142, 146):
        view.show_stage(view.film.seek_step(number, -1))
        QApplication.processEvents()
        text = panel.chains.text
        lines = text.viewport().height() // text.fontMetrics().lineSpacing()
        bottom = text.mapTo(panel.viewport(), QPoint(0, text.height())).y()
        assert lines >= 7 and bottom <= panel.viewport().height(), number


def test_resolution_and_pitch_and_what_they_cost(qtbot, staged):
    panel, view = staged.window_.stages_panel, staged.window_.views.stages
    assert "mm at the walls, " in panel.given_up.text() and panel.points.edit.text() == "400"
    enter(qtbot, panel.points, "200")
    qtbot.waitUntil(lambda: view.film is not None and view.film.shape == (200, 200), timeout=WAIT_MS)
    assert float(panel.pitch.edit.text()) == pytest.approx(52 / 196, abs=1e-4)
    enter(qtbot, panel.pitch, "0.4")
    qtbot.waitUntil(
        lambda: staged.stages_controller.reel is not None and staged.stages_controller.reel.part.frame.pitch == 0.4,
        timeout=WAIT_MS,
    )
    assert panel.points.value == view.film.shape[0] == 134
    enter(qtbot, panel.points, "50")
    assert panel.points.reason.isVisible() and "100 to 2000" in panel.points.reason.text()


def test_what_cannot_be_computed_says_why_and_is_computed_when_it_can(qtbot, staged):
    window, panel = staged.window_, staged.window_.stages_panel
    enter(qtbot, panel.pitch, "3")
    empty = window.views.empty
    qtbot.waitUntil(lambda: empty.isVisible() and "not wider than two pixels" in empty.sentence.text(), timeout=WAIT_MS)
    assert window.views.stages.film is None and panel.isVisible() and not panel.chains.isVisible()
    enter(qtbot, panel.points, "150")
    show_stages(qtbot, staged)
    assert not window.views.empty.isVisible() and panel.chains.isVisible()


def test_stages_follow_the_drawing_and_are_never_of_another_one(qtbot, staged):
    view = staged.window_.views.stages
    before = view.film
    staged.run("circle 46,30 5")
    qtbot.waitUntil(lambda: view.film is not before and view.film is not None, timeout=WAIT_MS)
    assert len(staged.stages_controller.reel.part.regions) == 3
    shown = view.film
    staged.display_controller.show_view(View.DRAW)
    staged.run("circle 60,30 5")
    QApplication.processEvents()
    assert not staged.stages_controller.worker.busy and view.film is shown
    staged.display_controller.show_view(View.STAGES)
    qtbot.waitUntil(lambda: len(staged.stages_controller.reel.part.regions) == 4, timeout=WAIT_MS)
    staged.files.new()
    assert view.film is None


def test_cancelling_leaves_no_stages_of_an_earlier_job(qtbot, staged):
    enter(qtbot, staged.window_.stages_panel.points, "2000")
    assert staged.stages_controller.worker.busy and staged.window_.actions_["cancel"].isEnabled()
    staged.window_.actions_["cancel"].trigger()
    assert not staged.stages_controller.worker.busy and staged.window_.views.stages.film is None
    assert staged.window_.views.empty.button.text() == "Compute the stages"
    assert not staged.window_.status.bar.isVisible()


def test_both_themes(qtbot, staged):
    view = staged.window_.views.stages
    staged.window_.set_theme_choice(ThemeChoice.DARK)
    dark = view.pixels.grab().toImage()
    staged.window_.set_theme_choice(ThemeChoice.LIGHT)
    light = view.pixels.grab().toImage()
    middle = screen(view, 3, 3)
    assert dark.pixelColor(middle).lightness() < 40 and light.pixelColor(middle).lightness() > 240


@pytest.mark.exhaustive
def test_more_than_30_stages_are_shown_in_a_second(qtbot, staged):
    view = staged.window_.views.stages
    assert view.film.shape == (400, 400)

    def rate():
        begun = time.process_time()
        for at in range(40):
            view.show_stage(at)
            view.pixels.repaint()
        return 40 / (time.process_time() - begun)

    assert max(rate() for _ in range(3)) >= 30


def test_what_gets_no_path_is_said(qtbot, staged):
    panel = staged.window_.stages_panel
    assert not panel.finding.isVisible()
    for index in (0, 2):
        before = staged.stages_controller.reel
        staged.window_.panel.operations.switched.emit(index, False)
        qtbot.waitUntil(lambda reel=before: staged.stages_controller.reel is not reel, timeout=WAIT_MS)
    assert (
        staged.window_.views.stages.rail.numbers == (110,)
        and "no operation is one of them" in panel.finding.text()
        and panel.finding.isVisible()
    )
    staged.window_.panel.operations.switched.emit(2, True)
    staged.run("circle 60,5 1")
    qtbot.waitUntil(lambda: "has no room for T2" in panel.finding.text(), timeout=WAIT_MS)


def test_a_job_that_chooses_curves_is_shown_by_the_rule_of_1986(qtbot, wiring):
    new = StagesPanel()
    qtbot.addWidget(new)
    assert new.points.value == 400.0 and new.pitch.isHidden(), "before the first film"
    panel = wiring.window_.stages_panel
    wiring.run("rect 0,0 30,20")
    wiring.run("circle 9,8 3")
    qtbot.waitUntil(lambda: len(wiring.document.part.entities) == 5, timeout=WAIT_MS)
    job = wiring.document.job
    (first, *_) = job.operations
    own = replace(first, cut=replace(first.cut, curves=(CurveNumber(5),)))
    wiring.document.change_job("Own", replace(job, operations=(own,)))
    wiring.display_controller.show_view(View.STAGES)
    show_stages(qtbot, wiring)
    assert panel.rule.text() == BY_THE_RULE and panel.rule.isVisible()
    assert wiring.stages_controller.reel.made.paths, "all that is drawn is machined"
    wiring.document.change_job("All", job)
    show_stages(qtbot, wiring)
    assert not panel.rule.text()
