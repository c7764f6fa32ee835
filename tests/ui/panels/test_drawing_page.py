"""The page of the drawing: numbers that change it, layers, history; every change is one line of the shape language."""

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtWidgets import QApplication, QLabel

from app.drafting.curves.shapes import curve_length
from app.drafting.document import Document
from app.geometry.sample import bounds, union
from app.model.curves import Arc, Circle, Line
from app.model.notes import Dimension, DimensionKind
from app.model.part import Part
from app.ui.framework import style
from app.ui.framework.figures import TIMES
from app.ui.framework.side_scroll import WIDTH
from app.ui.framework.theme import DARK, LIGHT
from app.ui.panels.drawing_page import DrawingPage
from app.ui.panels.swatch import HUES, ColourPalette
from tests.ui.fields_typed import enter

SCROLL_BAR_PX = 8


@pytest.fixture
def document() -> Document:
    made = Document()
    made.run_script("line 10,10 60,10\narc 10,0 0,10 centre 0,0\nlayer holes\ncircle 5,5 3\ncircle 50,5 4")
    return made


@pytest.fixture
def page(qtbot, document) -> DrawingPage:
    made = DrawingPage(document, lambda: union([bounds(e.curve) for e in document.part.entities]))
    qtbot.addWidget(made)
    made.resize(WIDTH, 700)
    made.show()
    return made


def select(page: DrawingPage, document: Document, *ids: int) -> None:
    document.select(ids)
    page.refresh()
    QApplication.processEvents()


def last(document: Document) -> str:
    return document.log[-1].command


def test_with_nothing_selected_the_drawing_is_told_in_figures(page):
    told = {name: figure.value.text() for name, figure in page.properties.figures.items()}
    assert told == {"Curves": "4", "Extent": f"60.000 {TIMES} 10.000 mm", "Lower left": "0.000, 0.000", "Units": "mm"}
    assert page.properties.remark.text() == "nothing selected" and not page.properties.layer.isVisible()


def test_a_number_of_a_line_changes_it_by_one_line_that_can_be_undone(qtbot, page, document):
    select(page, document, 1)
    fields = page.properties.fields
    assert list(fields) == ["start", "end", "length", "angle"] and page.properties.remark.text() == "Line 1"
    enter(qtbot, fields["length"], "1in/2")
    assert last(document) == "set 1 length 12.7" and document.part.curve(1) == Line((10, 10), (22.7, 10))
    page.refresh()
    assert fields["end"].across.edit.text() == "22.700"
    document.undo()
    assert document.part.curve(1) == Line((10, 10), (60, 10))


def test_a_coordinate_changes_alone_to_the_last_digit(qtbot, page, document):
    document.run("set 1 end 60.123456789,10")
    select(page, document, 1)
    enter(qtbot, page.properties.fields["end"].up, "20")
    assert last(document) == "set 1 end 60.123456789,20"


def test_names_of_the_drawing_can_be_typed(qtbot, page, document):
    document.run("let w = 7")
    select(page, document, 3)
    enter(qtbot, page.properties.fields["radius"], "w/2")
    assert document.part.curve(3) == Circle((5, 5), 3.5)


def test_what_the_drawing_refuses_is_said_under_the_field_and_escape_brings_the_old_value_back(qtbot, page, document):
    select(page, document, 2)
    field = page.properties.fields["sweep"]
    enter(qtbot, field, "400")
    assert (
        "less than 360" in field.reason.text() and field.reason.isVisible() and field.edit.property("wrong") == "true"
    )
    assert document.part.curve(2) == Arc((10, 0), (0, 10), (0, 0))
    qtbot.keyClick(field.edit, Qt.Key.Key_Escape)
    assert field.edit.text() == "90.00" and field.edit.property("wrong") == "false"
    point = page.properties.fields["end"]
    enter(qtbot, point.across, "10")
    enter(qtbot, point.up, "0")
    assert "begins and ends" in point.reason.text() or "same as" in point.reason.text()


