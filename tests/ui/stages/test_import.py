"""Pictures as parts: opened, dropped, read otherwise, measured, and machined."""

import struct
from dataclasses import replace

import cv2
import numpy as np
import pytest
from PySide6.QtCore import QMimeData, QPoint, QPointF, Qt, QUrl
from PySide6.QtGui import QDragEnterEvent, QDropEvent
from PySide6.QtWidgets import QApplication

from app.raster.frame import PixelCode
from app.raster.picture_options import InkMeaning
from app.ui.framework.computation import ComputationState
from app.ui.framework.figures import TIMES
from app.ui.framework.theme import LIGHT
from app.ui.framework.view import View
from app.ui.views.stages.code_colours import code_colours
from app.ui.views.stages.import_panel import PictureAspect, SizeGivenBy
from app.ui.views.stages.painting.pixel_painter import pixel_at
from app.ui.views.stages.picture_preview import PixelSize
from tests.raster.test_doubts import plate
from tests.ui.conftest import WAIT_MS
from tests.ui.fields_typed import enter
from tests.ui.stages.conftest import show_stages
from tests.ui.stages.scan import DARK_INK, PAPER, scan

LEFT = Qt.MouseButton.LeftButton


@pytest.fixture
def opened(qtbot, wiring, tmp_path):
    wiring.files.open_file(scan(tmp_path / "scan.png"))
    qtbot.waitUntil(lambda: wiring.import_controller.preview is not None, timeout=WAIT_MS)
    return wiring


def read(qtbot, wiring):
    """Wait until the picture was read as the panel says."""
    qtbot.waitUntil(
        lambda: wiring.import_controller.preview.reading is wiring.window_.import_panel.reading, timeout=WAIT_MS
    )
    return wiring.import_controller.preview


def on_screen(wiring, col, row):
    """Where a place of the picture, px, lies on the screen."""
    pixels = wiring.window_.views.stages.pixels
    x, y = pixels.pixels.frame.to_mm(np.array([(float(col), float(row))]))[0].tolist()
    return pixels.view.to_screen((x, y)).toPoint()


def test_compute_takes_the_picture_that_is_looked_at(qtbot, opened):
    """F5 did nothing, without a word, as nothing was drawn yet."""
    action = opened.window_.actions_["compute"]
    assert action.isEnabled() and not opened.document.part.entities
    action.trigger()
    qtbot.waitUntil(lambda: opened.computation.state is ComputationState.CURRENT, timeout=WAIT_MS)
    assert opened.import_controller.preview is None and opened.computation.made.report.data["regions"]


def test_a_picture_is_shown_as_it_is_read(opened):
    window, panel = opened.window_, opened.window_.import_panel
    assert opened.display_controller.view is View.STAGES and panel.isVisible() and not window.stages_panel.isVisible()
    view = window.views.stages
    assert not view.rail.isVisible() and not view.player.isVisible() and not window.views.empty.isVisible()
    assert window.file_label.text() == "scan.png" and "A picture, not taken yet" in window.status.badge.text()
    image, colours = view.pixels.grab().toImage(), code_colours(LIGHT)
    for (col, row), code in (
        ((300.5, 80.5), PixelCode.INSIDE),
        ((240.5, 150.5), PixelCode.EMPTY),
        ((20.5, 150.5), PixelCode.CONTOUR),
    ):
        assert image.pixelColor(on_screen(opened, col, row)).name() == colours[code].name(), (col, row)
    assert panel.about.text().startswith(f"360 {TIMES} 240 px") and "300 dpi is a guess" in panel.summary.text()


def test_doubtful_places_are_listed_marked_and_gone_to(qtbot, opened):
    window, panel = opened.window_, opened.window_.import_panel
    places = opened.import_controller.preview.places
    assert len(places) == panel.list.count() >= 4 and panel.ambiguities.text() == f"{len(places)} doubtful places"
    assert (
        panel.list.item(0).text().startswith("Lines meet at column 12")
        and "more than two areas" in panel.list.item(0).toolTip()
    )
    pixels = window.views.stages.pixels
    assert len(pixels.marks) == len(places)
    before = pixels.view.scale
    qtbot.mouseClick(panel.list.viewport(), LEFT, pos=panel.list.visualItemRect(panel.list.item(1)).center())
    qtbot.waitUntil(lambda: pixels.view.scale > 3 * before, timeout=WAIT_MS)
    assert [mark.strong for mark in pixels.marks] == [k == 1 for k in range(len(places))]
    assert pixels.marks[1].at == pytest.approx(opened.import_controller.preview.at(places[1]))


