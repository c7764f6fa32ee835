"""The side panel: fields that accept arithmetic and units, mark what is wrong at once, and change the job undoably."""

from collections.abc import Iterator
from dataclasses import replace

import pytest
from PySide6.QtCore import QEvent, QPoint, QPointF, Qt
from PySide6.QtGui import QFocusEvent, QMouseEvent
from PySide6.QtWidgets import QApplication, QLabel

from app.drafting.document import Document
from app.gcode.posts import post_titles
from app.model.contour_operation import ContourOperation
from app.model.entry import Lead, LeadKind, Tabs
from app.model.hole_operations import DrillOperation
from app.model.job import Job, OriginXY
from app.model.operation import CutParameters, Order, PocketOperation, Side
from app.model.operation_kinds import OPERATION_KINDS
from app.model.part import Part
from app.model.tool import Tool
from app.ui.framework import style
from app.ui.framework.dropping import place_under
from app.ui.framework.section import ListRow
from app.ui.framework.side_scroll import WIDTH
from app.ui.framework.theme import LIGHT, TEXT_PX, text_font
from app.ui.panels.changes import Subject, SubjectKind, with_tool
from app.ui.panels.lists import OperationTimes
from app.ui.panels.side_panel import SidePanel
from tests.ui.fields_typed import enter

SCROLL_BAR_PX = 8


FIRST = Subject(SubjectKind.OPERATION, 0)


@pytest.fixture(scope="module")
def shared(qapp) -> Iterator[tuple[Document, SidePanel]]:
    """One panel for all tests: making its 400 widgets takes longer than most of what is asked of it."""
    document = Document(Job(Part()))
    made = SidePanel(document)
    yield document, made
    made.deleteLater()


@pytest.fixture
def document(shared) -> Document:
    document, _ = shared
    document.load(Job(Part()))
    return document


@pytest.fixture
def panel(shared, document) -> Iterator[SidePanel]:
    """The panel as it is when the window opens."""
    _, made = shared
    made.resize(made.sizeHint())
    made.show_results(OperationTimes({}), None)
    made.choose(FIRST)
    for group in made.operation_form.groups:
        group.group.fold.setChecked(False)
    made.show()
    yield made
    made.hide()


def test_notes_for_the_sheet_are_written_and_undone(qtbot, document, panel):
    panel.choose(Subject(SubjectKind.JOB))
    enter(qtbot, panel.job_form.clamping, "  two vices ")
    enter(qtbot, panel.job_form.zero, "3D taster")
    assert (document.job.clamping_note, document.job.zero_note) == ("two vices", "3D taster")
    document.undo()
    assert document.job.zero_note == panel.job_form.zero.edit.text() == ""
    assert document.job.clamping_note == panel.job_form.clamping.edit.text() == "two vices"


def test_every_post_can_be_chosen_by_its_title(qtbot, document, panel):
    panel.choose(Subject(SubjectKind.JOB))
    box = panel.job_form.post.box
    assert [box.itemText(k) for k in range(box.count())] == list(post_titles().values())
    assert box.currentText() == "LinuxCNC"
    box.activated.emit(list(post_titles()).index("haas"))
    assert document.job.post == "haas" and box.currentText() == "Haas"
    document.undo()
    assert document.job.post == "linuxcnc" and box.currentText() == "LinuxCNC"


def test_arithmetic_and_units_are_read(qtbot, document, panel):
    enter(qtbot, panel.operation_form.number("depth"), "1in + 8mm")
    assert document.job.operations[0].cut.depth == pytest.approx(33.4)
    assert panel.operation_form.number("depth").edit.text() == "33.400"


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("-1", "use 0.001 to 99999"),
        ("0", "use 0.001"),
        ("2 furlongs", "is no unit"),
        ("3+", "ends too early"),
        ("", "ends too early"),
    ],
)
def test_wrong_input_is_marked_at_once_with_the_reason_and_changes_nothing(qtbot, document, panel, text, reason):
    field, before = panel.operation_form.number("depth"), document.job
    field.edit.setFocus()
    field.edit.selectAll()
    qtbot.keyClick(field.edit, Qt.Key.Key_Backspace)
    qtbot.keyClicks(field.edit, text)
    assert field.edit.property("wrong") == "true", "not marked while typing"
    assert reason in field.reason.text()
    assert field.reason.isVisible()
    qtbot.keyClick(field.edit, Qt.Key.Key_Return)
    assert document.job is before


def test_escape_brings_the_old_value_back(qtbot, document, panel):
    field = panel.operation_form.number("depth")
    field.edit.setFocus()
    field.edit.selectAll()
    qtbot.keyClicks(field.edit, "nonsense")
    qtbot.keyClick(field.edit, Qt.Key.Key_Escape)
    assert field.edit.text() == "2.000"
    assert not field.reason.isVisible()