def test_what_is_no_number_is_marked_while_it_is_typed(qtbot, page, document):
    select(page, document, 3)
    field = page.properties.fields["radius"]
    field.edit.setFocus()
    field.edit.selectAll()
    qtbot.keyClicks(field.edit, "2*")
    assert field.edit.property("wrong") == "true" and field.reason.isVisible()


def test_several_show_what_they_have_in_common(qtbot, page, document):
    select(page, document, 3, 4)
    fields = page.properties.fields
    assert list(fields) == ["radius", "diameter", "length"] and fields["radius"].edit.placeholderText() == "various"
    assert (
        page.properties.figures["Kinds"].value.text() == "2 circles"
        and page.properties.layer.box.currentText() == "holes"
    )
    enter(qtbot, fields["diameter"], "9")
    assert last(document) == "set diameter 9"
    assert [document.part.curve(n) for n in (3, 4)] == [Circle((5, 5), 4.5), Circle((50, 5), 4.5)]
    page.refresh()
    assert fields["radius"].edit.text() == "4.500"


def test_different_kinds_share_their_layer_and_their_length(page, document, qtbot):
    select(page, document, 1, 2, 3)
    assert list(page.properties.fields) == ["length"] and page.properties.layer.box.currentIndex() == -1
    assert page.properties.figures["Kinds"].value.text() == "1 line, 1 arc, 1 circle"
    page.properties.layer.box.activated.emit(1)
    assert last(document) == 'set layer "holes"' and {e.layer for e in document.part.entities} == {"holes"}
    page.refresh()
    before = document.revision
    page.properties.layer.box.activated.emit(1)
    assert document.revision == before


def test_a_closed_contour_tells_its_area(page, document):
    select(page, document, 3)
    assert page.properties.figures["Area"].value.text() == "28.274 mm²"
    document.run("rect 100,100 160,140")
    select(page, document, 5, 6, 7, 8)
    assert page.properties.figures["Area"].value.text() == "2\u2009400.000 mm²"
    select(page, document, 5, 6, 7)
    assert "Area" not in page.properties.figures


@pytest.mark.exhaustive
def test_many_curves_are_added_up_while_the_window_lives(qtbot, page, document):
    document.run("spline 0,100 3,104 5,106 7,102; array 40 40 @20,20 5")
    select(page, document, *(e.id for e in document.part.entities if e.id >= 5))
    figures = page.properties.figures
    qtbot.waitUntil(lambda: figures["Extent"].value.text() != "")
    one = curve_length(document.part.curve(5))
    assert float(figures["Total length"].value.text().replace("\u2009", "").removesuffix(" mm")) == pytest.approx(
        1600 * one, abs=1e-2
    )
    document.run("move @100,0 5")
    page.refresh()
    qtbot.waitUntil(lambda: figures["Extent"].value.text() != "")
    select(page, document, 1, 2)
    assert page.properties.figures["Extent"].value.text() == f"60.000 {TIMES} 10.000 mm"


def test_a_dimension_tells_what_it_measures(page, document):
    part = Part().with_note(Dimension(DimensionKind.RADIUS, ((0, 0), (5, 0)), (9, 9)), "0")
    document.load(type(document.job)(part))
    document.selection = frozenset({1})
    page.refresh()
    assert {name: f.value.text() for name, f in page.properties.figures.items()} == {
        "Measures": "radius",
        "Figure": "R 5",
    }
    assert list(page.properties.fields) == ["place"]


def test_layers_show_their_state_and_a_click_draws_on_one(qtbot, page, document):
    rows = page.layers.rows_by_name
    assert [(name, row.count.text(), row.property("chosen")) for name, row in rows.items()] == [
        ("0", "2", "false"),
        ("holes", "2", "true"),
    ]
    assert rows["holes"].accessibleName() == "Layer holes, 2 curves, current"
    qtbot.mouseClick(rows["0"], Qt.MouseButton.LeftButton, pos=QPoint(150, 10))
    page.refresh()
    assert document.layer == "0" and rows["0"].property("chosen") == "true" and last(document) == 'layer "0"'


