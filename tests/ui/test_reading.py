"""Drawings that leave open how they are to be read: what is asked in the window, what the answers do, and where they
can be changed.
"""

from __future__ import annotations

from collections.abc import Callable
from io import StringIO
from pathlib import Path

import ezdxf
import pytest
from PySide6.QtCore import QMimeData, QPointF, Qt, QUrl
from PySide6.QtGui import QDropEvent
from PySide6.QtWidgets import QLabel, QPushButton

from app.formats.project.files import load_project
from app.model.part import Units
from app.model.read_options import DrawingOptions
from app.model.reading import DrawingSource, ReadingOptions
from app.ui.shell.translation import translate_all
from app.ui.shell.window_controller import WindowController
from tests.ui.conftest import WAIT_MS
from tests.ui.test_save_controller import save_to
from tests.ui.test_translation import left_english, seen_texts


def new(units: int) -> ezdxf.document.Drawing:
    document = ezdxf.new()
    document.header["$INSUNITS"] = units
    return document


def plate(space, x: float = 0.0, y: float = 0.0) -> None:
    """A rectangle, 40 by 20 units."""
    corners = [(x, y), (x + 40, y), (x + 40, y + 20), (x, y + 20)]
    for k in range(4):
        space.add_line(corners[k], corners[(k + 1) % 4])


def in_metres(document) -> None:
    plate(document.modelspace())


def far(document) -> None:
    plate(document.modelspace(), 2_300_000, 410_000)


def on_paper(document) -> None:
    document.layouts.new("A3")
    plate(document.layouts.get("A3"))


def with_a_stray(document) -> None:
    plate(document.modelspace(), 999_980, 0)


def frozen(document) -> None:
    document.layers.add("Old").freeze()
    plate(document.blocks.new("B"))
    document.modelspace().add_blockref("B", (0, 0), {"layer": "Old"})


def written(path: Path, draw: Callable[..., None], units: int = 4) -> Path:
    document = new(units)
    draw(document)
    text = StringIO()
    document.write(text)
    path.write_text(text.getvalue(), "utf-8")
    return path


OLD_SVG = (
    '<svg xmlns="http://www.w3.org/2000/svg" xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" '
    'inkscape:version="0.91 r1">'
    '<rect width="90" height="45" stroke="black" fill="none"/></svg>'
)


def ask(qtbot, wiring: WindowController, path: Path) -> None:
    wiring.files.open_file(path)
    qtbot.waitUntil(wiring.window_.card.isVisible, timeout=WAIT_MS)


def button(wiring: WindowController, words: str) -> QPushButton:
    return next(each for each in wiring.window_.card.buttons if each.text() == words)


def answer(qtbot, wiring: WindowController, words: str) -> None:
    with qtbot.waitSignal(wiring.files.open_controller.opened, timeout=WAIT_MS):
        qtbot.mouseClick(button(wiring, words), Qt.MouseButton.LeftButton)


def source(wiring: WindowController) -> DrawingSource:
    found = wiring.document.state.source
    assert found is not None
    return found


def size(wiring: WindowController) -> tuple[float, float]:
    found = wiring.display_controller.part_size()
    assert found is not None
    return found


def reread(qtbot, wiring: WindowController, act: Callable[[], object]) -> None:
    revision = wiring.document.revision
    act()
    qtbot.waitUntil(lambda: wiring.document.revision > revision, timeout=WAIT_MS)


@pytest.mark.parametrize(
    ("draw", "units", "told", "words", "how"),
    [
        (
            in_metres,
            6,
            "40\u2009000 \u00d7 20\u2009000 mm, and the largest tool 6 mm. The file names m",
            "Take it as mm",
            ReadingOptions(Units.MM, (), DrawingOptions(overrule=True)),
        ),
        (
            far,
            4,
            "more than 1 km from zero: its first curve, at (2300000.000, 410000.000) mm, 2.3 km away",
            "Move it to zero",
            ReadingOptions(None, (), DrawingOptions(to_zero=True)),
        ),
        (
            on_paper,
            4,
            "all that is drawn stands on the layout A3",
            "Take layout A3",
            ReadingOptions(None, (), DrawingOptions(layout="A3")),
        ),
        (frozen, 4, "Nothing of it is shown", "Read layer Old", ReadingOptions(None, ("Old",))),
    ],
)
def test_a_drawing_that_cannot_be_read_is_asked_about_and_read_by_the_answer(
    qtbot,
    wiring,
    tmp_path,
    draw,
    units,
    told,
    words,
    how,
) -> None:
    wiring.document.run("circle 0,0 5")
    wiring.document.mark_saved(tmp_path / "mine.hito")
    path = written(tmp_path / "part.dxf", draw, units)
    ask(qtbot, wiring, path)
    card = wiring.window_.card
    assert card.title.text() == "part.dxf" and told in card.text.text()
    assert len(wiring.document.part.entities) == 1, "the document has changed before the question was answered"
    answer(qtbot, wiring, words)
    assert not card.isVisible() and len(wiring.document.part.entities) == 4
    assert size(wiring) == pytest.approx((40.0, 20.0))
    assert source(wiring) == DrawingSource(str(path), how)
    assert all(layer.visible for layer in wiring.document.part.layers)