def test_stepover_by_per_cent_shows_overlap(qtbot, document, panel):
    form = panel.operation_form
    enter(qtbot, form.number("stepover"), "40%")
    assert document.job.operations[0].stepover == pytest.approx(2.4)
    assert form.number("stepover").note.text() == "40.0 %"
    assert form.overlap.text() == "3.600 mm"


def test_stepover_larger_than_the_tool_is_refused(qtbot, document, panel):
    enter(qtbot, panel.operation_form.number("stepover"), "7")
    assert document.job.operations[0].stepover is None
    assert "not more than the tool's diameter, 6 mm" in panel.operation_form.number("stepover").reason.text()


def test_every_change_is_undone_by_its_name(qtbot, document, panel):
    enter(qtbot, panel.operation_form.number("depth"), "5")
    panel.choose(Subject(SubjectKind.TOOL, 1))
    enter(qtbot, panel.tool_form.diameter, "1/4in")
    assert document.job.tool(1).diameter == pytest.approx(6.35)
    assert document.undo_name == "Change diameter"
    document.undo()
    assert document.job.tool(1).diameter == 6.0
    assert panel.tool_form.diameter.edit.text() == "6.000"
    assert document.undo_name == "Change depth"


def test_tools_are_added_and_removed_but_not_while_in_use(qtbot, document, panel):
    qtbot.mouseClick(panel.tools.add_button, Qt.MouseButton.LeftButton)
    assert [t.number for t in document.job.tools] == [1, 2, 3]
    assert panel.subject == Subject(SubjectKind.TOOL, 3)
    qtbot.mouseClick(panel.tool_form.remove_button, Qt.MouseButton.LeftButton)
    assert [t.number for t in document.job.tools] == [1, 2]
    panel.choose(Subject(SubjectKind.TOOL, 1))
    with qtbot.waitSignal(panel.refused) as caught:
        qtbot.mouseClick(panel.tool_form.remove_button, Qt.MouseButton.LeftButton)
    assert caught.args[0] == "T1 is used by Pocket; give that operation another tool first."


def test_new_number_of_a_tool_follows_into_its_operation(qtbot, document, panel):
    panel.choose(Subject(SubjectKind.TOOL, 1))
    enter(qtbot, panel.tool_form.number, "7")
    assert document.job.operations[0].cut.tool == 7
    assert panel.subject == Subject(SubjectKind.TOOL, 7)
    enter(qtbot, panel.tool_form.number, "2")
    assert "T2 is another tool" in panel.tool_form.number.reason.text()
    assert panel.subject == Subject(SubjectKind.TOOL, 7)


def test_switch_turns_an_operation_off(qtbot, document, panel):
    qtbot.mouseClick(panel.operations.switches[1], Qt.MouseButton.LeftButton)
    assert [op.cut.enabled for op in document.job.operations] == [True, False, True]
    assert document.undo_name == "Switch operation off"


@pytest.mark.parametrize("kind", OPERATION_KINDS.values())
def test_operations_are_added_and_removed(qtbot, document, panel, kind):
    panel.operations.added.emit(kind)
    assert isinstance(document.job.operations[panel.subject.key], kind)
    for _ in range(4):
        qtbot.mouseClick(panel.operation_form.remove_button, Qt.MouseButton.LeftButton)
    assert document.job.operations == ()
    assert panel.subject.kind is SubjectKind.JOB


def kinds(document):
    return "".join(op.WORD[0].upper() for op in document.job.operations)


def test_operations_are_listed_as_they_are_cut(qtbot, document, panel):
    assert kinds(document) == "PRC"
    panel.operations.added.emit(PocketOperation)
    assert (kinds(document), panel.subject.key) == ("PRPC", 2)
    panel.choose(Subject(SubjectKind.JOB))
    qtbot.mouseClick(panel.job_form.order.buttons[Order.PATENT_1986], Qt.MouseButton.LeftButton)
    assert kinds(document) == "CPRP"
    panel.operations.added.emit(ContourOperation)
    assert (kinds(document), panel.subject.key) == ("CCPRP", 1)


def test_operations_move_freely_with_keys_and_buttons(qtbot, document, panel):
    moved = document.job.operations[0]
    panel.choose(Subject(SubjectKind.OPERATION, 0))
    assert not panel.operation_form.earlier.isEnabled()
    qtbot.mouseClick(panel.operation_form.later, Qt.MouseButton.LeftButton)
    assert (kinds(document), panel.subject.key) == ("RPC", 1)
    assert document.job.operations[1] is moved
    row = panel.window().focusWidget()
    qtbot.keyClick(row, Qt.Key.Key_Down, Qt.KeyboardModifier.AltModifier)
    assert (kinds(document), panel.subject.key) == ("RCP", 2)
    document.undo()
    assert (kinds(document), document.undo_name) == ("RPC", "Move operation")


