"""An inlay from the menu: asked for, made, laid into one another, and both programs written, or what is wrong said."""

from __future__ import annotations

from dataclasses import replace

import pytest

from app.core.resources import resource
from app.formats.job.toml import read_job
from app.ui.shell.drawing.inlay_controller import InlayForm
from app.usecases.inlay import InlayOptions

WAIT_MS = 60_000


@pytest.fixture
def carving(wiring):
    wiring.document.run("rectangle 0,0 20,14")
    data = resource("samples", "inlay.toml").read_bytes()
    job = read_job("inlay.toml", data).job
    wiring.document.change_job("job", replace(job, part=wiring.document.job.part))
    return wiring


def test_both_programs_are_made_and_written(qtbot, carving, tmp_path) -> None:
    inlay = carving.inlay_controller
    inlay.ask = lambda first: replace(first, glue=0.5)
    inlay.choose_file = lambda first: tmp_path / "badge"
    with qtbot.waitSignal(inlay.written, timeout=WAIT_MS):
        carving.window_.actions_["inlay"].trigger()
    assert {path.name for path in tmp_path.iterdir()} == {"badge_pocket.ngc", "badge_plug.ngc"}
    assert "plug in pocket: 0.0000 mm overlap" in carving.window_.notice.text.text()
    assert any("0.0000 mm overlap" in line.reply for line in carving.log.lines)


def test_a_job_that_is_no_inlay_is_refused(qtbot, wiring, tmp_path) -> None:
    wiring.document.run("rectangle 0,0 20,14")
    inlay = wiring.inlay_controller
    inlay.ask = lambda first: first
    inlay.choose_file = lambda first: tmp_path / "badge"
    with qtbot.waitSignal(inlay.failed, timeout=WAIT_MS) as told:
        inlay.start()
    assert "one operation, a vcarve with its flat_tool" in told.args[0] and not [*tmp_path.iterdir()]


def test_the_form_gives_what_is_typed(qtbot, wiring) -> None:
    form = InlayForm(wiring.window_, InlayOptions(0.3, 0.1, 2.0))
    assert form.wished == InlayOptions(0.3, 0.1, 2.0)
    form.saw.edit.selectAll()
    qtbot.keyClicks(form.saw.edit, "1.5")
    form.saw.edit.editingFinished.emit()
    assert form.wished.saw == 1.5
    form.close()
