"""Export for controls that change no tools, and the frame of the job, on the real engines."""

from dataclasses import replace

from app.model.contour_operation import ContourOperation
from app.model.operation import CutParameters, PocketOperation
from app.ui.framework.computation import ComputationState
from app.ui.framework.view import View
from app.ui.panels.changes import with_tool
from app.ui.shell.files.nc_export_controller import ExportPlace, post_filters
from tests.ui.conftest import WAIT_MS


def test_a_control_without_tool_changes_gets_a_file_for_each_tool_or_none(qtbot, computed, tmp_path):
    document, exporting = computed.document, computed.files.export_controller
    document.change_job("post", replace(document.job, post="grbl"))
    (tmp_path / "part_2_T2.nc").mkdir()
    exporting.choose_file = lambda suffix, post: ExportPlace(tmp_path / "part", post)
    with qtbot.waitSignal(exporting.failed, timeout=WAIT_MS) as caught:
        exporting.start()
    assert "part_2_T2.nc" in caught.args[0]
    assert [path.name for path in tmp_path.iterdir()] == ["part_2_T2.nc"]
    (tmp_path / "part_2_T2.nc").rmdir()
    with qtbot.waitSignal(exporting.written, timeout=WAIT_MS) as caught:
        exporting.start()
    assert [path.name for path in caught.args[0]] == ["part_1_T1.nc", "part_2_T2.nc"]
    assert [path.read_text("ascii") for path in caught.args[0]] == [
        file.nc.text for file in computed.computation.made.files
    ]
    assert "part_1_T1.nc, part_2_T2.nc are written." in computed.window_.status.message.toolTip()


def test_the_frame_is_computed_and_written(qtbot, computed, tmp_path):
    document = computed.document
    document.change_job("safe Z", replace(document.job, safe_z=7.5))
    asked = []
    computed.files.export_controller.choose_file = lambda suffix, post: (
        asked.append(suffix) or ExportPlace(tmp_path / "frame.ngc", post)
    )
    with qtbot.waitSignal(computed.files.export_controller.written, timeout=WAIT_MS):
        computed.window_.actions_["frame"].trigger()
    assert computed.computation.state is ComputationState.CURRENT
    assert asked == ["_frame"]
    text = (tmp_path / "frame.ngc").read_text("ascii")
    assert text == computed.computation.made.frame()
    assert "Z7.5000" in text
    assert "M3" not in text


def test_what_was_proven_is_said_before_the_file_is_asked_for(qtbot, computed, tmp_path):
    said = []
    notice = computed.window_.notice
    computed.files.export_controller.choose_file = lambda suffix, post: (
        said.append((notice.isVisible(), notice.text.text())) or ExportPlace(tmp_path / "part", post)
    )
    with qtbot.waitSignal(computed.files.export_controller.written, timeout=WAIT_MS):
        computed.files.export_controller.start()
    shown, sentence = said[0]
    made = computed.computation.made
    assert shown and "no gouge" in sentence and "nothing left within reach" in sentence
    assert f"{made.cut.judgement.certificate.gouge_mm:.3f} mm into the part" in sentence
    assert notice.property("error") == "false" and not notice.buttons


def test_metal_left_is_shown_in_the_cut_before_anything_is_written(qtbot, computed, tmp_path):
    document, exporting, window = computed.document, computed.files.export_controller, computed.window_
    asked = []
    exporting.choose_file = lambda suffix, post: asked.append(suffix)
    document.change_job(
        "wide",
        replace(document.job, operations=(PocketOperation(CutParameters(1)), ContourOperation(CutParameters(2)))),
    )
    document.change_job("large", with_tool(document.job, 1, replace(document.job.tool(1), diameter=12.0)))
    exporting.start()
    notice = window.notice
    qtbot.waitUntil(lambda: [button.text() for button in notice.buttons] == ["Show", "Write anyway"], timeout=WAIT_MS)
    assert "aterial left" in notice.text.text()
    assert not asked
    made = computed.computation.made
    qtbot.waitUntil(
        lambda: computed.cut_controller.cut is not None and computed.cut_controller.cut.cut is made.cut, timeout=WAIT_MS
    )
    notice.buttons[0].click()
    assert computed.display_controller.view is View.CUT
    assert (
        window.cut_panel.chosen.title.startswith("Left ")
        and window.views.cut.overlay.pin.place == window.cut_panel.chosen.place
    )
    assert not asked


def test_the_control_is_chosen_with_the_file_and_the_job_computed_for_it(qtbot, computed, tmp_path):
    exporting = computed.files.export_controller
    exporting.choose_file = lambda suffix, post: ExportPlace(tmp_path / "part", "haas")
    with qtbot.waitSignal(exporting.written, timeout=WAIT_MS) as caught:
        exporting.start()
    assert computed.document.job.post == computed.computation.made.job.post == "haas"
    (path,) = caught.args[0]
    assert path.read_text("ascii") == computed.computation.made.nc.text
    assert "O0" in path.read_text("ascii")
    computed.document.undo()
    assert computed.document.job.post == "linuxcnc"


def test_every_control_is_offered_with_the_suffix_of_its_files():
    filters = post_filters()
    assert filters["LinuxCNC (*.ngc)"] == "linuxcnc" and "grbl" in filters.values()
    assert all("(*." in each for each in filters)
