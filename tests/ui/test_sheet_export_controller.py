"""Sheet for the machine, from the menu: computed first where it has to be, written, and told."""

from dataclasses import replace

from app.ui.framework.computation import ComputationState
from tests.formats.pdf_words import pdf_pages
from tests.ui.conftest import WAIT_MS


def test_the_sheet_of_the_job_is_computed_and_written(qtbot, computed, tmp_path):
    document, exporting = computed.document, computed.sheet_export
    document.change_job("safe Z", replace(document.job, safe_z=7.5))
    exporting.choose_file = lambda first: tmp_path / first.name
    with qtbot.waitSignal(exporting.written, timeout=WAIT_MS) as caught:
        computed.window_.actions_["sheet"].trigger()
    assert computed.computation.state is ComputationState.CURRENT
    said = " ".join(word.text for page in pdf_pages(caught.args[0].read_bytes()) for word in page)
    assert "7.5 mm above the stock's top" in said and "Set-up sheet" in said
    assert computed.log.lines[-1].command == f"sheet {caught.args[0].name}"


def test_nothing_to_machine_has_no_sheet(qtbot, wiring, tmp_path):
    wiring.sheet_export.choose_file = lambda first: tmp_path / "a.pdf"
    with qtbot.waitSignal(wiring.sheet_export.failed, timeout=WAIT_MS) as caught:
        wiring.window_.actions_["sheet"].trigger()
    assert caught.args[0].startswith("There is no path for a sheet")
    assert not (tmp_path / "a.pdf").exists()