def test_layers_are_dragged_and_stepped_into_another_order(qtbot, page, document):
    document.run("layer marks; layer 0")
    page.refresh()
    row = page.layers.rows_by_name["0"]
    qtbot.mousePress(row, Qt.MouseButton.LeftButton, pos=QPoint(150, 10))
    at = row.mapToGlobal(QPoint(150, 10))
    for way in (10, 24, 40, 52, 60):
        qtbot.mouseMove(row, row.mapFromGlobal(at + QPoint(0, way)))
        page.refresh()
    qtbot.mouseRelease(row, Qt.MouseButton.LeftButton)
    assert list(page.layers.rows_by_name) == ["holes", "marks", "0"] == [layer.name for layer in document.part.layers]
    assert [line.command for line in document.log[-2:]] == [
        'order layer "0" after "holes"',
        'order layer "0" after "marks"',
    ]
    row.setFocus()
    qtbot.keyClick(row, Qt.Key.Key_Up, Qt.KeyboardModifier.AltModifier)
    page.refresh()
    assert list(page.layers.rows_by_name) == ["holes", "0", "marks"] and page.layers.rows_by_name["0"] is row
    entries = {action.text().replace("&", ""): action for action in page.layers.menu("holes").actions()}
    assert not entries["Move up"].isEnabled()
    entries["Move down"].trigger()
    assert last(document) == 'order layer "holes" after "0"'


def test_eye_lock_and_colour_are_lines(qtbot, page, document):
    row = page.layers.rows_by_name["holes"]
    for button, line in (
        (row.eye, 'hide "holes"'),
        (row.bolt, 'lock "holes"'),
        (row.eye, 'show "holes"'),
        (row.bolt, 'unlock "holes"'),
    ):
        qtbot.mouseClick(button, Qt.MouseButton.LeftButton)
        page.refresh()
        assert last(document) == line
    assert row.eye.accessibleName() == "Hide layer holes"


def palette_of(qtbot, row) -> ColourPalette:
    qtbot.mouseClick(row.swatch, Qt.MouseButton.LeftButton)
    return next(w for w in QApplication.topLevelWidgets() if isinstance(w, ColourPalette) and w.isVisible())


def test_a_colour_is_chosen_from_the_palette_or_typed(qtbot, page, document):
    row = page.layers.rows_by_name["holes"]
    qtbot.mouseClick(palette_of(qtbot, row).hues["#d55e00"], Qt.MouseButton.LeftButton)
    assert document.part.layers[1].colour == "#d55e00" and "vermilion" in HUES.values()
    page.refresh()
    assert "vermilion" in row.swatch.accessibleName()
    palette = palette_of(qtbot, row)
    palette.other.setText("#12345")
    qtbot.keyClick(palette.other, Qt.Key.Key_Return)
    assert palette.other.property("wrong") == "true" and document.part.layers[1].colour == "#d55e00"
    palette.other.setText("123456")
    qtbot.keyClick(palette.other, Qt.Key.Key_Return)
    assert document.part.layers[1].colour == "#123456"


def test_a_double_click_renames(qtbot, page, document):
    row = page.layers.rows_by_name["holes"]
    qtbot.mouseDClick(row, Qt.MouseButton.LeftButton, pos=QPoint(150, 10))
    assert row.edit.isVisible() and row.edit.selectedText() == "holes"
    qtbot.keyClicks(row.edit, "bolt holes")
    qtbot.keyClick(row.edit, Qt.Key.Key_Return)
    page.refresh()
    assert last(document) == 'rename layer "holes" to "bolt holes"' and list(page.layers.rows_by_name) == [
        "0",
        "bolt holes",
    ]
    row = page.layers.rows_by_name["bolt holes"]
    row.begin_rename()
    qtbot.keyClicks(row.edit, "x")
    qtbot.keyClick(row.edit, Qt.Key.Key_Escape)
    assert not row.edit.isVisible() and document.part.layers[1].name == "bolt holes"


