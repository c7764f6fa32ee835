"""Export drawing: every format the dialog offers, read again by its reader; what was converted or left out is told."""

from dataclasses import replace
from pathlib import Path

import pytest

from app.formats.readers import read_drawing
from app.model.curves import Circle
from app.model.notes import Mark
from app.ui.shell.files.drawing_export_controller import offered
from tests.ui.conftest import WAIT_MS

LINES = (
    "layer holes",
    'colour holes "#d55e00"',
    "circle 10,10 4",
    "layer 0",
    "rect 0,0 60,40",
    "ellipse 30,20 40,20 5",
)


def export(qtbot, wiring, path: Path, format_: str) -> None:
    wiring.drawing_export.choose_file = lambda first: (path, format_)
    with qtbot.waitSignal(wiring.drawing_export.written, timeout=WAIT_MS):
        wiring.window_.actions_["export_drawing"].trigger()


@pytest.mark.parametrize("format_", offered().values())
def test_what_is_exported_is_read_again(qtbot, wiring, tmp_path, format_):
    for line in LINES:
        wiring.document.run(line)
    path = tmp_path / f"part{format_ if format_.startswith('.') else '.dxf'}"
    export(qtbot, wiring, path, format_)
    part = read_drawing(path.name, path.read_bytes()).part
    assert {layer.name for layer in part.layers} >= {"0", "holes"}
    assert len(part.entities) >= 6
    assert wiring.log.lines[-1].command == f"export {path.name}"
    converted = "1 ellipse became lines and arcs" in wiring.window_.notice.text.text()
    assert converted == (format_ == "R12")


def test_a_name_without_a_suffix_gets_that_of_the_format(qtbot, wiring, tmp_path):
    wiring.document.run("circle 0,0 5")
    export(qtbot, wiring, tmp_path / "my part", ".svg")
    assert (tmp_path / "my part.svg").read_bytes().startswith(b"<")


def test_the_suffix_typed_decides(qtbot, wiring, tmp_path):
    wiring.document.run("circle 0,0 5")
    export(qtbot, wiring, tmp_path / "part.draw", "R2010")
    assert "circle 0,0 5" in (tmp_path / "part.draw").read_text()


def test_notes_are_told_to_be_left_out(qtbot, wiring, tmp_path):
    job = wiring.document.job
    part = job.part.with_curves([Circle((0.0, 0.0), 5.0)], "0").with_note(Mark((3.0, 3.0)), "0")
    wiring.document.change_job("Point", replace(job, part=part))
    export(qtbot, wiring, tmp_path / "part.dxf", "R2018")
    assert "1 point, guide or dimension left out" in wiring.window_.notice.text.text()


def test_an_empty_drawing_is_told(qtbot, wiring):
    with qtbot.waitSignal(wiring.drawing_export.failed) as caught:
        wiring.window_.actions_["export_drawing"].trigger()
    assert "Nothing is drawn" in caught.args[0]


def test_a_file_that_cannot_be_written_is_told(qtbot, wiring, tmp_path):
    wiring.document.run("circle 0,0 5")
    wiring.drawing_export.choose_file = lambda first: (tmp_path / "none" / "a.dxf", "R2010")
    with qtbot.waitSignal(wiring.drawing_export.failed, timeout=WAIT_MS) as caught:
        wiring.drawing_export.start()
    assert "Cannot write" in caught.args[0]
