"""Operations proposed and chosen in the window: a step each, undone as one, right at the first F5."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from PySide6.QtCore import QPoint, QRect, QRectF, QSize, Qt

from app.drafting.document import Document
from app.model.chamfer_operation import ChamferOperation
from app.model.contour_operation import ContourOperation
from app.model.hole_operations import BoreOperation, CountersinkOperation, DrillOperation
from app.model.operation import PocketOperation, Side
from app.model.slot_operation import SlotOperation
from app.model.vcarve_operation import VcarveOperation
from app.ui.framework.computation import ComputationState
from app.ui.framework.samples import PathLineKind, sample_pen
from app.ui.framework.theme import DARK, LIGHT
from app.ui.framework.view import View
from app.ui.panels.changes import Subject, SubjectKind
from app.ui.shell.drawing.proposal_controller import NOTHING_DRAWN, NOTHING_SELECTED
from app.ui.shell.drawing.purpose_words import PurposeWord
from app.ui.shell.drawing.selection_ribbon import place_beside
from app.ui.shell.drawing.word_places import WordPlaces, place_at
from app.ui.views.canvas.canvas import Canvas
from app.ui.views.canvas.view_transform import ViewTransform

WAIT_MS = 20_000
PLATE = ("rectangle 0,0 80,50", "rectangle 25,15 55,35", "circle 12,25 3", "circle 68,25 3")


@pytest.fixture
def plate(wiring):
    """A plate with an inner rectangle and two holes of 6 mm."""
    for line in PLATE:
        wiring.document.run(line)
    return wiring


def proposed(qtbot, wiring, command="propose"):
    with qtbot.waitSignal(wiring.proposal_controller.worker.done, timeout=WAIT_MS):
        wiring.window_.actions_[command].trigger()
    return wiring.document.job


def test_a_plate_comes_out_right_at_the_first_compute(qtbot, plate):
    job = proposed(qtbot, plate)
    kinds = [type(each) for each in job.operations]
    assert kinds[0] is DrillOperation
    assert PocketOperation in kinds
    assert isinstance(job.operations[-1], ContourOperation)
    assert job.operations[-1].side is Side.OUTSIDE
    notes = [line for line in plate.log.lines if line.command.startswith("propose ")]
    assert len(notes) == len(kinds)
    assert "2 holes of 6 mm" in notes[0].reply
    plate.window_.notice.buttons[0].click()
    qtbot.waitUntil(lambda: plate.computation.state is not ComputationState.RUNNING, timeout=WAIT_MS)
    assert plate.computation.state is ComputationState.CURRENT, plate.computation.error
    assert [each.text for each in plate.computation.made.findings if each.counts] == []


def test_one_undo_brings_back_operations_tools_and_stock(qtbot, plate):
    before = plate.document.job
    assert proposed(qtbot, plate) != before
    plate.window_.actions_["undo"].trigger()
    assert plate.document.job == before


def test_as_in_1986_gives_back_the_rule_that_a_job_begins_with(qtbot, plate):
    before = plate.document.job
    proposed(qtbot, plate)
    after = proposed(qtbot, plate, "propose_1986")
    assert (after.operations, after.tools) == (before.operations, before.tools)


def test_nothing_drawn_is_said(wiring):
    wiring.window_.actions_["propose"].trigger()
    assert not wiring.proposal_controller.worker.busy
    assert wiring.window_.status.message.toolTip() == NOTHING_DRAWN


def test_an_opened_drawing_offers_a_proposal_and_keeps_its_operations(qtbot, wiring, tmp_path):
    path = tmp_path / "plate.draw"
    path.write_text("\n".join(PLATE) + "\n")
    before = wiring.document.job.operations
    with qtbot.waitSignal(wiring.files.open_controller.opened, timeout=WAIT_MS):
        wiring.files.open_file(path)
    notice = wiring.window_.notice
    assert notice.isVisible()
    assert [each.text() for each in notice.buttons] == ["Propose operations", "Keep the operations there are"]
    assert wiring.document.job.operations == before
    with qtbot.waitSignal(wiring.proposal_controller.worker.done, timeout=WAIT_MS):
        notice.buttons[0].click()
    assert isinstance(wiring.document.job.operations[0], DrillOperation)


def opened(qtbot, wiring, path):
    with qtbot.waitSignal(wiring.files.open_controller.opened, timeout=WAIT_MS):
        wiring.files.open_file(path)
    return wiring.document.job.operations


def computed_at_once(qtbot, wiring):
    """Press F5 and wait for the paths."""
    wiring.window_.actions_["compute"].trigger()
    ended = (ComputationState.CURRENT, ComputationState.FAILED)
    qtbot.waitUntil(lambda: wiring.computation.state in ended, timeout=WAIT_MS)
    assert wiring.computation.state is ComputationState.CURRENT, wiring.computation.error
    return [type(each) for each in wiring.document.job.operations]


def test_an_opened_drawing_is_proposed_for_at_its_first_compute_alone(qtbot, wiring, tmp_path):
    path = tmp_path / "plate.draw"
    path.write_text("\n".join(PLATE) + "\n")
    before = opened(qtbot, wiring, path)
    kinds = computed_at_once(qtbot, wiring)
    assert kinds[0] is DrillOperation
    assert kinds[-1] is ContourOperation
    assert [each.text() for each in wiring.window_.notice.buttons] == ["As in 1986", "Undo"]
    wiring.window_.actions_["undo"].trigger()
    assert wiring.document.job.operations == before
    assert computed_at_once(qtbot, wiring) == [type(each) for each in before]


def test_the_first_file_that_cannot_be_read_leaves_nothing_to_compute(qtbot, wiring, tmp_path):
    path = tmp_path / "wrong.dxf"
    path.write_bytes(b"nothing")
    wiring.files.open_file(path)
    assert wiring.window_.actions_["compute"].isEnabled()
    wiring.window_.actions_["compute"].trigger()
    qtbot.waitUntil(lambda: wiring.window_.notice.isVisible(), timeout=WAIT_MS)
    assert not wiring.window_.actions_["compute"].isEnabled() and wiring.computation.made is None
    assert "Nothing is drawn yet" in wiring.window_.views.empty.sentence.text()


@pytest.mark.parametrize("is_sample", [False, True], ids=["a file", "a sample that is proposed for as it opens"])
def test_compute_waits_for_the_drawing_that_is_being_opened(qtbot, wiring, samples, tmp_path, is_sample):
    """It took the place of the opening, which was lost without a word."""
    path = samples / "nameplate.draw"
    if not is_sample:
        path = tmp_path / "plate.draw"
        path.write_text("\n".join(PLATE))
    window, compute = wiring.window_, wiring.window_.actions_["compute"]
    assert not compute.isEnabled(), "nothing is drawn"
    wiring.files.open_file(path)
    assert window.views.empty.sentence.text() == f"{path.name} is being read." and window.views.empty.isVisible()
    compute.trigger()
    qtbot.waitUntil(lambda: wiring.computation.state is ComputationState.CURRENT, timeout=WAIT_MS)
    assert wiring.document.path == path and wiring.computation.made.files
    assert type(wiring.document.job.operations[-1]) is ContourOperation


def test_operations_that_were_said_stay_at_the_first_compute(qtbot, wiring, tmp_path):
    path = tmp_path / "plate.draw"
    path.write_text("\n".join(PLATE) + "\n")
    opened(qtbot, wiring, path)
    wiring.window_.notice.buttons[1].click()
    assert not wiring.proposal_controller.due
    opened(qtbot, wiring, path)
    assert wiring.proposal_controller.due
    wiring.window_.panel.operations.added.emit(DrillOperation)
    assert not wiring.proposal_controller.due


def test_fig_2_keeps_the_rule_of_1986_wherever_it_lies(qtbot, wiring, samples, tmp_path):
    path = tmp_path / "drawn.dxf"
    path.write_bytes((samples / "fig2.dxf").read_bytes())
    before = opened(qtbot, wiring, path)
    assert wiring.proposal_controller.due
    computed_at_once(qtbot, wiring)
    assert wiring.document.job.operations == before


def test_what_has_nothing_to_propose_is_computed_as_it_stands(qtbot, wiring, tmp_path):
    path = tmp_path / "gap.draw"
    path.write_text("line 0,0 20,0 20,20 0,0.5\n")
    before = opened(qtbot, wiring, path)
    wiring.window_.actions_["compute"].trigger()
    qtbot.waitUntil(lambda: not wiring.proposal_controller.worker.busy, timeout=WAIT_MS)
    assert not wiring.proposal_controller.due
    assert wiring.computation.state is not ComputationState.NONE
    assert wiring.document.job.operations == before


def test_the_plus_menu_of_the_operations_proposes(qtbot, plate):
    entries = {each.text(): each for each in plate.window_.panel.operations.menu.actions()}
    with qtbot.waitSignal(plate.proposal_controller.worker.done, timeout=WAIT_MS):
        entries["Propose operations"].trigger()
    assert isinstance(plate.document.job.operations[0], DrillOperation)


def machined(qtbot, wiring, way, *numbers):
    wiring.document.select(numbers)
    with qtbot.waitSignal(wiring.proposal_controller.worker.done, timeout=WAIT_MS):
        wiring.window_.actions_[f"machine_{way}"].trigger()
    return wiring.document.job


@pytest.fixture
def numbers(plate):
    """Numbers of the curves: outline, inner rectangle, holes."""
    ids = [entity.id for entity in plate.document.part.entities]
    assert len(ids) == 10
    return ids[:4], ids[4:8], ids[8:]


WAYS = {
    "pocket": (PocketOperation, None, 1),
    "outside": (ContourOperation, Side.OUTSIDE, 0),
    "inside": (ContourOperation, Side.INSIDE, 1),
    "on": (ContourOperation, Side.ON, 1),
    "slot": (SlotOperation, None, 1),
    "drill": (DrillOperation, None, 2),
    "bore": (BoreOperation, None, 2),
    "countersink": (CountersinkOperation, None, 2),
    "chamfer": (ChamferOperation, Side.INSIDE, 1),
    "engrave": (ContourOperation, Side.ON, 1),
    "vcarve": (VcarveOperation, None, 1),
}


@pytest.mark.parametrize("way", WAYS)
def test_a_selection_becomes_an_operation_of_its_own_curves(qtbot, plate, numbers, way):
    kind, side, which = WAYS[way]
    before = plate.document.job
    job = machined(qtbot, plate, way, *numbers[which])
    shown = plate.window_.panel.subject
    new = job.operations[shown.key]
    assert isinstance(new, kind)
    assert side is None or new.side is side
    wanted = numbers[which] if which == 2 else numbers[which][:1]
    assert [each.text for each in new.cut.curves] == [f"#{number}" for number in wanted]
    assert job.operations == (new,), "those that a job begins with, which nobody chose, are gone"
    assert job.tool(new.cut.tool) in job.tools
    plate.window_.actions_["undo"].trigger()
    assert plate.document.job == before


def test_saying_what_each_curve_is_makes_a_plate_that_is_right_at_once(qtbot, plate, numbers):
    outline, inner, holes = numbers
    machined(qtbot, plate, "outside", *outline)
    machined(qtbot, plate, "pocket", *inner)
    plate.document.select(holes)
    job = machined(qtbot, plate, "drill", *holes)
    on = [each for each in job.operations if each.cut.enabled]
    assert [type(each) for each in on] == [DrillOperation, PocketOperation, ContourOperation]
    plate.compute()
    qtbot.waitUntil(lambda: plate.computation.state is not ComputationState.RUNNING, timeout=WAIT_MS)
    assert plate.computation.state is ComputationState.CURRENT, plate.computation.error
    assert [each.kind for each in plate.computation.made.findings if each.counts] == []


def test_operations_that_somebody_chose_stay_and_can_be_switched_off(qtbot, plate, numbers):
    plate.window_.panel.operations.added.emit(PocketOperation)
    job = machined(qtbot, plate, "pocket", *numbers[1])
    assert len(job.operations) == 5 and all(each.cut.enabled for each in job.operations)
    own = job.operations[plate.window_.panel.subject.key]
    plate.window_.notice.buttons[0].click()
    assert own.cut.curves and [each for each in plate.document.job.operations if each.cut.enabled] == [own]


def test_the_ribbon_over_a_selection_says_what_it_is_to_become(qtbot, plate, numbers):
    ribbon, canvas = plate.ribbon, plate.window_.canvas
    plate.document.select(())
    assert ribbon.isHidden()
    plate.document.select(numbers[2])
    assert not ribbon.isHidden() and canvas.area.contains(ribbon.geometry())
    plate.window_.actions_["tool_line"].trigger()
    assert ribbon.isHidden(), "no tool is in its way"
    plate.window_.actions_["tool_select"].trigger()
    plate.document.select(numbers[2])
    with qtbot.waitSignal(plate.proposal_controller.worker.done, timeout=WAIT_MS):
        qtbot.mouseClick(ribbon.buttons["drill"], Qt.MouseButton.LeftButton)
    assert [type(each) for each in plate.document.job.operations] == [DrillOperation]
    plate.display_controller.show_view(View.PATHS)
    assert ribbon.isHidden()


def test_what_a_selection_cannot_become_is_grey_and_says_why(qtbot, plate, numbers):
    ribbon, ways = plate.ribbon, plate.selection_ways
    plate.document.select(numbers[1])
    qtbot.waitUntil(lambda: not ribbon.buttons["drill"].isEnabled(), timeout=WAIT_MS)
    assert "is no circle, so it cannot be drilled" in ribbon.buttons["drill"].toolTip()
    assert [way for way, button in ribbon.buttons.items() if not button.isEnabled()] == ["drill"]
    machined = next(each for each in plate.context_menu.made(None).actions() if each.menu() is not None).menu()
    grey = [each.toolTip() for each in machined.actions() if not each.isEnabled()]
    assert len(grey) == 3 and grey[0] == ways.refused["drill"], "drill, bore, countersink"
    plate.document.select(numbers[2])
    assert ribbon.buttons["drill"].isEnabled()
    plate.document.run("line 0,60 20,70")
    plate.document.select([max(each.id for each in plate.document.part.entities)])
    qtbot.waitUntil(lambda: not ribbon.buttons["pocket"].isEnabled(), timeout=WAIT_MS)
    assert [way for way, button in ribbon.buttons.items() if button.isEnabled()] == ["on", "engrave"]


def words_of(wiring) -> list[str]:
    return [each.text() for each in wiring.purpose_words.words]


def test_what_curves_are_to_become_is_a_word_at_each_area_and_changed_by_a_press(qtbot, plate):
    job, told = proposed(qtbot, plate), plate.purpose_words
    qtbot.waitUntil(lambda: len(told.words) == 4, timeout=WAIT_MS)
    assert words_of(plate) == ["Drill · through"] * 2 + ["Pocket · 2 mm", "Contour outside · through · 4 tabs"]
    assert all(not each.isHidden() for each in told.words)
    qtbot.mouseClick(told.words[2], Qt.MouseButton.LeftButton)
    actions = {each.text(): each for each in told.menu.actions()}
    told.menu.hide()
    assert not actions["Drill"].isEnabled() and "Pocket" not in actions
    actions["Leave this standing"].trigger()
    assert PocketOperation not in [type(each) for each in plate.document.job.operations]
    qtbot.waitUntil(lambda: len(told.words) == 3, timeout=WAIT_MS)
    plate.window_.actions_["undo"].trigger()
    assert plate.document.job == job


def test_one_hole_of_two_is_left_standing_and_another_becomes_a_pocket(qtbot, plate, numbers):
    proposed(qtbot, plate)
    told = plate.purpose_words
    qtbot.waitUntil(lambda: len(told.words) == 4, timeout=WAIT_MS)
    told.words[0].click()
    told.menu.hide()
    told.menu.actions()[0].trigger()
    drill = plate.document.job.operations[0]
    assert isinstance(drill, DrillOperation) and [each.text for each in drill.cut.curves] == [f"#{numbers[2][1]}"]
    qtbot.waitUntil(lambda: len(told.words) == 3, timeout=WAIT_MS)
    told.words[0].click()
    told.menu.hide()
    with qtbot.waitSignal(plate.proposal_controller.worker.done, timeout=WAIT_MS):
        next(each for each in told.menu.actions() if each.text() == "Pocket").trigger()
    kinds = [type(each) for each in plate.document.job.operations]
    assert DrillOperation not in kinds and kinds.count(PocketOperation) == 2


@pytest.mark.parametrize(
    ("area", "filled", "at"),
    [
        (QRect(100, 100, 200, 100), True, QPoint(174, 139)),
        (QRect(100, 100, 200, 100), False, QPoint(174, 169)),
        (QRect(100, 100, 30, 30), True, QPoint(89, 133)),
        (QRect(100, 100, 30, 300), False, QPoint(89, 403)),
    ],
)
def test_a_word_stands_in_its_area_or_below_one_that_is_small(area, filled, at):
    assert place_at(area, QSize(50, 20), filled).topLeft() == at


def test_a_word_covers_no_other_one_and_few_curves() -> None:
    view, word = ViewTransform(scale=10.0, ox=0.0, oy=600.0), QSize(80, 20)
    plate, hole, slot = (10.0, 10.0, 60.0, 40.0), (12.0, 20.0, 15.0, 23.0), (14.0, 25.0, 20.0, 27.0)
    places = WordPlaces(view, QRect(0, 0, 800, 600), np.array([plate, hole, slot]).T)
    box = QRectF(hole[0], hole[1], 3.0, 3.0)
    beside = places.take(box, word, filled=True)
    assert beside == QRect(QPoint(157, 374), word), "below and above it lies over the plate's edge"
    assert places.take(box, word, filled=True).topLeft() == QPoint(94, 403), "next best"
    assert WordPlaces(view, QRect(0, 0, 50, 50), places.curves).take(box, word, filled=True) is None


@pytest.fixture
def in_japanese(wiring):
    wiring.window_.actions_["language_ja"].trigger()
    yield
    wiring.window_.actions_["language_en"].trigger()


@pytest.mark.usefixtures("in_japanese")
def test_words_are_as_large_as_they_are_in_japanese(qtbot, plate):
    proposed(qtbot, plate)
    told = plate.purpose_words
    qtbot.waitUntil(lambda: len(told.words) == 4, timeout=WAIT_MS)
    plate.window_.grab()
    qtbot.waitUntil(lambda: all(word.size() == word.sizeHint() for word in told.words), timeout=WAIT_MS)
    assert words_of(plate)[2:] == ["ポケット加工 · 2 mm", "輪郭加工 外側 · 貫通 · タブ 4 個"]
    plate.window_.actions_["units_inch"].trigger()
    assert words_of(plate)[2] == "Pocket · 0.07874 in", "in the unit that is shown, and looked up when it is seen"
    plate.window_.actions_["units_mm"].trigger()


def test_a_word_does_not_lie_over_the_size_of_the_stock(qtbot, plate):
    proposed(qtbot, plate)
    told, canvas = plate.purpose_words, plate.window_.canvas
    qtbot.waitUntil(lambda: len(told.words) == 4, timeout=WAIT_MS)
    for scale in (5.0, 4.0, 3.0, 2.5):
        canvas.set_view(replace(canvas.view, scale=scale).centred((40.0, 25.0), canvas.area))
        size = canvas.around.size_place(canvas.view).toAlignedRect()
        assert not size.isEmpty()
        assert not any(word.geometry().intersects(size) for word in told.words if not word.isHidden())


@pytest.mark.parametrize("theme", [LIGHT, DARK], ids=lambda theme: theme.name)
def test_a_word_has_a_dot_in_the_colour_of_its_paths(qtbot, theme) -> None:
    canvas = Canvas(Document(), theme)
    qtbot.addWidget(canvas)
    word = PurposeWord(canvas, PathLineKind.CONTOUR)
    word.resize(120, 24)
    assert word.grab().toImage().pixelColor(10, 12) == sample_pen(PathLineKind.CONTOUR, theme).color()


def test_words_are_gone_while_a_tool_is_in_hand_and_over_paths(qtbot, plate):
    proposed(qtbot, plate)
    told, window = plate.purpose_words, plate.window_
    qtbot.waitUntil(lambda: len(told.words) == 4, timeout=WAIT_MS)
    window.actions_["tool_line"].trigger()
    assert all(each.isHidden() for each in told.words)
    window.actions_["tool_select"].trigger()
    assert not told.words[0].isHidden()
    plate.display_controller.show_view(View.PATHS)
    assert all(each.isHidden() for each in told.words)


@pytest.mark.parametrize(
    ("selection", "at"),
    [
        (QRect(100, 200, 50, 40), QPoint(74, 156)),
        (QRect(100, 20, 50, 40), QPoint(74, 73)),
        (QRect(0, 200, 10, 10), QPoint(7, 156)),
        (QRect(-50, -50, 900, 900), QPoint(349, 7)),
        (QRect(), QPoint(349, 7)),
        (QRect(100, 2000, 50, 40), QPoint(74, 562)),
    ],
)
def test_the_ribbon_stands_where_it_is_seen(selection, at):
    assert place_beside(selection, QSize(100, 30), QRect(0, 0, 800, 600)) == at


def test_an_empty_selection_is_said(plate):
    plate.document.select(())
    before = plate.document.job
    plate.window_.actions_["machine_pocket"].trigger()
    assert not plate.proposal_controller.worker.busy
    assert plate.document.job == before
    assert plate.window_.status.message.toolTip() == NOTHING_SELECTED


def test_what_is_no_circle_is_not_drilled(qtbot, plate, numbers):
    plate.document.select(numbers[1])
    with qtbot.waitSignal(plate.proposal_controller.worker.failed, timeout=WAIT_MS):
        plate.window_.actions_["machine_drill"].trigger()
    assert "no circle" in plate.window_.notice.text.text()


def test_the_menu_at_the_mouse_offers_it_for_a_selection_alone(plate, numbers):
    menu = plate.context_menu
    plate.document.select(())
    assert "Machine this" not in [each.text() for each in menu.made(None).actions()]
    plate.document.select(numbers[1])
    made = menu.made(None)
    (sub,) = [each.menu() for each in made.actions() if each.text() == "Machine this"]
    assert [each.objectName() for each in sub.actions()] == [f"machine_{way}" for way in WAYS]


def test_the_curves_of_the_chosen_operation_are_marked(qtbot, plate, numbers):
    panel, canvas = plate.window_.panel, plate.window_.canvas
    panel.operations.added.emit(PocketOperation)
    machined(qtbot, plate, "pocket", *numbers[1])
    qtbot.waitUntil(lambda: not canvas.owned.isEmpty(), timeout=WAIT_MS)
    box = canvas.owned.boundingRect()
    assert (box.left(), box.top(), box.right(), box.bottom()) == (25, 15, 55, 35)
    panel.choose(Subject(SubjectKind.OPERATION, 0 if panel.subject.key else 1))
    assert canvas.owned.isEmpty(), "one that machines all marks none"


def test_an_operation_takes_the_selected_curves_in_one_step(qtbot, plate, numbers):
    panel, canvas = plate.window_.panel, plate.window_.canvas
    panel.choose(Subject(SubjectKind.OPERATION, 0))
    before = plate.document.job
    plate.document.select(numbers[2])
    with qtbot.waitSignal(plate.proposal_controller.worker.done, timeout=WAIT_MS):
        panel.operation_form.use.click()
    own = plate.document.job.operations[0].cut.curves
    assert [each.text for each in own] == [f"#{number}" for number in numbers[2]]
    qtbot.waitUntil(lambda: canvas.owned.boundingRect().right() == pytest.approx(71), timeout=WAIT_MS)
    plate.window_.actions_["undo"].trigger()
    assert plate.document.job == before
    assert canvas.owned.isEmpty()


def test_an_operation_takes_nothing_from_an_empty_selection(plate):
    plate.window_.panel.choose(Subject(SubjectKind.OPERATION, 0))
    plate.document.select(())
    before = plate.document.job
    plate.window_.panel.operation_form.use.click()
    assert plate.document.job == before
    assert plate.window_.status.message.toolTip() == NOTHING_SELECTED


def test_circles_that_drills_make_are_not_marked_as_a_pocket(qtbot, plate):
    job = proposed(qtbot, plate)
    panel, canvas = plate.window_.panel, plate.window_.canvas
    (pocket,) = [k for k, each in enumerate(job.operations) if each.COARSE]
    panel.choose(Subject(SubjectKind.OPERATION, pocket))
    qtbot.waitUntil(lambda: canvas.owned.boundingRect().left() == 25, timeout=WAIT_MS)
    panel.choose(Subject(SubjectKind.OPERATION, 0))
    qtbot.waitUntil(lambda: canvas.owned.boundingRect().left() == pytest.approx(9), timeout=WAIT_MS)