def test_a_size_can_be_kept_as_the_file_says(qtbot, wiring, tmp_path) -> None:
    ask(qtbot, wiring, written(tmp_path / "yard.dxf", in_metres, 6))
    assert [each.text() for each in wiring.window_.card.buttons] == ["Take it as mm", "Take it as inch", "Keep m"]
    answer(qtbot, wiring, "Keep m")
    assert size(wiring) == pytest.approx((40_000.0, 20_000.0))


@pytest.mark.parametrize(
    "leave",
    [
        lambda qtbot, card: qtbot.mouseClick(card.cancel, Qt.MouseButton.LeftButton),
        lambda qtbot, card: qtbot.keyClick(card.buttons[0], Qt.Key.Key_Escape),
    ],
)
def test_a_question_that_is_not_answered_leaves_the_document(qtbot, wiring, tmp_path, leave) -> None:
    wiring.document.run("circle 0,0 5")
    wiring.document.mark_saved(tmp_path / "mine.hito")
    state = wiring.document.state
    ask(qtbot, wiring, written(tmp_path / "far.dxf", far))
    leave(qtbot, wiring.window_.card)
    assert not wiring.window_.card.isVisible() and wiring.document.state is state


def test_enter_takes_the_likely_answer(qtbot, wiring, tmp_path) -> None:
    ask(qtbot, wiring, written(tmp_path / "far.dxf", far))
    first = wiring.window_.card.buttons[0]
    qtbot.waitUntil(first.hasFocus)
    with qtbot.waitSignal(wiring.files.open_controller.opened, timeout=WAIT_MS):
        qtbot.keyClick(first, Qt.Key.Key_Space)
    assert source(wiring).reading.how.to_zero


def test_what_was_drawn_meanwhile_is_not_lost_to_the_answer(qtbot, wiring, tmp_path) -> None:
    ask(qtbot, wiring, written(tmp_path / "far.dxf", far))
    wiring.document.run("circle 0,0 5")
    qtbot.mouseClick(button(wiring, "Move it to zero"), Qt.MouseButton.LeftButton)
    assert "not saved" in wiring.window_.notice.text.text() or "in no file yet" in wiring.window_.notice.text.text()
    assert len(wiring.document.part.entities) == 1


def test_a_question_goes_with_the_drawing_that_it_is_about(qtbot, wiring, tmp_path) -> None:
    ask(qtbot, wiring, written(tmp_path / "none.dxf", in_metres, 0))
    wiring.files.new()
    assert not wiring.window_.card.isVisible()


def test_a_dropped_file_and_a_recent_one_are_asked_about_alike(qtbot, wiring, tmp_path) -> None:
    path, window = written(tmp_path / "far.dxf", far), wiring.window_
    data = QMimeData()
    data.setUrls([QUrl.fromLocalFile(str(path))])
    window.dropEvent(
        QDropEvent(
            QPointF(50, 50), Qt.DropAction.CopyAction, data, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier
        )
    )
    qtbot.waitUntil(window.card.isVisible, timeout=WAIT_MS)
    window.card.hide()
    window.preferences.settings = window.preferences.settings.with_recent_file(path)
    window.actions_.recent.aboutToShow.emit()
    window.actions_.recent.actions()[0].trigger()
    qtbot.waitUntil(window.card.isVisible, timeout=WAIT_MS)


def test_curves_beyond_1_km_are_asked_about_after_opening(qtbot, wiring, tmp_path) -> None:
    ask(qtbot, wiring, written(tmp_path / "edge.dxf", with_a_stray))
    assert wiring.window_.card.text.text() == "3 curves lie beyond 1 km and are missing."
    answer(qtbot, wiring, "Move it to zero")
    assert len(wiring.document.part.entities) == 4 and size(wiring) == pytest.approx((40.0, 20.0))


def test_a_stray_that_is_missing_wherever_the_drawing_stands_is_told_and_not_asked_about(
    qtbot, wiring, tmp_path
) -> None:
    def stray(document) -> None:
        plate(document.modelspace())
        document.modelspace().add_circle((2e6, 0), 5)

    with qtbot.waitSignal(wiring.files.open_controller.opened, timeout=WAIT_MS):
        wiring.files.open_file(written(tmp_path / "stray.dxf", stray))
    assert not wiring.window_.card.isVisible()
    assert [finding.text for finding in wiring.display_controller.findings if "beyond 1 km" in finding.text]