def test_ink_can_be_told_otherwise(qtbot, opened):
    panel = opened.window_.import_panel
    otsu = panel.threshold.value()
    assert DARK_INK < otsu <= PAPER and not panel.otsu.isEnabled()
    panel.threshold.setValue(20)
    assert not read(qtbot, opened).picture.ink.any()
    qtbot.mouseClick(panel.otsu, LEFT)
    lines = read(qtbot, opened)
    assert panel.threshold.value() == otsu and lines.kind is InkMeaning.LINES
    qtbot.mouseClick(panel.invert, LEFT)
    assert np.array_equal(read(qtbot, opened).picture.ink, ~lines.picture.ink)
    qtbot.mouseClick(panel.invert, LEFT)
    qtbot.mouseClick(panel.ink.buttons[InkMeaning.AREAS], LEFT)
    areas = read(qtbot, opened)
    assert "ink itself is machined" in panel.kind.text()
    assert (
        areas.kind is InkMeaning.AREAS
        and np.array_equal(areas.plane == PixelCode.INSIDE, lines.picture.ink)
        and not areas.places
    )
    enter(qtbot, panel.despeckle, "5000")
    assert read(qtbot, opened).picture.ink.sum() < lines.picture.ink.sum()


def test_size_comes_from_the_resolution_or_from_two_points(qtbot, opened):
    panel, pixels = opened.window_.import_panel, opened.window_.views.stages.pixels
    enter(qtbot, panel.dpi, "254")
    assert read(qtbot, opened).reading.frame.pitch == pytest.approx(0.1) and not panel.summary.text()
    qtbot.mouseClick(panel.measure.buttons[SizeGivenBy.POINTS], LEFT)
    read(qtbot, opened)
    assert "first point" in panel.summary.text() and panel.apart.isVisible() and not panel.dpi.isVisible()
    for col, row in ((20, 60), (220, 60)):
        qtbot.mouseClick(pixels, LEFT, pos=on_screen(opened, col, row))
        read(qtbot, opened)
    assert "how far apart" in panel.summary.text()
    places = [mark.at for mark in pixels.marks if mark.strong]
    assert [x for place in places for x in place] == pytest.approx([2.0, 18.0, 22.0, 18.0], abs=0.1)
    assert [x for point in panel.reading.measure.points for x in point] == pytest.approx([20, 60, 220, 60], abs=1)
    enter(qtbot, panel.apart, "100")
    assert read(qtbot, opened).reading.frame.pitch == pytest.approx(0.5, rel=0.01)
    assert float(panel.about.text().split()[4]) == pytest.approx(180, rel=0.01)


def test_the_photograph_itself_can_be_seen(qtbot, opened):
    qtbot.mouseClick(opened.window_.import_panel.see.buttons[PictureAspect.PICTURE], LEFT)
    image = opened.window_.views.stages.pixels.grab().toImage()
    grey = image.pixelColor(on_screen(opened, 300.5, 80.5))
    assert (grey.red(), grey.green(), grey.blue()) == (PAPER, PAPER, PAPER)


def test_a_used_picture_is_the_part_on_its_own_pixels(qtbot, opened):
    window, panel = opened.window_, opened.window_.import_panel
    tools = opened.document.job.tools
    enter(qtbot, panel.dpi, "63.5")
    panel.take.click()
    show_stages(qtbot, opened)
    view = window.views.stages
    assert view.rail.isVisible() and not panel.isVisible() and view.film.shape == (242, 362)
    assert (
        opened.document.job.tools == tools and opened.document.part.entities and window.file_label.text() == "scan.png"
    )
    assert (
        f"picture's own 362 {TIMES} 242 px" in window.stages_panel.bitmap.text()
        and not window.stages_panel.points.isVisible()
    )
    opened.compute()
    qtbot.waitUntil(lambda: opened.computation.state is ComputationState.CURRENT, timeout=60_000)
    made = opened.computation.made
    assert made.program.pitch_mm == pytest.approx(0.4)
    assert not any(finding.kind.name == "GOUGE" for finding in made.findings)
    assert any(finding.kind.name == "AMBIGUOUS" for finding in made.findings)


def test_a_picture_that_was_drawn_in_is_a_drawing(qtbot, opened):
    enter(qtbot, opened.window_.import_panel.dpi, "63.5")
    opened.window_.import_panel.take.click()
    show_stages(qtbot, opened)
    part = opened.document.part
    assert opened.computation.pixels_of(part) is not None
    opened.run("circle 200,200 5")
    assert opened.computation.pixels_of(opened.document.part) is None
    opened.document.undo()
    assert opened.computation.pixels_of(opened.document.part) is not None


def test_what_gives_no_part_is_said_in_the_panel(qtbot, opened):
    panel = opened.window_.import_panel
    panel.threshold.setValue(20)
    panel.take.click()
    qtbot.waitUntil(panel.wrong.isVisible, timeout=WAIT_MS)
    assert "nothing in the picture" in panel.wrong.text() and opened.document.part.entities == ()
    panel.leave.click()
    assert not panel.isVisible() and opened.import_controller.preview is None
    assert opened.window_.views.empty.isVisible()


