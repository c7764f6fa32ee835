"""Title, badge, panel and picture speak of the same thing, in the real window."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QLabel

from app.core.resources import resource
from app.model.contour_operation import ContourOperation
from app.model.job import Job
from app.model.operation import CutParameters, PocketOperation
from app.model.tool import Tool
from app.model.tool_kind import ToolKind
from app.model.vcarve_operation import VcarveOperation
from app.ui.framework.computation import ComputationState
from app.ui.framework.figures import clock
from app.ui.framework.view import View
from app.ui.shell.files.nc_export_controller import ExportPlace
from app.ui.views.surfaces.scene_computation import SceneState
from tests.part_shapes import layered_part, square
from tests.ui.conftest import WAIT_MS

SLOT = (
    "(Stock: X 0 30 Y 0 20 Z -5 0)\n(Tool: T1 flat 6 mm)\nG21 G90\nT1 M6\nS9000 M3\n"
    "G0 X5 Y10 Z5\nG1 Z-1 F200\nX25\nG0 Z5\nM30\n"
)


@pytest.fixture
def foreign(qtbot, computed, tmp_path):
    """The sample, computed, and another program opened beside it."""
    path = tmp_path / "slot.ngc"
    path.write_text(SLOT)
    computed.files.open_file(path)
    qtbot.waitUntil(lambda: computed.nc.foreign and computed.nc.shown is not None, timeout=WAIT_MS)
    return computed


def test_in_the_nc_view_title_and_badge_are_those_of_the_program_that_is_shown(foreign):
    window, showing = foreign.window_, foreign.display_controller
    assert showing.view is View.NC
    assert window.file_label.text() == "slot.ngc"
    assert window.status.badge.text().startswith("No error in the text · ")
    showing.show_view(View.CURVES)
    assert window.file_label.text() == "slot.ngc" and "No error" in window.status.badge.text()
    showing.show_view(View.PATHS)
    assert window.file_label.text() == "fig2.dxf" and window.status.badge.text().startswith("✓ 0 gouge")
    foreign.nc.back()
    showing.show_view(View.NC)
    assert window.file_label.text() == "fig2.dxf" and window.status.badge.text().startswith("✓ 0 gouge")


def test_an_error_in_a_program_is_the_badge_and_a_press_goes_to_its_line(qtbot, wiring, tmp_path):
    path = tmp_path / "wrong.ngc"
    path.write_text(SLOT.replace("X25", "X"))
    wiring.files.open_file(path)
    qtbot.waitUntil(lambda: wiring.nc.shown is not None and wiring.nc.foreign, timeout=WAIT_MS)
    badge, listed = wiring.window_.status.badge, wiring.window_.findings_list
    assert badge.text() == "Error in line 8" and badge.property("verdict") == "bad"
    qtbot.mouseClick(badge, Qt.MouseButton.LeftButton)
    assert len(listed.rows) == 1
    wiring.display_controller.go_to(wiring.nc.shown_document.findings[0])
    listed.hide()
    assert wiring.window_.views.nc.pane.text.current == 7


@pytest.mark.exhaustive
def test_computing_brings_the_cut_back_to_the_job(qtbot, foreign):
    own = foreign.cut_controller
    foreign.nc.show_cut()
    qtbot.waitUntil(lambda: own.cut is not None and own.cut.given is not None, timeout=WAIT_MS)
    assert foreign.window_.file_label.text() == "slot.ngc"
    assert foreign.window_.status.badge.text() == foreign.window_.cut_panel.title.text()
    foreign.compute()
    assert own.shown_document is None and not foreign.nc.foreign
    assert foreign.window_.file_label.text() == "fig2.dxf"
    qtbot.waitUntil(lambda: foreign.computation.state is ComputationState.CURRENT, timeout=WAIT_MS)
    qtbot.waitUntil(lambda: own.cut is not None and own.cut.given is None, timeout=WAIT_MS)


def test_another_drawing_takes_the_cut_of_another_program_away(qtbot, foreign):
    foreign.nc.show_cut()
    qtbot.waitUntil(lambda: foreign.cut_controller.shown_document is not None, timeout=WAIT_MS)
    foreign.files.new()
    assert foreign.cut_controller.shown_document is None


def test_what_was_proven_goes_with_its_buttons_when_the_job_changes(qtbot, computed, tmp_path):
    exporting, notice = computed.files.export_controller, computed.window_.notice
    exporting.choose_file = lambda suffix, post: ExportPlace(tmp_path / "a.ngc", post)
    exporting.start()
    assert notice.isVisible() and "Read back" in notice.text.text()
    computed.document.select(frozenset({1}))
    assert notice.isVisible(), "looking at something is no change"
    computed.document.run("circle 150,50 10")
    assert not notice.isVisible()


def test_nobody_is_told_to_compute_where_nothing_is_drawn_any_more(qtbot, computed):
    window, showing = computed.window_, computed.display_controller
    showing.show_view(View.CUT)
    qtbot.waitUntil(lambda: computed.cut_controller.cut is not None, timeout=WAIT_MS)
    everything = tuple(entity.id for entity in computed.document.part.entities)
    computed.document.select(everything)
    computed.document.run("delete")
    assert not window.actions_["compute"].isEnabled()
    assert window.cut_panel.title.text() == "Out of date: nothing is drawn any more"
    showing.show_view(View.NC)
    banner = window.views.nc.pane.banner
    qtbot.waitUntil(lambda: banner.sentence.text() == "Nothing is drawn any more.", timeout=WAIT_MS)
    assert banner.button.isHidden()


def test_the_list_of_findings_wants_a_drawing_before_it_wants_f5(wiring):
    listed = wiring.window_.findings_list
    for said in ("Nothing is drawn; draw a part or open a drawing.", "Press F5."):
        wiring.display_controller.open_findings()
        assert any(label.text().endswith(said) for label in listed.findChildren(QLabel))
        listed.hide()
        wiring.document.run("line 0,0 9,0")


def test_a_question_stays_until_it_is_answered(wiring):
    wiring.document.run("circle 0,0 10")
    wiring.files.ask_new()
    wiring.document.run("circle 50,0 10")
    assert wiring.window_.notice.isVisible()


def test_the_sample_part_brings_its_own_job(qtbot, wiring):
    job = wiring.document.job
    wiring.document.change_job("Depth", replace(job, safe_z=33.0, operations=(ContourOperation(CutParameters(1)),)))
    wiring.files.open_sample()
    qtbot.waitUntil(lambda: wiring.document.path is not None, timeout=WAIT_MS)
    assert wiring.document.job.safe_z == 5.0
    assert len(wiring.document.job.operations) > 1


def test_an_empty_layer_and_a_colour_make_nothing_out_of_date(computed):
    computed.document.run("layer empty")
    assert computed.computation.state is ComputationState.CURRENT
    computed.document.run("circle 150,50 10")
    assert computed.computation.state is ComputationState.STALE


def test_the_times_of_the_operations_and_what_is_waited_for_add_up(computed):
    panel, data = computed.window_.panel, computed.computation.made.report.data
    times = [computed.computation.operation_times()[index] for index in range(len(panel.operations.switches))]
    shown = panel._times.whole()
    rows = [row.time.text() for row in panel.operations.waiting]
    assert len(rows) >= 2, "two tools are changed, and the spindle is waited for"
    beside = shown.beside
    assert sum(shown.of.values()) + beside.changing + beside.dwelling + beside.travelling == round(data["time_s"])
    assert rows[0] == clock(data["tool_changes"]["time_s"]) and data["tool_changes"]["count"] == 2
    assert sum(times) < data["time_s"]
    computed.document.run("circle 150,50 10")
    assert not panel.operations.waiting


def test_the_time_of_a_flat_tool_is_that_of_the_carving_that_asks_for_it(qtbot, wiring):
    tools = (Tool(1, 3.0), Tool(2, 12.0, ToolKind.V, tip_angle=math.radians(90)))
    carving = VcarveOperation(CutParameters(2, depth=3.0, stepdown=3.0), 1)
    wiring.document.run("rectangle 0,0 40,30")
    wiring.document.change_job("Carve", replace(wiring.document.job, tools=tools, operations=(carving,)))
    wiring.computation.start()
    qtbot.waitUntil(lambda: wiring.computation.state is ComputationState.CURRENT, timeout=WAIT_MS)
    made = wiring.computation.made
    assert made.clean and len(made.job.operations) == 2 and len(wiring.document.job.operations) == 1
    times, told = wiring.computation.operation_times(), made.report.data["operations"]
    assert list(times) == [0] and times[0] == pytest.approx(told[0]["time_s"] + told[1]["time_s"])
    shown = wiring.window_.panel._times.whole()
    beside = shown.beside
    whole = sum(shown.of.values()) + beside.changing + beside.dwelling + beside.travelling
    assert whole == round(made.report.data["time_s"])


@pytest.mark.exhaustive
def test_a_scene_that_opens_shows_nothing_of_the_one_before_and_its_surfaces_first(qtbot, wiring):
    wiring.scenes.open_sample("torus")
    work, view = wiring.scenes.work, wiring.window_.views.surfaces
    qtbot.waitUntil(lambda: work.state is SceneState.PROVEN, timeout=60_000)
    moves: list[int] = []
    work.computed.connect(lambda shown, again: moves.append(len(shown.computed.moves.moves)))
    wiring.scenes.open(resource("samples", "spheres.toml"))
    assert view.shown is None and wiring.window_.status.badge.text().endswith("Computing")
    assert wiring.window_.file_label.text() == "spheres.toml"
    qtbot.waitUntil(lambda: view.shown is not None, timeout=WAIT_MS)
    assert moves[0] == 0 and view.shown.computed.scene.name == "spheres"
    qtbot.waitUntil(lambda: work.state is SceneState.PROVEN, timeout=60_000)
    assert moves[-1] > 0


@pytest.mark.parametrize("name", ["tool_library", "which_tool"])
def test_what_is_opened_in_the_panel_of_the_job_is_seen(wiring, name):
    window = wiring.window_
    section = {"tool_library": window.panel.library, "which_tool": window.panel.advice}[name]
    wiring.document.run("rectangle 0,0 20,20")
    wiring.display_controller.show_view(View.DRAW)
    window.side.show_page("Drawing")
    window.actions_[name].trigger()
    assert section.isVisible() and window.side.page == "Job"
    window.side.show_page("Drawing")
    window.actions_[name].trigger()
    assert section.isVisible(), "what is covered comes to the front, and is not closed unseen"
    window.actions_[name].trigger()
    assert section.isHidden()


@pytest.mark.parametrize("name", ["job_properties", "add_tool", "add_pocket"])
def test_what_is_added_to_the_job_is_seen(wiring, name):
    wiring.document.run("rectangle 0,0 20,20")
    wiring.display_controller.show_view(View.DRAW)
    wiring.window_.side.show_page("Drawing")
    wiring.window_.actions_[name].trigger()
    assert wiring.window_.side.page == "Job"


def test_what_computing_again_cannot_help_offers_no_such_button(qtbot, wiring):
    cut = CutParameters(1, depth=11.0)
    wiring.document.load(Job(layered_part({"0": [square(20.0)]}), (Tool(1, 6.0),), (PocketOperation(cut),)))
    wiring.compute()
    qtbot.waitUntil(lambda: wiring.computation.state is ComputationState.FAILED, timeout=WAIT_MS)
    window, empty = wiring.window_, wiring.window_.views.empty
    for view in (View.PATHS, View.CUT, View.NC):
        wiring.display_controller.show_view(view)
        assert "reduce the depth" in empty.sentence.text() and not empty.button.isVisible()
    qtbot.mouseClick(window.status.badge, Qt.MouseButton.LeftButton)
    told = [label.text() for label in window.findings_list.findChildren(QLabel)]
    assert any("11 mm" in text for text in told), told


def test_where_no_scene_is_open_the_prompt_says_how_to_open_one(wiring):
    wiring.display_controller.show_view(View.SURFACES)
    assert wiring.window_.command_line.edit.placeholderText().startswith("Open a scene, drop a solid")