def test_an_svg_of_an_older_editor_tells_what_it_was_read_with(qtbot, wiring, tmp_path) -> None:
    path = tmp_path / "old.svg"
    path.write_text(OLD_SVG, "ascii")
    ask(qtbot, wiring, path)
    assert "written by Inkscape 0.91 and was read with 90 units to the inch" in wiring.window_.card.text.text()
    assert size(wiring) == pytest.approx((25.4, 12.7))
    answer(qtbot, wiring, "Read 72 to the inch")
    assert size(wiring) == pytest.approx((31.75, 15.875))
    assert source(wiring).reading.how.pixels_per_inch == 72.0


def test_long_names_do_not_make_the_window_wider(qtbot, wiring, tmp_path) -> None:
    def named(document) -> None:
        document.layouts.new("L" * 200)
        plate(document.layouts.get("L" * 200))

    before = wiring.window_.size()
    ask(qtbot, wiring, written(tmp_path / f"{'n' * 180}.dxf", named))
    assert wiring.window_.size() == before and wiring.window_.minimumSizeHint().width() < before.width()
    answer(qtbot, wiring, f"Take layout {'L' * 39}…")
    assert source(wiring).reading.how.layout == "L" * 200


def test_an_answer_after_work_was_done_is_a_step_that_can_be_undone(qtbot, wiring, tmp_path) -> None:
    ask(qtbot, wiring, written(tmp_path / "none.dxf", in_metres, 0))
    wiring.window_.panel.job_form.margin.committed.emit(3.0)
    assert wiring.document.modified
    reread(qtbot, wiring, lambda: button(wiring, "Read in inch").click())
    assert size(wiring) == pytest.approx((1016.0, 508.0)) and wiring.document.job.stock.margin == 3.0
    wiring.document.undo()
    assert size(wiring) == pytest.approx((40.0, 20.0)) and source(wiring).reading.units is None
    assert wiring.document.job.stock.margin == 3.0


def show_reading(qtbot, wiring: WindowController):
    wiring.window_.actions_["reading"].trigger()
    section = wiring.window_.drawing_page.reading
    qtbot.waitUntil(section.isVisible)
    return section


def test_the_page_shows_how_it_was_read_and_reads_it_again(qtbot, wiring, tmp_path) -> None:
    def both(document) -> None:
        document.layers.add("Holes")
        plate(document.modelspace(), 100, 50)
        document.modelspace().add_circle((120, 60), 5, {"layer": "Holes"})
        on_paper(document)

    with qtbot.waitSignal(wiring.files.open_controller.opened, timeout=WAIT_MS):
        wiring.files.open_file(written(tmp_path / "both.dxf", both))
    section = show_reading(qtbot, wiring)
    assert section.file.text() == "both.dxf" and section.units.box.currentText() == "mm, as in the file"
    reread(qtbot, wiring, lambda: section.to_zero.switch.click())
    assert wiring.window_.canvas.picture.lookup.box == pytest.approx((0.0, 0.0, 40.0, 20.0))
    reread(
        qtbot,
        wiring,
        lambda: section.layers.menu.actions()[
            [a.text() for a in section.layers.menu.actions()].index("Holes")
        ].trigger(),
    )
    assert len(wiring.document.part.entities) == 4 and section.layers.text.text() == "Holes"
    reread(qtbot, wiring, lambda: section.layout_.chosen.emit("A3"))
    assert source(wiring).reading.how == DrawingOptions(layout="A3", to_zero=True, without_layers=("Holes",))
    assert wiring.document.undo_name == "Read both.dxf"
    for _ in range(3):
        wiring.document.undo()
    assert len(wiring.document.part.entities) == 5 and source(wiring).reading == ReadingOptions()
    qtbot.waitUntil(lambda: not section.to_zero.switch.isChecked())


def test_what_was_drawn_since_is_asked_about_before_it_is_replaced(qtbot, wiring, tmp_path) -> None:
    with qtbot.waitSignal(wiring.files.open_controller.opened, timeout=WAIT_MS):
        wiring.files.open_file(written(tmp_path / "plate.dxf", in_metres))
    section, notice = show_reading(qtbot, wiring), wiring.window_.notice
    wiring.document.run("circle 20,10 5")
    section.read_again.click()
    assert notice.text.text() == "Reading plate.dxf again replaces what was drawn in it since; Undo brings it back."
    reread(qtbot, wiring, lambda: notice.buttons[0].click())
    assert len(wiring.document.part.entities) == 4
    wiring.document.undo()
    assert len(wiring.document.part.entities) == 5