def test_an_operation_is_duplicated_beside_itself(qtbot, document, panel):
    panel.choose(Subject(SubjectKind.OPERATION, 1))
    qtbot.mouseClick(panel.operation_form.twice, Qt.MouseButton.LeftButton)
    assert (kinds(document), panel.subject.key) == ("PRRC", 2)
    assert document.job.operations[1] == document.job.operations[2]
    panel.operations.focus(panel.subject)
    qtbot.keyClick(panel.window().focusWidget(), Qt.Key.Key_D, Qt.KeyboardModifier.ControlModifier)
    assert kinds(document) == "PRRRC"
    document.undo()
    assert (kinds(document), document.undo_name) == ("PRRC", "Duplicate operation")


def test_a_dragged_row_moves_its_operation(qtbot, document, panel):
    row = panel.operations._rows[Subject(SubjectKind.OPERATION, 0)]
    where, left = QPointF(row.rect().center()), Qt.MouseButton.LeftButton
    for kind, at in (
        (QEvent.Type.MouseButtonPress, where),
        (QEvent.Type.MouseMove, where + QPointF(0, row.height() + 2)),
    ):
        QApplication.sendEvent(
            row, QMouseEvent(kind, at, row.mapToGlobal(at), left, left, Qt.KeyboardModifier.NoModifier)
        )
    assert (kinds(document), panel.subject.key) == ("RPC", 1)


def test_contour_has_no_stepover(qtbot, document, panel):
    panel.choose(Subject(SubjectKind.OPERATION, 2))
    assert panel.operation_form.title.text() == "Contour"
    assert not panel.operation_form.number("stepover").isVisible()


def test_stock_and_origin(qtbot, document, panel):
    panel.choose(Subject(SubjectKind.JOB))
    enter(qtbot, panel.job_form.margin, "5")
    panel.job_form.origin_xy.box.setCurrentIndex(1)
    panel.job_form.origin_xy.box.activated.emit(1)
    assert document.job.stock.margin == 5.0
    assert document.job.origin_xy is OriginXY.LOWER_LEFT
    assert panel.job.origin.text() == "Lower left of stock, top of stock"


def test_what_only_the_job_knows_is_said_at_the_field(qtbot, document, panel):
    document.change_job("Tools", Job(Part(), tools=(Tool(1, 6.0),), operations=(PocketOperation(CutParameters(1)),)))
    panel.choose(Subject(SubjectKind.TOOL, 1))
    enter(qtbot, panel.tool_form.speed, "12in")
    assert "type the number alone" in panel.tool_form.speed.reason.text()


@pytest.mark.parametrize("kind", list(SubjectKind))
def test_nothing_is_wider_than_the_panel(qtbot, document, panel, kind):
    panel.resize(panel.width(), 300)
    enter(qtbot, panel.operation_form.number("depth"), "12")
    panel.show_results(OperationTimes({0: 36_000.0, 1: 0.0}), 123)
    panel.choose(Subject(kind, 1 if kind is SubjectKind.TOOL else 0))
    qtbot.wait(20)
    assert panel.widget().minimumSizeHint().width() <= WIDTH - SCROLL_BAR_PX


def test_values_that_do_not_fit_one_another_are_marked(qtbot, document, panel):
    form = panel.operation_form
    enter(qtbot, form.number("depth"), "12")
    assert "the stock is 10 mm thick" in form.number("depth").reason.text()
    enter(qtbot, form.number("stepover"), "4")
    tool = document.job.tool(1)
    document.change_job("Smaller tool", with_tool(document.job, 1, replace(tool, diameter=3.0)))
    assert "not more than the tool's diameter, 3 mm" in form.number("stepover").reason.text()
    document.undo()
    assert not form.number("stepover").reason.isVisible()


@pytest.fixture(params=[TEXT_PX, TEXT_PX + 1])
def styled(qapp, request) -> Iterator[None]:
    """The program's own style; and once more with letters a pixel larger, for other machines have other fonts."""
    font, colours, sheet = qapp.font(), qapp.palette(), qapp.styleSheet()
    style.apply(qapp, LIGHT)
    qapp.setFont(text_font(request.param))
    yield
    qapp.setStyleSheet(sheet)
    qapp.setPalette(colours)
    qapp.setFont(font)


