"""A template applied in the window: operations by the layers' names, one step, said when nothing fits."""

from __future__ import annotations

from dataclasses import replace

import pytest

from app.core.resources import resource
from app.model.contour_operation import ContourOperation
from app.model.drawn_depths import DepthSource, DrawnDepth
from app.model.operation import PocketOperation

WAIT_MS = 20_000
TEMPLATE = resource("samples", "layers.toml")


@pytest.fixture
def plate(wiring):
    for line in ('layer "pocket 3mm"', "rectangle 10,10 40,30", 'layer "cut"', "rectangle 0,0 80,50"):
        wiring.document.run(line)
    return wiring


def applied(qtbot, wiring, path=TEMPLATE):
    with qtbot.waitSignal(wiring.template_controller.worker.done, timeout=WAIT_MS):
        wiring.template_controller.apply(path)
    return wiring.document.job


def test_the_layers_get_their_operations_as_one_step(qtbot, plate) -> None:
    before = plate.document.job
    job = applied(qtbot, plate)
    assert [(type(each), each.cut.depth) for each in job.operations] == [
        (PocketOperation, 3.0),
        (ContourOperation, 10.0),
    ]
    assert (job.stock.margin, len(job.tools), job.post, job.part) == (10.0, 3, before.post, before.part)
    assert "2 operations" in plate.window_.notice.text.text()
    (note,) = (line for line in plate.log.lines if "layer 'pocket 3mm'" in line.reply)
    assert "3 mm deep, as its name says" in note.reply
    plate.window_.actions_["undo"].trigger()
    assert plate.document.job == before


def test_what_does_not_fit_is_said_and_changes_nothing(qtbot, wiring, tmp_path) -> None:
    wiring.document.run("rectangle 0,0 80,50")
    before = wiring.document.job
    plain = tmp_path / "plain.toml"
    plain.write_text("[stock]\nthickness = 5\n")
    for path, words in ((TEMPLATE, "no rule of the template"), (plain, "has no rules for layers")):
        with qtbot.waitSignal(wiring.template_controller.failed, timeout=WAIT_MS) as told:
            wiring.template_controller.apply(path)
        assert words in told.args[0]
    assert wiring.document.job == before


def test_the_drawing_s_own_depths_are_taken_as_one_step(qtbot, wiring) -> None:
    wiring.document.run("rectangle 0,0 30,30")
    job = wiring.document.job
    told = DrawnDepth(DepthSource.TEXT, 4.0, "t=4", (5.0, 5.0), (), 2.0)
    unclear = DrawnDepth(DepthSource.TEXT, None, "depth?", (50.0, 50.0), (), 2.0)
    wiring.document.change_job("depths", replace(job, part=replace(job.part, depths=(told, unclear))))
    before = wiring.document.job
    with qtbot.waitSignal(wiring.template_controller.worker.done, timeout=WAIT_MS):
        wiring.template_controller.take_depths()
    assert {each.cut.depth for each in wiring.document.job.operations} == {4.0}
    assert "1 depth not understood" in wiring.window_.notice.text.text()
    assert any("text 't=4': 4 mm deep" in line.reply for line in wiring.log.lines)
    wiring.window_.actions_["undo"].trigger()
    assert wiring.document.job == before