def test_a_way_in_which_it_cannot_be_read_is_refused_and_shown_no_longer(qtbot, wiring, tmp_path) -> None:
    with qtbot.waitSignal(wiring.files.open_controller.opened, timeout=WAIT_MS):
        wiring.files.open_file(written(tmp_path / "plate.dxf", in_metres))
    section = show_reading(qtbot, wiring)
    with qtbot.waitSignal(wiring.files.reread_controller.failed, timeout=WAIT_MS) as caught:
        section.layers.chosen.emit(("0",))
    assert "without layer 0 nothing is left" in caught.args[0]
    assert section.layers.text.text() == "none" and source(wiring).reading == ReadingOptions()


def test_a_project_keeps_how_its_drawing_was_read_and_opens_without_a_question(qtbot, wiring, tmp_path) -> None:
    path = written(tmp_path / "drawn.dxf", in_metres, 6)
    ask(qtbot, wiring, path)
    answer(qtbot, wiring, "Take it as mm")
    save_to(qtbot, wiring, tmp_path / "yard.hito")
    assert load_project(tmp_path / "yard.hito").project.state.source == source(wiring)
    assert 'path = "drawn.dxf"' in (tmp_path / "yard.hito").read_text("utf-8")
    wiring.files.new()
    with qtbot.waitSignal(wiring.files.open_controller.opened, timeout=WAIT_MS):
        wiring.files.open_file(tmp_path / "yard.hito")
    assert not wiring.window_.card.isVisible() and size(wiring) == pytest.approx((40.0, 20.0))
    section = show_reading(qtbot, wiring)
    qtbot.waitUntil(lambda: section.contents is not None, timeout=WAIT_MS)
    assert section.units.value is Units.MM and section.units.box.itemText(0) == "m, as in the file"
    section.units.chosen.emit(Units.INCH)
    reread(qtbot, wiring, lambda: wiring.window_.notice.buttons[0].click())
    assert size(wiring) == pytest.approx((1016.0, 508.0)) and wiring.document.part.name == "yard"


def test_a_project_whose_drawing_is_gone_says_so(qtbot, wiring, tmp_path) -> None:
    path = written(tmp_path / "plate.dxf", in_metres)
    with qtbot.waitSignal(wiring.files.open_controller.opened, timeout=WAIT_MS):
        wiring.files.open_file(path)
    save_to(qtbot, wiring, tmp_path / "plate.hito")
    path.unlink()
    with qtbot.waitSignal(wiring.files.open_controller.opened, timeout=WAIT_MS):
        wiring.files.open_file(tmp_path / "plate.hito")
    section = show_reading(qtbot, wiring)
    qtbot.waitUntil(lambda: bool(section.trouble.text()), timeout=WAIT_MS)
    assert "plate.dxf is no longer in" in section.trouble.text() and not section.units.isEnabled()


def test_a_drawing_of_ones_own_has_nothing_to_read(wiring) -> None:
    wiring.document.run("rect 0,0 10,10")
    wiring.window_.side.show_page("Drawing")
    assert wiring.window_.drawing_page.reading.isHidden()
    assert not wiring.window_.actions_["reading"].isEnabled()


@pytest.fixture
def japanese_wiring(wiring):
    wiring.window_.actions_["language_ja"].trigger()
    yield wiring
    wiring.window_.actions_["language_en"].trigger()


@pytest.mark.parametrize(
    ("draw", "units"), [(in_metres, 6), (far, 4), (on_paper, 4), (frozen, 4), (with_a_stray, 4), (in_metres, 0)]
)
def test_every_question_is_asked_in_japanese(qtbot, japanese_wiring, tmp_path, draw, units) -> None:
    wiring = japanese_wiring
    ask(qtbot, wiring, written(tmp_path / "1.dxf", draw, units))
    card = wiring.window_.card
    translate_all(card)
    told = {label.text() for label in card.findChildren(QLabel) if label.isVisible() and label is not card.title}
    buttons = {each.text() for each in card.findChildren(QPushButton) if each.isVisible()}
    assert left_english(told | buttons | {card.accessibleName()}) == []
    assert told.isdisjoint({"", card.title.text()}) and len(told) > 1


def test_the_page_speaks_japanese(qtbot, japanese_wiring, tmp_path) -> None:
    path = written(tmp_path / "1.dxf", in_metres, 0)
    ask(qtbot, japanese_wiring, path)
    section = show_reading(qtbot, japanese_wiring)
    translate_all(section)
    assert left_english(seen_texts(section) - {str(path), path.name}) == []