def test_a_dropped_picture_is_taken_and_a_damaged_one_refused(qtbot, wiring, tmp_path):
    window, path = wiring.window_, scan(tmp_path / "Scan.JPG")
    mime = QMimeData()
    mime.setUrls([QUrl.fromLocalFile(str(path))])
    copy, none = Qt.DropAction.CopyAction, Qt.KeyboardModifier.NoModifier
    enter = QDragEnterEvent(QPoint(50, 50), copy, mime, LEFT, none)
    QApplication.sendEvent(window, enter)
    assert enter.isAccepted()
    QApplication.sendEvent(window, QDropEvent(QPointF(50, 50), copy, mime, LEFT, none))
    qtbot.waitUntil(lambda: wiring.import_controller.preview is not None, timeout=WAIT_MS)
    wiring.import_controller.leave()
    (tmp_path / "cut.png").write_bytes(scan(tmp_path / "whole.png").read_bytes()[:60])
    wiring.files.open_file(tmp_path / "cut.png")
    qtbot.waitUntil(lambda: window.notice.isVisible() and "cut.png" in window.notice.text.text(), timeout=WAIT_MS)
    assert wiring.import_controller.preview is None


def import_of(qtbot, wiring, path):
    """Read a picture and wait for its preview."""
    wiring.files.open_file(path)
    qtbot.waitUntil(
        lambda: wiring.import_controller.preview is not None and wiring.import_controller.preview.reading.path == path,
        timeout=WAIT_MS,
    )


def test_a_gap_is_named_at_one_place_everywhere(qtbot, wiring, tmp_path):
    path = tmp_path / "gap.png"
    cv2.imwrite(str(path), plate(1, island=False))
    import_of(qtbot, wiring, path)
    panel = wiring.window_.import_panel
    assert panel.list.item(0).text() == "Gap at column 150, row 50"
    panel.take.click()
    qtbot.waitUntil(panel.wrong.isVisible, timeout=WAIT_MS)
    assert "enclosed by lines. At column 150, row 50" in panel.wrong.text()
    pixels = wiring.window_.views.stages.pixels
    assert pixel_at(pixels.pixels.frame, pixels.marks[0].at) == (50, 150)


def test_a_resolution_that_cannot_be_meant_is_a_guess(qtbot, wiring, tmp_path):
    path = scan(tmp_path / "neg.bmp")
    data = path.read_bytes()
    path.write_bytes(data[:38] + struct.pack("<ii", -10000, -10000) + data[46:])
    import_of(qtbot, wiring, path)
    assert "300 dpi is a guess" in wiring.window_.import_panel.summary.text()


def test_what_cannot_be_shown_is_said_in_the_panel(qtbot, opened):
    picturing, panel = opened.import_controller, opened.window_.import_panel
    wrong = replace(picturing.preview, reading=replace(picturing.preview.reading, measure=PixelSize(-254.0)))
    picturing.take_from(lambda progress: wrong, picturing.show_preview)
    qtbot.waitUntil(panel.wrong.isVisible, timeout=WAIT_MS)
    assert "pitch is -0.1 mm" in panel.wrong.text()


def test_an_error_goes_when_the_next_picture_is_good(qtbot, wiring, tmp_path):
    notice = wiring.window_.notice
    (tmp_path / "cut.png").write_bytes(scan(tmp_path / "whole.png").read_bytes()[:60])
    wiring.files.open_file(tmp_path / "cut.png")
    qtbot.waitUntil(lambda: notice.isVisible() and "cut.png" in notice.text.text(), timeout=WAIT_MS)
    import_of(qtbot, wiring, tmp_path / "whole.png")
    assert not notice.isVisible()


@pytest.mark.exhaustive
def test_a_picture_that_is_drawn_in_says_so_once(qtbot, opened):
    enter(qtbot, opened.window_.import_panel.dpi, "63.5")
    opened.window_.import_panel.take.click()
    show_stages(qtbot, opened)
    told = [line for line in opened.log.lines if "ordinary drawing" in line.reply]
    assert told == []
    opened.run("circle 200,200 5")
    opened.run("circle 210,200 5")
    told = [line for line in opened.log.lines if "ordinary drawing" in line.reply]
    assert len(told) == 1


def test_another_drawing_takes_the_place_of_the_picture(qtbot, opened, samples):
    opened.files.open_file(samples / "fig2.dxf")
    qtbot.waitUntil(lambda: bool(opened.document.part.entities), timeout=WAIT_MS)
    assert opened.import_controller.preview is None and not opened.window_.import_panel.isVisible()
    assert opened.computation.pixels_of(opened.document.part) is None
