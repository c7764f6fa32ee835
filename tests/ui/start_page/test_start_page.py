"""The page that the window begins with, in the real window."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QColor, QImage

from app.core.progress import NO_PROGRESS
from app.core.resources import resource
from app.model.curves import Arc
from app.model.part import Part
from app.ui.framework.computation import ComputationState
from app.ui.framework.theme import DARK, LIGHT
from app.ui.framework.view import View
from app.ui.shell.new_job import MATERIALS, NewPart, new_job
from app.ui.shell.start import begin
from app.ui.shell.start_page.file_card import FileCard
from app.ui.shell.start_page.page import StartPage
from app.ui.shell.start_page.thumbnail import thumbnail
from app.ui.views.canvas.modes import CanvasTool
from app.ui.views.language import command_runner
from tests.ui.conftest import WAIT_MS


@pytest.fixture
def started(qtbot, wiring, tmp_path):
    """A window that begins, with two files that were opened lately, of which one is gone."""
    path = tmp_path / "lid.draw"
    path.write_text("rect 0,0 60,40\ncircle 30,20 8\n")
    for each in (tmp_path / "gone.dxf", path):
        wiring.workspace.preferences.add_recent(each)
    begin(wiring, None)
    qtbot.waitUntil(lambda: wiring.window_.views.starting, timeout=WAIT_MS)
    return wiring


def painted(qtbot, wiring):
    control = wiring.start_controller
    qtbot.waitUntil(lambda: not control._left and not control.worker.busy, timeout=60_000)


def test_the_last_files_and_four_samples_are_offered_as_pictures(qtbot, started):
    window, page = started.window_, started.window_.views.start
    assert [card.text() for card in page.files] == ["lid.draw"] and page.files[0].words == "today"
    assert [card.text() for card in page.samples] == ["A plate", "A sign", "A mould", "Fig. 2 of 1986"]
    assert window.status.badge.text() == "Nothing open" and window.file_label.text() == "Start here"
    assert not window.side.isVisible() and not window.tool_strip.isVisible()
    painted(qtbot, started)
    for card in (*page.files, *page.samples):
        colours = {card._picture.pixel(x, y) for x in range(0, 200, 3) for y in range(0, 120, 3)}
        assert len(colours) > 2, card.text()


def test_a_press_opens_a_file(qtbot, started):
    page = started.window_.views.start
    qtbot.mouseClick(page.files[0], Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: len(started.document.part.entities) == 5, timeout=WAIT_MS)
    assert not started.window_.views.starting and started.window_.file_label.text() == "lid.draw"


def test_the_plate_comes_with_operations_for_what_is_drawn(qtbot, started):
    page = started.window_.views.start
    qtbot.mouseClick(page.samples[0], Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: started.window_.notice.text.text().startswith("Proposed: "), timeout=WAIT_MS)
    words = [operation.WORD for operation in started.document.job.operations]
    assert words[-1] == "contour" and "pocket" in words
    assert str(resource("samples", "plate.draw")) not in started.window_.preferences.settings.recent_files


def test_figure_2_is_computed_at_once(qtbot, started):
    qtbot.mouseClick(started.window_.views.start.samples[3], Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: started.computation.state is ComputationState.CURRENT, timeout=WAIT_MS)
    assert started.display_controller.view is View.PATHS


def test_a_new_part_has_its_size_its_machine_and_its_material(qtbot, started):
    card = started.window_.views.start.new
    assert card.lengths[0].edit.hasFocus()
    for field, typed in zip(card.lengths, ("100", "2in", "6"), strict=True):
        field.edit.setFocus()
        field.edit.selectAll()
        qtbot.keyClicks(field.edit, typed)
        qtbot.keyClick(field.edit, Qt.Key.Key_Tab)
    card.material.show_value("wood")
    card.machine.show_value("grbl")
    qtbot.mouseClick(card.begin, Qt.MouseButton.LeftButton)
    job = started.document.job
    assert (job.post, job.stock.thickness) == ("grbl", 6.0)
    assert started.display_controller.part_size() == pytest.approx((100.0, 50.8))
    assert job.tool(1).feeds and job.tool(1).feed_rate != new_job(NewPart(1, 1, 1, "steel", "grbl")).tool(1).feed_rate
    assert not started.window_.views.starting and started.display_controller.view is View.DRAW
    started.document.undo()
    assert not started.document.part.entities, "its outline is a step that can be undone"


def test_a_new_part_has_round_corners(qtbot, started, monkeypatch):
    monkeypatch.setattr(command_runner, "AT_ONCE_S", 0.0)  # as on a busy machine, where the outline comes later
    card = started.window_.views.start.new
    card.lengths[0].edit.selectAll()
    qtbot.keyClicks(card.lengths[0].edit, "x")
    qtbot.keyClick(card.lengths[0].edit, Qt.Key.Key_Return)
    assert started.window_.views.starting, "what is marked as wrong begins nothing"
    card.lengths[0].edit.selectAll()
    qtbot.keyClicks(card.lengths[0].edit, "80")
    card.corners.edit.selectAll()
    qtbot.keyClicks(card.corners.edit, "30")
    qtbot.keyClick(card.corners.edit, Qt.Key.Key_Return)
    assert started.window_.views.starting and "25 mm" in card.corners.reason.text(), "50 mm is its shorter side"
    qtbot.mouseClick(card.begin, Qt.MouseButton.LeftButton)
    assert started.window_.views.starting, "what is marked as wrong begins nothing"
    card.corners.edit.selectAll()
    qtbot.keyClicks(card.corners.edit, "6")
    qtbot.keyClick(card.corners.edit, Qt.Key.Key_Return)
    qtbot.waitUntil(lambda: len(started.document.part.entities) == 8, timeout=WAIT_MS)
    curves = [entity.curve for entity in started.document.part.entities]
    assert [each.radius for each in curves if isinstance(each, Arc)] == [6.0] * 4 and len(curves) == 8
    canvas = started.window_.canvas
    qtbot.waitUntil(lambda: canvas._glide.state() is not canvas._glide.State.Running, timeout=WAIT_MS)
    middle = canvas.view.to_screen((40.0, 25.0))
    assert abs(middle.x() - canvas.area.center().x()) < 1 and abs(middle.y() - canvas.area.center().y()) < 1


def test_escape_a_tool_a_view_or_a_typed_line_lead_to_the_drawing(qtbot, started):
    window, views = started.window_, started.window_.views
    qtbot.keyClick(views.start, Qt.Key.Key_Escape)
    assert not views.starting and window.tool_strip.isVisible()
    started.open_start()
    window.actions_["tool_line"].trigger()
    assert not views.starting and window.canvas.tool is CanvasTool.LINE
    window.canvas.cancel()
    started.open_start()
    window.actions_["view_nc"].trigger()
    assert not views.starting and started.display_controller.view is View.NC
    started.open_start()
    started.run("circle 0,0 5")
    assert not views.starting and len(started.document.part.entities) == 1


def test_file_new_asks_what_it_is_to_be(wiring):
    wiring.window_.actions_["new"].trigger()
    assert wiring.window_.views.starting and wiring.window_.views.start.new.lengths[0].edit.hasFocus()


@pytest.mark.parametrize("material", MATERIALS)
def test_every_material_has_feeds_for_the_first_tools(material):
    job = new_job(NewPart(80, 50, 10, material, "linuxcnc"))
    assert job.part == Part() and [tool.diameter for tool in job.tools] == [6.0, 3.0]
    assert all(any(row.material == material for row in tool.feeds) for tool in job.tools)
    assert job.stock.material == ("aluminium" if material == "aluminium" else ""), "others are several materials"


@pytest.mark.parametrize("name", ["fig2.dxf", "plate.draw", "torus.toml"])
def test_a_picture_fills_its_room_by_day_and_by_night(qapp, name):
    for theme in (LIGHT, DARK):
        image = thumbnail(resource("samples", name), QSize(200, 120), theme, NO_PROGRESS)
        inked = [(x, y) for x in range(200) for y in range(120) if image.pixelColor(x, y).rgb() != theme.canvas.rgb()]
        xs, ys = {x for x, _ in inked}, {y for _, y in inked}
        assert max(max(xs) - min(xs) - 120, max(ys) - min(ys) - 75) > 0, "it is too small"
        assert min(xs) > 2 and max(xs) < 197 and min(ys) > 2 and max(ys) < 117


def test_a_program_is_drawn_by_its_cuts(qapp, tmp_path):
    path = Path(tmp_path / "slot.ngc")
    path.write_text("G21 G90\nT1 M6\nG0 X0 Y0 Z5\nG1 Z-1 F100\nX30\nY20\nG0 Z5\nX90\nM30\n")
    image = thumbnail(path, QSize(200, 120), LIGHT, NO_PROGRESS)
    inked = [(x, y) for x in range(200) for y in range(120) if image.pixelColor(x, y).rgb() != LIGHT.canvas.rgb()]
    assert max(x for x, _ in inked) - min(x for x, _ in inked) == pytest.approx(1.5 * 92, abs=4)


def test_a_dense_program_is_no_patch_and_one_without_a_way_in_the_plane_has_no_picture(qapp, tmp_path):
    rows = "".join(f"G0 Y{k / 20}\nG1 X{(0 if k % 2 else 50) if k < 300 else 20 + k % 2 * 10}\n" for k in range(600))
    path = tmp_path / "dense.ngc"
    path.write_text(f"G21 G90\nG0 X0 Y0 Z-1\nF500\n{rows}M30\n")
    image = thumbnail(path, QSize(200, 120), LIGHT, NO_PROGRESS)
    inks = [image.pixelColor(100, y).red() for y in range(20, 100)]
    assert min(inks) > 20 and max(inks) < 250 and len(set(inks)) > 2, "lines shine through"
    path.write_text("G21 G90\nG0 X0 Y0 Z5\nG1 Z-1 F100\nM30\n")
    assert thumbnail(path, QSize(200, 120), LIGHT, NO_PROGRESS).isNull()


def test_the_inside_of_an_outline_is_tinted_its_holes_are_not(qapp, tmp_path):
    path = tmp_path / "lid.draw"
    path.write_text("rect 0,0 60,40\ncircle 30,20 12\n")
    image = thumbnail(path, QSize(200, 120), LIGHT, NO_PROGRESS)
    assert image.pixelColor(100, 60).rgb() == LIGHT.canvas.rgb()
    assert image.pixelColor(100, 20).rgb() not in (LIGHT.canvas.rgb(), LIGHT.ink.rgb())


@pytest.mark.exhaustive
def test_of_a_scene_only_what_lies_on_top_is_drawn(qapp):
    image = thumbnail(resource("samples", "die.toml"), QSize(200, 120), LIGHT, NO_PROGRESS)
    rows = [y for y in range(120) if any(image.pixelColor(x, y).rgb() != LIGHT.canvas.rgb() for x in range(200))]
    lowest = [x for x in range(200) if image.pixelColor(x, rows[-1]).rgb() != LIGHT.canvas.rgb()]
    assert all(image.pixelColor(x, rows[-1]).green() >= image.pixelColor(x, rows[-1]).red() for x in lowest), (
        "a corner of the binder, nothing that hangs below it"
    )


def test_what_was_said_of_the_part_before_does_not_lie_over_the_page(wiring):
    wiring.window_.notice.ask("This is the sample part.", [("Draw your own", lambda: None)])
    wiring.open_start()
    assert not wiring.window_.notice.isVisible()
    wiring.window_.notice.ask("What is to become of the changes?", [("Save", lambda: None)], stays=True)
    wiring.open_start()
    assert wiring.window_.notice.isVisible(), "a question waits for its answer"


def test_columns_are_even_in_the_narrowest_window(qtbot):
    page = StartPage()
    qtbot.addWidget(page)
    page.new.show_machines([("linuxcnc", "LinuxCNC")], "linuxcnc")
    page.show_files(*([FileCard(Path(name), name, "today") for name in names] for names in ("ab", "cdef")))
    page.resize(1024, 560)
    page.show()
    qtbot.waitExposed(page)
    widths = [card.width() for card in (*page.files, *page.samples)]
    assert max(widths) - min(widths) <= 1, widths
    left = {card.x() for card in page.files} | {page.new.x()}
    assert left < {card.x() for card in page.samples}


def test_a_picture_keeps_its_shape_when_the_card_gets_another_width(qtbot):
    card = FileCard(Path("a.draw"), "a", "today")
    qtbot.addWidget(card)
    picture = QImage(200, 100, QImage.Format.Format_RGB32)
    picture.fill(QColor("#ff0000"))
    card.show_picture(picture)
    card.resize(150, card.height())
    seen = card.grab().toImage()
    ratio = seen.devicePixelRatio()
    red = [
        (x, y)
        for x in range(seen.width())
        for y in range(seen.height())
        if seen.pixelColor(x, y).getRgb()[:3] == (255, 0, 0)
    ]
    wide, high = (max(each) - min(each) + 1 for each in zip(*red, strict=True))
    assert abs(wide / high - 2.0) < 0.1 and wide > 100 * ratio
