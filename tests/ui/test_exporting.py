"""Export for controls that change no tools, and the frame of the job, on the real engines."""

from dataclasses import replace

from app.ui.computation import State
from tests.ui.conftest import WAIT_MS


def test_a_control_without_tool_changes_gets_a_file_for_each_tool_or_none(qtbot, computed, tmp_path):
    document, exporting = computed.document, computed.files.exporting
    document.change_job("post", replace(document.job, post="grbl"))
    (tmp_path / "part_2_T2.nc").mkdir()
    exporting.choose_file = lambda ending: tmp_path / "part"
    with qtbot.waitSignal(exporting.failed, timeout=WAIT_MS) as caught:
        exporting.start()
    assert "part_2_T2.nc" in caught.args[0]
    assert [path.name for path in tmp_path.iterdir()] == ["part_2_T2.nc"]
    (tmp_path / "part_2_T2.nc").rmdir()
    with qtbot.waitSignal(exporting.written, timeout=WAIT_MS) as caught:
        exporting.start()
    assert [path.name for path in caught.args[0]] == ["part_1_T1.nc", "part_2_T2.nc"]
    assert [path.read_text("ascii") for path in caught.args[0]] == [file.nc.text for file in computed.computation.made.files]
    assert "part_1_T1.nc, part_2_T2.nc are written." in computed.window_.status.message.toolTip()


def test_the_frame_is_computed_and_written(qtbot, computed, tmp_path):
    document = computed.document
    document.change_job("safe Z", replace(document.job, safe_z=7.5))
    asked = []
    computed.files.exporting.choose_file = lambda ending: asked.append(ending) or tmp_path / "frame.ngc"
    with qtbot.waitSignal(computed.files.exporting.written, timeout=WAIT_MS):
        computed.window_.actions_["frame"].trigger()
    assert computed.computation.state is State.CURRENT
    assert asked == ["_frame.ngc"]
    text = (tmp_path / "frame.ngc").read_text("ascii")
    assert text == computed.computation.made.frame()
    assert "Z7.5000" in text
    assert "M3" not in text