def test_nothing_is_wider_than_the_panel_when_all_is_set_and_unfolded(qtbot, styled, document, panel):
    lead, tabs = Lead(LeadKind.ARC, 2.0), Tabs(3)
    contour = ContourOperation(
        CutParameters(2, finish_depth=0.2, floor_to_leave=0.1), Side.OUTSIDE, lead, tabs, 2, True, 0.2
    )
    document.change_job(
        "All", replace(document.job, operations=(contour, DrillOperation(CutParameters(1), 2.0, 3.0, 1.0, through=1.0)))
    )
    for index in (0, 1):
        panel.choose(Subject(SubjectKind.OPERATION, index))
        for group in panel.operation_form.groups:
            group.group.fold.setChecked(True)
        qtbot.wait(1)
        assert panel.widget().minimumSizeHint().width() <= WIDTH - SCROLL_BAR_PX


def test_a_depth_that_the_flutes_do_not_reach_is_marked_before_anything_is_computed(qtbot, document, panel):
    tool = document.job.tools[0]
    document.change_job("Flutes", with_tool(document.job, tool.number, replace(tool, flute_length=8.0)))
    enter(qtbot, panel.operation_form.number("depth"), "9")
    field = panel.operation_form.number("depth")
    assert "flutes of T1 are 8 mm long" in field.reason.text() and not field.reason.isHidden()
    assert document.job.operations[0].cut.depth == 9, "it is told, not forbidden"
    enter(qtbot, field, "8")
    assert field.reason.isHidden()


@pytest.mark.parametrize(("flutes", "words"), [(5.0, "cuts 5 mm with its flutes"), (0.0, "")])
def test_a_step_down_that_the_cutter_cannot_take_is_marked(qtbot, document, panel, flutes, words):
    tool = document.job.tools[0]
    document.change_job("Flutes", with_tool(document.job, tool.number, replace(tool, flute_length=flutes)))
    enter(qtbot, panel.operation_form.number("depth"), "5")
    enter(qtbot, panel.operation_form.number("stepdown"), "6")
    assert panel.operation_form.number("stepdown").reason.text() == "", "no deeper than the depth"
    enter(qtbot, panel.operation_form.number("depth"), "10")
    assert words in panel.operation_form.number("stepdown").reason.text()
    assert bool(panel.operation_form.number("stepdown").reason.text()) is bool(words)


def test_the_menu_of_a_plus_stays_in_the_window(qtbot, panel):
    button, width = panel.operations.add_button, panel.operations.menu.sizeHint().width()
    left = place_under(button, width).x()
    right_of_window = panel.window().mapToGlobal(QPoint(panel.window().width(), 0)).x()
    assert left + width == right_of_window, "it would have left it"
    assert place_under(button, 4).x() == button.mapToGlobal(QPoint(0, 0)).x(), "a narrow one has its left edges in line"


def test_the_tab_key_goes_down_the_panel_and_rows_are_read_aloud(document, panel):
    job = document.job
    document.change_job("Change diameter", with_tool(job, 1, replace(job.tools[0], diameter=8.0)))
    QApplication.processEvents()
    stop, seen = panel.tools.add_button, []
    while len(seen) < 9:
        if stop.isVisible() and stop.focusPolicy() & Qt.FocusPolicy.TabFocus:
            QApplication.sendEvent(stop, QFocusEvent(QEvent.Type.FocusIn))
            seen.append(stop.accessibleName())
        stop = stop.nextInFocusChain()
    rows = [each for each in seen if each.startswith("T")]
    assert seen[1:3] == rows[:2] and rows[0].startswith("T1, Flat 8 mm"), seen
    assert seen[3] == "Add an operation"
    assert [each.split(", ")[0] for each in seen[4:8]] == ["Pocket", "Pocket on or off", "Rest", "Rest on or off"]


def test_a_row_is_read_as_it_reads_now_unless_it_was_given_a_name(qtbot):
    """Whatever a translation has made of the name it had before."""
    label = QLabel("T1")
    row, named = ListRow(label), ListRow(QLabel("2 mm"))
    qtbot.addWidget(row)
    qtbot.addWidget(named)
    named.call("Gouge, 2 mm")
    for each in (row, named):
        QApplication.sendEvent(each, QFocusEvent(QEvent.Type.FocusIn))
    assert (row.accessibleName(), named.accessibleName()) == ("T1", "Gouge, 2 mm")
    row.setAccessibleName("工具 1")
    label.setText("T2")
    for each in (row, named):
        QApplication.sendEvent(each, QFocusEvent(QEvent.Type.FocusIn))
    assert (row.accessibleName(), named.accessibleName()) == ("T2", "Gouge, 2 mm")