def test_a_new_layer_is_current_and_asks_for_its_name(qtbot, page, document):
    qtbot.mouseClick(page.layers.add_button, Qt.MouseButton.LeftButton)
    page.refresh()
    row = page.layers.rows_by_name["Layer 1"]
    assert document.layer == "Layer 1" and row.edit.isVisible()
    qtbot.keyClicks(row.edit, "text")
    qtbot.keyClick(row.edit, Qt.Key.Key_Return)
    assert document.layer == "text"


def test_every_new_layer_has_a_colour_of_its_own(qtbot, page, document):
    before = len(document.part.layers)
    for _ in range(8):
        qtbot.mouseClick(page.layers.add_button, Qt.MouseButton.LeftButton)
        page.refresh()
    *colours, last_colour = [layer.colour for layer in document.part.layers[before:]]
    assert all(colours) and len(set(colours)) == 7, "so many can be told apart, and seen on white"
    assert last_colour == ""
    document.undo()
    document.undo()
    assert len(document.part.layers) == before + 6, "layer and colour are one step"


def test_an_empty_layer_goes_at_once_and_a_full_one_is_asked_about(qtbot, page, document):
    document.run("layer empty")
    page.refresh()
    row = page.layers.rows_by_name["empty"]
    row.setFocus()
    qtbot.keyClick(row, Qt.Key.Key_Delete)
    assert last(document) == 'remove layer "empty"'
    page.refresh()
    with qtbot.waitSignal(page.layers.removal) as asked:
        qtbot.keyClick(page.layers.rows_by_name["holes"], Qt.Key.Key_Delete)
    assert asked.args == ["holes", 2] and "holes" in [layer.name for layer in document.part.layers]


def test_the_menu_of_a_layer_puts_the_selection_there(page, document):
    document.select({1})
    entries = {action.text().replace("&", ""): action for action in page.layers.menu("holes").actions()}
    assert not entries["Draw on it"].isEnabled()
    entries["Put the selection here"].trigger()
    assert last(document) == 'set layer "holes"' and document.part.entities[0].layer == "holes"
    entries["Select what is on it"].trigger()
    assert document.selection == {1, 3, 4}


def test_history_goes_back_and_forth_by_a_click_and_by_enter(qtbot, page, document):
    listed = page.history.list
    assert [listed.item(at).text() for at in range(listed.count())] == [
        "Beginning",
        "Line",
        "Arc",
        "Layer",
        "Circle",
        "Circle",
    ]
    assert listed.currentRow() == 5
    qtbot.mouseClick(listed.viewport(), Qt.MouseButton.LeftButton, pos=listed.visualItemRect(listed.item(2)).center())
    page.refresh()
    assert (
        len(document.part.entities) == 2 and page.history.remark.text() == "3 taken back" and last(document) == "undo 3"
    )
    assert listed.item(3).foreground().color() == LIGHT.muted and listed.item(2).foreground().color() == LIGHT.ink
    listed.setCurrentRow(5)
    qtbot.keyClick(listed, Qt.Key.Key_Return)
    page.refresh()
    assert len(document.part.entities) == 4 and page.history.remark.text() == ""


def test_the_page_follows_the_document_while_it_is_seen(qtbot, page, document):
    document.select({1})
    qtbot.waitUntil(lambda: page.properties.remark.text() == "Line 1")
    page.hide()
    document.select({2})
    page.show()
    assert page.properties.remark.text() == "Arc 2"


@pytest.mark.parametrize("theme", [LIGHT, DARK])
def test_nothing_is_wider_than_the_page(qapp, page, document, theme):
    style.apply(qapp, theme)
    document.run("spline 0,0 10,10 20,0 30,30; ellipse 0,0 20,0 5")
    try:
        for chosen in ((), (1,), (2,), (3,), (5,), (6,), (1, 2, 3), (3, 4)):
            select(page, document, *chosen)
            assert page.widget().minimumSizeHint().width() <= WIDTH - SCROLL_BAR_PX, chosen
            for label in page.properties.findChildren(QLabel):
                assert not label.isVisible() or label.width() >= label.minimumSizeHint().width()
    finally:
        qapp.setStyleSheet("")
